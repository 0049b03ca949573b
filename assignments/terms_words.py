"""The terms of an assignment in words, as handout and feedback page say them."""

from __future__ import annotations

from assignments.terms import Calendar, Late, moment_text

COUNTS = {
    "newest": "the newest attempt counts",
    "best": "the best attempt counts",
    "first": "the first attempt counts",
    "mean": "the mean of all attempts counts",
}
"""Which attempt counts, by the word of the terms."""


def late_text(late: Late) -> str:
    """Say what lateness costs, "" when it costs nothing.

    >>> late_text(Late("linear", share=0.1, per_hours=24, grace_minutes=15, cap=0.5))
    'Late work loses 10 % of its points for every 24 h begun, 50 % at most; up to 15 minutes are let pass.'
    >>> late_text(Late("steps", steps=((0, 0.1), (24, 0.3))))
    'Late work loses a part of its points: 10 % at once, 30 % after 24 h.'
    """
    if late.rule == "none":
        return ""
    if late.rule == "steps":
        lost = "a part of its points: " + ", ".join(_step(hours, share) for hours, share in late.steps)
    else:
        lost = f"{100 * late.share:.3g} % of its points"
        lost += f" for every {late.per_hours:g} h begun" if late.rule == "linear" else ""
    cap = f", {100 * late.cap:.3g} % at most" if late.cap < 1 else ""
    grace = f"; up to {late.grace_minutes:g} minutes are let pass" if late.grace_minutes else ""
    return f"Late work loses {lost}{cap}{grace}."


def _step(hours: float, share: float) -> str:
    return f"{100 * share:.3g} % {f'after {hours:g} h' if hours else 'at once'}"


def closes_text(calendar: Calendar, assignment_id: str, student: str = "") -> str:
    """Say when the last moment is, "" when there is none."""
    closes = calendar.terms_of(assignment_id, student).closes
    return f"Nothing counts that comes after {moment_text(closes, calendar.time_zone)}." if closes else ""


def terms_text(calendar: Calendar, assignment_id: str, student: str = "") -> tuple[str, ...]:
    """Return all that a student has to know, one sentence each; nothing where there are no terms."""
    terms, due = calendar.terms_of(assignment_id, student), calendar.due_text(assignment_id, student)
    attempts = {0: "", 1: "One attempt."}.get(terms.attempts, f"{terms.attempts} attempts; {COUNTS[terms.counts]}.")
    dues = (f"Due {due}.", late_text(terms.late)) if due else ()
    return tuple(filter(None, (*dues, closes_text(calendar, assignment_id, student), attempts)))

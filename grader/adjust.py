"""What a person decides about a grade: added beside the run that it settles, never over it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from assignments.model import Assignment
from grader.model import UNSURE_ABOUT, Finding, Grade, Outcome
from vml_course.errors import InputError, UnknownNameError

TOTAL = "total"
"""Stands for the whole attempt where a question's name is asked."""


@dataclass(frozen=True)
class Adjustment:
    """Points that a person gave to a question, or to the whole attempt (`total`)."""

    question: str
    points: float
    reason: str
    who: str
    at: str

    def told(self, symbol: str) -> str:
        """Say it to the student: of which symbol, and why; who decided is for the instructor's eyes."""
        return f"{symbol} set to {self.points:g} points: {self.reason}"

    def __str__(self) -> str:
        """Say it in one line."""
        return f"{self.question} set to {self.points:g} by {self.who} on {self.at[:10]}: {self.reason}"


@dataclass(frozen=True)
class Standing:
    """What an attempt earned: points of each question with the most it can earn, its outcomes, why to look."""

    points: float
    worth: Mapping[str, tuple[float, float]]
    outcomes: Mapping[str, Outcome]
    reasons: tuple[str, ...]


def decided(grade: Grade, adjustments: Iterable[Adjustment]) -> Grade:
    """Return a grade whose questions say what a person decided, in place of what was found; a pure function.

    The points of a question go to its aspects in proportion, so that every level keeps what it is worth.
    """
    newest = {item.question: item for item in adjustments if item.question != TOTAL}
    findings = tuple(
        _decided(finding, newest[finding.question_id], grade.of(finding.question_id))
        if finding.question_id in newest
        else finding
        for finding in grade.findings
    )
    still = tuple(d for d in grade.diagnosis if not set(d.ids or (d.subject,)) <= newest.keys())
    return replace(
        grade, findings=findings, diagnosis=still, decided=frozenset(newest) & {f.question_id for f in findings}
    )


def _decided(finding: Finding, item: Adjustment, aspects: tuple[Finding, ...]) -> Finding:
    """Return what a person decided of one aspect; the first one says why."""
    out_of = sum(one.out_of for one in aspects)
    points = item.points * finding.out_of / out_of if out_of else 0.0
    message = f"A person decided: {item.reason}" if finding is aspects[0] else ""
    return Finding(finding.question_id, finding.aspect, _outcome(item.points, out_of), points, finding.out_of, message)


def check_adjustment(assignment: Assignment, adjustment: Adjustment) -> None:
    """Refuse what cannot be given.

    Raises
    ------
    InputError
        When there is no such question, the points are out of range, or no reason is given.
    """
    worth = {**{q.id: q.points for q in assignment.questions}, TOTAL: assignment.total_points}
    if adjustment.question not in worth:
        raise UnknownNameError("question", adjustment.question, worth)
    if not 0 <= adjustment.points <= worth[adjustment.question]:
        expected = f"0 to {worth[adjustment.question]:g} for {adjustment.question}"
        raise InputError("points", expected, f"{adjustment.points:g}")
    if not adjustment.reason.strip():
        raise InputError("reason", "why the points are given", "nothing", "Say it with --reason.")


def settle(standing: Standing, adjustments: Iterable[Adjustment]) -> Standing:
    """Apply what a person decided, in order; a pure function.

    A question that was set is unsure no more; a total settles the whole attempt.

    >>> before = Standing(6.0, {"e": (6.0, 6.0)}, {"e": Outcome.UNSURE}, ("Unsure about e.",))
    >>> after = settle(before, [Adjustment("e", 2.0, "read from the scan", "ann", "2026-05-01")])
    >>> after.points, after.outcomes["e"].value, after.reasons
    (2.0, 'partial', ())
    """
    points, worth, outcomes, reasons = standing.points, dict(standing.worth), dict(standing.outcomes), standing.reasons
    for item in adjustments:
        if item.question == TOTAL:
            points, reasons = item.points, ()
            outcomes = {name: Outcome.PARTIAL if o is Outcome.UNSURE else o for name, o in outcomes.items()}
        elif item.question in worth:
            had, out_of = worth[item.question]
            points += item.points - had
            worth[item.question], outcomes[item.question] = (item.points, out_of), _outcome(item.points, out_of)
    if Outcome.UNSURE not in outcomes.values():
        reasons = tuple(reason for reason in reasons if not reason.startswith(UNSURE_ABOUT))
    return Standing(round(points, 6), worth, outcomes, reasons)


def _outcome(points: float, out_of: float) -> Outcome:
    if points >= out_of:
        return Outcome.RIGHT
    return Outcome.PARTIAL if points > 0 else Outcome.WRONG

"""How attempts, lateness and the due date are told to a student, in words."""

from __future__ import annotations

from dataclasses import dataclass

from assignments.terms import Terms
from assignments.terms_words import COUNTS, late_text
from grader.ledger import Row
from grader.page import counted, points_text


@dataclass(frozen=True)
class Standing:
    """What a student may still do, and what lateness did.

    Attributes
    ----------
    sentences : tuple of str
        Due date, lateness, attempts.
    may_hand_in : bool
        Whether another attempt would count.
    """

    sentences: tuple[str, ...]
    may_hand_in: bool


def standing(row: Row | None, terms: Terms, due: str, closes: str = "", *, is_over: bool) -> Standing:
    """Say where a student stands.

    Parameters
    ----------
    row : Row or None
        What counts; None: nothing is known of other attempts.
    terms : Terms
        With the student's extensions.
    due : str
        The due date in words, "" when there is none.
    closes : str
        A sentence on the last moment, "" when there is none.
    is_over : bool
        Whether the last moment has passed.
    """
    used = row.attempts if row else 1
    left = max(terms.attempts - used, 0) if terms.attempts else None
    sentences = [f"Due: {due}."] if due else []
    if not is_over:
        sentences += [late_text(terms.late) if due else "", closes]
    sentences += _lateness(row, terms) if row else []
    sentences.append(_attempts(used, left, terms, is_over=is_over))
    if row and row.ignored:
        sentences.append(_ignored(row.ignored))
    return Standing(tuple(sentence for sentence in sentences if sentence), not is_over and left != 0)


def _lateness(row: Row, terms: Terms) -> list[str]:
    if row.late_share <= 0:
        return []
    share = f"{100 * row.late_share:.3g} %"
    if row.late_share >= 1 and row.attempt in row.ignored:
        return ["It came after the last moment or after the last attempt, so it counts nothing."]
    off = points_text(row.earned - row.points)
    reach = " in the mean" if terms.counts == "mean" else ""
    return [f"Handed in late: {share}{reach} of the {points_text(row.earned)} points earned, {off}, are taken off."]


def _attempts(used: int, left: int | None, terms: Terms, *, is_over: bool) -> str:
    counts = f"{COUNTS[terms.counts].capitalize()}."
    how = counts if used > 1 or (left and not is_over) else ""
    if is_over:
        return f"{counted(used, 'attempt')} handed in; the time is over. {how}".strip()
    if left is None:
        return f"You may hand in again as often as you like. {counts}"
    said = "no attempt is left" if left == 0 else f"{counted(left, 'attempt')} left"
    return f"{used} of {counted(terms.attempts, 'attempt')} used, {said}. {how}".strip()


def _ignored(ignored: tuple[int, ...]) -> str:
    if len(ignored) == 1:
        return f"Attempt {ignored[0]} came too late, or was one too many: it does not count."
    return f"Attempts {', '.join(map(str, ignored))} came too late, or were too many: they do not count."

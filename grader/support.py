"""Whether a student's own tracking table supports a value, and whether an error was made in tracking or after it.

A value alone proves nothing: it can be guessed, or copied. Full credit for a conclusion needs a table that it could
come from; without one, points are counted and a person looks.
"""

from __future__ import annotations

from dataclasses import replace

from grader.model import Asked, Finding, Outcome
from grader.tracked import LEAST_EACH_SIDE, OUR_FAILURE

SDS = 3.0
METHOD = 2.0
"""The table's own value may be off by so many times what the reference says of it: a line is no joint fit."""


def supported(asked: Asked, finding: Finding, half_width: float) -> Finding:
    """Return a finding on a conclusion's value, held against the table that it should come from.

    Parameters
    ----------
    asked : Asked
    finding : Finding
        On the value; one that is right turns UNSURE where the table does not support it.
    half_width : float
        Of the tolerance, SI units.
    """
    found = asked.table.values.get(asked.question.id)
    if found is not None:
        finding = replace(finding, numbers={**finding.numbers, "from_table": found})
    if finding.outcome is Outcome.RIGHT:
        return finding if finding.carried else _held(asked, finding, half_width)
    if finding.outcome is Outcome.UNSURE or found is None:
        return finding
    is_good = abs(found - asked.key.values[asked.question.id]) <= half_width
    return replace(finding, message=f"{finding.message} {_AFTER if is_good else _BEFORE}")


_AFTER = "Your tracking table is good enough for a right value: look for the error in what you did with it."
_BEFORE = "The reference method finds no right value in your tracking table either: look at the tracking first."


def _held(asked: Asked, finding: Finding, half_width: float) -> Finding:
    why = _why_unsupported(asked, finding.numbers["value"], half_width)
    if not why:
        return finding
    message = f"The value is right, but {why}; a person will look at it."
    return replace(finding, outcome=Outcome.UNSURE, message=message)


def _why_unsupported(asked: Asked, value: float, half_width: float) -> str:
    table, found = asked.table, asked.table.values.get(asked.question.id)
    if table.why_not == OUR_FAILURE:
        return OUR_FAILURE
    if table.fit is None and not asked.submission.tracking:
        return "there is no tracking table that it could come from"
    if table.fit is None or not table.is_near:
        how = "cannot be compared with" if table.fit is None else "does not follow"
        return f"your tracking table {how} your video"
    if min(table.rows(asked.key.truth["t_impact_s"])) < LEAST_EACH_SIDE:
        return "your tracking table does not show the impact"
    spread = METHOD * SDS * table.sds.get(asked.question.id, 0.0)
    if found is not None and abs(value - found) > half_width + spread:
        return "your tracking table gives another one"
    return ""

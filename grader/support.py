"""Whether a student's own tracking table supports a value, and whether an error was made in tracking or after it.

A value alone proves nothing: it can be guessed, or copied. Full credit for a conclusion needs a table that it could
come from; without one, points are counted and a person looks.
"""

from __future__ import annotations

from dataclasses import replace

from grader.model import Asked, Finding, Outcome

SDS = 3.0
OF_A_LINE = 3.0
"""A straight line over 20 ms is at most so many times as uncertain as the reference, which fits everything at once."""

HAND_PX = 1.7
"""Root mean square distance of points that were clicked with 1 px in each coordinate, and a little more."""


def spread_of(asked: Asked) -> float:
    """Return what three sd of a careful student's line come to on this table; 0 where that is not known."""
    return SDS * OF_A_LINE * asked.table.sds.get(asked.question.id, 0.0)


def is_as_good_as_clicks(asked: Asked, value: float) -> bool:
    """Tell whether a value is as near to the truth, and to the own table, as points clicked by hand allow."""
    fit, found = asked.table.fit, asked.table.values.get(asked.question.id)
    if fit is None or found is None or fit.rms_px > HAND_PX:
        return False
    truth, reach = asked.key.values[asked.question.id], spread_of(asked)
    return abs(value - truth) <= reach and abs(value - found) <= reach


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
    if table.fit is None:
        return "there is no tracking table that it could come from"
    if not table.is_near:
        return "your tracking table does not follow your video"
    if table.why_not:
        return "no impact can be found in your tracking table"
    if found is not None and abs(value - found) > half_width + spread_of(asked):
        return "your tracking table gives another one"
    return ""

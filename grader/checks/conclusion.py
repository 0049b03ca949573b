"""Judge a number that follows from measured ones: does it, and is it right."""

from __future__ import annotations

from grader.concluding import judge_concluded
from grader.model import Asked, Finding


def conclusion(asked: Asked) -> tuple[Finding, ...]:
    """Work it out again from the numbers that you measured: half of the points are for the formula.

    When your formula is right and a measured number is not, that error is counted where it arose and costs nothing
    here, as long as your numbers describe a possible impact: the bodies change their velocities, e lies between 0 and
    1.2, and no number is a bare 0 that is none.
    """
    return judge_concluded(asked)

"""Judge e: does it follow from the student's velocities, and is it right."""

from __future__ import annotations

from grader.judging import judge_concluded
from grader.model import Asked, Finding


def restitution(asked: Asked) -> tuple[Finding, ...]:
    """Work it out again from the velocities that you wrote: half of the points are for the formula, half for the value.

    When your formula is right and a velocity is not, that error is counted at the velocity and costs nothing here,
    as long as your velocities describe a possible impact: the leg slows down, and e lies between 0 and 1.2.
    """
    return judge_concluded(asked, lambda numbers: numbers.e)

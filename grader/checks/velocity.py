"""Judge a velocity."""

from __future__ import annotations

from grader.judging import judge_measured
from grader.model import Asked, Finding


def velocity(asked: Asked) -> tuple[Finding, ...]:
    """Compare with the true velocity just before or just after the impact; unit and value are judged apart.

    An error that all of your velocities share, such as a wrong scale, is counted only once.
    """
    return judge_measured(asked)

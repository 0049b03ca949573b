"""Judge an angular velocity."""

from __future__ import annotations

from grader.judging import judge_measured
from grader.model import Asked, Finding


def angular_velocity(asked: Asked) -> tuple[Finding, ...]:
    """Compare with the true angular velocity of the leg, counter-clockwise positive; unit and value are judged apart.

    An error that both of your angular velocities share, such as degrees for radians, is counted only once.
    """
    return judge_measured(asked)

"""Judge an acceleration."""

from __future__ import annotations

from grader.judging import judge_measured
from grader.model import Asked, Finding


def acceleration(asked: Asked) -> tuple[Finding, ...]:
    """Compare with the true acceleration, or deceleration where that is asked; unit and value are judged apart."""
    return judge_measured(asked)

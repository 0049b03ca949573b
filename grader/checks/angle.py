"""Judge an angle."""

from __future__ import annotations

from grader.judging import judge_measured
from grader.model import Asked, Finding


def angle(asked: Asked) -> tuple[Finding, ...]:
    """Compare with the true angle, in radians or degrees as you chose; unit and value are judged apart."""
    return judge_measured(asked)

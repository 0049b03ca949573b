"""Judge the scale of the picture."""

from __future__ import annotations

from grader.judging import judge_measured
from grader.model import Asked, Finding
from grader.stated import Stated

_SLIPS = (("K5", 2.0), ("K5b", 0.5), ("K3", 1 / 3.28084), ("K4", 0.01), ("K4b", 0.001))


def scale(asked: Asked) -> tuple[Finding, ...]:
    """Compare with the scale at which your video was made. Every length and velocity is built on it."""
    return judge_measured(asked, _explain)


def _explain(asked: Asked, stated: Stated) -> str:
    truth = asked.key.values[asked.question.id]
    if stated.value == 1.0:
        return "K1"
    if abs(stated.value * truth - 1) < 0.05:
        return "K1b"
    return next((code for code, factor in _SLIPS if abs(stated.value / (truth * factor) - 1) < 0.02), "")

"""Judge the frame rate."""

from __future__ import annotations

from grader.judging import judge_measured
from grader.model import Asked, Finding
from grader.stated import Stated

_PLAYBACK = (24.0, 25.0, 29.97, 30.0, 50.0, 59.94, 60.0)


def rate(asked: Asked) -> tuple[Finding, ...]:
    """Compare with the rate at which your video was recorded, which is not the rate at which a player shows it."""
    return judge_measured(asked, _explain)


def _explain(_: Asked, stated: Stated) -> str:
    return "K2" if any(abs(stated.value - rate) < 0.05 for rate in _PLAYBACK) else ""

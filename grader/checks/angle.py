"""Judge an angle."""

from __future__ import annotations

import math

from grader.judging import judge_measured, tolerance_of, truth_of
from grader.model import Asked, Finding
from grader.stated import Stated


def angle(asked: Asked) -> tuple[Finding, ...]:
    """Compare with the true angle, in radians or degrees as you chose; unit and value are judged apart."""
    return judge_measured(asked, _explain)


def _explain(asked: Asked, stated: Stated) -> str:
    is_degrees = abs(math.radians(stated.value) - truth_of(asked)) <= tolerance_of(asked).half_width
    return "PA4" if is_degrees else ""

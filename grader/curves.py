"""Which curves a student's tracking table gives: the ball's position and the leg's angle, over the true ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from assignments.model import AnswerKey, Assignment
from grader.charts import Curve
from grader.trajectory import TrajectoryFit
from vml_course.model.arrays import FloatArray

_BALL, _PIVOT, _STRIKER = "ball", "knee", "foot"


def curves_of(fit: TrajectoryFit, key: AnswerKey, assignment: Assignment) -> Iterator[Curve]:
    """Yield the curves for which the table has the points; times are relative to the impact."""
    del assignment  # the points decide; another assignment may choose by its scene
    impact_s = key.truth.get("t_impact_s")
    time_ms = 1000 * (fit.time_s - (impact_s or 0.0))
    impact_ms = 0.0 if impact_s is not None else None
    px_per_m = key.truth["px_per_m"]
    if _BALL in fit.points:
        own, true = (_of(fit, xy, _BALL)[:, 0] for xy in (fit.own_m, fit.true_m))
        shift = own - true
        start = float(true[np.isfinite(true)][:1].sum())
        yield Curve(
            "ball", "Ball, horizontal position", "position (m)", "px", time_ms,
            own - start, true - start, shift * px_per_m, impact_ms,
        )  # fmt: skip
    if {_PIVOT, _STRIKER} <= set(fit.points):
        own, true = (_angle_deg(fit, xy) for xy in (fit.own_m, fit.true_m))
        difference = (own - true + 180) % 360 - 180
        yield Curve(
            "leg", "Leg, angle from horizontal", "angle (deg)", "deg", time_ms,
            true + difference, true, difference, impact_ms,
        )  # fmt: skip


def _of(fit: TrajectoryFit, xy: FloatArray, point: str) -> FloatArray:
    return np.asarray(xy[:, fit.points.index(point)])


def _angle_deg(fit: TrajectoryFit, xy: FloatArray) -> FloatArray:
    across = _of(fit, xy, _STRIKER) - _of(fit, xy, _PIVOT)
    angle = np.arctan2(across[:, 1], across[:, 0])
    seen = np.isfinite(angle)
    angle[seen] = np.unwrap(angle[seen])
    return np.degrees(angle)

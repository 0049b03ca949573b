"""Which curves a tracking table gives over the true ones: the struck body's position, the striker's angle."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from assignments.model import AnswerKey, Assignment
from assignments.names import names_in, vector_of
from grader.charts import Curve
from grader.trajectory import TrajectoryFit
from vml_course.model.arrays import FloatArray


def curves_of(fit: TrajectoryFit, key: AnswerKey, assignment: Assignment) -> Iterator[Curve]:
    """Yield the curves for which the table has the points; times are relative to the impact."""
    impact_s = key.truth.get("t_impact_s")
    time_ms = 1000 * (fit.time_s - (impact_s or 0.0))
    impact_ms = 0.0 if impact_s is not None else None
    px_per_m = key.truth["px_per_m"]
    names, vector = names_in(assignment.scene), vector_of(assignment.scene)
    if names["struck"] in fit.points:
        own, true = (_of(fit, xy, names["struck"])[:, 0] for xy in (fit.own_m, fit.true_m))
        shift = own - true
        start = float(true[np.isfinite(true)][:1].sum())
        yield Curve(
            names["struck"], f"{names['Struck']}, horizontal position", "position (m)", "px", time_ms,
            own - start, true - start, shift * px_per_m, impact_ms,
        )  # fmt: skip
    if vector and set(vector[1:]) <= set(fit.points):
        own, true = (_angle_deg(fit, xy, vector[1:]) for xy in (fit.own_m, fit.true_m))
        difference = (own - true + 180) % 360 - 180
        yield Curve(
            "angle", f"{names['Body']}, angle from horizontal", "angle (deg)", "deg", time_ms,
            true + difference, true, difference, impact_ms,
        )  # fmt: skip


def _of(fit: TrajectoryFit, xy: FloatArray, point: str) -> FloatArray:
    return np.asarray(xy[:, fit.points.index(point)])


def _angle_deg(fit: TrajectoryFit, xy: FloatArray, vector: tuple[str, str]) -> FloatArray:
    tail, head = vector
    across = _of(fit, xy, head) - _of(fit, xy, tail)
    angle = np.arctan2(across[:, 1], across[:, 0])
    seen = np.isfinite(angle)
    angle[seen] = np.unwrap(angle[seen])
    return np.degrees(angle)

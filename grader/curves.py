"""What a tracking table gives over the truth: curves of the bodies in time, and points in the picture of the impact."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from assignments.model import AnswerKey, Assignment
from assignments.names import names_in, vector_of
from grader.charts import Curve, PlacedPoint, PointsChart
from grader.frame import ImpactFrame
from grader.page import number
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


# ---------------------------------------------------------------- in the picture of the impact

_MOST_FRAMES_APART = 0.51


def points_chart(
    frame: ImpactFrame, fit: TrajectoryFit | None, key: AnswerKey, *, show_truth: bool
) -> PointsChart | None:
    """Return the picture of the impact with the student's points in it, and the true ones where they are shown.

    The table's own scale, origin and delay are taken out, as for the curves. None when there is nothing to draw.
    """
    own = _own_px(frame, fit, key.truth["px_per_m"]) if fit else {}
    true = dict(zip(key.points, key.xy_px[frame.index].tolist(), strict=True)) if show_truth else {}
    wanted = [name for name in key.points if name in own or (name in true and not own)]
    points = tuple(_placed(frame, name, own.get(name), true.get(name)) for name in wanted)
    points = tuple(point for point in points if point.own or point.true)
    rows = tuple(_point_row(name, own.get(name), true.get(name)) for name in wanted)
    return PointsChart(frame, points, rows, _picture_text(points)) if points else None


def _own_px(frame: ImpactFrame, fit: TrajectoryFit, px_per_m: float) -> dict[str, list[float]]:
    """Return where the student's table has the points in this frame, in pixels of the video."""
    apart = np.abs(fit.frame - fit.lag_frames - frame.index)
    row = int(np.argmin(apart))
    if apart[row] > _MOST_FRAMES_APART:
        return {}
    xy_px = fit.own_m[row] * np.array([px_per_m, -px_per_m])
    return {name: xy.tolist() for name, xy in zip(fit.points, xy_px, strict=True) if np.isfinite(xy).all()}


def _placed(frame: ImpactFrame, name: str, own: list[float] | None, true: list[float] | None) -> PlacedPoint:
    return PlacedPoint(name, _inside(frame, own), _inside(frame, true))


def _inside(frame: ImpactFrame, xy: list[float] | None) -> tuple[float, float] | None:
    """Return a place in the cut-out, None where it lies outside. Pixel centres are whole numbers in the video."""
    if xy is None:
        return None
    x, y = xy[0] - frame.left + 0.5, xy[1] - frame.top + 0.5
    return (round(x, 1), round(y, 1)) if 0 <= x <= frame.width and 0 <= y <= frame.height else None


def _point_row(name: str, own: list[float] | None, true: list[float] | None) -> tuple[str, ...]:
    apart = number(float(np.hypot(own[0] - true[0], own[1] - true[1])), 2) if own and true else "–"
    return name, _xy_text(own), _xy_text(true), apart


def _xy_text(xy: list[float] | None) -> str:
    return f"{xy[0]:.1f}, {xy[1]:.1f}" if xy else "–"


def _picture_text(points: tuple[PlacedPoint, ...]) -> str:
    own = [point.name for point in points if point.own]
    true = [point.name for point in points if point.true]
    said = [f"Your points: {', '.join(own)}." if own else "Your table has no points in this frame."]
    return " ".join([*said, *([f"True points: {', '.join(true)}."] if true else [])])

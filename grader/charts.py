"""Small charts as numbers: a template draws them, so that text is escaped and every line can be restyled.

Coordinates are those of an SVG with y down, rounded to a tenth.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from grader.frame import ImpactFrame
from vml_course.chart.axes import Scale, label, nice_ticks
from vml_course.model.arrays import FloatArray

MOST_DOTS = 160  # of a curve; with them and the picture a page stays below 60 kB
WIDTH, LEFT, RIGHT = 640.0, 58.0, 14.0
TOP, MAIN, GAP, RESIDUAL, BOTTOM = 14.0, 190.0, 26.0, 64.0, 40.0


@dataclass(frozen=True)
class Tick:
    """A place on an axis, with its label."""

    at: float
    label: str


@dataclass(frozen=True)
class CurveChart:
    """A student's curve over the true one, and the difference beneath.

    `truth` holds SVG point lists; `dots` and `residual` are SVG paths of strokes without length, which round ends
    make dots: a tenth of the bytes of circles.
    """

    id: str
    title: str
    description: str
    y_label: str
    residual_label: str
    truth: tuple[str, ...]
    dots: str
    residual: str
    residual_zero: float
    x_ticks: tuple[Tick, ...]
    y_ticks: tuple[Tick, ...]
    residual_ticks: tuple[Tick, ...]
    impact_x: float | None
    rows: tuple[tuple[str, ...], ...]

    width, left, right_edge = WIDTH, LEFT, WIDTH - RIGHT
    top, main_bottom = TOP, TOP + MAIN
    residual_top, residual_bottom = TOP + MAIN + GAP, TOP + MAIN + GAP + RESIDUAL
    height = TOP + MAIN + GAP + RESIDUAL + BOTTOM


@dataclass(frozen=True, eq=False)
class Curve:
    """What a chart is drawn from; all arrays have shape (n,), NaN where not measured."""

    id: str
    title: str
    y_label: str
    residual_unit: str
    time_ms: FloatArray
    own: FloatArray
    true: FloatArray
    residual: FloatArray
    impact_ms: float | None = None


def curve_chart(curve: Curve) -> CurveChart | None:
    """Lay a curve out; None when there is nothing to draw."""
    curve = _thinned(curve)
    both = np.isfinite(curve.own) & np.isfinite(curve.true)
    if both.sum() < 2 or np.ptp(curve.time_ms[both]) == 0:
        return None
    x_low, x_high = float(curve.time_ms[both].min()), float(curve.time_ms[both].max())
    values = np.concatenate([curve.own[both], curve.true[both]])
    y_ticks = nice_ticks(float(values.min()), float(values.max()), 5)
    reach = float(np.abs(curve.residual[both]).max()) or 1e-9
    residual_ticks = nice_ticks(-reach, reach, 2)
    x = Scale(x_low, x_high, LEFT, WIDTH - RIGHT)
    y = Scale(y_ticks[0], y_ticks[-1], TOP + MAIN, TOP)
    r = Scale(residual_ticks[0], residual_ticks[-1], TOP + MAIN + GAP + RESIDUAL, TOP + MAIN + GAP)
    impact = curve.impact_ms
    return CurveChart(
        id=curve.id,
        title=curve.title,
        description=_description(curve, both),
        y_label=curve.y_label,
        residual_label=f"difference ({curve.residual_unit})",
        truth=_runs(x, y, curve.time_ms, curve.true),
        dots=_dots(x, y, curve.time_ms[both], curve.own[both]),
        residual=_dots(x, r, curve.time_ms[both], curve.residual[both]),
        residual_zero=r(0.0),
        x_ticks=tuple(Tick(x(v), label(v)) for v in nice_ticks(x_low, x_high, 7) if x_low <= v <= x_high),
        y_ticks=tuple(Tick(y(v), label(v)) for v in y_ticks),
        residual_ticks=tuple(Tick(r(v), label(v)) for v in residual_ticks),
        impact_x=x(impact) if impact is not None and x_low <= impact <= x_high else None,
        rows=_rows(curve, both),
    )


def _thinned(curve: Curve) -> Curve:
    """Return a long curve with evenly chosen frames only; more would not be told apart."""
    count = len(curve.time_ms)
    if count <= MOST_DOTS:
        return curve
    kept = np.linspace(0, count - 1, MOST_DOTS).round().astype(int)
    arrays = {name: getattr(curve, name)[kept] for name in ("time_ms", "own", "true", "residual")}
    return replace(curve, **arrays)


def _description(curve: Curve, both: np.ndarray) -> str:
    rms = math.sqrt(float((curve.residual[both] ** 2).mean()))
    return (
        f"{curve.title}, {int(both.sum())} of your numbers over the true curve. "
        f"Root mean square difference: {rms:.2g} {curve.residual_unit}."
    )


def _runs(x: Scale, y: Scale, time_ms: FloatArray, values: FloatArray) -> tuple[str, ...]:
    """Return the curve as point lists, interrupted where nothing is known."""
    seen = np.isfinite(values)
    breaks = np.flatnonzero(np.diff(seen.astype(int))) + 1
    pieces = np.split(np.arange(values.size), breaks)
    kept = [piece for piece in pieces if piece.size > 1 and seen[piece[0]]]
    return tuple(" ".join(f"{x(time_ms[i]):g},{y(values[i]):g}" for i in piece) for piece in kept)


def _dots(x: Scale, y: Scale, time_ms: FloatArray, values: FloatArray) -> str:
    return "".join(f"M{x(t):g} {y(v):g}h0" for t, v in zip(time_ms.tolist(), values.tolist(), strict=True))


def _rows(curve: Curve, both: np.ndarray, most: int = 24) -> tuple[tuple[str, ...], ...]:
    """Return the chart's numbers as a table, thinned evenly."""
    at = np.flatnonzero(both)
    at = at[np.unique(np.linspace(0, at.size - 1, min(most, at.size)).round().astype(int))]
    columns = (curve.time_ms, curve.own, curve.true, curve.residual)
    return tuple(tuple(f"{column[i]:.4g}" for column in columns) for i in at)


# ---------------------------------------------------------------- points in a picture


@dataclass(frozen=True)
class PlacedPoint:
    """A tracked point in the picture's coordinates: where the student has it and where it truly is."""

    name: str
    own: tuple[float, float] | None
    true: tuple[float, float] | None


@dataclass(frozen=True)
class PointsChart:
    """A cut-out of the video with points in it; `rows` are name, own, true, distance."""

    frame: ImpactFrame
    points: tuple[PlacedPoint, ...]
    rows: tuple[tuple[str, ...], ...]
    description: str

    @property
    def own_rows(self) -> tuple[tuple[str, ...], ...]:
        """The table without anything true."""
        return tuple(row[:2] for row in self.rows)


# ---------------------------------------------------------------- of a class


@dataclass(frozen=True)
class Bar:
    """One bar of a histogram, in the picture's coordinates."""

    x: float
    y: float
    width: float
    height: float
    count: int
    label: str


def histogram(shares: Sequence[float], bins: int = 10, width: float = 560.0, height: float = 120.0) -> tuple[Bar, ...]:
    """Lay out how many scores fall into each tenth; `shares` are 0 to 1.

    >>> [bar.count for bar in histogram([0.05, 0.95, 1.0])]
    [1, 0, 0, 0, 0, 0, 0, 0, 0, 2]
    """
    counts = [0] * bins
    for share in shares:
        counts[min(bins - 1, max(0, int(share * bins)))] += 1
    highest, step = max(1, *counts), width / bins
    return tuple(
        Bar(
            x=round(i * step + 3, 1),
            y=round(height * (1 - count / highest), 1),
            width=round(step - 6, 1),
            height=round(height * count / highest, 1),
            count=count,
            label=f"{100 * i // bins}–{100 * (i + 1) // bins} %",
        )
        for i, count in enumerate(counts)
    )


@dataclass(frozen=True)
class ScatterChart:
    """Points of a class over two axes, with the line that fits them best."""

    x_label: str
    y_label: str
    dots: tuple[tuple[float, float], ...]
    line: tuple[float, float, float, float] | None
    x_ticks: tuple[Tick, ...]
    y_ticks: tuple[Tick, ...]

    width, height, left, right_edge, top, bottom = 560.0, 240.0, 52.0, 546.0, 26.0, 200.0


def scatter_chart(x_values: Sequence[float], y_values: Sequence[float], x_label: str, y_label: str) -> ScatterChart:
    """Lay out a score (0 to 100) over a number that is not negative.

    The line is drawn where there are three points or more that differ in x.
    """
    x_ticks = nice_ticks(0.0, max((*x_values, 1e-6)), 6)
    y_ticks = nice_ticks(0.0, 100.0, 5)
    kind = ScatterChart
    x = Scale(x_ticks[0], x_ticks[-1], kind.left, kind.right_edge)
    y = Scale(y_ticks[0], y_ticks[-1], kind.bottom, kind.top)
    fitted = _fitted(np.array(x_values, dtype=float), np.array(y_values, dtype=float))
    return ScatterChart(
        x_label=x_label,
        y_label=y_label,
        dots=tuple((x(a), y(b)) for a, b in zip(x_values, y_values, strict=True)),
        line=None if fitted is None else (x(fitted[0]), y(fitted[1]), x(fitted[2]), y(fitted[3])),
        x_ticks=tuple(Tick(x(value), label(value)) for value in x_ticks),
        y_ticks=tuple(Tick(y(value), label(value)) for value in y_ticks),
    )


def _fitted(x: FloatArray, y: FloatArray) -> tuple[float, float, float, float] | None:
    """Return both ends of the least-squares line; None with fewer than three points, or where x hardly varies."""
    if len(x) < 3 or np.ptp(x) <= 1e-6 * np.abs(x).max():
        return None
    away = (x - x.mean()) / np.ptp(x)  # of order one: the squares of tiny numbers are zero
    slope = float(away @ y) / float(away @ away) / float(np.ptp(x))
    low, high = float(x.min()), float(x.max())
    middle, level = float(x.mean()), float(y.mean())
    return low, level + slope * (low - middle), high, level + slope * (high - middle)

"""The plot that a student hands in: positions and angle with the fits before and after, the impact, and what is left.

Left the struck body's way along the blow, right the striker (its angle about the pivot, or its way along the blow);
beneath each the residuals of the joint fit. Dots are measured; dashed lines are the student's, over 20 ms each side,
where the model can be solved by them.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vml_course.chart.axes import Scale, label, nice_ticks
from vml_course.chart.shapes import BLUE, GREEN, GREY, INK, ORANGE, PALE, RED, Dot, Drawing, Line, Shape, Words
from vml_course.kinetics.free_bodies import blow
from vml_course.kinetics.lines import MODELS as BY_LINES
from vml_course.kinetics.straight import fit_line
from vml_course.kinetics.vectors import unwrapped
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion
from vml_course.model.rounding import with_uncertainty
from vml_course.model.solution import ImpactSolution

WIDTH, LEFT, MIDDLE, RIGHT = 980.0, 72.0, 86.0, 18.0
TOP, MAIN, GAP, REST, BOTTOM = 116.0, 300.0, 22.0, 96.0, 50.0
PANEL = (WIDTH - LEFT - MIDDLE - RIGHT) / 2
HEIGHT = TOP + MAIN + GAP + REST + BOTTOM
LINES_S = 0.020
KEY_Y = 76.0
SHOWN = 1.25  # times the fitted span is shown
PLAIN = {"e": "e", "I": "I", "M": "M", "mu": "μ", "v1": "v₁"}


@dataclass(frozen=True, eq=False, slots=True)
class Track:
    """One quantity through time: measured and fitted, shape (n,), NaN where unknown; time from the impact, ms."""

    title: str
    unit: str
    rest_unit: str
    rest_factor: float
    time_ms: FloatArray
    measured: FloatArray
    fitted: FloatArray


def impact_plot(motion: Motion, solution: ImpactSolution, striker: str, struck: str) -> Drawing:
    """Draw a joint solution over its measurement.

    Parameters
    ----------
    motion : Motion
        What was measured.
    solution : ImpactSolution
        Of method "joint", with its `fitted` points.
    striker, struck : str
        The points that are shown.
    """
    time_ms = 1e3 * (motion.time_s - solution.value("t_impact"))
    tracks = (
        _struck_track(motion, solution, struck, time_ms),
        _striker_track(motion, solution, striker, struck, time_ms),
    )
    by_lines = solution.model in BY_LINES
    shapes = [shape for k, track in enumerate(tracks) for shape in _panel(track, LEFT + k * (PANEL + MIDDLE), by_lines)]
    values = [
        f"{name} = {with_uncertainty(found.value, found.sd)} {found.unit.replace('^2', '²')}".strip()
        for symbol, name in PLAIN.items()
        if (found := solution.estimates.get(symbol)) is not None
    ]
    moment = f"impact at t = {solution.value('t_impact'):.5f} s, after frame {solution.frame_before}"
    title = f"{', '.join(values)}"
    head = [Words((LEFT, 30), title, 18, INK, is_bold=True), Words((LEFT, 52), f"{solution.model}: {moment}", 13, GREY)]
    told = f"{title}. {moment}. Dots are measured, curves fitted on either side; residuals beneath."
    return Drawing(
        WIDTH, HEIGHT, (*head, *_legend(by_lines), *shapes), f"{solution.model}: fits before and after the impact", told
    )


def _blow(solution: ImpactSolution, struck: str) -> FloatArray:
    fitted = solution.fitted
    if fitted is None:
        raise ValueError("only a joint solution can be drawn")
    return blow(fitted, struck if struck in fitted.points else fitted.points[0], solution.value("t_impact"))


def _struck_track(motion: Motion, solution: ImpactSolution, struck: str, time_ms: FloatArray) -> Track:
    n = _blow(solution, struck)
    return _along(f"{struck}, along the blow", struck, motion, solution, n, time_ms)


def _along(
    title: str, point: str, motion: Motion, solution: ImpactSolution, n: FloatArray, time_ms: FloatArray
) -> Track:
    fitted = solution.fitted
    own = motion.of(point) @ n
    model = fitted.of(point) @ n if fitted and point in fitted.points else np.full(len(own), np.nan)
    return Track(title, "m", "mm", 1e3, time_ms, own, model)


def _striker_track(motion: Motion, solution: ImpactSolution, striker: str, struck: str, time_ms: FloatArray) -> Track:
    """Return the angle about the fitted pivot, or without one the way along the blow."""
    if "pivot_x_m" not in solution.figures or solution.fitted is None:
        n = _blow(solution, struck)
        return _along(f"{striker}, along the blow", striker, motion, solution, n, time_ms)
    pivot = np.array([solution.figures["pivot_x_m"], solution.figures["pivot_y_m"]])
    own, model = (
        np.degrees(unwrapped(np.arctan2(*(where.of(striker) - pivot).T[::-1]))) for where in (motion, solution.fitted)
    )
    both = np.isfinite(own) & np.isfinite(model)
    turns = 360.0 * np.round(np.median((own - model)[both]) / 360.0) if both.any() else 0.0
    return Track(f"angle of {striker} about the pivot", "°", "°", 1.0, time_ms, own, model + turns)


def _panel(track: Track, left: float, by_lines: bool) -> list[Shape]:  # noqa: FBT001
    reach = SHOWN * float(np.abs(track.time_ms[np.isfinite(track.fitted)]).max(initial=10.0))
    shown = np.isfinite(track.measured) & (np.abs(track.time_ms) <= reach)
    x = Scale(-reach, reach, left, left + PANEL)
    y_ticks = nice_ticks(float(track.measured[shown].min()), float(track.measured[shown].max()), 6)
    y = Scale(y_ticks[0], y_ticks[-1], TOP + MAIN, TOP)
    rest = track.rest_factor * (track.measured - track.fitted)
    most = float(np.nanmax(np.abs(rest), initial=1e-9))
    r_ticks = nice_ticks(-most, most, 2)
    bottom = TOP + MAIN + GAP + REST
    r = Scale(r_ticks[0], r_ticks[-1], bottom, TOP + MAIN + GAP)
    shapes: list[Shape] = [Words((left, TOP - 10), f"{track.title} ({track.unit})", 13, INK)]
    shapes += _frame(left, TOP, TOP + MAIN, y, y_ticks) + _frame(left, TOP + MAIN + GAP, bottom, r, r_ticks)
    shapes += _time_axis(x, reach, bottom, left)
    shapes.append(Line(((x(0), TOP), (x(0), bottom)), RED, 1.2, (5, 4)))
    shapes += [
        Dot((x(t), y(v)), 2.6, "none", INK) for t, v in zip(track.time_ms[shown], track.measured[shown], strict=True)
    ]
    shapes += _curves(track, x, y) + (_student_lines(track, x, y, y_ticks) if by_lines else [])
    seen = np.isfinite(rest)
    shapes += [Dot((x(t), r(v)), 2.2, GREY) for t, v in zip(track.time_ms[seen], rest[seen], strict=True)]
    shapes.append(
        Words(
            (left - 52, (TOP + MAIN + GAP + bottom) / 2),
            f"residual ({track.rest_unit})",
            11,
            GREY,
            "middle",
            is_upright=True,
        )
    )
    return shapes


def _frame(left: float, top: float, bottom: float, y: Scale, ticks: tuple[float, ...]) -> list[Shape]:
    shapes: list[Shape] = []
    for value in ticks:
        shapes.append(Line(((left, y(value)), (left + PANEL, y(value))), GREY if value == 0 else PALE, 0.8))
        shapes.append(Words((left - 7, y(value) + 4), label(value), 11, GREY, "end"))
    edge = ((left, top), (left + PANEL, top), (left + PANEL, bottom), (left, bottom), (left, top))
    return [*shapes, Line(edge, GREY, 0.8)]


def _time_axis(x: Scale, reach: float, bottom: float, left: float) -> list[Shape]:
    ticks = [value for value in nice_ticks(-reach, reach, 8) if abs(value) <= reach]
    shapes: list[Shape] = [Words((x(value), bottom + 17), label(value), 11, GREY, "middle") for value in ticks]
    shapes += [Line(((x(value), bottom), (x(value), bottom + 4)), GREY, 0.8) for value in ticks]
    return [*shapes, Words((left + PANEL / 2, bottom + 37), "time from the impact (ms)", 12, INK, "middle")]


def _curves(track: Track, x: Scale, y: Scale) -> list[Shape]:
    """Return the joint fit before (blue) and after (orange)."""
    shapes: list[Shape] = []
    for side, colour in ((track.time_ms <= 0, BLUE), (track.time_ms > 0, ORANGE)):
        at = np.flatnonzero(side & np.isfinite(track.fitted))
        if len(at) > 1:
            shapes.append(Line(tuple((x(track.time_ms[i]), y(track.fitted[i])) for i in at), colour, 2.2))
    return shapes


def _student_lines(track: Track, x: Scale, y: Scale, ticks: tuple[float, ...]) -> list[Shape]:
    """Return straight lines through the fitted frames within 20 ms of the impact, drawn to where it is."""
    shapes: list[Shape] = []
    fitted = np.isfinite(track.fitted) & np.isfinite(track.measured)
    for side, sign in ((track.time_ms <= 0, -1.0), (track.time_ms > 0, 1.0)):
        near: NDArray[np.bool_] = fitted & side & (np.abs(track.time_ms) <= 1e3 * LINES_S)
        if near.sum() < 3:
            continue
        line = fit_line(track.time_ms[near], track.measured[near, None])
        ends = [(t, float(line.position(t)[0])) for t in np.linspace(0.0, sign * 1.3e3 * LINES_S, 27)]
        inside = [(x(t), y(v)) for t, v in ends if ticks[0] <= v <= ticks[-1]]
        if len(inside) > 1:
            shapes.append(Line(tuple(inside), GREEN, 1.4, (7, 4)))
    return shapes


def _legend(by_lines: bool) -> list[Shape]:  # noqa: FBT001
    """Return the key, in one row beneath the titles."""
    entries = [("measured", INK), ("fit before", BLUE), ("fit after", ORANGE), ("impact", RED)]
    if by_lines:
        entries.insert(3, ("lines, 20 ms", GREEN))
    widths = [26 + 7.0 * len(words) + 16 for words, _ in entries]
    starts = itertools.accumulate([LEFT, *widths[:-1]])
    shapes: list[Shape] = []
    for (words, colour), left in zip(entries, starts, strict=True):
        dash = {GREEN: (7.0, 4.0), RED: (5.0, 4.0)}.get(colour)
        key: Shape = Line(((left, KEY_Y), (left + 20, KEY_Y)), colour, 2.2, dash)
        shapes.append(Dot((left + 10, KEY_Y), 2.6, "none", INK) if colour == INK else key)
        shapes.append(Words((left + 26, KEY_Y + 4), words, 12, INK))
    return shapes

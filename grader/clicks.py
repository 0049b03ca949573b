"""How sharply numbers can be measured with straight lines through a student's own points, clicked by hand or tracked.

The scatter of the points about the true path tells their noise; a line over `LINE_S` each side of the impact turns it
into that of a slope, and the conclusion's own formula into that of a result.
"""

from __future__ import annotations

import math

import numpy as np

from assignments.names import vector_of
from assignments.textbook import textbook_of
from assignments.theory import Formula
from grader.model import Asked
from grader.own import OwnNumbers
from grader.trajectory import TrajectoryFit

LINE_S = 0.040
"""The longest line that a student must have fitted each side; half of what the reference fits where that is less."""

LEAST_FRAMES = 6
HAND_PX = 1.7
"""Root mean square distance of points that were clicked with 1 px in each coordinate, and a little more."""

SDS = 4.0
"""Of several numbers that a student measures, one in a hundred lies beyond three."""


def spread_of_measured(asked: Asked) -> float:
    """Return how far off a number may be that was measured with a line through the own points; 0 for coarse ones."""
    return SDS * _line_sd(asked, asked.question.dimension)


def spread_of_concluded(asked: Asked, way: OwnNumbers, formula: Formula) -> float:
    """Return how far off a formula may come out that is fed with numbers measured so."""
    measured = {item.id: item.field for item in textbook_of(asked.key.scene).measured if item.id in asked.questions}
    sds = {field: _line_sd(asked, asked.questions[id_].dimension) for id_, field in measured.items()}
    return SDS * way.spread(formula, sds)


def _line_sd(asked: Asked, dimension: str) -> float:
    fit = asked.table.fit
    if fit is None or fit.rms_px > HAND_PX or dimension not in {"velocity", "angular_velocity", "acceleration"}:
        return 0.0
    fps = asked.key.truth["fps"]
    noise_m = fit.rms_px / math.sqrt(2.0) / asked.key.truth["px_per_m"]
    if dimension == "acceleration":  # of the parabola through everything after the impact
        after = max(LEAST_FRAMES, asked.table.rows(asked.key.truth["t_impact_s"])[1])
        return noise_m * fps**2 * math.sqrt(720.0 / after**5)
    frames = max(LEAST_FRAMES, math.floor(fps * min(LINE_S, asked.table.window_s / 2)))  # whole ones on one side
    of_two_marks = math.sqrt(2.0)  # a direction has two ends, and a speed may come from it
    slope_sd = of_two_marks * noise_m * fps * math.sqrt(12.0 / (frames * (frames**2 - 1)))
    return slope_sd if dimension == "velocity" else slope_sd / _length_m(fit, asked.key.scene)


def _length_m(fit: TrajectoryFit, scene: str) -> float:
    """Return the distance of the two marks whose direction is measured."""
    names = vector_of(scene)
    if names is None or not set(names[1:]) <= set(fit.points):
        return math.inf
    tail, head = (fit.own_m[:, fit.points.index(name)] for name in names[1:])
    return float(np.nanmedian(np.hypot(*(head - tail).T)))

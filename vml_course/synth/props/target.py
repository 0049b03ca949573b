"""Marks that one can click exactly: a quadrant target, as on crash-test dummies, and a ranging pole."""

from __future__ import annotations

import numpy as np

from vml_course.synth.canvas import Canvas
from vml_course.synth.shapes import Point, box, disc

BLACK = (28.0, 28.0, 30.0)
WHITE = (236.0, 236.0, 232.0)
RED = (196.0, 44.0, 40.0)
TARGET_M = 0.022
TICK_M = 0.006
SMALLEST_TARGET_PX = 7.0


def draw_target(on: Canvas, centre: Point, samples_per_px: float, radius_m: float = TARGET_M) -> None:
    """Draw a disc of two black and two white quarters that meet in `centre`."""
    radius = max(radius_m, SMALLEST_TARGET_PX * samples_per_px / on.samples_per_m)
    (x, y), reach = centre, 1.2 * radius
    on = on.near((x - reach, y - reach), (x + reach, y + reach))
    rim = disc(on, centre, radius)
    on.fill(disc(on, centre, 1.12 * radius), BLACK)
    on.fill(rim, WHITE)
    across, along = on.x_m - x, on.y_m - y
    # Smallest of the two distances to the dividing lines: exact along both, which is where one measures.
    quarters = np.where(across * along > 0, -1.0, 1.0) * np.minimum(np.abs(across), np.abs(along))
    on.fill(np.maximum(quarters, rim).astype(np.float32), BLACK)


def draw_pole(on: Canvas, left: Point, right: Point) -> None:
    """Draw a level pole of ten red and white parts with upright ticks centred on `left` and `right`."""
    parts, (x, y), length = 10, left, right[0] - left[0]
    half = 0.014
    on = on.near((x - 0.01, y - 0.05), (right[0] + 0.01, y + 0.05))
    on.fill(box(on, (x, y - half - 0.004), (right[0], y + half + 0.004)), BLACK)
    for part in range(parts):
        ends = x + length * part / parts, x + length * (part + 1) / parts
        on.fill(box(on, (ends[0], y - half), (ends[1], y + half)), RED if part % 2 == 0 else WHITE)
    for end in (left, right):
        on.fill(box(on, (end[0] - TICK_M / 2, y - 0.04), (end[0] + TICK_M / 2, y + 0.04)), BLACK)

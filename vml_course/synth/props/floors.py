"""Still backgrounds seen from above, drawn at the camera's scale: an air table, boards, a lawn, a sheet with a grid."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from vml_course.synth.canvas import Canvas, Colour
from vml_course.synth.props.backgrounds import CLOTH, FAR_M, LAWN, LINE, draw_lines, plaster, tufts
from vml_course.synth.shapes import box

TABLE = (92.0, 108.0, 120.0)
HOLE = (58.0, 68.0, 76.0)
BOARD = (176.0, 150.0, 116.0)
HOLES_EVERY_M = 0.05
BOARD_M = 0.16
LANE_M = 0.5


def draw_table(on: Canvas, seed: int) -> None:
    """Draw a table with rows of air holes."""
    _fill(on, TABLE)
    pitch_m = HOLES_EVERY_M
    across, along = ((values + pitch_m / 2) % pitch_m - pitch_m / 2 for values in (on.x_m, on.y_m))
    on.fill(np.asarray(np.hypot(across, along) - 0.0022, np.float32), HOLE)
    plaster(on, seed)


def draw_boards(on: Canvas, seed: int) -> None:
    """Draw a floor of boards."""
    _fill(on, BOARD)
    row = np.floor(on.y_m / BOARD_M)
    tone = 9.0 * np.sin(12.9898 * row) + 0.0 * on.x_m
    joint = np.abs((on.y_m / BOARD_M) % 1.0 - 0.5) * BOARD_M * on.samples_per_m
    butt = np.abs(((on.x_m + 0.37 * row) / 1.1) % 1.0 - 0.5) * 1.1 * on.samples_per_m
    lines = -34.0 * np.maximum(
        np.clip(1.5 - (0.5 * BOARD_M * on.samples_per_m - joint), 0, 1), np.clip(1.5 - butt, 0, 1)
    )
    on.lighten(np.asarray(tone + lines, np.float32))
    plaster(on, seed)


def draw_turf(on: Canvas, seed: int) -> None:
    """Draw a mown lawn with a chalk line; the grass is speckled too, which tempts trackers away."""
    _fill(on, LAWN)
    on.lighten(tufts(on, seed))
    lanes = np.where((on.x_m / LANE_M) % 2.0 < 1.0, 5.0, -5.0) + 0.0 * on.y_m
    on.lighten(np.asarray(lanes, np.float32))
    on.fill(box(on, (-FAR_M, -0.02), (FAR_M, 0.02)), LINE, opacity=0.5)


def draw_sheet(on: Canvas, seed: int) -> None:
    """Draw a sheet with a line every 10 cm, a bolder one every 50 cm."""
    _fill(on, CLOTH)
    plaster(on, seed)
    draw_lines(on, 0.0)


FLOORS: Mapping[str, Callable[[Canvas, int], None]] = {
    "table": draw_table,
    "boards": draw_boards,
    "grass": draw_turf,
    "grid": draw_sheet,
}


def _fill(on: Canvas, rgb: Colour) -> None:
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, FAR_M)), rgb)

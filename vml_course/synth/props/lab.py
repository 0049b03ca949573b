"""Where experiments are filmed: a wall and a floor from the side, a table or boards from above; with a scale bar."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vml_course.model.camera import Camera
from vml_course.synth.canvas import Canvas, Colour, make_canvas
from vml_course.synth.props.lettering import write
from vml_course.synth.props.target import draw_pole
from vml_course.synth.shapes import Point, box, disc, polygon, tapered
from vml_course.synth.texture import Plane, grain

WALL = (172.0, 178.0, 176.0)
LOWER = (118.0, 132.0, 142.0)
EDGE = (70.0, 74.0, 80.0)
FLOOR = (150.0, 132.0, 110.0)
TABLE = (92.0, 108.0, 120.0)
HOLE = (58.0, 68.0, 76.0)
BOARD = (176.0, 150.0, 116.0)
STEEL = (104.0, 110.0, 118.0)
INK = (30.0, 30.0, 32.0)
WALL_GREY = 3.0
FAR_M = 100.0


def draw_wall(camera: Camera, seed: int, marks_m: Mapping[str, Point], floor_m: float) -> Canvas:
    """Draw a wall above a floor, seen from the side, and the bar."""
    on = _empty(camera)
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, FAR_M)), WALL)
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, floor_m + 0.16)), LOWER)
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, floor_m + 0.02)), EDGE)
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, floor_m)), FLOOR)
    _plaster(on, seed)
    _bar(on, marks_m)
    return on


def draw_air_table(camera: Camera, seed: int, marks_m: Mapping[str, Point], pitch_m: float = 0.05) -> Canvas:
    """Draw a table with rows of air holes, seen from above, and the bar."""
    on = _empty(camera)
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, FAR_M)), TABLE)
    across, along = ((values + pitch_m / 2) % pitch_m - pitch_m / 2 for values in (on.x_m, on.y_m))
    on.fill(np.asarray(np.hypot(across, along) - 0.0022, np.float32), HOLE)
    _plaster(on, seed)
    _bar(on, marks_m)
    return on


def draw_boards(camera: Camera, seed: int, marks_m: Mapping[str, Point], wide_m: float = 0.16) -> Canvas:
    """Draw a floor of boards, seen from above, and the bar."""
    on = _empty(camera)
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, FAR_M)), BOARD)
    row = np.floor(on.y_m / wide_m)
    tone = 9.0 * np.sin(12.9898 * row) + 0.0 * on.x_m
    joint = np.abs((on.y_m / wide_m) % 1.0 - 0.5) * wide_m * on.samples_per_m
    butt = np.abs(((on.x_m + 0.37 * row) / 1.1) % 1.0 - 0.5) * 1.1 * on.samples_per_m
    lines = -34.0 * np.maximum(
        np.clip(1.5 - (0.5 * wide_m * on.samples_per_m - joint), 0, 1), np.clip(1.5 - butt, 0, 1)
    )
    on.lighten(np.asarray(tone + lines, np.float32))
    _plaster(on, seed)
    _bar(on, marks_m)
    return on


def draw_stand(on: Canvas, pivot_m: Point, foot_m: Point) -> None:
    """Draw a steel post from the floor to a pivot, behind everything that moves."""
    (x, y), (x0, y0) = pivot_m, foot_m
    on.fill(tapered(on, ((x0, y0 + 0.022), 0.022), ((x0, y), 0.022)), STEEL)
    on.fill(tapered(on, ((x0, y), 0.022), ((x, y), 0.022)), STEEL)
    base = [(x0 - 0.12, y0 - 0.012), (x0 + 0.12, y0 - 0.012), (x0 + 0.07, y0 + 0.02), (x0 - 0.07, y0 + 0.02)]
    on.fill(polygon(on, base), EDGE)
    on.fill(disc(on, pivot_m, 0.034), EDGE)


def _empty(camera: Camera) -> Canvas:
    width, height = camera.size_px
    return make_canvas((height, width), camera.px_per_m, (camera.origin_x_px, camera.origin_y_px))


def _plaster(on: Canvas, seed: int) -> None:
    shape = (on.opacity.shape[0], on.opacity.shape[1])
    speckle: Plane = grain(seed, "wall", shape, 3.0)
    on.lighten(np.asarray(WALL_GREY * speckle, np.float32))


def _bar(on: Canvas, marks_m: Mapping[str, Point]) -> None:
    left, right = marks_m["bar_left"], marks_m["bar_right"]
    draw_pole(on, left, right)
    length = round(right[0] - left[0], 6)
    text, high = (f"{length:g} m" if length >= 1 else f"{100 * length:g} cm"), 22.0 / on.samples_per_m
    lit: Colour = INK
    write(on, text, (right[0] + 2.6 * high, left[1]), high, lit)

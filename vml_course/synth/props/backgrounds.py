"""Still backgrounds seen from the side, at the camera's scale: a laboratory, a gym, a lawn, a cloth with a grid."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import cast

import numpy as np

from vml_course.synth.canvas import Canvas, Colour
from vml_course.synth.shapes import box
from vml_course.synth.texture import Plane, grain

PAINT = (172.0, 178.0, 176.0)
LOWER = (118.0, 132.0, 142.0)
EDGE = (70.0, 74.0, 80.0)
SCREED = (150.0, 132.0, 110.0)
WALL = (150.0, 164.0, 168.0)
DADO = (122.0, 142.0, 152.0)
SKIRTING = (92.0, 102.0, 108.0)
FLOOR = (176.0, 148.0, 112.0)
SKY = (186.0, 204.0, 218.0)
HEDGE = (88.0, 112.0, 76.0)
LAWN = (104.0, 142.0, 72.0)
LINE = (230.0, 232.0, 226.0)
CLOTH = (168.0, 172.0, 176.0)
THREAD = (118.0, 124.0, 132.0)
WALL_GREY = 3.0
FAR_M = 100.0
GRID_M = 0.1


def draw_lab(on: Canvas, seed: int, floor_m: float) -> None:
    """Draw a painted wall above a floor."""
    _bands(on, ((FAR_M, PAINT), (floor_m + 0.16, LOWER), (floor_m + 0.02, EDGE), (floor_m, SCREED)))
    plaster(on, seed)


def draw_room(on: Canvas, seed: int, floor_m: float) -> None:
    """Draw a quiet wall and a floor of boards."""
    _bands(on, ((FAR_M, WALL), (floor_m + 0.62, DADO), (floor_m + 0.03, SKIRTING), (floor_m, FLOOR)))
    plaster(on, seed)
    on.lighten(_planks(on, floor_m))


def draw_lawn(on: Canvas, seed: int, floor_m: float) -> None:
    """Draw a mown lawn before a hedge, under the sky; the grass is speckled too, which tempts trackers away."""
    _bands(on, ((FAR_M, SKY), (floor_m + 0.55, HEDGE), (floor_m + 0.2, LAWN)))
    leaves = 12.0 * grain(seed, "hedge", _shape(on), 2.0, 2.0)
    hedge, lawn = _between(on, floor_m + 0.2, floor_m + 0.55), _between(on, -FAR_M, floor_m + 0.2)
    on.lighten(leaves.astype(np.float32), hedge)
    on.lighten(tufts(on, seed), lawn)
    depth = floor_m + 0.2 - on.y_m + 0.0 * on.x_m
    # The mower's lanes widen towards the viewer.
    lanes = np.where(np.sqrt(np.maximum(depth, 0.0) / 0.11) % 2.0 < 1.0, 5.0, -5.0)
    on.lighten(lanes.astype(np.float32), lawn)
    on.fill(_between(on, floor_m + 0.055, floor_m + 0.075), LINE, opacity=0.8)


def draw_grid(on: Canvas, seed: int, floor_m: float) -> None:
    """Draw a cloth with a line every 10 cm, a bolder one every 50 cm, down to a floor."""
    _bands(on, ((FAR_M, CLOTH), (floor_m, FLOOR)))
    on.lighten((0.7 * WALL_GREY * grain(seed, "cloth", _shape(on), 2.0)).astype(np.float32))
    draw_lines(on, floor_m, _between(on, floor_m, FAR_M))
    on.lighten(_planks(on, floor_m))


BACKGROUNDS: Mapping[str, Callable[[Canvas, int, float], None]] = {
    "lab": draw_lab,
    "gym": draw_room,
    "grass": draw_lawn,
    "grid": draw_grid,
}


def plaster(on: Canvas, seed: int) -> None:
    """Roughen a quiet surface a little."""
    on.lighten((WALL_GREY * grain(seed, "wall", _shape(on), 3.0)).astype(np.float32))


def tufts(on: Canvas, seed: int) -> Plane:
    """Return the grey levels of short grass."""
    blades = 8.0 * grain(seed, "lawn", _shape(on), 1.0) + 5.0 * grain(seed, "tufts", _shape(on), 3.0)
    return blades.astype(np.float32)


def draw_lines(on: Canvas, from_m: float, inside_m: Plane | float = -FAR_M) -> None:
    """Draw a line every 10 cm, a bolder one every 50 cm, counted from a height, where a distance is negative."""
    for every, wide in ((GRID_M, 0.0025), (5 * GRID_M, 0.006)):
        away = np.minimum(*(np.abs(along - every * np.round(along / every)) for along in (on.x_m, on.y_m - from_m)))
        on.fill(np.maximum(away - wide / 2, inside_m).astype(np.float32), THREAD)


def _bands(on: Canvas, tops: tuple[tuple[float, Colour], ...]) -> None:
    for top, rgb in tops:
        on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, top)), rgb)


def _between(on: Canvas, low_m: float, high_m: float) -> Plane:
    return box(on, (-FAR_M, low_m), (FAR_M, high_m))


def _shape(on: Canvas) -> tuple[int, int]:
    return cast("tuple[int, int]", on.opacity.shape)


def _planks(on: Canvas, floor_m: float) -> Plane:
    """Darken the joints between floor boards, which run along the wall."""
    depth = floor_m - on.y_m + 0.0 * on.x_m
    joint = np.abs((depth / 0.055) % 1.0 - 0.5) * 0.055 * on.samples_per_m
    return np.asarray(-14.0 * np.clip(1.5 - joint, 0.0, 1.0) * (depth > 0), np.float32)

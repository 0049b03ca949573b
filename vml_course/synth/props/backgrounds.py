"""Still backgrounds, drawn at the camera's scale: a gym, a lawn, a wall with a grid; and what to calibrate with."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import cast

import cv2
import numpy as np

from vml_course.model.camera import Camera
from vml_course.synth.canvas import Canvas, make_canvas
from vml_course.synth.props.target import draw_pole
from vml_course.synth.shapes import Point, box
from vml_course.synth.texture import Plane, grain

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
TEXT = (30.0, 30.0, 32.0)
WALL_GREY = 3.0
FAR_M = 100.0
GRID_M = 0.1


def draw_background(camera: Camera, seed: int, floor_m: float, kind: str = "gym") -> Canvas:
    """Draw a background at a camera's scale.

    Parameters
    ----------
    camera : Camera
    seed : int
    floor_m : float
        Height of the line where wall and floor meet.
    kind : str
        One of `BACKGROUNDS`.
    """
    width, height = camera.size_px
    on = make_canvas((height, width), camera.px_per_m, (camera.origin_x_px, camera.origin_y_px))
    BACKGROUNDS[kind](on, seed, floor_m)
    return on


def draw_scale(on: Canvas, marks_m: Mapping[str, Point]) -> None:
    """Draw a pole with its length between the marks `bar_left` and `bar_right`, where there are any."""
    if "bar_left" in marks_m:
        left, right = marks_m["bar_left"], marks_m["bar_right"]
        draw_pole(on, left, right)
        write(on, f"{right[0] - left[0]:g} m", (right[0] + 0.03, left[1] - 0.014))


def draw_room(on: Canvas, seed: int, floor_m: float) -> None:
    """Draw a quiet wall and a floor of boards."""
    _bands(on, ((FAR_M, WALL), (floor_m + 0.62, DADO), (floor_m + 0.03, SKIRTING), (floor_m, FLOOR)))
    on.lighten((WALL_GREY * grain(seed, "wall", _shape(on), 3.0)).astype(np.float32))
    on.lighten(_planks(on, floor_m))


def draw_lawn(on: Canvas, seed: int, floor_m: float) -> None:
    """Draw a mown lawn before a hedge, under the sky; the grass is speckled too, which tempts trackers away."""
    _bands(on, ((FAR_M, SKY), (floor_m + 0.55, HEDGE), (floor_m + 0.2, LAWN)))
    leaves = 12.0 * grain(seed, "hedge", _shape(on), 2.0, 2.0)
    blades = 8.0 * grain(seed, "lawn", _shape(on), 1.0) + 5.0 * grain(seed, "tufts", _shape(on), 3.0)
    hedge, lawn = _between(on, floor_m + 0.2, floor_m + 0.55), _between(on, -FAR_M, floor_m + 0.2)
    on.lighten(leaves.astype(np.float32), hedge)
    on.lighten(blades.astype(np.float32), lawn)
    depth = floor_m + 0.2 - on.y_m + 0.0 * on.x_m
    # The mower's lanes widen towards the viewer.
    lanes = np.where(np.sqrt(np.maximum(depth, 0.0) / 0.11) % 2.0 < 1.0, 5.0, -5.0)
    on.lighten(lanes.astype(np.float32), lawn)
    on.fill(_between(on, floor_m + 0.055, floor_m + 0.075), LINE, opacity=0.8)


def draw_grid(on: Canvas, seed: int, floor_m: float) -> None:
    """Draw a cloth with a line every 10 cm, a bolder one every 50 cm, down to a floor."""
    _bands(on, ((FAR_M, CLOTH), (floor_m, FLOOR)))
    on.lighten((0.7 * WALL_GREY * grain(seed, "cloth", _shape(on), 2.0)).astype(np.float32))
    cloth = _between(on, floor_m, FAR_M)
    for every, wide in ((GRID_M, 0.0025), (5 * GRID_M, 0.006)):
        away = np.minimum(*(np.abs(along - every * np.round(along / every)) for along in (on.x_m, on.y_m - floor_m)))
        on.fill(np.maximum(away - wide / 2, cloth).astype(np.float32), THREAD)
    on.lighten(_planks(on, floor_m))


BACKGROUNDS: Mapping[str, Callable[[Canvas, int, float], None]] = {
    "gym": draw_room,
    "grass": draw_lawn,
    "grid": draw_grid,
}


def write(on: Canvas, text: str, at_m: Point) -> None:
    """Write into the picture; letters are 4.5 cm high."""
    column = round(at_m[0] * on.samples_per_m + on.origin[0])
    row = round(on.origin[1] - at_m[1] * on.samples_per_m)
    ink = np.zeros(on.opacity.shape, np.uint8)
    size = 0.045 * on.samples_per_m / 22.0  # this face's capitals are 22 px high at scale 1
    cv2.putText(ink, text, (column, row), cv2.FONT_HERSHEY_SIMPLEX, size, 255, max(1, round(2.2 * size)), cv2.LINE_AA)
    on.fill((0.5 - ink.astype(np.float32) / 255.0) / on.samples_per_m, TEXT)


def _bands(on: Canvas, tops: tuple[tuple[float, tuple[float, float, float]], ...]) -> None:
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

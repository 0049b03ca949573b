"""What belongs to a testing machine: its dark back plate, grips, a steel ruler."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from vml_course.model.camera import Camera
from vml_course.synth.canvas import Canvas, Colour, make_canvas, sheet
from vml_course.synth.props.lettering import write
from vml_course.synth.props.target import SMALLEST_TARGET_PX, WHITE, draw_target
from vml_course.synth.shapes import Point, box, disc
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite
from vml_course.synth.texture import Plane, grain

BACK = (66.0, 74.0, 84.0)
STEEL = (150.0, 156.0, 162.0)
STEEL_EDGE = (84.0, 90.0, 96.0)
JAW = (112.0, 118.0, 126.0)
RULER = (224.0, 226.0, 222.0)
INK: Colour = (26.0, 26.0, 28.0)
RED: Colour = (188.0, 40.0, 36.0)
FAR_M = 100.0
MARK_M = 0.0014
TICK_M = 0.0004
MM_M = 0.001


def draw_back(camera: Camera, seed: int) -> Canvas:
    """Draw the back plate of a machine, which fills the picture."""
    width, height = camera.size_px
    on = make_canvas((height, width), camera.px_per_m, (camera.origin_x_px, camera.origin_y_px))
    on.fill(box(on, (-FAR_M, -FAR_M), (FAR_M, FAR_M)), BACK)
    on.lighten(np.asarray(2.0 * grain(seed, "back", (height, width), 3.0), np.float32))
    return on


def draw_grip(half_m: Point, px_per_m: float, seed: int, jaw: float) -> Sprite:
    """Draw a grip, its centre the origin; the jaw, a darker strip, is on the right (`jaw` 1) or on the left (-1)."""
    (x, y), rim = half_m, 0.0008
    on = sheet((x + 0.001, x + 0.001, y + 0.001, y + 0.001), px_per_m, OVERSAMPLE)
    on.fill(box(on, (-x, -y), (x, y)), STEEL_EDGE)
    on.fill(box(on, (-x + rim, -y + rim), (x - rim, y - rim)), STEEL)
    brushed = grain(seed, "steel", (on.opacity.shape[0], 64), OVERSAMPLE)[:, :1]
    on.lighten(np.asarray(3.0 * brushed + 0.0 * on.x_m, np.float32))
    low, high = sorted((jaw * x, jaw * (x - 0.006)))
    on.fill(box(on, (low, -y + rim), (high, y - rim)), JAW)
    for up in (-0.6, 0.0, 0.6):
        on.fill(disc(on, (-0.35 * jaw * x, up * y), 0.0035), STEEL_EDGE)
        on.fill(disc(on, (-0.35 * jaw * x, up * y), 0.0018), INK)
    return make_sprite(on)


def draw_ruler(length_m: float, px_per_m: float) -> Sprite:
    """Draw a ruler from its zero mark, the origin, to the right: a tick every mm; its ends are the longest."""
    high, low, side = 0.004, 0.0048, 0.011
    on = sheet((side, length_m + side + 0.006, low + 0.001, high + 0.001), px_per_m, OVERSAMPLE)
    on.fill(box(on, (-side, -low), (length_m + side + 0.005, high)), STEEL_EDGE)
    on.fill(box(on, (-side + 0.0004, -low + 0.0004), (length_m + side + 0.0046, high - 0.0004)), RULER)
    on.fill(_ticks(on, length_m), INK)
    letters = 0.0024
    write(on, "0", (-0.004, -0.0005), letters, INK)
    write(on, f"{1000 * length_m:.0f} mm", (length_m + 0.0085, -0.0005), letters, INK)
    return make_sprite(on)


def draw_marks(on: Canvas, places_m: Mapping[str, Point]) -> None:
    """Print a target in a white disc for each point, with its letter on the side away from x = 0."""
    radius, letters = max(MARK_M, SMALLEST_TARGET_PX * OVERSAMPLE / on.samples_per_m), 0.0024
    for name, (x, y) in places_m.items():
        disc_m = 1.7 * radius
        near = on.near((x - 4 * disc_m, y - 2 * disc_m), (x + 4 * disc_m, y + 2 * disc_m))
        near.fill(disc(near, (x, y), 1.16 * disc_m), RED)
        near.fill(disc(near, (x, y), disc_m), WHITE)
        draw_target(near, (x, y), OVERSAMPLE, MARK_M)
        beside = x + math.copysign(1.16 * disc_m + 0.8 * letters, x), y
        near.fill(disc(near, beside, letters), WHITE)
        write(near, name, beside, letters, RED)


def _ticks(on: Canvas, length_m: float) -> Plane:
    """Return the distance to the ticks, which hang from the upper edge: longest at the ends."""
    number = np.clip(np.round(on.x_m / MM_M), 0, round(length_m / MM_M))
    ends = (number == 0) | (number == round(length_m / MM_M))
    depth = np.where(ends, 0.0076, np.where(number % 10 == 0, 0.0042, np.where(number % 5 == 0, 0.0032, 0.002)))
    across = np.abs(on.x_m - number * MM_M) - np.where(ends, 1.25, 0.6) * TICK_M / 2
    return np.asarray(np.maximum(across, np.maximum(0.0036 - depth - on.y_m, on.y_m - 0.0036)), np.float32)

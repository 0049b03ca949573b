"""Straight bodies seen from above: a door with a card at hinge and edge, a rod with a card at each end."""

from __future__ import annotations

import numpy as np

from vml_course.synth.canvas import Canvas, Colour, sheet
from vml_course.synth.props.prints import Print
from vml_course.synth.props.surface import draw_card, speckle
from vml_course.synth.shapes import Point, both, box, disc
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite
from vml_course.synth.texture import Plane

PAINT = (74.0, 116.0, 104.0)
LEAF_EDGE = (46.0, 74.0, 66.0)
PINE = (212.0, 176.0, 122.0)
BRASS = (170.0, 140.0, 70.0)
RED = (186.0, 52.0, 44.0)
GRAIN_GREY = 24.0


def draw_door(length_m: float, half_m: float, card_m: float, px_per_m: float, printed: Print) -> Sprite:
    """Draw a door from above that reaches down from its hinge, the origin, to the card at its edge and a bit beyond."""
    wide, beyond = card_m + 0.005, card_m + 0.01
    on = sheet((wide, wide, length_m + beyond, card_m + 0.01), px_per_m, OVERSAMPLE)
    leaf = box(on, (-half_m, -length_m - 0.6 * card_m), (half_m, 0.6 * card_m))
    on.fill(leaf, LEAF_EDGE)
    inner = box(on, (-half_m + 0.005, -length_m - 0.6 * card_m + 0.005), (half_m - 0.005, 0.6 * card_m - 0.005))
    on.fill(inner, PAINT)
    printed.draw_stripes(on, inner, 0.0)
    speckle(on, printed, "door", GRAIN_GREY, leaf)
    for at, name in (((0.0, 0.0), "hinge"), ((0.0, -length_m), "edge")):
        draw_card(on, at, card_m, printed, name)
    return make_sprite(on)


def draw_rod(marks_m: tuple[Point, Point], half_m: float, reach_m: float, px_per_m: float, printed: Print) -> Sprite:
    """Draw an upright wooden rod, its centre the origin, as long as twice `reach_m`, with a card at two marks."""
    wide, card_m = half_m + 0.006, 0.94 * half_m
    on = sheet((wide, wide, reach_m, reach_m), px_per_m, OVERSAMPLE)
    body = _rounded(on, half_m, reach_m)
    on.fill(body, PINE)
    on.lighten(_wood(on), body)
    for share in (-0.5, 0.5):
        _band(on, body, share * reach_m, BRASS)
    on.fill(both(body, box(on, (-0.004, -0.02), (0.004, 0.02))), RED)
    on.fill(both(body, box(on, (-0.02, -0.004), (0.02, 0.004))), RED)
    printed.draw_stripes(on, body, reach_m)
    speckle(on, printed, "rod", GRAIN_GREY, body)
    for place, name in zip(marks_m, ("tail", "tip"), strict=True):
        draw_card(on, place, card_m, printed, name)
    return make_sprite(on)


def draw_frame(on: Canvas, half_m: float, hinge_m: Point = (0.0, 0.0)) -> None:
    """Draw the wall that a door hangs in, cut open above its hinge, and the knuckle of the hinge."""
    x, y = hinge_m
    wall = box(on, (-100.0, y + 0.07), (100.0, y + 0.30))
    on.fill(wall, (122.0, 126.0, 130.0))
    on.fill(both(wall, box(on, (-100.0, y + 0.07), (100.0, y + 0.085))), (78.0, 82.0, 88.0))
    on.fill(box(on, (x - half_m - 0.03, y + 0.02), (x + half_m + 0.03, y + 0.10)), (96.0, 84.0, 70.0))
    on.fill(disc(on, (x, y + 0.03), 0.02), BRASS)


def _rounded(on: Canvas, half_m: float, reach_m: float) -> Plane:
    corner = 0.3 * half_m
    across, along = np.abs(on.x_m) - half_m + corner, np.abs(on.y_m) - reach_m + corner
    outside = np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0))
    return np.asarray(outside + np.minimum(np.maximum(across, along), 0.0) - corner, np.float32)


def _band(on: Canvas, body: Plane, height_m: float, rgb: Colour) -> None:
    on.fill(both(body, box(on, (-1.0, height_m - 0.008), (1.0, height_m + 0.008))), rgb)


def _wood(on: Canvas) -> Plane:
    return np.asarray(8.0 * np.sin(on.x_m * 420.0 + 1.6 * np.sin(on.y_m * 14.0)), np.float32)

"""Balls and pucks, each with its centre as origin."""

from __future__ import annotations

import math

import numpy as np

from vml_course.synth.canvas import Canvas, Colour, sheet
from vml_course.synth.props.lettering import write
from vml_course.synth.props.prints import Print
from vml_course.synth.props.surface import draw_mark, shade, speckle
from vml_course.synth.props.target import draw_target
from vml_course.synth.shapes import Point, both, box, disc
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite
from vml_course.synth.texture import Plane

LEATHER = (222.0, 222.0, 206.0)
STITCH = (176.0, 44.0, 40.0)
RUBBER = (206.0, 112.0, 54.0)
LINE = (50.0, 38.0, 34.0)
INK = (28.0, 28.0, 30.0)
PAPER = (236.0, 236.0, 232.0)
GRAIN_GREY = 20.0


def draw_softball(radius_m: float, px_per_m: float, printed: Print) -> Sprite:
    """Draw a white ball with two red seams."""
    on, rim = _round(radius_m, px_per_m, LEATHER)
    for side in (-1.0, 1.0):
        bow = _ring(on, (side * 1.22 * radius_m, 0.0), 0.84 * radius_m)
        on.fill(both(rim, bow - 0.012 * radius_m), STITCH)
        turn = np.arctan2(on.y_m + 0.0 * on.x_m, on.x_m - side * 1.22 * radius_m)
        stitch = np.abs((turn * 13.0) % 1.0 - 0.5) * 0.065 * radius_m * 2 - 0.022 * radius_m
        on.fill(both(rim, bow - 0.075 * radius_m, np.asarray(stitch, np.float32)), STITCH)
    speckle(on, printed, "ball", GRAIN_GREY, rim)
    on.lighten(shade(on, (-0.2 * radius_m, 0.2 * radius_m), 1.3 * radius_m), rim)
    return make_sprite(on)


def draw_basketball(radius_m: float, px_per_m: float, printed: Print, mark_m: Point) -> Sprite:
    """Draw a ball with dark ribs and a target at `mark_m`, so that one sees how it turns."""
    on, rim = _round(radius_m, px_per_m, RUBBER)
    printed.draw_stripes(on, rim, radius_m)
    width = 0.02 * radius_m
    ribs = [np.abs(on.x_m + 0.0 * on.y_m), np.abs(on.y_m + 0.0 * on.x_m)]
    ribs += [_ring(on, (side * 1.25 * radius_m, 0.0), 0.8 * radius_m) for side in (-1.0, 1.0)]
    for rib in ribs:
        on.fill(both(rim, np.asarray(rib - width, np.float32)), LINE)
    speckle(on, printed, "basketball", 26.0, rim)
    on.lighten(shade(on, (0.0, 0.0), radius_m), rim)
    if printed.has_targets:
        draw_target(on, (0.0, 0.0), OVERSAMPLE)
    draw_mark(on, printed, mark_m, radius_m - math.hypot(*mark_m))
    return make_sprite(on)


def draw_puck(radius_m: float, px_per_m: float, printed: Print, number: str, rgb: Colour) -> Sprite:
    """Draw a puck seen from above: a coloured rim, a paper face with a printed number and a target in the middle."""
    on, rim = _round(radius_m, px_per_m, rgb)
    face = disc(on, (0.0, 0.0), 0.78 * radius_m)
    on.fill(face, PAPER)
    for side in () if printed.kind == "stripes" else (-1.0, 1.0):
        write(on, number, (side * 0.52 * radius_m, 0.0), 0.42 * radius_m, INK, inside_m=face)
        edge = side * 0.5 * radius_m
        bar = box(on, (-0.4 * radius_m, edge - 0.05 * radius_m), (0.4 * radius_m, edge + 0.05 * radius_m))
        on.fill(both(face, bar), rgb)
    printed.draw_stripes(on, face, radius_m)
    speckle(on, printed, f"puck {number}", 26.0, rim, 1.2)
    draw_mark(on, printed, (0.0, 0.0), 0.42 * radius_m, 0.26 * radius_m)
    return make_sprite(on)


def _round(radius_m: float, px_per_m: float, rgb: Colour) -> tuple[Canvas, Plane]:
    on = sheet((radius_m,) * 4, px_per_m, OVERSAMPLE)
    rim = disc(on, (0.0, 0.0), radius_m)
    on.fill(rim, rgb)
    return on, rim


def _ring(on: Canvas, centre: Point, radius_m: float) -> Plane:
    """Return the distance to a circle line."""
    return np.asarray(np.abs(disc(on, centre, radius_m)), np.float32)

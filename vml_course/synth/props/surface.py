"""What trackers live on: printed speckle, and the light on round things."""

from __future__ import annotations

import numpy as np

from vml_course.synth.canvas import Canvas
from vml_course.synth.props.prints import Print, draw_logo
from vml_course.synth.props.target import SMALLEST_TARGET_PX, TARGET_M, draw_target
from vml_course.synth.shapes import Point, disc
from vml_course.synth.sprite import OVERSAMPLE
from vml_course.synth.texture import Plane

CARD = (196.0, 196.0, 190.0)
CARD_GREY = 34.0
LOGO_OF_REACH = 1.45  # a shield as high as that part of a circle's radius just fits into it


def speckle(on: Canvas, printed: Print, name: str, grey: float, inside_m: Plane, size_px: float = 1.0) -> None:
    """Print fine speckle where a distance is negative; it is the same speckle for the same seed and name."""
    on.lighten(np.asarray(printed.speckle(on, name, grey, OVERSAMPLE, size_px), np.float32), inside_m)


def shade(on: Canvas, at_m: Point, radius_m: float, grey: float = 40.0) -> Plane:
    """Return how much darker a ball is towards its rim, the same all round so that it may turn: grey levels."""
    part = np.hypot(on.x_m - at_m[0], on.y_m - at_m[1]) / radius_m
    return np.asarray(-grey * np.clip(part, 0.0, 1.0) ** 3, np.float32)


def draw_mark(on: Canvas, printed: Print, at_m: Point, reach_m: float, target_m: float = TARGET_M) -> None:
    """Draw what shows a tracked place: a target, or a logo that fills a circle; nothing on stripes and plain bodies."""
    if printed.kind == "logo":
        draw_logo(on, at_m, LOGO_OF_REACH * reach_m)
    elif printed.kind == "speckle":
        draw_target(on, at_m, OVERSAMPLE, target_m)


def draw_card(on: Canvas, at_m: Point, radius_m: float, printed: Print, name: str) -> None:
    """Stick a round card on a body, a place that can be tracked: speckled with a target in its middle, or printed."""
    near = on.near((at_m[0] - radius_m, at_m[1] - radius_m), (at_m[0] + radius_m, at_m[1] + radius_m))
    rim = disc(near, at_m, radius_m)
    near.fill(rim, (70.0, 70.0, 72.0))
    inner = np.asarray(rim + 0.05 * radius_m, np.float32)
    near.fill(inner, CARD)
    printed.draw_stripes(near, inner, at_m[1] + radius_m)
    speckle(near, printed, name, CARD_GREY, inner, 1.3)
    if printed.kind == "logo" or radius_m > 1.5 * max(TARGET_M, SMALLEST_TARGET_PX * OVERSAMPLE / on.samples_per_m):
        draw_mark(near, printed, at_m, radius_m)

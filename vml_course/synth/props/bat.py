"""A bat that hangs from the hands, its origin: knob, taped handle, wooden barrel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.synth.bodies import BAT_CLAMP_M
from vml_course.synth.canvas import Canvas, sheet
from vml_course.synth.props.prints import Print
from vml_course.synth.props.surface import draw_mark, speckle
from vml_course.synth.props.target import draw_target
from vml_course.synth.shapes import both, box, disc, tapered, union
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite
from vml_course.synth.texture import Plane

WOOD = (206.0, 164.0, 108.0)
TAPE = (52.0, 54.0, 60.0)
BAND = (150.0, 40.0, 42.0)
STEEL = (112.0, 116.0, 124.0)
TIP_M = 0.075  # of the barrel beyond the point that hits
HANDLE_M = 0.017
GRAIN_GREY = 26.0


@dataclass(frozen=True, slots=True)
class Bat:
    """Sizes in metres: from the hands to the point of the barrel that hits, and the barrel there."""

    length_m: float
    barrel_m: float


def draw_bat(bat: Bat, px_per_m: float, printed: Print) -> Sprite:
    """Draw a bat whose hands are its origin; a steel clamp holds it there."""
    wide = max(BAT_CLAMP_M, bat.barrel_m) + 0.005
    on = sheet((wide, wide, bat.length_m + TIP_M + bat.barrel_m, BAT_CLAMP_M + 0.02), px_per_m, OVERSAMPLE)
    wood = _wood(on, bat)
    on.fill(wood, WOOD)
    on.lighten(_rings(on, bat), wood)
    for low, high, rgb in ((-0.44, -0.1, TAPE), (-0.52, -0.5, BAND), (-0.56, -0.54, BAND)):
        on.fill(both(wood, box(on, (-1.0, low * bat.length_m), (1.0, high * bat.length_m))), rgb)
    printed.draw_stripes(on, wood, -0.56 * bat.length_m)
    clamp = disc(on, (0.0, 0.0), BAT_CLAMP_M)
    on.fill(clamp, STEEL)
    outline = union(wood, clamp)
    speckle(on, printed, "bat", GRAIN_GREY, outline, 1.2)
    if printed.has_targets:
        draw_target(on, (0.0, 0.0), OVERSAMPLE)
    draw_mark(on, printed, (0.0, -bat.length_m), bat.barrel_m)
    return make_sprite(on)


def _wood(on: Canvas, bat: Bat) -> Plane:
    """Return the distance to the bat: nowhere in front is it thicker than where it hits."""
    barrel, tip = ((0.0, -bat.length_m), bat.barrel_m), ((0.0, -bat.length_m - TIP_M), 0.93 * bat.barrel_m)
    neck, top = ((0.0, -0.45 * bat.length_m), HANDLE_M), ((0.0, 0.035), HANDLE_M)
    return union(tapered(on, top, neck), tapered(on, neck, barrel), tapered(on, barrel, tip))


def _rings(on: Canvas, bat: Bat) -> Plane:
    """Darken along the grain of the wood, and towards the back."""
    along = np.sin(on.x_m * 520.0 + 1.4 * np.sin(on.y_m * 16.0))
    return np.asarray(7.0 * along + 16.0 * np.clip(on.x_m / bat.barrel_m, -1.0, 1.0), np.float32)

"""A ballistic pendulum: a box on two arms, its front cut open so that one sees what flies into it."""

from __future__ import annotations

import numpy as np

from vml_course.synth.bodies import CATCHER_HUB_M, Catcher
from vml_course.synth.canvas import sheet
from vml_course.synth.props.prints import Print
from vml_course.synth.props.surface import draw_card, shade, speckle
from vml_course.synth.props.target import draw_target
from vml_course.synth.shapes import both, box, disc, tapered, union
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite

ARM = (128.0, 132.0, 140.0)
BOX = (172.0, 122.0, 74.0)
FRAME = (86.0, 58.0, 36.0)
TUNNEL = (52.0, 46.0, 42.0)
PUTTY = (120.0, 116.0, 128.0)
FELT = (206.0, 218.0, 84.0)
SEAM = (240.0, 240.0, 232.0)
GRAIN_GREY = 24.0


def draw_catcher(catcher: Catcher, px_per_m: float, printed: Print) -> Sprite:
    """Draw a pendulum whose pivot is its origin; the tunnel opens to the left and ends in putty."""
    half, depth, pellet = catcher.half_m, catcher.depth_m, catcher.pellet_m
    top = -depth + pellet + 0.03
    on = sheet((half, half, catcher.bottom_m, CATCHER_HUB_M), px_per_m, OVERSAMPLE)
    arms = union(*(tapered(on, ((0.0, 0.0), 0.007), ((x, top), 0.007)) for x in (-0.55 * half, 0.55 * half)))
    on.fill(arms, ARM)
    hub = disc(on, (0.0, 0.0), CATCHER_HUB_M)
    on.fill(hub, ARM)
    body = box(on, (-half, -catcher.bottom_m), (half, top))
    on.fill(body, FRAME)
    on.fill(box(on, (-half + 0.006, -catcher.bottom_m + 0.006), (half - 0.006, top - 0.006)), BOX)
    printed.draw_stripes(on, body, top)
    tunnel = box(on, (-half, -depth - 1.12 * pellet), (1.15 * pellet, -depth + 1.12 * pellet))
    on.fill(tunnel, TUNNEL)
    on.fill(both(tunnel, -disc(on, (-0.12 * pellet, -depth), 1.06 * pellet), _right_of(on.x_m, on.y_m)), PUTTY)
    outline = union(arms, hub, body)
    speckle(on, printed, "catcher", GRAIN_GREY, outline, 1.2)
    draw_card(on, (0.0, -depth - catcher.mark_m), catcher.card_m, printed, "bob")
    if printed.has_targets:
        draw_target(on, (0.0, 0.0), OVERSAMPLE, 0.016)
    return make_sprite(on)


def draw_tennis_ball(radius_m: float, px_per_m: float, printed: Print) -> Sprite:
    """Draw a felt ball with its white seam, its centre the origin."""
    on = sheet((radius_m,) * 4, px_per_m, OVERSAMPLE)
    rim = disc(on, (0.0, 0.0), radius_m)
    on.fill(rim, FELT)
    for side in (-1.0, 1.0):
        bow = np.abs(disc(on, (side * 1.15 * radius_m, side * 0.5 * radius_m), 0.9 * radius_m)) - 0.06 * radius_m
        on.fill(both(rim, np.asarray(bow, np.float32)), SEAM)
    speckle(on, printed, "felt", 30.0, rim, 1.2)
    on.lighten(shade(on, (0.0, 0.0), radius_m), rim)
    return make_sprite(on)


def _right_of(x_m: np.ndarray, y_m: np.ndarray) -> np.ndarray:
    return np.asarray(-x_m + 0.0 * y_m, np.float32)

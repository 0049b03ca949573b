"""A leg from the knee down: knee sleeve, sock, boot, with targets at knee, shin and foot.

Drawn hanging straight down from the knee, which is its origin, toes forward (+x, where the ball is). In
front, no part reaches farther than the boot's striking circle, so that the leg never enters the ball.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.synth.canvas import Canvas, sheet
from vml_course.synth.props.prints import Print, draw_logo, stripes
from vml_course.synth.props.target import draw_target
from vml_course.synth.shapes import both, box, tapered, union
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite
from vml_course.synth.texture import Plane

SKIN = (205.0, 156.0, 128.0)
SLEEVE = (112.0, 108.0, 118.0)
SOCK = (44.0, 92.0, 168.0)
BAND = (214.0, 216.0, 222.0)
BOOT = (206.0, 92.0, 36.0)
SOLE = (60.0, 56.0, 58.0)
TOE_M = 0.12
SOLE_M = 0.014
SLEEVE_TO = 0.17  # of the way from knee to foot
SOCK_FROM = 0.24  # of the way from knee to foot
GRAIN_GREY = 25.0
LOGO_OF_SHIN = 1.25


@dataclass(frozen=True, slots=True)
class Leg:
    """Sizes in metres; `shin_at` is the part of the length at which the shin's target sits."""

    length_m: float
    foot_m: float
    knee_m: float
    shin_m: float
    shin_at: float


def draw_leg(leg: Leg, px_per_m: float, printed: Print, *, plain_knee: bool = False) -> Sprite:
    """Draw a leg whose knee is its origin.

    Targets sit where something else does not show the place: none on a plain knee or a plain leg, and none on a
    shin with a logo or stripes.
    """
    wide = max(leg.knee_m, leg.foot_m + 0.05)
    on = sheet((wide, wide, leg.length_m + TOE_M + leg.foot_m, leg.knee_m), px_per_m, OVERSAMPLE)
    limb, boot = _limb(on, leg), _boot(on, leg)
    on.fill(limb, SKIN)
    on.fill(both(limb, box(on, (-1.0, -SLEEVE_TO * leg.length_m), (1.0, 1.0))), SLEEVE)
    _draw_sock(on, leg, limb, printed.kind)
    _draw_boot(on, leg, boot)
    outline = union(limb, boot)
    on.lighten(_roundness(on, leg), outline)
    speckle = printed.speckle(on, "leg", GRAIN_GREY, OVERSAMPLE)
    below_knee = box(on, (-1.0, -10.0), (1.0, -SLEEVE_TO * leg.length_m))
    on.lighten(speckle, both(outline, below_knee) if plain_knee else outline)
    shin = (0.0, -leg.shin_at * leg.length_m)
    if printed.kind == "logo":
        draw_logo(on, shin, LOGO_OF_SHIN * leg.shin_m)
    for place in _targets(leg, printed.kind, plain_knee=plain_knee):
        draw_target(on, place, OVERSAMPLE)
    return make_sprite(on)


def _targets(leg: Leg, kind: str, *, plain_knee: bool) -> list[tuple[float, float]]:
    ways = {"speckle": (0.0, leg.shin_at, 1.0), "plain": ()}.get(kind, (0.0, 1.0))
    return [(0.0, -way * leg.length_m) for way in ways if way or not plain_knee]


def _limb(on: Canvas, leg: Leg) -> Plane:
    """Return the distance to knee, calf and ankle."""
    shin = ((0.0, -leg.shin_at * leg.length_m), leg.shin_m)
    knee = ((0.0, 0.0), leg.knee_m)
    ankle = ((-0.1 * leg.foot_m, -0.86 * leg.length_m), 0.78 * leg.foot_m)
    return union(tapered(on, knee, shin), tapered(on, shin, ankle))


def _boot(on: Canvas, leg: Leg, shift: float = 0.0) -> Plane:
    """Return the distance to the boot, or to the same shape shifted forward."""
    height, r = -leg.length_m, leg.foot_m
    foot = ((shift, height), r)
    collar = ((shift - 0.1 * r, 0.86 * height), 0.85 * r)
    toe = ((shift - 0.15 * r, height - TOE_M), 0.5 * r)
    heel = ((shift - 0.45 * r, 0.9 * height), 0.75 * r)
    return union(tapered(on, foot, toe), tapered(on, collar, foot), tapered(on, heel, foot))


def _draw_boot(on: Canvas, leg: Leg, boot: Plane) -> None:
    """Draw upper, three stripes, and a sole along the back: what the boot shifted forward does not cover."""
    upper = both(boot, _boot(on, leg, SOLE_M))
    on.fill(boot, SOLE)
    on.fill(upper, BOOT)
    for step in (0.45, 0.85, 1.25):
        x, y = -0.55 * leg.foot_m, -leg.length_m - (step - 0.1) * leg.foot_m
        stripe = tapered(on, ((x, y), 0.006), ((x + 0.9 * leg.foot_m, y - 0.45 * leg.foot_m), 0.006))
        on.fill(both(upper, stripe), BAND)
    collar = both(upper, -_boot_opening(on, leg))
    on.fill(collar, SOLE)


def _boot_opening(on: Canvas, leg: Leg) -> Plane:
    """Return the distance to all that lies below the boot's upper rim."""
    rim = -0.86 * leg.length_m + 0.55 * leg.foot_m
    return np.asarray(on.y_m - rim + 0.0 * on.x_m, np.float32)


def _draw_sock(on: Canvas, leg: Leg, limb: Plane, kind: str) -> None:
    top = -SOCK_FROM * leg.length_m
    sock = both(limb, box(on, (-1.0, -1.0), (1.0, top)))
    on.fill(sock, SOCK)
    if kind == "stripes":
        on.fill(both(sock, stripes(on, top)), BAND)
        return
    for drop in (0.012, 0.04):
        on.fill(both(limb, box(on, (-1.0, top - drop - 0.014), (1.0, top - drop))), BAND)


def _roundness(on: Canvas, leg: Leg) -> Plane:
    """Darken towards the back of the leg, so that it looks round."""
    return np.asarray(22.0 * np.clip(on.x_m / leg.shin_m, -1.0, 0.6) + 0.0 * on.y_m, np.float32)

"""A pendulum hammer with a rounded head, and a block that slides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.synth.bodies import HAMMER_HUB_M
from vml_course.synth.canvas import Canvas, sheet
from vml_course.synth.props.lettering import write
from vml_course.synth.props.prints import Print
from vml_course.synth.props.surface import draw_card, draw_mark, speckle
from vml_course.synth.props.target import draw_target
from vml_course.synth.shapes import box, disc, tapered, union
from vml_course.synth.sprite import OVERSAMPLE, Sprite, make_sprite

STEEL = (126.0, 132.0, 142.0)
HANDLE = (160.0, 112.0, 64.0)
RED = (178.0, 58.0, 50.0)
OAK = (196.0, 152.0, 96.0)
INK = (46.0, 34.0, 26.0)
GRAIN_GREY = 24.0


@dataclass(frozen=True, slots=True)
class Hammer:
    """Sizes in metres: from the pivot to the middle of the head, and the head's striking circle."""

    length_m: float
    head_m: float


def draw_hammer(hammer: Hammer, px_per_m: float, printed: Print) -> Sprite:
    """Draw a hammer that hangs from its pivot, the origin; its face looks to the right."""
    head, length = hammer.head_m, hammer.length_m
    on = sheet(
        (3.2 * head, max(HAMMER_HUB_M, head) + 0.005, length + 1.25 * head, HAMMER_HUB_M + 0.005), px_per_m, OVERSAMPLE
    )
    handle = tapered(on, ((0.0, 0.0), 0.016), ((0.0, -length), 0.019))
    on.fill(handle, HANDLE)
    hub = disc(on, (0.0, 0.0), HAMMER_HUB_M)
    on.fill(hub, RED)
    back = box(on, (-2.2 * head, -length - 0.8 * head), (-0.4 * head, -length + 0.8 * head))
    tail = box(on, (-2.9 * head, -length - 1.1 * head), (-2.2 * head, -length + 1.1 * head))
    on.fill(union(back, tail), RED)
    face = disc(on, (0.0, -length), head)
    on.fill(face, STEEL)
    outline = union(handle, hub, back, tail, face)
    printed.draw_stripes(on, union(handle, back, tail, face), -HAMMER_HUB_M)
    speckle(on, printed, "hammer", GRAIN_GREY, outline, 1.2)
    if printed.has_targets:
        draw_target(on, (0.0, 0.0), OVERSAMPLE, 0.016)
    draw_mark(on, printed, (0.0, -length), head, 0.016)
    return make_sprite(on)


def draw_block(half_m: tuple[float, float], px_per_m: float, printed: Print) -> Sprite:
    """Draw a wooden block of half-width and half-height, its centre the origin, with a card in the middle."""
    (wide, high) = half_m
    on = sheet((wide, wide, high, high), px_per_m, OVERSAMPLE)
    body = box(on, (-wide, -high), (wide, high))
    on.fill(body, INK)
    inner = box(on, (-wide + 0.004, -high + 0.004), (wide - 0.004, high - 0.004))
    on.fill(inner, OAK)
    on.lighten(_rings(on), inner)
    printed.draw_stripes(on, inner, high)
    speckle(on, printed, "block", GRAIN_GREY, body)
    write(on, "m", (0.68 * wide, 0.62 * high), 0.26 * high, INK)
    draw_card(on, (0.0, 0.0), 0.58 * min(wide, high), printed, "block card")
    return make_sprite(on)


def draw_rail(on: Canvas, top_m: float, from_m: float, floor_m: float) -> None:
    """Draw the bench on which the block slides, from some place to the right edge of the picture."""
    on.fill(box(on, (from_m, top_m - 0.045), (100.0, top_m)), (88.0, 92.0, 98.0))
    on.fill(box(on, (from_m, top_m - 0.006), (100.0, top_m)), (136.0, 142.0, 148.0))
    for leg in (from_m + 0.06, from_m + 0.7):
        on.fill(box(on, (leg, floor_m), (leg + 0.05, top_m - 0.045)), (70.0, 74.0, 80.0))


def _rings(on: Canvas) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    return np.asarray(9.0 * np.sin(on.y_m * 380.0 + 2.0 * np.sin(on.x_m * 30.0)), np.float32)

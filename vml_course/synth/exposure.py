"""What a camera sees while its shutter is open: the mean of the composited pictures of many instants.

The instants lie in the middles of equal parts of the exposure, close enough together that nothing moves by
more than `STEP_PX` from one to the next. A body is averaged as a veil (colour times opacity, and opacity),
which gives the same mean as averaging pictures as long as all but one stand still. Only where the
boxes of two moving bodies meet are whole pictures averaged.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple, Protocol

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.synth.shake import shifted
from vml_course.synth.sprite import Box, Planes, Sprite, Veil, lay_veil

STEP_PX = 0.7
FEWEST_INSTANTS, MOST_INSTANTS = 8, 400
STILL_PX = 1e-4  # a body that moves less is at rest: one instant shows it


class Body(Protocol):
    """What can be exposed: a drawing and its poses at some instants of one exposure."""

    @property
    def instants(self) -> int:
        """How many there are."""

    @property
    def is_still(self) -> bool:
        """Whether one instant shows it."""

    def box(self, shape: tuple[int, ...]) -> Box:
        """Return the part of a picture of some shape that the body may reach."""

    def lay(self, on: Planes, instant: int, corner: tuple[int, int] = (0, 0)) -> Box:
        """Lay the body over a part of the picture that begins at `corner`; return what may have changed."""

    def veil(self, box: Box) -> Veil:
        """Return the mean over the instants of what lies over a box."""


class Swept(NamedTuple):
    """A body during one exposure: its drawing, and where it is, shape (k, 3), px, px, rad, at k instants."""

    sprite: Sprite
    pose_px: FloatArray

    @property
    def instants(self) -> int:
        """How many poses there are."""
        return len(self.pose_px)

    @property
    def is_still(self) -> bool:
        """Whether one instant shows it."""
        return bool((np.ptp(self.pose_px, axis=0) * (1.0, 1.0, self.sprite.reach_px) < STILL_PX).all())

    def box(self, shape: tuple[int, ...]) -> Box:
        """Return the part of the picture that the body may reach."""
        return self.sprite.box(self.pose_px, shape)

    def lay(self, on: Planes, instant: int, corner: tuple[int, int] = (0, 0)) -> Box:
        """Lay the body over a part of the picture that begins at `corner`; return what may have changed."""
        x, y, turn = self.pose_px[instant]
        return self.sprite.lay(on, (x - corner[0], y - corner[1]), turn)

    def veil(self, box: Box) -> Veil:
        """Return the mean over the instants of what lies over a box."""
        return self.sprite.smeared(self.pose_px, box)


def count_instants(sprites: Sequence[Sprite], pose_px: FloatArray, stretch: float = 1.0) -> int:
    """Return how many instants an exposure needs.

    Parameters
    ----------
    sprites : sequence of Sprite
    pose_px : float array, shape (k, b, 3)
        Where each body is at some times of the exposure: px, px, rad.
    stretch : float
        By how much the lens may lengthen a way.
    """
    steps = np.abs(np.diff(pose_px, axis=0))
    reach = np.array([sprite.reach_px for sprite in sprites])
    longest = stretch * float((np.hypot(steps[..., 0], steps[..., 1]) + reach * steps[..., 2]).sum(axis=0).max())
    if longest < STILL_PX:
        return 1
    return int(np.clip(np.ceil(longest / STEP_PX), FEWEST_INSTANTS, MOST_INSTANTS))


def expose(on: Planes, bodies: Sequence[Body]) -> list[Box]:
    """Draw bodies that move during an exposure over a still picture; return the boxes that may have changed."""
    if all(body.instants == 1 for body in bodies):
        return [body.lay(on, 0) for body in bodies]
    boxes = [body.box(on.luma.shape) for body in bodies]
    moving = [box for body, box in zip(bodies, boxes, strict=True) if not body.is_still]
    shared = [common for pair in combinations(moving, 2) if not_empty(common := meet(*pair))]
    behind = [on.part(box).copy() for box in shared]
    for body, box in zip(bodies, boxes, strict=True):
        _expose_one(on, body, box)
    for box, still in zip(shared, behind, strict=True):
        _expose_together(on.part(box), still, bodies, box)
    return boxes


def expose_shaken(still: Planes, bodies: Sequence[Body], offset_px: FloatArray) -> Planes:
    """Return the picture of an exposure during which the camera itself moves: whole pictures are averaged.

    Parameters
    ----------
    still : Planes
        What stands still, as an unmoved camera sees it.
    bodies : sequence of Body
    offset_px : float array, shape (k, 2) or (k, h, 2)
        How far the picture, or each of its rows, is shifted at each instant.
    """
    total = Planes(np.zeros_like(still.luma), np.zeros_like(still.chroma))
    for instant, offset in enumerate(offset_px):
        sheet = shifted(still, offset)
        for body in bodies:
            body.lay(sheet, instant)
        total.luma[...] += sheet.luma
        total.chroma[...] += sheet.chroma
    count = np.float32(len(offset_px))
    return Planes(total.luma / count, total.chroma / count)


def meet(one: Box, other: Box) -> Box:
    """Return what two boxes have in common; it may be empty.

    >>> meet((0, 0, 4, 4), (2, 2, 8, 8))
    (2, 2, 4, 4)
    """
    return max(one[0], other[0]), max(one[1], other[1]), min(one[2], other[2]), min(one[3], other[3])


def not_empty(box: Box) -> bool:
    """Tell whether a box holds a pixel."""
    return box[0] < box[2] and box[1] < box[3]


def _expose_one(on: Planes, body: Body, box: Box) -> None:
    if body.is_still:
        body.lay(on, 0)
    elif not_empty(box):
        lay_veil(on, body.veil(box), box)


def _expose_together(on: Planes, still: Planes, bodies: Sequence[Body], box: Box) -> None:
    """Average whole pictures of the box, where bodies hide one another."""
    total, sheet = Planes(np.zeros_like(still.luma), np.zeros_like(still.chroma)), still.copy()
    count = bodies[0].instants
    for instant in range(count):
        sheet.luma[...], sheet.chroma[...] = still.luma, still.chroma
        for body in bodies:
            body.lay(sheet, instant, (box[0], box[1]))
        total.luma[...] += sheet.luma
        total.chroma[...] += sheet.chroma
    on.luma[...], on.chroma[...] = total.luma / np.float32(count), total.chroma / np.float32(count)

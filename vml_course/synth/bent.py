"""A body during one exposure of a camera that is not square, or whose rows are exposed one after another."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.synth.exposure import STILL_PX
from vml_course.synth.sight import Sight, in_halves
from vml_course.synth.spline import add_gathered
from vml_course.synth.sprite import Box, Planes, Sprite, Veil, empty_veil, lay_veil


class Bent(NamedTuple):
    """A drawing and its poses in a square camera's pixels.

    Attributes
    ----------
    sprite : Sprite
    pose_px : float array, shape (k, h, 3) or (k, 1, 3)
        At each instant, for each row of the picture or for all: px, px, rad.
    sight : Sight
    offset_px : float array, shape (k, h, 2) or (k, 1, 2)
        How far the rows of the picture are shifted.
    """

    sprite: Sprite
    pose_px: FloatArray
    sight: Sight
    offset_px: FloatArray

    @property
    def instants(self) -> int:
        """How many instants there are."""
        return len(self.pose_px)

    @property
    def is_still(self) -> bool:
        """Whether one instant shows it."""
        return bool((np.ptp(self.pose_px, axis=0) * (1.0, 1.0, self.sprite.reach_px) < STILL_PX).all())

    def box(self, shape: tuple[int, ...]) -> Box:
        """Return the part of the picture that the body may reach."""
        return self._box(self.pose_px, self.offset_px, shape)

    def lay(self, on: Planes, instant: int, corner: tuple[int, int] = (0, 0)) -> Box:
        """Lay the body over a part of the picture that begins at `corner`; return what may have changed."""
        which = slice(instant, instant + 1)
        x, y = corner
        shape = on.luma.shape[0] + y, on.luma.shape[1] + x
        x0, y0, x1, y1 = self._box(self.pose_px[which], self.offset_px[which], shape)
        box = max(x0, x), max(y0, y), x1, y1
        within = box[0] - x, box[1] - y, x1 - x, y1 - y
        if box[0] < x1 and box[1] < y1:
            lay_veil(on, self._veil(box, which), within)
        return within

    def veil(self, box: Box) -> Veil:
        """Return the mean over the instants of what lies over a box; the picture itself must not be shifted."""
        return self._veil(box, slice(None))

    def _veil(self, box: Box, which: slice) -> Veil:
        rows = slice(box[1], box[3]) if self.pose_px.shape[1] > 1 else slice(None)
        pose, offset = self.pose_px[which, rows], self.offset_px[which][0]
        places = np.ascontiguousarray(self.sight.places_in(box, offset if offset.any() else None))
        half = (pose[:, ::2] + pose[:, 1::2]) / 2 if pose.shape[1] > 1 else pose
        veil, (luma, chroma) = empty_veil(box), self.sprite.drawings
        add_gathered(luma, self.sprite.ways(pose), places, veil.luma)
        add_gathered(chroma, halved(self.sprite.ways(half)), in_halves(places), veil.chroma)
        count = np.float32(len(pose))
        return Veil(veil.luma / count, veil.chroma / count)

    def _box(self, pose_px: FloatArray, offset_px: FloatArray, shape: tuple[int, ...]) -> Box:
        low, high = self.sight.box(*self.sprite.reach(pose_px))
        flat = offset_px.reshape(-1, 2)
        low, high = np.floor((low + flat.min(axis=0)) / 2) * 2, np.ceil((high + flat.max(axis=0)) / 2) * 2 + 2
        (x0, y0), (x1, y1) = np.clip([low, high], 0, [shape[1], shape[0]]).astype(int).tolist()
        return x0, y0, x1, y1


def halved(ways: FloatArray) -> FloatArray:
    """Lead to a drawing of half as many samples, whose first lies in the middle of two."""
    half = ways / 2
    half[..., 2] -= 0.25
    return np.asarray(half)

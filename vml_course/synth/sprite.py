"""A rigid body's picture: drawn and blurred once, then laid into each frame by one warp.

Turning and shifting a picture commute with an isotropic blur, so the optics may be applied once, to the
drawing; what each frame shows is then exact at edges and in the texture. The warp reads by quadratic B-splines
(`spline`), whose own blur is a part of the optics: OpenCV's cubic kernel (a = -3/4) does not reproduce a straight
ramp and pulls edges by up to 0.05 sample, and a bilinear one is sharper on a sample than between two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import cv2
import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.synth.canvas import Canvas
from vml_course.synth.overlay import cover
from vml_course.synth.spline import VARIANCE, Drawing, add_warps, lay_over, make_drawing
from vml_course.synth.texture import Plane

OVERSAMPLE = 2
OPTICS_PX = 0.65  # standard deviation of lens and pixel together
CHROMA_PX = 1.1

Box = tuple[int, int, int, int]


@dataclass(frozen=True, eq=False)
class Planes:
    """A picture that is being made: brightness at full size, colour at half size.

    Attributes
    ----------
    luma : float32 array, shape (h, w)
    chroma : float32 array, shape (h / 2, w / 2, 2)
    """

    luma: Plane
    chroma: Plane

    def copy(self) -> Planes:
        """Return planes of their own."""
        return Planes(self.luma.copy(), self.chroma.copy())

    def part(self, box: Box) -> Planes:
        """Return a box of the picture; it shares its samples."""
        x0, y0, x1, y1 = box
        return Planes(self.luma[y0:y1, x0:x1], self.chroma[y0 // 2 : y1 // 2, x0 // 2 : x1 // 2])

    def restore(self, source: Planes, box: Box) -> None:
        """Take a box (x0, y0, x1, y1; even numbers) back from another picture."""
        x0, y0, x1, y1 = box
        self.luma[y0:y1, x0:x1] = source.luma[y0:y1, x0:x1]
        half = slice(y0 // 2, y1 // 2), slice(x0 // 2, x1 // 2)
        self.chroma[half] = source.chroma[half]


class Veil(NamedTuple):
    """What lies over a box of a picture, in colour times opacity: a sprite's planes at the picture's scale."""

    luma: Plane
    chroma: Plane


@dataclass(frozen=True, eq=False)
class Sprite:
    """A blurred drawing, several samples a pixel, in colour times opacity.

    Attributes
    ----------
    luma : float32 array, shape (h, w, 2)
        Y' times opacity, and opacity.
    chroma : float32 array, shape (h / 2, w / 2, 3)
        Cb and Cr times opacity, and opacity.
    origin : (float, float)
        Column and row of the body's origin in `luma`.
    """

    luma: Plane
    chroma: Plane
    origin: tuple[float, float]

    @cached_property
    def drawings(self) -> tuple[Drawing, Drawing]:
        """Brightness and colour, ready to be read."""
        return make_drawing(self.luma), make_drawing(self.chroma)

    def lay(self, on: Planes, at_px: tuple[float, float], angle_rad: float) -> Box:
        """Lay the drawing over a picture, its origin at `at_px`, turned counter-clockwise as one sees it.

        Returns
        -------
        Box
            What it may have changed: x0, y0, x1, y1, even numbers.
        """
        pose = np.array([[*at_px, angle_rad]])
        box = self.box(pose, on.luma.shape)
        (luma, chroma), part = self.ways_in(box, pose), on.part(box)
        lay_over(part.luma[..., None], self.drawings[0], luma[0])
        lay_over(part.chroma, self.drawings[1], chroma[0])
        return box

    @property
    def reach_px(self) -> float:
        """How far the drawing's corners lie from the body's origin."""
        (rows, columns), (x, y) = self.luma.shape[:2], self.origin
        return float(np.hypot(max(x, columns - x), max(y, rows - y)) / OVERSAMPLE)

    def smeared(self, pose_px: FloatArray, box: Box) -> Veil:
        """Return the mean of what lies over a box in several poses, shape (k, 3): px, px, rad."""
        veil = empty_veil(box)
        for drawing, ways, total in zip(self.drawings, self.ways_in(box, pose_px), veil, strict=True):
            add_warps(drawing, ways, total)
        count = np.float32(len(pose_px))
        return Veil(veil.luma / count, veil.chroma / count)

    def box(self, pose_px: FloatArray, shape: tuple[int, ...]) -> Box:
        """Return the part of a picture of some shape that the drawing may reach in poses of shape (..., 3)."""
        low, high = self.reach(pose_px)
        (x0, y0), (x1, y1) = (
            np.clip([np.floor(low / 2) * 2, np.ceil(high / 2) * 2 + 2], 0, [shape[1], shape[0]]).astype(int).tolist()
        )
        return x0, y0, x1, y1

    def reach(self, pose_px: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the corners, px, of the upright box around all poses, shape (..., 3)."""
        (rows, columns), (column, row) = self.luma.shape[:2], self.origin
        across = np.array([-column, columns - column, -column, columns - column]) / OVERSAMPLE
        down = np.array([-row, -row, rows - row, rows - row]) / OVERSAMPLE
        x, y, angle = pose_px[..., :1], pose_px[..., 1:2], pose_px[..., 2:]
        c, s = np.cos(angle), np.sin(angle)
        seen_x, seen_y = x + c * across + s * down, y - s * across + c * down
        return np.array([seen_x.min(), seen_y.min()]), np.array([seen_x.max(), seen_y.max()])

    def ways(self, pose_px: FloatArray) -> FloatArray:
        """Return the ways from a picture to the brightness in some poses: shape (..., 3) -> (..., 2, 3)."""
        x, y, angle = np.moveaxis(pose_px, -1, 0)
        c, s = OVERSAMPLE * np.cos(angle), OVERSAMPLE * np.sin(angle)
        column, row = self.origin
        found = np.empty((*pose_px.shape[:-1], 2, 3))
        found[..., 0, 0], found[..., 0, 1], found[..., 0, 2] = c, -s, column - c * x + s * y
        found[..., 1, 0], found[..., 1, 1], found[..., 1, 2] = s, c, row - s * x - c * y
        return found

    def ways_in(self, box: Box, pose_px: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the ways from the pixels of a box, and from its colour samples, to brightness and colour."""
        ways = self.ways(pose_px - (box[0], box[1], 0.0))
        # A colour sample covers 2 x 2 pixels: its centre lies half a pixel right and down of the first, and it
        # steps by two pixels in a drawing of half as many samples.
        colour = ways.copy()
        colour[..., 2] = (colour[..., 2] + 0.5 * ways[..., :2].sum(axis=-1) - 0.5) / 2
        return ways, colour


def make_sprite(drawing: Canvas) -> Sprite:
    """Blur a drawing, made with `OVERSAMPLE` samples a pixel, as the optics and the pixels do.

    Reading it adds the rest of the blur.
    """
    brightness = np.dstack([drawing.colour[..., 0], drawing.opacity])
    colour = np.dstack([drawing.colour[..., 1:], drawing.opacity])
    soft = cv2.GaussianBlur(colour, (0, 0), np.sqrt((CHROMA_PX * OVERSAMPLE) ** 2 - 4 * VARIANCE))
    return Sprite(
        luma=np.asarray(cv2.GaussianBlur(brightness, (0, 0), np.sqrt((OPTICS_PX * OVERSAMPLE) ** 2 - VARIANCE))),
        chroma=np.asarray(cv2.resize(soft, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)),
        origin=drawing.origin,
    )


def make_planes(drawing: Canvas) -> Planes:
    """Blur an opaque drawing, made at the picture's own scale, as the optics and the pixels do."""
    blurred = cv2.GaussianBlur(drawing.colour[..., 1:], (0, 0), CHROMA_PX)
    rows, columns = drawing.opacity.shape
    return Planes(
        luma=np.asarray(cv2.GaussianBlur(np.ascontiguousarray(drawing.colour[..., 0]), (0, 0), OPTICS_PX)),
        chroma=np.asarray(cv2.resize(blurred, (columns // 2, rows // 2), interpolation=cv2.INTER_AREA)),
    )


def lay_veil(on: Planes, veil: Veil, box: Box) -> None:
    """Lay a veil over a box of a picture."""
    part = on.part(box)
    cover(part.luma[..., None], veil.luma)
    cover(part.chroma, veil.chroma)


def empty_veil(box: Box) -> Veil:
    """Return a veil of the size of a box that covers nothing."""
    rows, columns = box[3] - box[1], box[2] - box[0]
    return Veil(np.zeros((rows, columns, 2), np.float32), np.zeros((rows // 2, columns // 2, 3), np.float32))

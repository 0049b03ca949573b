"""A rigid body's picture: drawn and blurred once, then laid into each frame by one warp.

Turning and shifting a picture commute with an isotropic blur, so the optics may be applied once, to the
drawing; what each frame shows is then exact at edges and in the texture. The warp is bilinear: OpenCV's
cubic kernel (a = -3/4) does not reproduce a straight ramp and pulls edges by up to 0.05 sample, while
the bilinear one has no such bias, and on a drawing that is blurred over several samples it costs no
sharpness that one could measure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from vml_course.model.arrays import FloatArray
from vml_course.synth.canvas import Canvas
from vml_course.synth.overlay import cover, lay_over
from vml_course.synth.smear import add_warps
from vml_course.synth.texture import Plane

OVERSAMPLE = 4
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

    def lay(self, on: Planes, at_px: tuple[float, float], angle_rad: float) -> Box:
        """Lay the drawing over a picture, its origin at `at_px`, turned counter-clockwise as one sees it.

        Returns
        -------
        Box
            What it may have changed: x0, y0, x1, y1, even numbers.
        """
        box = self.box(at_px, angle_rad, on.luma.shape)
        (luma, chroma), part = self._from_box(at_px, angle_rad, box), on.part(box)
        lay_over(part.luma[..., None], self.luma, luma)
        if part.chroma.size:
            size = part.chroma.shape[1], part.chroma.shape[0]
            seen = cv2.warpAffine(self.chroma, chroma, size, flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)
            cover(part.chroma, np.asarray(seen))
        return box

    @property
    def reach_px(self) -> float:
        """How far the drawing's corners lie from the body's origin."""
        (rows, columns), (x, y) = self.luma.shape[:2], self.origin
        return float(np.hypot(max(x, columns - x), max(y, rows - y)) / OVERSAMPLE)

    def smeared(self, pose_px: FloatArray, box: Box) -> Veil:
        """Return the mean of what lies over a box in several poses, shape (k, 3): px, px, rad."""
        x0, y0, x1, y1 = box
        matrices = np.array([self._from_box((x, y), turn, box) for x, y, turn in pose_px])
        veil = Veil(
            np.zeros((y1 - y0, x1 - x0, 2), np.float32), np.zeros(((y1 - y0) // 2, (x1 - x0) // 2, 3), np.float32)
        )
        for drawing, which, total in zip((self.luma, self.chroma), (0, 1), veil, strict=True):
            add_warps(drawing, np.ascontiguousarray(matrices[:, which]), total)
        count = np.float32(len(pose_px))
        return Veil(veil.luma / count, veil.chroma / count)

    def box(self, at_px: tuple[float, float], angle_rad: float, shape: tuple[int, ...]) -> Box:
        """Return the part of a picture of some shape that the drawing may reach."""
        matrix = self._from_picture(at_px, angle_rad)
        rows, columns = self.luma.shape[:2]
        corners = np.array([[0, 0], [columns, 0], [0, rows], [columns, rows]], dtype=np.float64)
        seen = np.linalg.solve(matrix[:, :2], (corners - matrix[:, 2]).T).T
        low = np.floor(seen.min(axis=0) / 2).astype(int) * 2
        high = np.ceil(seen.max(axis=0) / 2).astype(int) * 2 + 2
        (x0, y0), (x1, y1) = np.clip([low, high], 0, [shape[1], shape[0]]).tolist()
        return x0, y0, x1, y1

    def _from_box(
        self, at_px: tuple[float, float], angle_rad: float, box: Box
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the ways from a box of the picture to the drawing, for brightness and for colour."""
        matrix = self._from_picture(at_px, angle_rad)
        # A colour sample covers 2 x 2 pixels: its centre lies half a pixel right and down of the first.
        return _shifted(matrix, box[0], box[1]), _halved(_shifted(matrix, box[0] + 0.5, box[1] + 0.5))

    def _from_picture(self, at_px: tuple[float, float], angle_rad: float) -> NDArray[np.float64]:
        c, s = OVERSAMPLE * np.cos(angle_rad), OVERSAMPLE * np.sin(angle_rad)
        turn = np.array([[c, -s], [s, c]])
        return np.column_stack([turn, np.array(self.origin) - turn @ np.array(at_px)])


def make_sprite(drawing: Canvas) -> Sprite:
    """Blur a drawing, made with `OVERSAMPLE` samples a pixel, as the optics and the pixels do."""
    brightness = np.dstack([drawing.colour[..., 0], drawing.opacity])
    colour = np.dstack([drawing.colour[..., 1:], drawing.opacity])
    half = cv2.resize(
        cv2.GaussianBlur(colour, (0, 0), CHROMA_PX * OVERSAMPLE), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA
    )
    return Sprite(
        luma=np.asarray(cv2.GaussianBlur(brightness, (0, 0), OPTICS_PX * OVERSAMPLE)),
        chroma=np.asarray(half),
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


def _shifted(matrix: NDArray[np.float64], x: float, y: float) -> NDArray[np.float64]:
    return np.column_stack([matrix[:, :2], matrix @ np.array([x, y, 1.0])])


def _halved(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Step by two pixels in a drawing of half as many samples: the steps stay, the offset is halved."""
    return np.column_stack([matrix[:, :2], (matrix[:, 2] - 0.5) / 2])

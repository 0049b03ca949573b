"""A sheet to draw on, in metres: planes of Y'CbCr colour with an opacity, edges exact to a fraction of a sample.

Everything is drawn in the planes that a video holds (full range, BT.601 weights). The way from RGB to them
is linear but for a constant, so laying one picture over another gives the same in both, and nothing has to
be converted frame by frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.model.camera import Camera
from vml_course.synth.texture import Plane

Colour = tuple[float, float, float]
_TO_YCBCR = np.array(
    [[0.299, 0.587, 0.114], [-0.168736, -0.331264, 0.5], [0.5, -0.418688, -0.081312]], dtype=np.float64
)


def ycbcr(rgb: Colour) -> Colour:
    """Convert a colour, 0 to 255, to full-range Y'CbCr.

    >>> tuple(round(part, 6) for part in ycbcr((255, 255, 255)))
    (255.0, 128.0, 128.0)
    """
    y, cb, cr = _TO_YCBCR @ np.array(rgb, dtype=np.float64)
    return float(y), float(cb + 128), float(cr + 128)


@dataclass(frozen=True, eq=False)
class Canvas:
    """A drawing and its own axes (metres, y up).

    Attributes
    ----------
    colour : float32 array, shape (h, w, 3)
        Y'CbCr times opacity.
    opacity : float32 array, shape (h, w)
    x_m, y_m : float32 array, shape (1, w) and (h, 1)
        Coordinates of the samples' centres.
    samples_per_m : float
    origin : (float, float)
        Column and row of the point (0, 0); the centre of the top-left sample is (0, 0).
    """

    colour: Plane
    opacity: Plane
    x_m: Plane
    y_m: Plane
    samples_per_m: float
    origin: tuple[float, float]

    def fill(self, distance_m: Plane, rgb: Colour, opacity: float = 1.0) -> None:
        """Paint where the signed distance is negative; an edge covers a sample in proportion."""
        cover = opacity * np.clip(0.5 - distance_m * self.samples_per_m, 0.0, 1.0)
        rows, columns = (np.flatnonzero(cover.any(axis=axis)) for axis in (1, 0))
        if not len(rows):
            return
        where = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        part, paint = cover[where], np.array(ycbcr(rgb), dtype=np.float32)
        self.opacity[where] += part * (1.0 - self.opacity[where])
        for plane in range(3):
            self.colour[(*where, plane)] += part * (paint[plane] - self.colour[(*where, plane)])

    def near(self, low_m: tuple[float, float], high_m: tuple[float, float]) -> Canvas:
        """Return the part of this canvas between two corners, to draw small things quickly; it shares its samples."""
        rows, columns = self.opacity.shape
        x0, x1 = np.clip([self._column(low_m[0]) - 2, self._column(high_m[0]) + 3], 0, columns)
        y0, y1 = np.clip([self._row(high_m[1]) - 2, self._row(low_m[1]) + 3], 0, rows)
        return Canvas(
            self.colour[y0:y1, x0:x1],
            self.opacity[y0:y1, x0:x1],
            self.x_m[:, x0:x1],
            self.y_m[y0:y1],
            self.samples_per_m,
            (self.origin[0] - float(x0), self.origin[1] - float(y0)),
        )

    def _column(self, x_m: float) -> int:
        return round(self.origin[0] + x_m * self.samples_per_m)

    def _row(self, y_m: float) -> int:
        return round(self.origin[1] - y_m * self.samples_per_m)

    def lighten(self, change: Plane, inside_m: Plane | None = None) -> None:
        """Add grey levels to the brightness, where the signed distance is negative."""
        if inside_m is not None:
            change = change * np.clip(0.5 - inside_m * self.samples_per_m, 0.0, 1.0)
        self.colour[..., 0] += change * self.opacity


def make_canvas(shape: tuple[int, int], samples_per_m: float, origin: tuple[float, float]) -> Canvas:
    """Return an empty canvas of some rows and columns whose point (0, 0) lies at column and row `origin`."""
    rows, columns = shape
    return Canvas(
        colour=np.zeros((rows, columns, 3), np.float32),
        opacity=np.zeros((rows, columns), np.float32),
        x_m=((np.arange(columns) - origin[0]) / samples_per_m).astype(np.float32)[None, :],
        y_m=((origin[1] - np.arange(rows)) / samples_per_m).astype(np.float32)[:, None],
        samples_per_m=samples_per_m,
        origin=origin,
    )


def camera_canvas(camera: Camera) -> Canvas:
    """Return an empty canvas as large as a camera's picture, at its scale, as a square camera sees it."""
    width, height = camera.size_px
    return make_canvas((height, width), camera.px_per_m, (camera.origin_x_px, camera.origin_y_px))


def sheet(reach_m: tuple[float, float, float, float], px_per_m: float, oversample: int) -> Canvas:
    """Return an empty canvas that reaches from the origin to left, right, down and up, with a margin of 4 px.

    Its sizes are even, so that it can be halved exactly.
    """
    left, right, down, up = (2 * round((reach * px_per_m + 4.0) * oversample / 2) for reach in reach_m)
    return make_canvas((down + up, left + right), px_per_m * oversample, (float(left), float(up)))

"""What each pixel looks at when the camera is turned, tilted or bent by its lens.

Everything is drawn for a square camera. A pixel of the real one looks at a place of that square picture
(`Camera.square_px`), and there the drawing is read, once: nothing is resampled twice, and what the truth says
of a point holds for the picture by construction. The optics' blur is bent along, which moves no centre.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, cast

import numpy as np
from scipy.ndimage import map_coordinates

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.synth.sprite import Box, Planes
from vml_course.synth.texture import Plane

SPLINE: Final = 5  # order; the still picture is not oversampled, and a lower one would blur it
MARGIN_PX = 16
EDGE_POINTS = 24


@dataclass(frozen=True)
class Board(Camera):
    """A square view that is large enough for all that a camera sees: no real camera, so held to no range."""

    def __post_init__(self) -> None:
        """Accept any size."""


@dataclass(frozen=True, eq=False)
class Sight:
    """Where a camera looks."""

    camera: Camera

    @cached_property
    def places(self) -> FloatArray:
        """What each pixel looks at, px of a square camera: shape (h, w, 2)."""
        return self.places_in((0, 0, *self.camera.size_px))

    def places_in(self, box: Box, offset_px: FloatArray | None = None) -> FloatArray:
        """Return what the pixels of a box look at while the picture is shifted: shape (rows, columns, 2).

        Parameters
        ----------
        box : Box
        offset_px : float array, shape (h, 2) or (1, 2), optional
            How far the rows of the whole picture are shifted.
        """
        x0, y0, x1, y1 = box
        if offset_px is None and "places" in self.__dict__:
            return self.places[y0:y1, x0:x1]
        seen = np.stack(np.meshgrid(np.arange(x0, x1), np.arange(y0, y1)), axis=-1).astype(np.float64)
        if offset_px is not None:
            seen -= (offset_px if len(offset_px) == 1 else offset_px[y0:y1])[:, None]
        return self.camera.square_px(seen)

    def box(self, low_px: FloatArray, high_px: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the corners of what is seen of an upright box of the square picture, not clipped."""
        way = np.linspace(0.0, 1.0, EDGE_POINTS)
        sides = [np.stack([way, np.full_like(way, end)], axis=-1) for end in (0.0, 1.0)]
        edge = np.concatenate([*sides, *(side[:, ::-1] for side in sides)])
        seen = self.camera.seen_px(low_px + edge * (high_px - low_px))
        return seen.min(axis=0) - 2.0, seen.max(axis=0) + 2.0

    @cached_property
    def board(self) -> Camera:
        """The camera to draw for: this one when it is square, else one that sees all that this one does."""
        if self.camera.is_square:
            return self.camera
        low, high = self._reach
        width, height = (high - low).tolist()
        plain = {name: getattr(self.camera, name) for name in ("fps", "px_per_m")}
        x, y = self.camera.origin_x_px - low[0], self.camera.origin_y_px - low[1]
        return Board(width_px=width, height_px=height, origin_x_px=x, origin_y_px=y, **plain)

    @cached_property
    def _reach(self) -> FloatArray:
        """Corners of the board in the square picture, even numbers: shape (2, 2)."""
        flat = self.places.reshape(-1, 2)
        low, high = flat.min(axis=0) - MARGIN_PX, flat.max(axis=0) + MARGIN_PX
        return np.asarray(np.stack([np.floor(low / 2) * 2, np.ceil(high / 2) * 2]))

    def still(self, board: Planes) -> Planes:
        """Return the camera's picture of what was drawn on its board."""
        if self.camera.is_square:
            return board
        places = self.places - self._reach[0]
        halves = (in_halves(places) - 0.5) / 2
        blue, red = (_read(board.chroma[..., k], halves) for k in (0, 1))
        return Planes(_read(board.luma, places), np.ascontiguousarray(np.dstack([blue, red])))


def in_halves(places: FloatArray) -> FloatArray:
    """Return what the colour samples look at, each in the middle of four pixels: (h, w, ...) -> (h / 2, w / 2, ...)."""
    return np.asarray((places[::2, ::2] + places[1::2, ::2] + places[::2, 1::2] + places[1::2, 1::2]) / 4)


def _read(plane: Plane, places: FloatArray) -> Plane:
    rows_columns = np.moveaxis(places[..., ::-1], -1, 0)
    seen = map_coordinates(plane.astype(np.float64), rows_columns, order=SPLINE, mode="mirror")
    return cast(Plane, seen.astype(np.float32))

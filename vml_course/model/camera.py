"""Where the camera stands and how fast it looks: from metres (y up) to pixels (y down)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray
from vml_course.model.lens import bent, straightened
from vml_course.model.quantity import check_quantities, quantity


@dataclass(frozen=True)
class Camera:
    """A camera that looks squarely at the plane of motion, or by its last fields nearly so.

    Pixel convention everywhere in this project: the *centre* of the top-left pixel is (0, 0), x to the
    right, y down. `origin_x_px`, `origin_y_px` say where the world's origin is seen by a square camera.

    The square picture is turned and tilted about its middle, so that the scale there stays `px_per_m`
    (across the tilt), and then bent by the lens. `to_px` and `to_m` are the whole way, exact both ways.
    """

    fps: float = quantity(480.0, "1/s", 24.0, 2000.0, about="frames per second")
    width_px: float = quantity(1280, "px", 64, 1920, about="width of the picture", whole=True)
    height_px: float = quantity(720, "px", 64, 1080, about="height of the picture", whole=True)
    px_per_m: float = quantity(500.0, "px/m", 50.0, 5000.0, about="scale of the picture")
    origin_x_px: float = quantity(420.0, "px", -4000.0, 8000.0, about="where the world's origin is seen")
    origin_y_px: float = quantity(200.0, "px", -4000.0, 8000.0, about="where the world's origin is seen")
    shutter: float = quantity(0.0, "", 0.0, 1.0, about="exposure as a part of the frame interval; 0 is a flash")
    rolling_shutter: float = quantity(
        0.0, "", 0.0, 1.0, about="part of the frame interval by which the last row is exposed after the first"
    )
    shake_px: float = quantity(0.0, "px", 0.0, 10.0, about="how far a hand lets the picture wander")
    roll_deg: float = quantity(0.0, "deg", -30.0, 30.0, about="turn of the picture, counter-clockwise")
    pan_deg: float = quantity(0.0, "deg", -15.0, 15.0, about="how far the plane's right side leans away")
    tilt_deg: float = quantity(0.0, "deg", -15.0, 15.0, about="how far the plane's upper side leans away")
    distance_m: float = quantity(4.0, "m", 2.0, 100.0, about="how far away a camera stands that is panned or tilted")
    distortion: float = quantity(
        0.0, "", -0.12, 0.2, symbol="k1", about="radial distortion in the corners: below 0 barrel, above pincushion"
    )

    def __post_init__(self) -> None:
        check_quantities(self)
        for name in ("width_px", "height_px"):
            if getattr(self, name) % 2:
                raise InputError(name, "an even number of pixels (video halves the colour planes)", getattr(self, name))

    @property
    def exposure_s(self) -> float:
        """How long the shutter is open; a frame's time is the middle of it."""
        return self.shutter / self.fps

    def row_delay_s(self, y_px: FloatArray | float) -> FloatArray | float:
        """How much later a row is exposed than the middle of the picture, whose time is the frame's."""
        rows = float(self.height_px)
        return self.rolling_shutter / self.fps * (y_px - (rows - 1) / 2) / rows

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height as whole numbers."""
        return int(self.width_px), int(self.height_px)

    @property
    def is_square(self) -> bool:
        """Whether nothing is turned, tilted or bent: then the picture is the plane at one scale."""
        return not (self.roll_deg or self.pan_deg or self.tilt_deg or self.distortion)

    def to_px(self, xy_m: FloatArray) -> FloatArray:
        """Map world points to the picture: array, shape (..., 2), metres, y up -> pixels, y down."""
        return self.seen_px(self.to_square_px(xy_m))

    def to_square_px(self, xy_m: FloatArray) -> FloatArray:
        """Map world points to the picture that this camera would see if nothing were turned, tilted or bent."""
        xy = np.asarray(xy_m, dtype=np.float64)
        origin = np.array([self.origin_x_px, self.origin_y_px])
        return np.asarray(origin + xy * np.array([self.px_per_m, -self.px_per_m]))

    def to_m(self, xy_px: FloatArray) -> FloatArray:
        """Map picture points to the world: array, shape (..., 2), pixels, y down -> metres, y up."""
        xy = self.square_px(np.asarray(xy_px, dtype=np.float64)) - np.array([self.origin_x_px, self.origin_y_px])
        return np.asarray(xy / np.array([self.px_per_m, -self.px_per_m]))

    @property
    def longest_stretch(self) -> float:
        """By how much the lens lengthens a way at most, which is outwards in a corner."""
        return 1.0 + 3.0 * max(0.0, self.distortion)

    def seen_px(self, square_px: FloatArray) -> FloatArray:
        """Map the pixels of a square camera to those of this one: array, shape (..., 2)."""
        if self.is_square:
            return square_px
        tilted = _through(self._tilt, (square_px - self._middle) / self._half_diagonal)
        return bent(tilted, self.distortion) * self._half_diagonal + self._middle

    def square_px(self, seen_px: FloatArray) -> FloatArray:
        """Map this camera's pixels to those of a square one: array, shape (..., 2)."""
        if self.is_square:
            return seen_px
        tilted = straightened((seen_px - self._middle) / self._half_diagonal, self.distortion)
        return _through(np.asarray(np.linalg.inv(self._tilt), np.float64), tilted) * self._half_diagonal + self._middle

    @property
    def _middle(self) -> FloatArray:
        return (np.array(self.size_px) - 1.0) / 2

    @property
    def _half_diagonal(self) -> float:
        return float(np.hypot(*self._middle))

    @property
    def _tilt(self) -> FloatArray:
        """The perspective from the square picture to the turned and tilted one, about the middle, in half diagonals."""
        roll, pan, tilt = np.radians([self.roll_deg, self.pan_deg, self.tilt_deg])
        turn = np.array([[np.cos(roll), np.sin(roll), 0], [-np.sin(roll), np.cos(roll), 0], [0, 0, 1]])
        # What lies to the right and below in the plane, seen from one unit of distance in front of its middle.
        plane = np.array(
            [
                [np.cos(pan), 0, 0],
                [np.sin(pan) * np.sin(tilt), np.cos(tilt), 0],
                [np.sin(pan) * np.cos(tilt), -np.sin(tilt), 1],
            ]
        )
        far = self.px_per_m * self.distance_m / self._half_diagonal
        return np.asarray(np.diag([far, far, 1]) @ turn @ plane @ np.diag([1 / far, 1 / far, 1]))


def _through(perspective: FloatArray, xy: FloatArray) -> FloatArray:
    """Map points by a perspective, shape (3, 3)."""
    seen = xy @ perspective[:, :2].T + perspective[:, 2]
    return np.asarray(seen[..., :2] / seen[..., 2:])

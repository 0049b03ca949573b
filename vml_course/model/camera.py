"""Where the camera stands and how fast it looks: from metres (y up) to pixels (y down)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray
from vml_course.model.quantity import check_quantities, quantity


@dataclass(frozen=True)
class Camera:
    """An ideal camera that looks squarely at the plane of motion.

    Pixel convention everywhere in this project: the *centre* of the top-left pixel is (0, 0), x to the
    right, y down. `origin_x_px`, `origin_y_px` say where the world's origin is seen.
    """

    fps: float = quantity(480.0, "1/s", 24.0, 2000.0, about="frames per second")
    width_px: float = quantity(1280, "px", 64, 1920, about="width of the picture", whole=True)
    height_px: float = quantity(720, "px", 64, 1088, about="height of the picture", whole=True)
    px_per_m: float = quantity(500.0, "px/m", 50.0, 5000.0, about="scale of the picture")
    origin_x_px: float = quantity(420.0, "px", -4000.0, 8000.0, about="where the world's origin is seen")
    origin_y_px: float = quantity(200.0, "px", -4000.0, 8000.0, about="where the world's origin is seen")
    shutter: float = quantity(0.0, "", 0.0, 1.0, about="exposure as a part of the frame interval; 0 is a flash")
    shake_px: float = quantity(0.0, "px", 0.0, 10.0, about="how far a hand lets the picture wander")

    def __post_init__(self) -> None:
        check_quantities(self)
        for name in ("width_px", "height_px"):
            if getattr(self, name) % 2:
                raise InputError(name, "an even number of pixels (video halves the colour planes)", getattr(self, name))

    @property
    def exposure_s(self) -> float:
        """How long the shutter is open; a frame's time is the middle of it."""
        return self.shutter / self.fps

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height as whole numbers."""
        return int(self.width_px), int(self.height_px)

    def to_px(self, xy_m: FloatArray) -> FloatArray:
        """Map world points to the picture: array, shape (..., 2), metres, y up -> pixels, y down."""
        xy = np.asarray(xy_m, dtype=np.float64)
        origin = np.array([self.origin_x_px, self.origin_y_px])
        return np.asarray(origin + xy * np.array([self.px_per_m, -self.px_per_m]))

    def to_m(self, xy_px: FloatArray) -> FloatArray:
        """Map picture points to the world: array, shape (..., 2), pixels, y down -> metres, y up."""
        xy = np.asarray(xy_px, dtype=np.float64) - np.array([self.origin_x_px, self.origin_y_px])
        return np.asarray(xy / np.array([self.px_per_m, -self.px_per_m]))

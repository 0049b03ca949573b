"""How a rendered clip is stored: container, codec, noise."""

from __future__ import annotations

from dataclasses import dataclass

from vml_course.errors import UnknownNameError
from vml_course.model.quantity import check_quantities, quantity

FORMATS = ("mp4", "avi")


@dataclass(frozen=True)
class Recording:
    """Sensor noise and compression. `mp4` is H.264, `avi` is MJPEG."""

    format: str = "mp4"
    crf: float = quantity(18, "", 0, 40, about="H.264 constant rate factor; smaller is better", whole=True)
    noise_grey: float = quantity(1.0, "grey levels", 0.0, 20.0, about="standard deviation of the sensor's noise")

    def __post_init__(self) -> None:
        if self.format not in FORMATS:
            raise UnknownNameError("format", self.format, FORMATS)
        check_quantities(self)

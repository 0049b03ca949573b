"""How a rendered clip is lit and stored: light, noise, container, codec."""

from __future__ import annotations

from dataclasses import dataclass

from vml_course.errors import UnknownNameError
from vml_course.model.quantity import check_quantities, quantity

FORMATS = ("mp4", "avi")


@dataclass(frozen=True)
class Recording:
    """Light, sensor noise and compression; all but a little noise is off. `mp4` is H.264, `avi` is MJPEG."""

    format: str = "mp4"
    crf: float = quantity(18, "", 0, 40, about="H.264 constant rate factor; smaller is better", whole=True)
    noise_grey: float = quantity(1.0, "grey levels", 0.0, 20.0, about="standard deviation of the sensor's noise")
    shot_noise_grey: float = quantity(
        0.0, "grey levels", 0.0, 20.0, about="standard deviation of the light's own noise at white, by the root of it"
    )
    contrast: float = quantity(1.0, "", 0.05, 1.0, about="contrast about mid grey; 1 is as drawn")
    brightness_drift: float = quantity(0.0, "", -0.5, 0.5, about="relative change of the light over the clip")
    flicker: float = quantity(0.0, "", 0.0, 0.5, about="relative amplitude of the lamps' flicker")
    flicker_hz: float = quantity(100.0, "1/s", 50.0, 480.0, about="frequency of the lamps' flicker")
    vignetting: float = quantity(0.0, "", 0.0, 0.8, about="part of the light that is missing in the corners")
    file_fps: float = quantity(
        0.0, "1/s", 0.0, 1000.0, about="rate that the file claims, as slow-motion phones do; 0 is the camera's"
    )

    def __post_init__(self) -> None:
        if self.format not in FORMATS:
            raise UnknownNameError("format", self.format, FORMATS)
        check_quantities(self)

"""How a rendered clip is lit and stored: light, noise, container, codec."""

from __future__ import annotations

from dataclasses import dataclass

from vml_course.errors import InputError
from vml_course.model.choice import check_choices, choice
from vml_course.model.quantity import check_quantities, quantity

CODECS = {"mp4": ("h264", "hevc", "vp9"), "avi": ("mjpeg", "ffv1")}  # of each format, its usual one first
FORMATS = tuple(CODECS)
USUAL = "usual"


@dataclass(frozen=True)
class Recording:
    """Light, sensor noise and compression; all but a little noise is off."""

    format: str = choice("mp4", FORMATS, about="kind of file; usually mp4 holds H.264, avi MJPEG")
    codec: str = choice(
        USUAL, (USUAL, *(codec for codecs in CODECS.values() for codec in codecs)), about="how pictures are compressed"
    )
    crf: float = quantity(
        18, "", 0, 51, about="constant rate factor; smaller is better, ffv1 loses nothing", whole=True
    )
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
        check_choices(self)
        check_quantities(self)
        if self.codec not in (USUAL, *CODECS[self.format]):
            fitting = next(name for name, codecs in CODECS.items() if self.codec in codecs)
            expected = f"one of {', '.join(CODECS[self.format])} in {self.format}"
            raise InputError("codec", expected, self.codec, f"Or set format={fitting}.")

    @property
    def stored_codec(self) -> str:
        """The codec's own name, also where the usual one was asked for."""
        return CODECS[self.format][0] if self.codec == USUAL else self.codec

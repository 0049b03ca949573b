"""How bright the picture is at any time and place: drift, flicker of lamps, dark corners, contrast.

A gain g of the light makes g times Y' and moves the colour differences in proportion about 128, their grey.
"""

from __future__ import annotations

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.recording import Recording
from vml_course.synth.texture import Plane

GREY = 128.0


def light_at(recording: Recording, time_s: FloatArray, last_s: float, exposure_s: float) -> FloatArray:
    """Return the relative brightness at some times; 1 in a clip without drift and flicker.

    Parameters
    ----------
    recording : Recording
    time_s : float array
        Middles of exposures.
    last_s : float
        Time of the last frame, at which the drift is complete.
    exposure_s : float
        An open shutter evens the flicker out: the mean of a cosine over it is sin(x) / x of it.
    """
    drift = 1.0 + recording.brightness_drift * time_s / last_s
    evened = recording.flicker * np.sinc(recording.flicker_hz * exposure_s)
    return np.asarray(drift * (1.0 + evened * np.cos(2 * np.pi * recording.flicker_hz * time_s)))


def dark_corners(vignetting: float, shape: tuple[int, int]) -> Plane:
    """Return 1 in the middle of the picture, less by `vignetting` in its corners, and by the square between."""
    rows, columns = shape
    y, x = (np.linspace(-1.0, 1.0, count) for count in (rows, columns))
    across, along = (x * (columns - 1)) ** 2, (y * (rows - 1)) ** 2
    radius = (along[:, None] + across) / ((columns - 1) ** 2 + (rows - 1) ** 2)
    return np.asarray(1.0 - vignetting * radius, dtype=np.float32)


def as_lit(drawn: Plane, light: float | Plane, contrast: float, black: float) -> Plane:
    """Return a plane under some light and with some contrast about mid grey; `black` is 0 or, of colour, 128."""
    return np.asarray(black + light * (GREY - black + contrast * (drawn - GREY)), dtype=np.float32)

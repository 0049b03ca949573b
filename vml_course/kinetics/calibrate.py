"""From two clicked points of known distance to a calibration."""

from __future__ import annotations

import math
from collections.abc import Sequence

from vml_course.errors import InputError
from vml_course.model.motion import Calibration

SHORTEST_STICK_PX = 20.0


def calibrate(
    stick_px: Sequence[float],
    length_m: float,
    *,
    origin_px: tuple[float, float] | None = None,
    axis_angle_rad: float = 0.0,
    length_text: str = "",
) -> Calibration:
    """Return the calibration that a stick of known length gives.

    Parameters
    ----------
    stick_px : (x1, y1, x2, y2)
        Both ends in pixels, y down.
    length_m : float
        Their true distance in metres.
    origin_px : (float, float), optional
        Where the world's origin is seen; the stick's first end when not given.
    axis_angle_rad : float
        Angle of the x axis from the picture's horizontal, counter-clockwise as one sees it.
    length_text : str
        What was typed, such as "22 cm"; kept for the record.

    Raises
    ------
    InputError
        When a number is not finite, the length is not positive, or the ends are closer than 20 px
        (a click is good to about one pixel, so the scale would be worse than 5 %).

    >>> calibrate((100, 400, 210, 400), 0.22, length_text="22 cm").px_per_m
    500.0
    """
    numbers = (*stick_px, length_m, axis_angle_rad, *(origin_px or ()))
    if len(stick_px) != 4 or not all(map(math.isfinite, numbers)):
        raise InputError("scale", "two points x1, y1, x2, y2 and a length, all finite", numbers)
    if length_m <= 0:
        raise InputError("scale", "a length of more than 0 m", f"{length_text or length_m}")
    x1, y1, x2, y2 = map(float, stick_px)
    distance_px = math.hypot(x2 - x1, y2 - y1)
    if distance_px < SHORTEST_STICK_PX:
        hint = "Zoom in or use a longer object."
        raise InputError("scale", f"ends at least {SHORTEST_STICK_PX:g} px apart", f"{distance_px:.1f} px", hint)
    return Calibration(
        px_per_m=distance_px / length_m,
        origin_px=origin_px or (x1, y1),
        axis_angle_rad=axis_angle_rad,
        stick_px=(x1, y1, x2, y2),
        length_m=length_m,
        length_text=length_text,
    )


def relative_scale_sd(stick_px: Sequence[float], click_sd_px: float = 1.0) -> float:
    """Return the relative uncertainty of a scale from the repeatability of a click.

    Every velocity carries the same share. Of the four clicked coordinates only the two along the stick
    count, hence the square root of 2.

    Parameters
    ----------
    stick_px : (x1, y1, x2, y2)
    click_sd_px : float
        One standard deviation of one clicked coordinate.

    >>> round(relative_scale_sd((0, 0, 96.4, 0)), 4)
    0.0147
    """
    x1, y1, x2, y2 = stick_px
    return math.sqrt(2.0) * click_sd_px / math.hypot(x2 - x1, y2 - y1)

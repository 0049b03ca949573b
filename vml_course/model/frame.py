"""One picture of a video: its number, its time, its luma plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Luma = NDArray[np.uint8]


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """A decoded picture; `luma` is the plane as the file holds it, without colour conversion.

    Attributes
    ----------
    index : int
        Number of the picture in the source file, in the order of presentation, from 0.
    time_s : float
        Its own time stamp in the file, in seconds.
    luma : uint8 array, shape (height, width)
    """

    index: int
    time_s: float
    luma: Luma


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """A picture in the planes that encoders want: full-range (0 to 255) Y'CbCr, 4:2:0.

    Attributes
    ----------
    luma : uint8 array, shape (height, width)
    blue, red : uint8 array, shape (height / 2, width / 2)
        Colour differences Cb and Cr; 128 is grey.
    """

    luma: Luma
    blue: Luma
    red: Luma


@dataclass(frozen=True, slots=True)
class VideoInfo:
    """What a video file is; counts are decoded facts, not header claims.

    Attributes
    ----------
    frame_count : int
        Pictures that can really be shown.
    fps : float
        Pictures per second by the file's time stamps (mean, when the rate varies).
    is_variable_rate : bool
        Whether the time stamps are unevenly spaced beyond the container's rounding.
    codec, container : str
    pixel_aspect : float
        Width of a pixel by its height: 1 but in some camcorders' files (HDV: 1.333).
    damage : str
        What is wrong with the file though it can be read in part; "" when nothing is.
    """

    width_px: int
    height_px: int
    frame_count: int
    fps: float
    is_variable_rate: bool
    codec: str
    container: str
    damage: str = ""
    pixel_aspect: float = 1.0

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of a picture, as arrays have them."""
        return self.height_px, self.width_px

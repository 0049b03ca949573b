"""A tracked clip with all that is known about it: what the exports write."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from vml_course.model.frame import VideoInfo
from vml_course.model.motion import Calibration, Motion, VectorSeries
from vml_course.model.track import Track


@dataclass(frozen=True, eq=False)
class Tracked:
    """One measured clip.

    Attributes
    ----------
    track : Track
        In pixels; frames numbered as in the source video.
    info : VideoInfo
        Of the file that was read.
    calibration, motion : Calibration and Motion, or None
        None when no scale was given.
    vectors : tuple of VectorSeries
        Lengths in metres with a calibration, in pixels without.
    fps : float
        Frames per second when recorded, as used for the times.
    video : str
        File name of the source, without its folder.
    sha256 : str
        Fingerprint of the file that was read.
    time_base : str
        Where the times come from, in words.
    scale_relative_sd : float or None
        One standard deviation of the scale from the repeatability of a click, as a share.
    warnings : tuple of str
        What a person should know: variable rate, damage, lost points.
    path : Path or None
        The file that was read.
    first_picture, picture_step : int
        Row k of the track is picture `first_picture + k * picture_step` of that file. (A clip's frames
        carry the numbers of the video that it was cut from, so `track.frame` may differ.)
    """

    track: Track
    info: VideoInfo
    calibration: Calibration | None
    motion: Motion | None
    vectors: tuple[VectorSeries, ...]
    fps: float
    video: str = ""
    sha256: str = ""
    time_base: str = ""
    scale_relative_sd: float | None = None
    warnings: tuple[str, ...] = ()
    path: Path | None = None
    first_picture: int = 0
    picture_step: int = 1

"""The list of a file's pictures, in the order of presentation.

It comes from demuxing, never from the header: headers count pictures that an edit list hides, or say
nothing. Files store pictures in decoding order, so their time stamps are sorted.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import av
import numpy as np
from av.container import InputContainer
from av.video.stream import VideoStream

from vml_course.errors import VideoError
from vml_course.io.container import EXPECTED, open_video, pictures_of
from vml_course.io.planes import upright_shape
from vml_course.io.timing import rate_of
from vml_course.model.arrays import IntArray
from vml_course.model.frame import VideoInfo

# Only in these does a seek land where the stamps say; elsewhere we decode from the start.
SEEKABLE = ("mp4", "matroska", "avi")
LONGEST_REORDERING = 16  # pictures, the most that H.264 and HEVC allow
CUT_OFF, WOUNDED = "the file ends early", "pictures inside the file are damaged and left out"


@dataclass(frozen=True, eq=False, slots=True)
class PictureIndex:
    """Every picture of a file.

    Attributes
    ----------
    path : Path
    pts : int array, shape (n,)
        Time stamps in units of `time_base`, rising; where the file has none, the pictures' numbers.
    keys : int array, shape (k,)
        Numbers of the pictures at which decoding can start.
    time_base : Fraction
    may_seek : bool
        Whether a stamp names one picture and a seek can find it.
    rate : Fraction
        Pictures per second, not rounded; the mean when it varies; 0 when nothing tells it.
    info : VideoInfo
    files : tuple of Path
        Where each picture is a file of its own: these, in order.
    """

    path: Path
    pts: IntArray
    keys: IntArray
    time_base: Fraction
    may_seek: bool
    rate: Fraction
    info: VideoInfo
    files: tuple[Path, ...] = ()

    def time_s(self, number: int) -> float:
        """Return the time stamp of a picture in seconds."""
        return float(int(self.pts[number]) * self.time_base)


def index_video(path: Path) -> PictureIndex:
    """List the pictures of a video.

    Raises
    ------
    FileMissingError
    VideoError
        When the file is empty, cut off before its index, no video, or has no picture that can be decoded.
    """
    with open_video(path) as (container, stream):
        codec, kind = stream.codec_context.name, container.format.name
        declared, headline = stream.average_rate, stream.frames
        aspect = float(stream.sample_aspect_ratio or 1)
        stamps, keys, time_base, damage = _demux(container, stream)
    shape, first_pts = _first_picture(path)
    stamps = stamps[np.searchsorted(stamps, first_pts) :]
    if damage:
        stamps = stamps[: _unbroken(stamps)]
    may_seek = _may_seek(kind, stamps, keys)
    if not may_seek:
        stamps, time_base, damage = _decode_stamps(path, time_base, declared, damage)
    rate, is_variable = rate_of(stamps, time_base, declared)
    if damage and headline > len(stamps):
        damage += f": {len(stamps)} of {headline} frames are there"
    info = VideoInfo(shape[1], shape[0], len(stamps), float(rate), is_variable, codec, kind, damage, aspect)
    return PictureIndex(path, stamps, np.searchsorted(stamps, keys), time_base, may_seek, rate, info)


def _demux(container: InputContainer, stream: VideoStream) -> tuple[IntArray, IntArray, Fraction, str]:
    """Return sorted stamps of all pictures (empty when they are missing or doubled), of key pictures, and damage."""
    stamps: list[int | None] = []
    keys: list[int] = []
    damage = ""
    try:
        for packet in container.demux(stream):
            if not packet.size or packet.is_discard:
                continue
            if packet.is_corrupt:
                damage = CUT_OFF
                continue
            damage = WOUNDED if damage else ""
            stamps.append(packet.pts)
            if packet.is_keyframe and packet.pts is not None:
                keys.append(packet.pts)
    except av.FFmpegError:
        damage = CUT_OFF
    if None in stamps or len(set(stamps)) < len(stamps):
        stamps, keys = [], []
    return _sorted(stamps), _sorted(keys), Fraction(stream.time_base or 1), damage


def _unbroken(stamps: IntArray) -> int:
    """Return how many pictures of a cut-off file are in line: those stored last may follow missing ones."""
    steps = np.diff(stamps)
    tail = max(len(steps) - LONGEST_REORDERING, 0)
    gaps = np.flatnonzero(steps[tail:] > 1.5 * np.median(steps)) if len(steps) else steps
    return tail + int(gaps[0]) + 1 if len(gaps) else len(stamps)


def _may_seek(kind: str, stamps: IntArray, keys: IntArray) -> bool:
    """AVI has no stamps of its own: they are guessed, and wrong as soon as pictures are stored out of order."""
    return (
        len(stamps) > 0 and any(name in kind for name in SEEKABLE) and ("avi" not in kind or len(keys) == len(stamps))
    )


def _sorted(values: list[int] | list[int | None]) -> IntArray:
    return np.sort(np.array(values, dtype=np.int64))


def _decode_stamps(
    path: Path, time_base: Fraction, declared: Fraction | None, damage: str
) -> tuple[IntArray, Fraction, str]:
    """Count the pictures by decoding them all; number them when their stamps are missing or do not rise."""
    stamps: list[int | None] = []
    with open_video(path) as (container, stream):
        try:
            stamps.extend(frame.pts for frame in pictures_of(container, stream))
        except av.FFmpegError:
            damage = damage or CUT_OFF
    known = [stamp for stamp in stamps if stamp is not None]
    if len(known) < len(stamps) or any(later <= earlier for earlier, later in pairwise(known)):
        return np.arange(len(stamps), dtype=np.int64), 1 / Fraction(declared or 25), damage
    return np.array(known, dtype=np.int64), time_base, damage


def _first_picture(path: Path) -> tuple[tuple[int, int], int]:
    """Return height and width of the first picture that is shown, upright, and its stamp.

    The header knows nothing of rotation. A video cut at an open group of pictures stores some that come before its
    key picture and lean on what was cut off: no decoder shows them.
    """
    with open_video(path) as (container, stream):
        for frame in pictures_of(container, stream):
            return upright_shape(frame), frame.pts if frame.pts is not None else np.iinfo(np.int64).min
    raise VideoError(path.name, EXPECTED, "a file without a picture that can be decoded")

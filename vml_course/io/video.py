"""Video in and out: facts of a file, its pictures by exact number, and the writer.

A picture's number is its place in the order of presentation. A seek is believed only when the time
stamp that comes back is the expected one; otherwise decoding starts further back, at worst at the start.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TypeVar

import av
import numpy as np

from vml_course.errors import FrameRangeError, VideoError
from vml_course.io.container import open_video, pictures_of
from vml_course.io.encode import write_video
from vml_course.io.index import PictureIndex
from vml_course.io.planes import bgr_of, luma_of, picture_from_bgr, picture_of, upright_shape
from vml_course.io.sequence import index_clip, pictures_from
from vml_course.model.frame import Frame, Picture, VideoInfo

__all__ = [
    "ColourFrame",
    "bgr_of",
    "exact_rate_of",
    "picture_from_bgr",
    "probe",
    "read_frames",
    "read_pictures",
    "write_video",
]

Made = TypeVar("Made")
Numbered = Generator[tuple[int, av.VideoFrame], None, None]
SEEK_TRIES = 3


@dataclass(frozen=True, eq=False, slots=True)
class ColourFrame:
    """A decoded picture with its colours; number and time as in `Frame`."""

    index: int
    time_s: float
    picture: Picture


def probe(path: Path) -> VideoInfo:
    """Tell what a video file (or a folder of pictures) is, from its pictures and not from its header.

    Raises
    ------
    FileMissingError
    VideoError
        When the file is empty, cut off before its index, no video, or has no picture that can be decoded.
    """
    return index_clip(Path(path)).info


def exact_rate_of(path: Path) -> Fraction:
    """Return the file's pictures per second without rounding (the mean, when the rate varies)."""
    return index_clip(Path(path)).rate


def read_frames(path: Path, start: int = 0, end: int | None = None, step: int = 1) -> Iterator[Frame]:
    """Decode the luma of frames `start`, `start + step`, ... up to and including `end`.

    Parameters
    ----------
    start, end : int
        Numbers in the order of presentation, from 0; `end=None` means the last.
    step : int
        Take every `step`-th.

    Raises
    ------
    FrameRangeError
        At once, when the range does not lie inside the video.
    VideoError
        When the file is no video; or, on the way, at a damaged picture (it says up to which frame it is usable).
    """
    return frames_of(index_clip(Path(path)), start, end, step)


def read_pictures(path: Path, start: int = 0, end: int | None = None, step: int = 1) -> Iterator[ColourFrame]:
    """Decode pictures with their colours; numbers, range and errors as in `read_frames`."""
    return colours_of(index_clip(Path(path)), start, end, step)


def frames_of(index: PictureIndex, start: int, end: int | None, step: int) -> Iterator[Frame]:
    """Do what `read_frames` does, for a video whose pictures are listed already."""
    wanted = _wanted(index, start, end, step)
    return (Frame(number, index.time_s(number), luma) for number, luma in _read(index, wanted, luma_of))


def colours_of(index: PictureIndex, start: int, end: int | None, step: int) -> Iterator[ColourFrame]:
    """Do what `read_pictures` does, for a video whose pictures are listed already."""
    wanted = _wanted(index, start, end, step)
    return (ColourFrame(number, index.time_s(number), picture) for number, picture in _read(index, wanted, picture_of))


def _wanted(index: PictureIndex, start: int, end: int | None, step: int) -> range:
    count, name = len(index.pts), index.path.name
    last = count - 1 if end is None else end
    if step < 1:
        raise FrameRangeError("step", "1 or more", step)
    if not 0 <= start < count:
        raise FrameRangeError("start", f"a frame of {name}, 0 to {count - 1}", start)
    if not start <= last < count:
        raise FrameRangeError("end", f"a frame of {name} from the start on, {start} to {count - 1}", last)
    return range(start, last + 1, step)


def _read(index: PictureIndex, wanted: range, make: Callable[[av.VideoFrame], Made]) -> Iterator[tuple[int, Made]]:
    number = -1
    with closing(_from(index, wanted.start)) as pictures:
        for number, frame in pictures:
            if number in wanted:
                yield number, make(frame)
            if number >= wanted[-1]:
                return
    raise _damage(index, number + 1)


def _from(index: PictureIndex, start: int) -> Numbered:
    """Decode from a place at or before `start`: the nearest key picture that a seek really finds, or the first."""
    if index.files:
        yield from pictures_from(index, start)
        return
    keys = index.keys[index.keys <= start] if index.may_seek else index.keys[:0]
    for key in keys[::-1][:SEEK_TRIES]:
        pictures = _decode(index, int(key))
        first = next(pictures, None)
        if first is not None and first[0] <= start and first[1].key_frame:
            yield first
            yield from pictures
            return
        pictures.close()
    yield from _decode(index, 0)


def _decode(index: PictureIndex, key: int) -> Numbered:
    """Yield numbered pictures from a seek to picture `key` on (0: from the start), checking each stamp."""
    number = 0
    with open_video(index.path) as (container, stream):
        if key:
            with suppress(av.FFmpegError):  # the place that comes back is checked by the caller
                container.seek(int(index.pts[key]), stream=stream)
        try:
            for place, frame in enumerate(pictures_of(container, stream)):
                number = number + 1 if place else _first_number(index, frame, key)
                if frame.is_corrupt or (index.may_seek and frame.pts != _stamp(index, number)):
                    raise _damage(index, number)
                if upright_shape(frame) != (index.info.height_px, index.info.width_px):
                    raise _damage(index, number, "pictures of one size", "another size")
                yield number, frame
        except av.FFmpegError as error:
            raise _damage(index, number + 1) from error


def _first_number(index: PictureIndex, frame: av.VideoFrame, key: int) -> int:
    return int(np.searchsorted(index.pts, frame.pts)) if key and frame.pts is not None else 0


def _stamp(index: PictureIndex, number: int) -> int | None:
    return int(index.pts[number]) if number < len(index.pts) else None


def _damage(index: PictureIndex, number: int, expected: str = "undamaged pictures", got: str = "damage") -> VideoError:
    hint = f"Frames 0 to {number - 1} can be used: give --end {number - 1}." if number else ""
    return VideoError(index.path.name, expected, f"{got} at frame {number}", hint)

"""The pictures of a tracking request, in both directions, by their frame numbers and on the recording's clock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vml_course.errors import FrameRangeError, InputError
from vml_course.io.source import Source, open_source
from vml_course.model.frame import Frame
from vml_course.model.track import Seed

if TYPE_CHECKING:
    from vml_course.usecases.track_clip import TrackRequest


RATE = "the frames per second when recorded, above 0"


class Way(NamedTuple):
    """The pictures that following points takes: on from the first placed, and back from the last placed.

    Attributes
    ----------
    onwards, back : iterator of Frame
    onwards_count, back_count : int
        How many pictures each has; there is no way back when all points are placed in the first picture.
    """

    onwards: Iterator[Frame]
    back: Iterator[Frame]
    onwards_count: int
    back_count: int

    @property
    def total(self) -> int:
        """How many pictures are decoded."""
        return self.onwards_count + self.back_count


@dataclass(frozen=True, eq=False)
class Reel:
    """A range of pictures of a source.

    Attributes
    ----------
    source : Source
    rows : range
        Which pictures of the file.
    fps : float
        Frames per second when recorded. A given rate stretches the time stamps: slow-motion clips are stored to
        play at 30 1/s.
    """

    source: Source
    rows: range
    fps: float

    @property
    def steady_fps(self) -> float | None:
        """The rate to count times by; None when it varies and each picture's own stamp counts."""
        return None if self.source.is_variable_rate else self.fps

    @property
    def first_frame(self) -> int:
        """Number of the first picture, as in the track's table."""
        return self.source.frame(self.rows[0])

    def row(self, name: str, frame: int) -> int:
        """Return which picture of the file has a frame number.

        Raises
        ------
        FrameRangeError
            Under `name`, when none of the range has.
        """
        first, last = (self.source.frame(self.rows[k]) for k in (0, -1))
        found = [row for row in self.rows if self.source.frame(row) == frame]
        if not found:
            step = (self.source.frame(self.rows[1]) - first) if len(self.rows) > 1 else 1
            by = f" in steps of {step}" if step > 1 else ""
            raise FrameRangeError(name, f"a frame of the clip, {first} to {last}{by}", frame)
        return found[0]

    def picture(self, row: int) -> Frame:
        """Decode one picture of the file."""
        return next(self._timed(self.source.frames(row, row, 1)))

    def onwards(self, row: int) -> Iterator[Frame]:
        """Decode from a picture of the file to the last one."""
        return self._timed(self.source.frames(row, self.rows[-1], self.rows.step))

    def backwards(self, row: int) -> Iterator[Frame]:
        """Decode from a picture of the file back to the first one."""
        return self._timed(self.source.frames_backwards(self.rows[0], row, self.rows.step))

    def way(self, seeds: Sequence[Seed]) -> Way:
        """Return the pictures in which points are to be followed.

        Raises
        ------
        FrameRangeError
            Under a point's name, when its frame is not one of these pictures.
        """
        placed = [self.rows[0] if seed.frame is None else self.row(seed.name, seed.frame) for seed in seeds]
        first, last = min(placed), max(placed)
        on = len(self.rows) - self.rows.index(first)
        if last == self.rows[0]:
            return Way(self.onwards(first), iter(()), on, 0)
        return Way(self.onwards(first), self.backwards(last), on, self.rows.index(last) + 1)

    def _timed(self, frames: Iterator[Frame]) -> Iterator[Frame]:
        stretch = float(self.source.rate or 1) / self.fps  # without a rate the stamps are numbers
        return (replace(frame, time_s=frame.time_s * stretch) for frame in frames)


def open_reel(request: TrackRequest) -> Reel:
    """Open the video of a request.

    Raises
    ------
    FileMissingError, VideoError
    FrameRangeError
        When the range does not lie inside the video.
    InputError
        When neither the request nor the file says a rate.
    """
    return reel_of(request, open_source(request.video))


def reel_of(request: TrackRequest, source: Source) -> Reel:
    """Return the pictures of a request, of a source that is open already; errors as `open_reel`."""
    if request.fps is None and not source.rate:
        raise InputError("fps", RATE, "none", f"{source.name} does not tell it: say it with --fps.")
    fps = request.fps if request.fps is not None else float(source.rate)
    if not (np.isfinite(fps) and fps > 0):
        raise InputError("fps", RATE, f"{fps:g}")
    source.frames(request.start, request.end, request.step)  # refuses a range that is none
    end = source.info.frame_count - 1 if request.end is None else request.end
    return Reel(source, range(request.start, end + 1, request.step), fps)

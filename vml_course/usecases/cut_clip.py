"""Cut a clip out of a video, and keep beside it where it came from."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from vml_course.errors import InputError
from vml_course.io.clip_note import write_note
from vml_course.io.source import Source, open_source
from vml_course.io.video import ColourFrame, write_video
from vml_course.model.frame import Picture

Progress = Callable[[int, int], None]
SQUARE = 0.002  # headers round
HIGH_QUALITY_CRF = 10  # H.264 whose losses stay below a phone's own


@dataclass(frozen=True)
class Cut:
    """A clip that was written: where, how many pictures, and which frames of the source they are."""

    clip: Path
    note: Path
    count: int
    first_frame: int
    last_frame: int
    fps: float
    fps_record: float
    warnings: tuple[str, ...]


def cut_clip(video: Path, out: Path, start: int, end: int, step: int = 1, progress: Progress | None = None) -> Cut:
    """Write pictures `start`, `start + step`, ... up to and including `end` as a clip of its own.

    Parameters
    ----------
    video, out : Path
        `out` ends in `.avi` (MJPEG, quality about 95) or `.mp4` (H.264, high quality).
    start, end, step : int
        Numbers in `video`, from 0.

    Raises
    ------
    FrameRangeError
        When the range does not lie in the video; nothing is written.
    InputError
        When `video` is a folder of pictures, or `out` itself.
    VideoError, FileMissingError, FileFormatError
        When the video cannot be read or the clip's name names no format.
    """
    if out.exists() and out.resolve() == video.resolve():
        raise InputError(str(out), "another name than the video's", "the same file")
    source = open_source(video)
    if not source.rate:
        hint = "`vml track` takes the pictures themselves: --start and --end choose, --fps tells the rate."
        raise InputError(source.name, "a video, which tells its rate", "pictures without one", hint)
    pictures = source.pictures(start, end, step)
    rate = source.index.rate / step
    total = len(range(start, end + 1, step))
    count = write_video(out, _counted(pictures, total, progress), rate, HIGH_QUALITY_CRF)
    note = write_note(out, source.note_of(start, end, step))
    last = start + (count - 1) * step
    fps, recorded = float(rate), float(source.rate)
    return Cut(out, note, count, source.frame(start), source.frame(last), fps, recorded, warnings_of(source))


def warnings_of(source: Source) -> tuple[str, ...]:
    """Return what a person should know of a video before measuring on it."""
    found = [f"{source.path.name}: {source.info.damage}."] if source.info.damage else []
    if source.is_variable_rate:
        found.append(f"{source.name}: the frame rate varies (mean {float(source.rate):.4g} 1/s); real times are used.")
    if abs(source.info.pixel_aspect - 1) > SQUARE:
        wide = f"{source.info.pixel_aspect:.4g} times as wide as high"
        found.append(f"{source.name}: the pixels are {wide}; lengths along x and y cannot share one scale.")
    return tuple(found)


def _counted(pictures: Iterator[ColourFrame], total: int, progress: Progress | None) -> Iterator[Picture]:
    for done, one in enumerate(pictures, start=1):
        yield one.picture
        if progress:
            progress(done, total)

"""A video to be measured: a whole file, or a clip whose note tells the numbers and times of its source."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from vml_course.errors import FileFormatError
from vml_course.io.backwards import frames_backwards
from vml_course.io.clip_note import ClipNote, note_path, read_note
from vml_course.io.files import sha256_of_all
from vml_course.io.index import PictureIndex
from vml_course.io.sequence import index_clip
from vml_course.io.video import ColourFrame, colours_of, frames_of
from vml_course.model.frame import Frame, VideoInfo


@dataclass(frozen=True, eq=False, slots=True)
class Source:
    """A video under the numbers of its source.

    Attributes
    ----------
    path : Path
        The file that is read.
    name, sha256 : str
        File name and fingerprint of the source: of the file itself, unless it is a clip with a note.
    info : VideoInfo
        Of the file that is read.
    rate : Fraction
        Frames per second of the source, by its file; 0 when it tells none, as a folder of pictures does.
    is_variable_rate : bool
        Of the source.
    """

    path: Path
    name: str
    sha256: str
    info: VideoInfo
    rate: Fraction
    is_variable_rate: bool
    index: PictureIndex
    note: ClipNote | None

    def frame(self, number: int) -> int:
        """Return the source's number of a picture of the file."""
        return self.note.frame(number) if self.note else number

    def note_of(self, start: int, end: int, step: int) -> ClipNote:
        """Return the note for a clip cut from pictures `start` to `end` of this file."""
        pts = self.note.pts if self.note else self.index.pts
        base = self.note.time_base if self.note else self.index.time_base
        inner = self.note.step if self.note else 1
        kept = pts[start : end + 1 : step]
        return ClipNote(
            self.name, self.sha256, self.frame(start), inner * step, self.rate, self.is_variable_rate, kept, base
        )

    def frames(self, start: int, end: int | None, step: int) -> Iterator[Frame]:
        """Decode luma; `start`, `end` count the file's own pictures, numbers and times are the source's."""
        decoded = frames_of(self.index, start, end, step)
        return self._renumbered(decoded) if self.note else decoded

    def frames_backwards(self, start: int, end: int | None, step: int) -> Iterator[Frame]:
        """Decode what `frames` does, the last picture first, in a room that does not grow with the clip."""
        decoded = frames_backwards(self.index, start, end, step)
        return self._renumbered(decoded) if self.note else decoded

    def pictures(self, start: int, end: int | None, step: int) -> Iterator[ColourFrame]:
        """Decode colours, numbered as in `frames`."""
        decoded = colours_of(self.index, start, end, step)
        return (replace(one, index=self.frame(one.index)) for one in decoded)

    def _renumbered(self, decoded: Iterator[Frame]) -> Iterator[Frame]:
        times_s = self.note.times_s() if self.note else ()
        return (Frame(self.frame(one.index), float(times_s[one.index]), one.luma) for one in decoded)


def open_source(path: Path) -> Source:
    """Look at a video or a folder of pictures, and at the note beside it when there is one.

    Raises
    ------
    FileMissingError, VideoError
        When it is neither.
    FileFormatError
        When the note is damaged or belongs to another clip.
    """
    index = index_clip(Path(path))
    path = index.path
    note = None if index.files else read_note(path)
    if note is None:
        sha256 = sha256_of_all(index.files or [path])
        return Source(path, path.name, sha256, index.info, index.rate, index.info.is_variable_rate, index, None)
    if len(note.pts) != index.info.frame_count:
        got = f"{index.info.frame_count} pictures"
        raise FileFormatError(note_path(path).name, f"a note of the clip's {len(note.pts)} pictures", got)
    return Source(path, note.source, note.sha256, index.info, note.fps_record, note.is_variable_rate, index, note)

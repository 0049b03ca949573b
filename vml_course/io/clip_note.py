"""The note beside a clip: which frames of which video it holds, so that numbers and times survive the cut."""

from __future__ import annotations

import json
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from vml_course.errors import FileFormatError
from vml_course.io.files import replacing, sha256_of
from vml_course.model.arrays import FloatArray, IntArray

SUFFIX = ".vmlclip.json"
VERSION = 1


@dataclass(frozen=True, eq=False, slots=True)
class ClipNote:
    """Where the pictures of a clip come from.

    Attributes
    ----------
    source, sha256 : str
        File name and fingerprint of the video that was cut.
    first_source_frame, step : int
        Picture k of the clip is frame `first_source_frame + k * step` of the source.
    fps_record : Fraction
        Frames per second of the source (the mean, when it varies).
    is_variable_rate : bool
    pts : int array, shape (n,)
        Time stamps of the clip's pictures in the source, in units of `time_base`.
    time_base : Fraction
    """

    source: str
    sha256: str
    first_source_frame: int
    step: int
    fps_record: Fraction
    is_variable_rate: bool
    pts: IntArray
    time_base: Fraction

    def frame(self, number: int) -> int:
        """Return the source's number of a picture of the clip."""
        return self.first_source_frame + number * self.step

    def times_s(self) -> FloatArray:
        """Return the pictures' times in the source, in seconds, shape (n,)."""
        return np.array([float(int(stamp) * self.time_base) for stamp in self.pts])


def note_path(clip: Path) -> Path:
    """Return where the note of a clip lies: `kick.avi` -> `kick.avi.vmlclip.json`."""
    return clip.with_name(clip.name + SUFFIX)


def write_note(clip: Path, note: ClipNote) -> Path:
    """Write the note of a clip that is there already, and return its path."""
    facts = {
        "vmlclip": VERSION,
        "source": note.source,
        "sha256": note.sha256,
        "clip_sha256": sha256_of(clip),
        "first_source_frame": note.first_source_frame,
        "step": note.step,
        "fps_record": float(note.fps_record),
        "fps_record_exact": [note.fps_record.numerator, note.fps_record.denominator],
        "variable_rate": note.is_variable_rate,
        "time_base": [note.time_base.numerator, note.time_base.denominator],
        "pts": note.pts.tolist(),
    }
    path = note_path(clip)
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(facts, ensure_ascii=False) + "\n", encoding="utf-8", errors="replace")
    return path


def read_note(clip: Path) -> ClipNote | None:
    """Return the note beside a clip, None when there is none.

    Raises
    ------
    FileFormatError
        When the note is unreadable or belongs to another file: frame numbers would be wrong.
    """
    path = note_path(clip)
    if not path.is_file():
        return None
    hint = f"Delete it to number the frames of {clip.name} from 0, or cut the clip again."
    try:
        facts = json.loads(path.read_text(encoding="utf-8"))
        note, belongs_to = _note(facts), facts["clip_sha256"]
    except (ValueError, TypeError, KeyError, OverflowError, ZeroDivisionError, RecursionError, AttributeError) as error:
        raise FileFormatError(path.name, "the note that `vml clip` writes", "something else", hint) from error
    if belongs_to != sha256_of(clip):
        raise FileFormatError(path.name, f"the note of {clip.name}", "that of another clip", hint)
    return note


def _note(facts: Any) -> ClipNote:
    if facts["vmlclip"] != VERSION or facts["step"] < 1:
        raise ValueError(facts)
    return ClipNote(
        str(facts["source"]),
        str(facts["sha256"]),
        int(facts["first_source_frame"]),
        int(facts["step"]),
        Fraction(*facts["fps_record_exact"]),
        bool(facts["variable_rate"]),
        np.array(facts["pts"], dtype=np.int64).reshape(-1),
        Fraction(*facts["time_base"]),
    )

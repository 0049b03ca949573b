"""An instructor's look at an assignment's file: every mistake, where it is, and what was expected."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from assignments.errors import AssignmentFileError
from assignments.handout import FirstPicture, render_handout
from assignments.load import FILE, load_folder
from assignments.locate import line_of
from assignments.model import Assignment
from assignments.variants import draw_variant, given_values
from vml_course.errors import FileMissingError


@dataclass(frozen=True)
class FileMistake:
    """One mistake; `line` counts from 1."""

    file: str
    line: int
    key: str
    expected: str
    got: str
    hint: str = ""


@dataclass(frozen=True)
class CheckedFile:
    """What was found in a file; `title` is the assignment's where there is no mistake."""

    file: str
    mistakes: tuple[FileMistake, ...]
    title: str = ""


def check_file(path: Path) -> CheckedFile:
    """Return every mistake in an assignment's file.

    Parameters
    ----------
    path : Path
        The file, or the folder that holds it.

    Raises
    ------
    FileMissingError
    """
    file = path / FILE if path.is_dir() else path
    if not file.is_file() or file.name != FILE:
        raise FileMissingError(str(path), f"a folder with an {FILE}, or that file", "something else")
    try:
        assignment = load_folder(file.parent.resolve())
    except AssignmentFileError as error:
        text = file.read_bytes().decode("utf-8", errors="replace")
        found = (
            FileMistake(str(file), line_of(text, m.name, str(m.got)), m.name, m.expected, str(m.got), m.hint)
            for m in error.mistakes
        )
        return CheckedFile(str(file), tuple(sorted(found, key=lambda mistake: mistake.line)))
    return CheckedFile(str(file), tuple(_of_the_handout(assignment)), assignment.title)


def _of_the_handout(assignment: Assignment) -> Iterator[FileMistake]:
    """Write the handout for a made-up variant before a blank picture, and say what stops it."""
    variant = draw_variant(assignment, b"a look keeps no secret", "nobody")
    places = {point: (200.0 + 50.0 * k, 200.0) for k, point in enumerate(assignment.points)}
    picture = FirstPicture(np.zeros((720, 1280, 3), np.uint8), places, (100.0, 600.0, 600.0, 600.0))
    try:
        render_handout(assignment, variant, given_values(assignment, variant), picture)
    except AssignmentFileError as error:
        line = getattr(error.__cause__, "lineno", None) or 1
        file = str(Path(assignment.folder) / assignment.handout_template)
        for mistake in error.mistakes:
            yield FileMistake(file, line, mistake.name, mistake.expected, str(mistake.got), mistake.hint)

"""An instructor's look at an assignment's file: every mistake, where it is, and what was expected."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from assignments.errors import AssignmentFileError
from assignments.load import FILE, load_folder
from assignments.locate import line_of
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
        return CheckedFile(str(file), (), load_folder(file.parent.resolve()).title)
    except AssignmentFileError as error:
        text = file.read_bytes().decode("utf-8", errors="replace")
        found = (
            FileMistake(str(file), line_of(text, m.name, str(m.got)), m.name, m.expected, str(m.got), m.hint)
            for m in error.mistakes
        )
        return CheckedFile(str(file), tuple(sorted(found, key=lambda mistake: mistake.line)))

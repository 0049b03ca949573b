"""Reads an assignment's folder: TOML in, frozen records out, every mistake named with its key."""

from __future__ import annotations

import importlib.resources
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from assignments.errors import AssignmentFileError
from assignments.model import Assignment
from assignments.resolve import mistakes_in
from assignments.schema import AssignmentFile
from assignments.toml_text import TomlError, content_of, shown, text_of
from vml_course.errors import InputError, UnknownNameError

FILE = "assignment.toml"
TO_BEGIN_WITH = "soccer-kick"


def catalogue() -> Path:
    """Return the folder that holds the assignments of this package."""
    return Path(str(importlib.resources.files("assignments"))) / "catalog"


def is_of_catalogue(folder: str | Path) -> bool:
    """Tell whether an assignment's folder is one of this package, which every student's `vml` has."""
    return Path(folder).resolve().parent == catalogue().resolve()


def assignment_ids() -> tuple[str, ...]:
    """Return the assignments of the catalogue: one folder each, the one to begin with first."""
    names = (folder.name for folder in catalogue().iterdir() if (folder / FILE).is_file())
    return tuple(sorted(names, key=lambda name: (name != TO_BEGIN_WITH, name)))


def known_assignments(also: Path | None = None) -> tuple[str, ...]:
    """Return the ids of the catalogue, then those in a folder of further assignments; no file is read."""
    own = (file.parent.name for file in sorted(also.glob(f"*/{FILE}"))) if also else ()
    return tuple(dict.fromkeys((*assignment_ids(), *own)))


def load_assignment(assignment: str, also: Path | None = None) -> Assignment:
    """Read an assignment: one of the catalogue, or an instructor's own folder.

    Parameters
    ----------
    assignment : str
        An id, or the path of a folder with an `assignment.toml`.
    also : Path, optional
        A folder of further assignments, such as a course's; one there comes before the catalogue's of the same id.

    Raises
    ------
    UnknownNameError
        When there is no such assignment.
    AssignmentFileError
        When its file has mistakes.
    """
    return load_folder(assignment_folder(assignment, also))


def assignment_folder(assignment: str, also: Path | None = None) -> Path:
    """Return where an assignment is, as in `load_assignment`.

    Raises
    ------
    UnknownNameError
    """
    is_id = Path(assignment).name == assignment and not assignment.startswith(".")
    places = [folder / assignment for folder in (also, catalogue()) if folder and is_id]
    for place in (*places, Path(assignment)):
        if (place / FILE).is_file():
            return place.resolve()
    raise UnknownNameError("assignment", assignment, known_assignments(also))


def load_folder(folder: Path) -> Assignment:
    """Read the assignment in a folder; the folder's name is its id.

    Raises
    ------
    AssignmentFileError
        With all mistakes found, each with its key.
    """
    place = f"{folder.name}/{FILE}"
    try:
        content = content_of(text_of((folder / FILE).read_bytes(), "file"), "file")
        assignment = AssignmentFile.model_validate(content).record(folder)
    except FileNotFoundError:
        raise AssignmentFileError(place, [InputError("file", f"a file named {FILE}", "none")]) from None
    except TomlError as error:
        raise AssignmentFileError(place, [error]) from error
    except ValidationError as error:
        raise AssignmentFileError(place, named_mistakes(error, content)) from error
    mistakes = tuple(mistakes_in(assignment))
    if mistakes:
        raise AssignmentFileError(place, mistakes)
    return assignment


def named_mistakes(error: ValidationError, content: dict[str, Any]) -> list[InputError]:
    """Translate pydantic's findings: key, expected, got."""
    return [
        _mistake(finding["type"], finding["loc"], finding["msg"], finding["input"], content)
        for finding in error.errors()
    ]


def _mistake(kind: str, place: tuple[int | str, ...], message: str, got: Any, content: dict[str, Any]) -> InputError:
    key = _key(place, content)
    if kind == "extra_forbidden":
        return InputError(key, "no such key", shown(got), "Is it misspelt?")
    if kind == "missing":
        return InputError(key, "a value", "none")
    if kind == "value_error":  # of a validator of ours: what was expected, in words
        return InputError(key or "file", message.removeprefix("Value error, "), shown(got))
    return InputError(key, _expectation(message), shown(got))


def _expectation(message: str) -> str:
    """Turn "Input should be a valid number, unable to ..." into "a valid number"."""
    for start in ("Input should be ", "String should match ", "String should "):
        message = message.removeprefix(start)
    return message.split(", unable")[0]


def _key(place: tuple[int | str, ...], content: Any) -> str:
    """Name a place as a person does: `question.v_b2.points`, not `question.7.points`."""
    names: list[str] = []
    for step in place:
        content = _inside(content, step)
        named = isinstance(step, int) and isinstance(content, dict) and isinstance(content.get("id"), str)
        names.append(content["id"] if named else str(step))
    return ".".join(names)


def _inside(content: Any, step: int | str) -> Any:
    try:
        return content[step]
    except (KeyError, IndexError, TypeError):
        return None

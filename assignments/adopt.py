"""An instructor's own assignment becomes one of the course, so that it can still be graded when its folder has gone."""

from __future__ import annotations

import filecmp
import shutil
from pathlib import Path

from assignments.course import Course
from assignments.load import assignment_folder, catalogue, load_folder
from assignments.model import Assignment
from vml_course.errors import InputError


def adopt(course: Course, assignment: str) -> Assignment:
    """Read an assignment for a course; one in a folder elsewhere is copied into the course first.

    Parameters
    ----------
    course : Course
    assignment : str
        An id of the course or of the catalogue, or the path of a folder.

    Raises
    ------
    UnknownNameError, AssignmentFileError
    InputError
        When the course has another assignment of that name.
    """
    folder = assignment_folder(assignment, course.assignments)
    loaded = load_folder(folder)
    if folder.parent in (catalogue().resolve(), course.assignments.resolve()):
        return loaded
    own = course.assignments / folder.name
    if own.exists() and not _is_same(folder, own):
        hint = "Rename your folder, or remove the other one as long as nothing was handed out."
        raise InputError(str(folder), f"a name that {course.assignments} does not have yet", repr(folder.name), hint)
    if not own.exists():
        shutil.copytree(folder, own)
    return load_folder(own)


def _is_same(one: Path, other: Path) -> bool:
    names = sorted(path.name for path in one.iterdir())
    _, different, unreadable = filecmp.cmpfiles(one, other, names, shallow=False)
    return names == sorted(path.name for path in other.iterdir()) and not different and not unreadable

"""Grading a batch: files that somebody names, those that were collected and wait, or all of an assignment again.

Every file is kept and has its receipt before it is looked at, and run and receipt are written in one transaction:
a run that was killed goes on with what still waits.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from assignments.course import Course
from grader.gradebook import Gradebook
from grader.marker import FEEDBACK, USUAL, Graded, Marker, Progress, Wanted, Whose, silent, write_class_page
from grader.receipts import WAITING, Status
from vml_course.errors import FileMissingError

__all__ = [
    "FEEDBACK",
    "Graded",
    "Wanted",
    "Whose",
    "grade_again",
    "grade_collected",
    "grade_files",
    "waiting_files",
    "write_class_page",
]


def grade_files(
    course: Course,
    files: Iterable[Path],
    wanted: Wanted = USUAL,
    *,
    whose: Whose | None = None,
    progress: Progress | None = None,
) -> list[Graded]:
    """Grade files, record what they earned, write a page for each student and one for the class.

    A file that cannot be graded gets a status and a polite reason; it never stops the others. Attempts are as old as
    the first arrival of their content, and the files of one batch are taken in the order in which they were changed.

    Parameters
    ----------
    course : Course
    files : iterable of Path
        Files, or folders, of which every file is taken.
    wanted : Wanted
    whose : Whose, optional
        A person's word that all of these files are one student's.
    progress : callable, optional
        `(files done, files in all)`.

    Returns
    -------
    list of Graded
        In the order in which the files were named.

    Raises
    ------
    FileMissingError
        When none of the files exists.
    InputError
        When there is no such student as they are said to be of, or no variant of that assignment for them.
    """
    listed = listed_files(files)
    with Gradebook.open(course) as book, wanted.crew_for(len(listed)) as crew:
        marker = Marker(course, book, crew, wanted)
        in_order = sorted(listed, key=_changed)
        graded = dict(zip(in_order, marker.mark_files(in_order, progress or silent, whose), strict=True))
        return marker.finish([graded[file] for file in listed])


def grade_collected(
    course: Course, assignment_id: str, wanted: Wanted = USUAL, *, progress: Progress | None = None
) -> list[Graded]:
    """Grade what was collected for an assignment and not graded yet, in the order in which it was handed in.

    As `grade_files`.
    """
    return _grade_kept(course, "collected", assignment_id, wanted, progress or silent)


def waiting_files(course: Course, assignment_id: str = "") -> int:
    """Return how many files came in that nobody could grade: a person says whose they are, or asks for others."""
    with Gradebook.open(course) as book:
        return sum(len(book.receipts(status, assignment_id)) for status in WAITING)


def grade_again(
    course: Course, assignment_id: str, wanted: Wanted = USUAL, *, progress: Progress | None = None
) -> list[Graded]:
    """Grade everything of an assignment anew that was graded before, as after a change of the grader or an assignment.

    Runs are added, attempts stay; what students were told changes with the next release only, which says how.
    """
    return _grade_kept(course, "graded", assignment_id, wanted, progress or silent)


def _grade_kept(course: Course, status: Status, assignment_id: str, wanted: Wanted, progress: Progress) -> list[Graded]:
    with Gradebook.open(course) as book:
        receipts = book.receipts(status, assignment_id)
        with wanted.crew_for(len(receipts)) as crew:
            marker = Marker(course, book, crew, wanted)
            return marker.finish(marker.mark_receipts(receipts, progress))


def listed_files(files: Iterable[Path]) -> list[Path]:
    """Return the files that are meant, each once: folders stand for what lies in them.

    Raises
    ------
    FileMissingError
        When none of them exists.
    """
    files, listed = [Path(file) for file in files], list[Path]()
    for path in files:
        inside = (
            sorted(p for p in path.iterdir() if p.is_file() and not p.name.startswith((".", "~$")))
            if path.is_dir()
            else [path]
        )
        listed += inside
    if not any(file.exists() for file in listed):
        first = files[0] if files else Path()
        is_folder = first.is_dir()
        expected = "a folder with workbooks in it" if is_folder else "an existing file or folder"
        raise FileMissingError(str(first), expected, "an empty folder" if is_folder else "no such file")
    return list(dict.fromkeys(listed))


def _changed(file: Path) -> float:
    return file.stat().st_mtime if file.exists() else 0.0

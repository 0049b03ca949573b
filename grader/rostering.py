"""What a course does with its class list: take it in, look at it, let go of it."""

from __future__ import annotations

from pathlib import Path

from assignments.course import Course, has_sample_roster
from grader.enrolment import DROPPED, Arrival, Student
from grader.gradebook import Gradebook
from grader.roster import read_roster


def import_roster(course: Course, file: Path, *, dry_run: bool = False) -> tuple[Arrival, ...]:
    """Take in a class list; with `dry_run` only tell what would become of each line.

    Raises
    ------
    FileMissingError, RosterError
    """
    people = read_roster(file)
    with Gradebook.open(course) as book:
        arrivals = book.take_in(people, file.name, dry_run=dry_run)
    if not dry_run and has_sample_roster(course) and file.resolve() != course.roster.resolve():
        course.roster.unlink()  # the sample's three students are nobody's
    return arrivals


def roster_of(course: Course) -> tuple[Student, ...]:
    """Return the students of a course, those of its `roster.csv` included."""
    with Gradebook.open(course) as book:
        if course.roster.is_file():
            book.students_from_roster(course.roster)
        return book.students()


def drop_student(course: Course, pid: str) -> None:
    """Leave a student out from now on.

    Raises
    ------
    InputError
    """
    with Gradebook.open(course) as book:
        book.set_status(pid, DROPPED)


def purge_names(course: Course, *, dropped_only: bool = False) -> int:
    """Remove names and addresses; return of how many students."""
    with Gradebook.open(course) as book:
        pids = (s.pid for s in book.students() if not dropped_only or s.status == DROPPED)
        return book.forget_names(pids)


def places_of_names(course: Course) -> tuple[str, ...]:
    """Return the files of a course that hold names beside the gradebook, as far as they exist."""
    patterns = (course.roster.name, "handouts/roster-*.csv", "feedback/*/class.html", "exports/*", "gradebook-before-*")
    found = (path for pattern in patterns for path in sorted(course.folder.glob(pattern)))
    return tuple(path.relative_to(course.folder).as_posix() for path in found)

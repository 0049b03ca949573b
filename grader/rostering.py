"""What a course does with its class list: take it in, look at it, let go of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from assignments.course import Course, has_sample_roster
from grader.enrolment import DROPPED, Arrival, Student
from grader.gradebook import Gradebook
from grader.roster import read_roster
from vml_course.errors import InputError


@dataclass(frozen=True)
class Imported:
    """What became of a class list, and of the `roster.csv` that lay in the course.

    Attributes
    ----------
    arrivals : tuple of Arrival
        One for each line, and for each student who is not on the list.
    had_sample : bool
        Whether `roster.csv` was the sample that a new course begins with; its students are nobody's.
    own_students : int
        How many stand in a `roster.csv` of one's own, which goes on being read beside the class list.
    """

    arrivals: tuple[Arrival, ...]
    had_sample: bool
    own_students: int


def import_roster(course: Course, file: Path, *, dry_run: bool = False) -> Imported:
    """Take in a class list, and put the sample list away; with `dry_run` only tell what would become of each line.

    Raises
    ------
    FileMissingError, RosterError
    """
    people = read_roster(file)
    is_another = file.resolve() != course.roster.resolve()
    had_sample = is_another and has_sample_roster(course)
    with Gradebook.open(course) as book:
        arrivals = book.take_in(people, file.name, dry_run=dry_run)
    if had_sample and not dry_run:
        course.roster.unlink()
    return Imported(arrivals, had_sample, _students_in(course.roster) if is_another and not had_sample else 0)


def _students_in(roster: Path) -> int:
    """Count the students of a list, 0 where it is none: whoever needs it says why."""
    try:
        return len(read_roster(roster))
    except InputError:
        return 0


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

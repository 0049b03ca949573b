"""What an export is given, and what it says of each student."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from assignments.course import Course
from assignments.model import Assignment
from grader.enrolment import ACTIVE, Student
from grader.releasing import Released
from vml_course.errors import InputError

Status = Literal["filled", "unchanged", "no grade", "skipped", "not in template"]
Decimal = Literal["auto", "point", "comma"]


@dataclass(frozen=True)
class Line:
    """What became of one student: `reason` says why nothing was written, or how points were scaled.

    `is_open` tells that points were written which a person has still to confirm.
    """

    name: str
    status: Status
    points: str = ""
    reason: str = ""
    pid: str = ""
    is_open: bool = False

    @property
    def needs_attention(self) -> bool:
        """Whether a person should look: a grade did not get into the file, or one that is not final did."""
        return self.is_open or self.status in {"skipped", "not in template"}


@dataclass(frozen=True)
class Template:
    """The platform's own file that is filled: its name for messages, its bytes."""

    name: str
    data: bytes


@dataclass(frozen=True)
class Job:
    """What is exported.

    Attributes
    ----------
    students : tuple of Student
        The whole class: who is not graded must not be taken for somebody of the same name who is.
    grades : mapping of str to Released
        Of the newest release, by pseudonym.
    stale : frozenset of str
        Pseudonyms of those whose grade has changed since that release.
    unsettled : frozenset of str
        Pseudonyms of those whose released points may still become fewer: a person has to look.
    template : Template or None
    column : str
        The heading of the column to fill, where the assignment's title does not say it.
    decimal : str
        The decimal mark that is written: "point", "comma", or "auto": as the template's other numbers.
    wheels : Path or None
        A folder of prepared wheels; they are downloaded when there is none.
    """

    course: Course
    assignment: Assignment
    students: tuple[Student, ...] = ()
    grades: Mapping[str, Released] | None = None
    stale: frozenset[str] = frozenset()
    unsettled: frozenset[str] = frozenset()
    template: Template | None = None
    column: str = ""
    decimal: Decimal = "auto"
    wheels: Path | None = None

    def grade_of(self, student: Student) -> Released | None:
        """Return what was released to a student."""
        return (self.grades or {}).get(student.pid)

    @property
    def graded(self) -> tuple[Student, ...]:
        """The students who have a released grade and are still in the course."""
        return tuple(student for student in self.students if student.status == ACTIVE and self.grade_of(student))


Write = Callable[[Job, Path], tuple[Line, ...]]


@dataclass(frozen=True)
class Export:
    """A platform's file.

    Attributes
    ----------
    write : callable
        `(job, path)`; writes the file and says what became of each student.
    suffix : str
        Of the file's name.
    template : str
        What file of the platform's has to be given, "" when none.
    from_release : bool
        Whether it tells grades; only released ones may leave.
    hint : str
        What to do with the file; `{points}` stands for the points of the assignment.
    """

    write: Write
    suffix: str
    template: str = ""
    from_release: bool = True
    hint: str = ""


def template_of(job: Job, expected: str) -> Template:
    """Return the template.

    Raises
    ------
    InputError
        When none was given.
    """
    if job.template is None:
        raise InputError("--template", expected, "none")
    return job.template

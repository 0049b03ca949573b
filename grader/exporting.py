"""Writing what a learning platform takes back, from what was released and nothing else."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from assignments.course import Course
from assignments.load import load_assignment
from grader.errors import NothingReleasedError
from grader.exports import export_to
from grader.filling.job import Decimal, Job, Line, Template
from grader.filling.numbers import points_text
from grader.gradebook import Gradebook, Row
from grader.releasing import Released, released_grades
from vml_course.errors import InputError
from vml_course.io.files import check_not_source, existing, replacing

EXPORTS = "exports"
_LARGEST_TEMPLATE_BYTES = 50_000_000


@dataclass(frozen=True)
class Wish:
    """How a platform's file is made; fields as in `grader.filling.job.Job`."""

    template: Path | None = None
    out: Path | None = None
    column: str = ""
    decimal: Decimal = "auto"
    wheels: Path | None = None


@dataclass(frozen=True)
class Exported:
    """The file that was written, what became of each student, and what to do with it.

    `stale` is how many grades have changed since the release.
    """

    file: Path
    lines: tuple[Line, ...]
    hint: str
    stale: int


def export_grades(course: Course, assignment_id: str, to: str, wish: Wish | None = None) -> Exported:
    """Write a platform's file, whole or not at all.

    Raises
    ------
    UnknownNameError
        When there is no such platform or assignment.
    NothingReleasedError
        When no grades were released.
    InputError, TableError
        When the template is missing, or is not what the platform exports.
    """
    wish, export = wish or Wish(), export_to(to)
    job = replace(
        _job(course, assignment_id),
        template=_template(wish.template),
        column=wish.column,
        decimal=wish.decimal,
        wheels=wish.wheels,
    )
    if export.from_release and not job.grades:
        raise NothingReleasedError(assignment_id)
    if bool(export.template) != bool(job.template):
        raise InputError("--template", export.template or f"none for {to}", wish.template or "none")
    suffix = export.suffix or (wish.template or Path()).suffix
    file = wish.out or _place(course, f"{job.assignment.id}-{to}{suffix}")
    check_not_source(file, [wish.template] if wish.template else [])
    with replacing(file) as temporary:
        temporary.touch(mode=0o600)  # it holds names and grades
        lines = export.write(job, temporary)
    return Exported(
        file,
        lines,
        export.hint.format(points=points_text(job.assignment.total_points)),
        len(job.stale) if export.from_release else 0,
    )


def _job(course: Course, assignment_id: str) -> Job:
    assignment = load_assignment(assignment_id, course.assignments)
    with Gradebook.open(course) as book:
        grades = {one.student.pid: one for one in released_grades(book, assignment.id)}
        now = {row.student.pid: row for row in book.rows(assignment.id)}
        students = book.students()
    stale = frozenset(pid for pid, one in grades.items() if _differs(one, now.get(pid)))
    unsettled = frozenset(pid for pid in grades.keys() - stale if now[pid].is_provisional)
    return Job(course, assignment, students, grades, stale, unsettled)


def _differs(released: Released, now: Row | None) -> bool:
    return now is None or now.attempt != released.attempt or abs(now.points - released.points) > 1e-9


def _template(path: Path | None) -> Template | None:
    if path is None:
        return None
    size = existing(path).stat().st_size
    if size > _LARGEST_TEMPLATE_BYTES:
        raise InputError(str(path), "a platform's table of grades", f"a file of {size / 1e6:.0f} MB")
    return Template(path.name, path.read_bytes())


def _place(course: Course, name: str) -> Path:
    """Return where a file goes that nobody named: in the folder of this machine, for it holds names."""
    folder = course.folder / EXPORTS
    folder.mkdir(parents=True, exist_ok=True)
    return folder / name

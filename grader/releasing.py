"""Releases: what was told to students and platform at one moment, and how it differs from the time before."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import Connection, insert, select

from assignments.course import Course
from assignments.load import load_assignment
from grader import tables
from grader.enrolment import Student, students_of
from grader.errors import NothingGradedError
from grader.events import note, now
from grader.gradebook import Gradebook
from grader.ledger import Row


@dataclass(frozen=True)
class Change:
    """One student's grade in a release, and in the one before (None when there was none)."""

    student: Student
    before: float | None
    after: float
    out_of: float
    is_provisional: bool = False

    @property
    def differs(self) -> bool:
        """Whether it is news."""
        return self.before is None or abs(self.after - self.before) > 1e-9

    @property
    def before_text(self) -> str:
        """What it was, in words."""
        return "new" if self.before is None else f"{self.before:g}"


@dataclass(frozen=True)
class Released:
    """One student's grade as it was released."""

    student: Student
    attempt: int
    earned: float
    late_share: float
    points: float
    out_of: float


def release_grades(course: Course, assignment_id: str, *, who: str, dry_run: bool = False) -> tuple[Change, ...]:
    """Release what counts now.

    Raises
    ------
    UnknownNameError
        When there is no such assignment.
    NothingGradedError
        When nobody has a grade.
    """
    load_assignment(assignment_id, course.assignments)
    with Gradebook.open(course) as book:
        rows = book.rows(assignment_id)
        if not rows:
            raise NothingGradedError(assignment_id)
        before = {one.student.pid: one.points for one in released_grades(book, assignment_id)}
        changes = tuple(
            Change(row.student, before.get(row.student.pid), row.points, row.out_of, row.is_provisional) for row in rows
        )
        if not dry_run:
            with book.writing() as connection:
                _write(connection, assignment_id, rows, who)
    return changes


def released_grades(book: Gradebook, assignment_id: str) -> tuple[Released, ...]:
    """Return the grades of the newest release, none when nothing was released."""
    with book.reading() as connection:
        at = _newest(connection, assignment_id)
        table = tables.released_grade
        found = connection.execute(select(table).where(table.c.release_id == at)).mappings().all()
        people = students_of(connection)
    return tuple(
        Released(
            people[line["student_id"]],
            line["attempt"],
            line["earned"],
            line["late_share"],
            line["points"],
            line["out_of"],
        )
        for line in found
    )


def _newest(connection: Connection, assignment_id: str) -> int:
    wanted = (
        select(tables.release.c.id)
        .select_from(tables.release.join(tables.assignment))
        .where(tables.assignment.c.slug == assignment_id)
        .order_by(tables.release.c.id.desc())
    )
    return int(connection.scalar(wanted.limit(1)) or 0)


def _write(connection: Connection, assignment_id: str, rows: Sequence[Row], who: str) -> None:
    ids = {student.pid: at for at, student in students_of(connection).items()}
    lines = [
        {
            "student_id": ids[row.student.pid],
            "grade_run_id": row.run_id,
            "earned": row.earned,
            "late_share": row.late_share,
            "points": row.points,
            "out_of": row.out_of,
            "attempt": row.attempt,
        }
        for row in rows
    ]
    snapshot = hashlib.sha256(json.dumps(lines, sort_keys=True).encode()).hexdigest()
    assignment = connection.scalar(select(tables.assignment.c.id).where(tables.assignment.c.slug == assignment_id))
    made = connection.execute(
        insert(tables.release).values(assignment_id=assignment, at=now(), who=who, snapshot_sha256=snapshot)
    )
    release = int(made.inserted_primary_key[0])  # type: ignore[index]  # one row was inserted
    connection.execute(insert(tables.released_grade), [{**line, "release_id": release} for line in lines])
    note(connection, "released", assignment_id, {"grades": len(lines), "sha256": snapshot, "who": who})

"""The instructor's book: who has which variant, what is true of it, what came in, what it earned.

A SQLite file in the course folder, or PostgreSQL by URL. Runs, keys and events are only added, never changed: the
effective grade is worked out from them, from what a person decided, and from the terms of the course.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any, Self

from sqlalchemy import Connection, Engine, func, insert, select

from assignments import key as keys
from assignments.course import Course
from assignments.model import AnswerKey, Assignment, Variant
from assignments.terms import Calendar
from grader import tables
from grader.adjust import Adjustment, check_adjustment
from grader.database import open_database
from grader.enrolment import ACTIVE, Arrival, Student, enrol_all, forget, set_status, students_of
from grader.errors import NoKeyError, UnknownVariantError
from grader.events import is_whole, note, now
from grader.ledger import (
    Row,
    add_adjustment,
    add_run,
    effective_rows,
    newest_attempt,
    submission_of,
    variant_of,
)
from grader.model import Grade, Submission
from grader.receipts import (
    Arrived,
    Receipt,
    Status,
    add_receipt,
    claim_receipt,
    knows_file,
    receipt_of,
    receipts_with,
    settle_receipt,
)
from grader.roster import Enrolled, read_roster
from vml_course.errors import InputError

__all__ = ["Gradebook", "Row", "Student"]

FILE = "gradebook.db"


def is_begun(course: Course) -> bool:
    """Tell whether a course has a gradebook already; looking makes none."""
    return bool(course.gradebook_url) or (course.folder / FILE).is_file()


class Gradebook:
    """An open gradebook; use it in a `with` block."""

    def __init__(self, engine: Engine, calendar: Calendar | None = None) -> None:
        self._engine, self._calendar = engine, calendar or Calendar()
        self._reader = engine.execution_options(reads=True)

    @classmethod
    def open(cls, course: Course) -> Self:
        """Open the gradebook of a course, and make it on first use.

        Raises
        ------
        DatabaseError
        """
        return cls(open_database(course.folder / FILE, course.gradebook_url), course.calendar)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the file."""
        self._engine.dispose()

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """Give a connection that only reads."""
        with self._reader.connect() as connection:
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """Give a connection in one transaction: all of the block is written, or nothing."""
        with self._engine.begin() as connection:
            yield connection

    # ------------------------------------------------------------ students

    def take_in(
        self, people: Sequence[Enrolled], source: str = "roster", *, dry_run: bool = False, bring_back: bool = True
    ) -> tuple[Arrival, ...]:
        """Take a class list in; who is new gets a random pseudonym. With `dry_run` all is undone again.

        Who was dropped and stands on the list is active again, unless `bring_back` is off.

        Returns
        -------
        tuple of Arrival
            A line of the list each, then the students who are not on it.

        Raises
        ------
        RosterError
        """
        with self._engine.connect() as connection, connection.begin() as transaction:
            arrivals = enrol_all(connection, people, source, bring_back=bring_back)
            if dry_run:
                transaction.rollback()
        return arrivals

    def students_from_roster(self, path: Path) -> tuple[Student, ...]:
        """Take the course's own class list in, and return its students in order; who was dropped stays so.

        Raises
        ------
        FileMissingError, RosterError
        """
        arrivals = self.take_in(read_roster(path), path.name, bring_back=False)
        return tuple(arrival.student for arrival in arrivals if arrival.status != "not listed")

    def students(self, *, active_only: bool = False) -> tuple[Student, ...]:
        """Return the students in the order in which they came."""
        with self._reader.connect() as connection:
            found = students_of(connection).values()
        return tuple(student for student in found if student.status == ACTIVE or not active_only)

    def student(self, pid: str) -> Student:
        """Return a student by pseudonym.

        Raises
        ------
        InputError
        """
        found = next((student for student in self.students() if student.pid == pid), None)
        if found is None:
            raise InputError("student", "a pseudonym of this course", repr(pid), "See: vml roster list.")
        return found

    def set_status(self, pid: str, status: str) -> None:
        """Mark a student as active or dropped; grades stay.

        Raises
        ------
        InputError
        """
        self.student(pid)
        with self._engine.begin() as connection:
            set_status(connection, pid, status)

    def forget_names(self, pids: Iterable[str]) -> int:
        """Remove names and addresses; grades and statistics stay. Return of how many students."""
        with self._engine.begin() as connection:
            return forget(connection, pids)

    # ------------------------------------------------------------ keys

    def keep_key(self, variant: Variant, key: AnswerKey) -> None:
        """Keep what is true of a variant; the same key a second time changes nothing."""
        text = json.dumps(keys.to_json(key), sort_keys=True)
        sha = hashlib.sha256(text.encode()).hexdigest()
        with self._engine.begin() as connection:
            at = variant_of(connection, variant, key.video_sha256)
            known = select(tables.answer_key.c.id).where(
                tables.answer_key.c.variant_id == at, tables.answer_key.c.key_sha256 == sha
            )
            if connection.scalar(known) is None:
                line = {"variant_id": at, "key_json": text, "key_sha256": sha, "created_at": now()}
                connection.execute(insert(tables.answer_key).values(**line))
                note(connection, "key-kept", variant.code, {"sha256": sha})

    def key_for_code(self, code: str, name: str = "workbook") -> AnswerKey:
        """Return the key of a variant by the code that its workbook carries.

        Raises
        ------
        UnknownVariantError
        """
        found = self._newest_key(tables.variant.c.code == code)
        if found is None:
            raise UnknownVariantError(name, code)
        return found

    def key_of(self, assignment_id: str, pid: str) -> AnswerKey:
        """Return the key of a student's variant.

        Raises
        ------
        NoKeyError
        """
        found = self._newest_key((tables.assignment.c.slug == assignment_id) & (tables.student.c.pid == pid))
        if found is None:
            raise NoKeyError(assignment_id, pid)
        return found

    def has_key(self, assignment_id: str, pid: str) -> bool:
        """Tell whether a student's variant is kept."""
        joined = tables.answer_key.join(tables.variant).join(tables.assignment).join(tables.student)
        mine = (tables.assignment.c.slug == assignment_id) & (tables.student.c.pid == pid)
        with self._reader.connect() as connection:
            return connection.scalar(select(tables.answer_key.c.id).select_from(joined).where(mine)) is not None

    def _newest_key(self, condition: Any) -> AnswerKey | None:
        joined = tables.answer_key.join(tables.variant).join(tables.assignment).join(tables.student)
        newest = select(tables.answer_key.c.key_json).select_from(joined).where(condition)
        with self._reader.connect() as connection:
            text = connection.scalar(newest.order_by(tables.answer_key.c.id.desc()).limit(1))
        return keys.from_json(json.loads(text)) if text else None

    # ------------------------------------------------------------ files that came in

    def receive(self, arrived: Arrived) -> int:
        """Keep a receipt of a file; the same bytes of the same name and student again are the same receipt."""
        with self._engine.begin() as connection:
            return add_receipt(connection, arrived)

    def claim(self, arrived: Arrived) -> Receipt:
        """Keep that a person said whose a file is (`arrived.pid`, by `arrived.told_by`); return its receipt.

        Raises
        ------
        InputError
            When there is no such student, or they have no variant of the assignment.
        """
        self.student(arrived.pid)
        self.key_of(arrived.assignment, arrived.pid)
        with self._engine.begin() as connection:
            return claim_receipt(connection, arrived)

    def receipts(self, status: Status, assignment_id: str = "") -> tuple[Receipt, ...]:
        """Return receipts in the order in which the files were handed in."""
        with self._reader.connect() as connection:
            return receipts_with(connection, status, assignment_id)

    def receipt_of(self, assignment_id: str, pid: str, attempt: int, source: str = "") -> Receipt | None:
        """Return the newest receipt of a student's attempt, of one source where it is named; None without one."""
        with self._reader.connect() as connection:
            return receipt_of(connection, assignment_id, pid, attempt, source)

    def knows_file(self, sha256: str, assignment_id: str, pid: str = "") -> str:
        """Return what became of these bytes when they came in before, from this student if named; "" if never."""
        with self._reader.connect() as connection:
            return knows_file(connection, sha256, assignment_id, pid)

    # ------------------------------------------------------------ runs

    def record_run(
        self,
        submission: Submission,
        grade: Grade,
        received_at: str = "",
        *,
        receipt: int | None = None,
        took_ms: int | None = None,
    ) -> int:
        """Record a grade and settle the receipt of its file, whole or not at all; return the attempt.

        The same content again is the same attempt; the run is added all the same. `received_at` is when it was
        handed in, in ISO 8601 with a zone; now when nobody knows.
        """
        with self._engine.begin() as connection:
            at, attempt = submission_of(connection, submission, received_at)
            add_run(connection, at, submission.code, grade, took_ms)
            if receipt is not None:
                settle_receipt(connection, receipt, "graded", "", at)
            data = {"attempt": attempt, "points": grade.points, "file_sha256": submission.file_sha256}
            note(connection, "graded", submission.code, data)
        return attempt

    def adjust(self, assignment: Assignment, pid: str, adjustment: Adjustment) -> tuple[int, Row]:
        """Record what a person decided about the attempt that counts; return that attempt, and the grade that follows.

        Raises
        ------
        InputError
            When nothing of this student was graded, there is no such question, the points are out of range,
            or no reason is given.
        """
        check_adjustment(assignment, adjustment)
        with self._engine.begin() as connection:
            counting = effective_rows(connection, self._calendar, assignment.id, pid)
            at = newest_attempt(connection, assignment.id, pid, counting[0].attempt) if counting else None
            if at is None:
                hint = "See: vml gradebook show."
                raise InputError(pid, f"a student whose {assignment.id} was graded", "none", hint)
            add_adjustment(connection, at, adjustment)
            note(connection, "adjusted", pid, {"assignment": assignment.id, **asdict(adjustment)})
        return counting[0].attempt, self.row(assignment.id, pid)

    def row(self, assignment_id: str, pid: str) -> Row:
        """Return the effective grade of one student, who was graded."""
        with self._reader.connect() as connection:
            return effective_rows(connection, self._calendar, assignment_id, pid)[0]

    def note_unreadable(self, receipt: int, file_sha256: str, reason: str) -> None:
        """Record that a file came in that could not be graded."""
        with self._engine.begin() as connection:
            settle_receipt(connection, receipt, "unreadable", reason)
            note(connection, "unreadable", file_sha256, {"reason": reason})

    def rows(self, assignment_id: str | None = None) -> tuple[Row, ...]:
        """Return the effective grades of each student and assignment, by the terms of the course."""
        with self._reader.connect() as connection:
            return effective_rows(connection, self._calendar, assignment_id)

    # ------------------------------------------------------------ what happened

    def note(self, kind: str, subject: str, data: Mapping[str, Any]) -> None:
        """Add an event to the chain."""
        with self._engine.begin() as connection:
            note(connection, kind, subject, data)

    def event_count(self) -> int:
        """Return the length of the chain of events."""
        with self._reader.connect() as connection:
            return int(connection.scalar(select(func.count()).select_from(tables.event)) or 0)

    def file_hashes(self) -> tuple[str, ...]:
        """Return the SHA-256 of every file that came in."""
        from_submissions = select(tables.submission.c.file_sha256)
        with self._reader.connect() as connection:
            return tuple(sorted(connection.scalars(from_submissions.union(select(tables.receipt.c.file_sha256)))))

    def is_whole(self) -> bool:
        """Tell whether the chain of events is unbroken."""
        with self._reader.connect() as connection:
            return is_whole(connection)

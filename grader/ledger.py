"""The gradebook's small functions, each on an open connection: one line of a table in or out."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, func, insert, select
from sqlalchemy import event as engine_event

from assignments.model import Variant
from grader import tables
from grader.adjust import Adjustment, Standing, settle
from grader.errors import UnknownVariantError
from grader.events import note, now
from grader.grade import GRADER_VERSION
from grader.model import Grade, Outcome, Submission, overall
from grader.roster import Enrolled

_ALPHABET = "23456789abcdefghjkmnpqrstvwxyz"  # nothing that can be mistaken for something else
_PID_LENGTH = 8


@dataclass(frozen=True)
class Student:
    """A student: pseudonym for every file, name and address for the instructor's eyes."""

    pid: str
    name: str = ""
    email: str = ""


@dataclass(frozen=True)
class Row:
    """The effective grade of one student in one assignment.

    Attributes
    ----------
    outcomes : mapping of str to Outcome
        The least outcome of each question.
    mistakes : tuple of str
        Codes that alone explained something.
    reasons : tuple of str
        Why a person should look.
    attempts : int
        How many different contents came in; the newest counts.
    adjustments : tuple of str
        What a person decided, in words.
    """

    student: Student
    assignment_id: str
    attempt: int
    points: float
    out_of: float
    status: str
    graded_at: str
    outcomes: Mapping[str, Outcome] = field(default_factory=dict)
    mistakes: tuple[str, ...] = ()
    reasons: tuple[str, ...] = ()
    attempts: int = 1
    adjustments: tuple[str, ...] = ()

    @property
    def is_provisional(self) -> bool:
        """Whether points are counted that a person has still to confirm."""
        return Outcome.UNSURE in self.outcomes.values()


def open_engine(path: Path) -> Engine:
    """Open the database file: only for its owner, write-ahead log, foreign keys on, patient with other writers."""
    _keep_private(path)
    engine = create_engine(f"sqlite:///{path}", connect_args={"timeout": 10})

    @engine_event.listens_for(engine, "connect")
    def _settings(connection: Any, _: Any) -> None:
        connection.isolation_level = None  # SQLAlchemy says BEGIN itself, below
        for setting in ("journal_mode=WAL", "foreign_keys=ON", "busy_timeout=10000", "synchronous=NORMAL"):
            connection.execute(f"PRAGMA {setting}")

    @engine_event.listens_for(engine, "begin")
    def _begin(connection: Connection) -> None:
        # Take the write lock at once: two graders then queue instead of failing halfway.
        reads = connection.get_execution_options().get("reads", False)
        connection.exec_driver_sql("BEGIN" if reads else "BEGIN IMMEDIATE")

    return engine


def _keep_private(path: Path) -> None:
    """Names and answers lie in it: nobody else may read it, not even for a moment."""
    if not path.parent.is_dir():
        return
    os.close(os.open(path, os.O_RDWR | os.O_CREAT, 0o600))
    if path.stat().st_mode & 0o077:
        path.chmod(0o600)


def enrol(connection: Connection, person: Enrolled) -> Student:
    """Return a person of a class list, with a new random pseudonym on first sight."""
    identity = tables.student_identity
    kind, value = ("email", person.email) if person.email else ("name", person.name)
    same = (identity.c.kind == kind) & (func.lower(identity.c.value) == value.lower())
    at = connection.scalar(select(identity.c.student_id).where(same))
    if at is None:
        pid = "".join(secrets.choice(_ALPHABET) for _ in range(_PID_LENGTH))
        made = connection.execute(insert(tables.student).values(pid=pid, created_at=now()))
        at = made.inserted_primary_key[0]  # type: ignore[index]  # one row was inserted
        for kind_, value_ in (("name", person.name), ("email", person.email)):
            if value_:
                connection.execute(insert(identity).values(student_id=at, kind=kind_, value=value_))
        note(connection, "enrolled", pid, {})
    return students_of(connection)[int(at)]


def students_of(connection: Connection) -> dict[int, Student]:
    """Return all students by id."""
    identities: dict[int, dict[str, str]] = {}
    for row in connection.execute(select(tables.student_identity)).mappings():
        identities.setdefault(row["student_id"], {})[row["kind"]] = row["value"]
    return {
        row["id"]: Student(row["pid"], **identities.get(row["id"], {}))
        for row in connection.execute(select(tables.student).order_by(tables.student.c.id)).mappings()
    }


def variant_of(connection: Connection, variant: Variant) -> int:
    """Return the id of a variant, adding it on first sight."""
    found = connection.scalar(select(tables.variant.c.id).where(tables.variant.c.code == variant.code))
    if found is not None:
        return int(found)
    line = {
        "assignment_id": _get_or_add(
            connection, tables.assignment, slug=variant.assignment_id, title=variant.assignment_id
        ),
        "student_id": _get_or_add(connection, tables.student, pid=variant.student, created_at=now()),
        "code": variant.code,
        "issued_at": now(),
    }
    return _add(connection, tables.variant, line)


def _get_or_add(connection: Connection, table: Any, **line: str) -> int:
    name = next(iter(line))
    found = connection.scalar(select(table.c.id).where(table.c[name] == line[name]))
    return int(found) if found is not None else _add(connection, table, line)


def _add(connection: Connection, table: Any, line: Mapping[str, Any]) -> int:
    made = connection.execute(insert(table).values(**line))
    return int(made.inserted_primary_key[0])  # type: ignore[index]  # one row was inserted


def submission_of(connection: Connection, submission: Submission) -> tuple[int, int]:
    """Return id and attempt of a submission; the same content again is the same attempt."""
    table = tables.submission
    at = connection.scalar(select(tables.variant.c.id).where(tables.variant.c.code == submission.code))
    if at is None:
        raise UnknownVariantError(submission.name, submission.code)
    mine = select(table.c.id, table.c.attempt).where(table.c.variant_id == at)
    same = connection.execute(mine.where(table.c.content_sha256 == submission.content_sha256)).first()
    if same is not None:
        return int(same[0]), int(same[1])
    newest = connection.scalar(select(func.max(table.c.attempt)).where(table.c.variant_id == at)) or 0
    line = {
        "variant_id": at,
        "attempt": newest + 1,
        "received_at": now(),
        "file_sha256": submission.file_sha256,
        "content_sha256": submission.content_sha256,
        "original_name": submission.name,
    }
    return _add(connection, table, line), newest + 1


def add_run(connection: Connection, submission_id: int, code: str, grade: Grade) -> None:
    """Add a run with all its scores."""
    key = select(func.max(tables.answer_key.c.id)).join(tables.variant).where(tables.variant.c.code == code)
    line = {
        "submission_id": submission_id,
        "answer_key_id": connection.scalar(key),
        "grader_version": GRADER_VERSION,
        "created_at": now(),
        "points": grade.points,
        "out_of": grade.out_of,
        "status": grade.status,
        "result_json": json.dumps({"diagnosis": [asdict(d) for d in grade.diagnosis], "reasons": grade.reasons}),
    }
    run = _add(connection, tables.grade_run, line)
    for position, finding in enumerate(grade.findings):
        score = {
            "grade_run_id": run,
            "position": position,
            "question": finding.question_id,
            "aspect": finding.aspect,
            "outcome": finding.outcome.value,
            "points": finding.points,
            "out_of": finding.out_of,
            "mistake": finding.mistake,
            "carried": int(finding.carried),
            "detail_json": json.dumps({"message": finding.message, "numbers": dict(finding.numbers)}),
        }
        connection.execute(insert(tables.criterion_score).values(**score))


def effective_rows(connection: Connection, assignment_id: str | None) -> tuple[Row, ...]:
    """Return of each student and assignment what the newest run on the newest attempt says.

    Attempts are as old as the first arrival of their content, so an old file that is graded again stays old.
    """
    joined = tables.grade_run.join(tables.submission).join(tables.variant).join(tables.assignment)
    wanted = select(
        tables.grade_run, tables.submission.c.attempt, tables.assignment.c.slug, tables.variant.c.student_id
    ).select_from(joined)
    if assignment_id is not None:
        wanted = wanted.where(tables.assignment.c.slug == assignment_id)
    newest: dict[tuple[str, int], Any] = {}
    attempts: dict[tuple[str, int], set[int]] = {}
    for row in connection.execute(wanted.order_by(tables.submission.c.id, tables.grade_run.c.id)).mappings():
        whose = (row["slug"], row["student_id"])
        newest[whose] = row
        attempts.setdefault(whose, set()).add(row["submission_id"])
    people = students_of(connection)
    rows = (replace(_row(connection, people[w[1]], newest[w]), attempts=len(attempts[w])) for w in sorted(newest))
    return tuple(rows)


def newest_attempt(connection: Connection, assignment_id: str, pid: str) -> int | None:
    """Return the id of the attempt that counts, None when nothing was graded."""
    joined = tables.grade_run.join(tables.submission).join(tables.variant).join(tables.assignment).join(tables.student)
    mine = (tables.assignment.c.slug == assignment_id) & (tables.student.c.pid == pid)
    found = connection.scalar(select(func.max(tables.submission.c.id)).select_from(joined).where(mine))
    return None if found is None else int(found)


def _row(connection: Connection, student: Student, run: Mapping[str, Any]) -> Row:
    scores = tables.criterion_score
    by_question: dict[str, list[Any]] = {}
    mistakes = [
        code for d in json.loads(run["result_json"])["diagnosis"] if len(d["codes"]) == 1 for code in d["codes"]
    ]
    for score in connection.execute(select(scores).where(scores.c.grade_run_id == run["id"])).mappings():
        by_question.setdefault(score["question"], []).append(score)
    row = Row(
        student=student,
        assignment_id=run["slug"],
        attempt=run["attempt"],
        points=run["points"],
        out_of=run["out_of"],
        status=run["status"],
        graded_at=run["created_at"],
        outcomes={question: _overall(found) for question, found in by_question.items()},
        mistakes=tuple(dict.fromkeys(mistakes)),
        reasons=tuple(json.loads(run["result_json"])["reasons"]),
    )
    worth = {
        question: (sum(score["points"] for score in found), sum(score["out_of"] for score in found))
        for question, found in by_question.items()
    }
    return _settled(row, worth, adjustments_of(connection, run["submission_id"]))


def _settled(row: Row, worth: Mapping[str, tuple[float, float]], adjustments: Sequence[Adjustment]) -> Row:
    """Apply what a person decided; nothing is changed where nobody did."""
    if not adjustments:
        return row
    now_ = settle(Standing(row.points, worth, row.outcomes, row.reasons), adjustments)
    status = row.status if now_.reasons else "ok"
    words = tuple(map(str, adjustments))
    return replace(
        row, points=now_.points, outcomes=now_.outcomes, reasons=now_.reasons, status=status, adjustments=words
    )


def adjustments_of(connection: Connection, submission_id: int) -> tuple[Adjustment, ...]:
    """Return what a person decided about an attempt, oldest first."""
    table = tables.adjustment
    wanted = select(table).where(table.c.submission_id == submission_id).order_by(table.c.id)
    names = [one.name for one in fields(Adjustment)]
    return tuple(Adjustment(**{n: row[n] for n in names}) for row in connection.execute(wanted).mappings())


def add_adjustment(connection: Connection, submission_id: int, adjustment: Adjustment) -> None:
    """Add what a person decided."""
    _add(connection, tables.adjustment, {"submission_id": submission_id, **asdict(adjustment)})


def _overall(scores: Sequence[Any]) -> Outcome:
    outcomes = (Outcome(score["outcome"]) for score in scores)
    return overall(outcomes, sum(score["points"] for score in scores), sum(score["out_of"] for score in scores))

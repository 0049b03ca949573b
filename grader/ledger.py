"""The gradebook's small functions, each on an open connection: one line of a table in or out."""

from __future__ import annotations

import datetime as dt
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from sqlalchemy import Connection, func, insert, select

from assignments.model import Variant
from assignments.terms import Calendar
from grader import tables
from grader.adjust import Adjustment, Standing, settle
from grader.effective import Attempt, effective
from grader.enrolment import Student, students_of
from grader.errors import UnknownVariantError
from grader.events import now
from grader.grade import GRADER_VERSION
from grader.model import Grade, Outcome, Submission, overall


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
        How many different contents came in.
    decisions : tuple of Adjustment
        What a person decided, oldest first.
    earned : float
        Points of the attempt that counts, before lateness.
    late_share : float
        The part that lateness took off.
    ignored : tuple of int
        Attempts that do not count.
    run_id : int
        The run that speaks for the attempt.
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
    decisions: tuple[Adjustment, ...] = ()
    earned: float = 0.0
    late_share: float = 0.0
    ignored: tuple[int, ...] = ()
    run_id: int = 0

    @property
    def adjustments(self) -> tuple[str, ...]:
        """What a person decided, in words."""
        return tuple(map(str, self.decisions))

    @property
    def is_provisional(self) -> bool:
        """Whether points are counted that a person has still to confirm."""
        return Outcome.UNSURE in self.outcomes.values()


def variant_of(connection: Connection, variant: Variant, video_sha256: str) -> int:
    """Return the id of a variant, adding it on first sight with everything that was drawn: it is never drawn again."""
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
        "variant_json": json.dumps(asdict(variant), sort_keys=True),
        "video_sha256": video_sha256,
    }
    return _add(connection, tables.variant, line)


def _get_or_add(connection: Connection, table: Any, **line: str) -> int:
    name = next(iter(line))
    found = connection.scalar(select(table.c.id).where(table.c[name] == line[name]))
    return int(found) if found is not None else _add(connection, table, line)


def _add(connection: Connection, table: Any, line: Mapping[str, Any]) -> int:
    made = connection.execute(insert(table).values(**line))
    return int(made.inserted_primary_key[0])  # type: ignore[index]  # one row was inserted


def submission_of(connection: Connection, submission: Submission, received_at: str = "") -> tuple[int, int]:
    """Return id and attempt of a submission; the same content again is the same attempt.

    `received_at` is when it was handed in (ISO 8601 with a zone), now when nobody knows.
    """
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
        "received_at": received_at or now(),
        "file_sha256": submission.file_sha256,
        "content_sha256": submission.content_sha256,
        "original_name": submission.name,
    }
    return _add(connection, table, line), newest + 1


def add_run(connection: Connection, submission_id: int, code: str, grade: Grade, took_ms: int | None = None) -> None:
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
        "ms": took_ms,
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


def effective_rows(
    connection: Connection, calendar: Calendar, assignment_id: str | None = None, pid: str | None = None
) -> tuple[Row, ...]:
    """Return of each student and assignment what counts: a pure function of runs, decisions and terms.

    Of each attempt its newest run speaks. Attempts are as old as the first arrival of their content, so an old file
    that is graded again stays old.
    """
    joined = tables.grade_run.join(tables.submission).join(tables.variant).join(tables.assignment)
    wanted = select(
        tables.grade_run,
        tables.submission.c.attempt,
        tables.submission.c.received_at,
        tables.assignment.c.slug,
        tables.variant.c.student_id,
    ).select_from(joined)
    if assignment_id is not None:
        wanted = wanted.where(tables.assignment.c.slug == assignment_id)
    if pid is not None:
        student = select(tables.student.c.id).where(tables.student.c.pid == pid).scalar_subquery()
        wanted = wanted.where(tables.variant.c.student_id == student)
    newest: dict[tuple[str, int], dict[int, Any]] = {}
    for run in connection.execute(wanted.order_by(tables.submission.c.attempt, tables.grade_run.c.id)).mappings():
        newest.setdefault((run["slug"], run["student_id"]), {})[run["submission_id"]] = run
    people = students_of(connection)
    return tuple(
        _counted(connection, people[whose[1]], calendar, list(newest[whose].values())) for whose in sorted(newest)
    )


def _counted(connection: Connection, student: Student, calendar: Calendar, runs: Sequence[Any]) -> Row:
    """Return what counts of a student's attempts, given the newest run on each."""
    rows = {run["attempt"]: _row(connection, student, run) for run in runs}
    attempts = [
        Attempt(run["attempt"], dt.datetime.fromisoformat(run["received_at"]), rows[run["attempt"]].points)
        for run in runs
    ]
    result = effective(attempts, calendar.terms_of(runs[0]["slug"], student.pid))
    return replace(
        rows[result.attempt],
        attempts=len(attempts),
        earned=result.earned,
        late_share=result.late_share,
        points=result.points,
        ignored=result.ignored,
    )


def newest_attempt(connection: Connection, assignment_id: str, pid: str, number: int | None = None) -> int | None:
    """Return the id of a student's newest attempt, or of the one with this number; None when it was never graded."""
    joined = tables.grade_run.join(tables.submission).join(tables.variant).join(tables.assignment).join(tables.student)
    mine = (tables.assignment.c.slug == assignment_id) & (tables.student.c.pid == pid)
    if number is not None:
        mine &= tables.submission.c.attempt == number
    newest = select(tables.submission.c.id).select_from(joined).where(mine).order_by(tables.submission.c.attempt.desc())
    found = connection.scalar(newest.limit(1))
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
        earned=run["points"],
        out_of=run["out_of"],
        status=run["status"],
        run_id=run["id"],
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
    return replace(
        row,
        points=now_.points,
        outcomes=now_.outcomes,
        reasons=now_.reasons,
        status=status,
        decisions=tuple(adjustments),
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

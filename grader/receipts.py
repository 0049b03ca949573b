"""Receipts: every file that came in, whose it is as far as anybody knows, and what became of it."""

from __future__ import annotations

import datetime as dt
from dataclasses import dataclass
from typing import Any, Literal

from sqlalchemy import Connection, Select, insert, select, update

from assignments.terms import Terms
from grader import tables
from grader.events import note, now

Status = Literal["collected", "graded", "unreadable", "unmatched", "conflict", "settled", "too large"]

WAITING: tuple[Status, ...] = ("unreadable", "unmatched", "conflict", "too large")
"""What a person has to look at."""


@dataclass(frozen=True)
class Arrived:
    """A file that came in.

    Attributes
    ----------
    file_sha256 : str
        Its bytes lie in the inbox under this name.
    name : str
        As it was called.
    source : str
        A platform, or `files`.
    assignment : str
        "" when nobody knows yet.
    pid : str
        Whose it is, "" when nobody knows.
    received_at : str
        When it was handed in, ISO 8601 with a zone.
    lms_ref : str
        What the platform knows the file by.
    status, reason : str
    told_by : str
        The person who said whose it is; "" where workbook or platform did.
    """

    file_sha256: str
    name: str
    source: str
    received_at: str
    assignment: str = ""
    pid: str = ""
    lms_ref: str = ""
    status: Status = "collected"
    reason: str = ""
    told_by: str = ""


@dataclass(frozen=True)
class Receipt:
    """A file that came in, as the gradebook keeps it."""

    id: int
    arrived: Arrived


def handed_in_at(terms: Terms, told: dt.datetime | None, *, is_late: bool | None, moment: dt.datetime) -> dt.datetime:
    """Return when something counts as handed in.

    Most platforms do not say in a download when a file came. Then it counts as in time, unless the platform calls
    it late: a class that is collected the day after must not be late as a whole. What it calls late, and does not say
    when, counts as just late: nobody loses more because it is collected later.

    Parameters
    ----------
    terms : Terms
    told : datetime or None
        What the platform, or the person who collects, says.
    is_late : bool or None
        What the platform calls it, None when it does not say.
    moment : datetime
        When it is collected.
    """
    if told is not None:
        return told
    if terms.due is None:
        return moment
    just_late = terms.due + dt.timedelta(minutes=terms.late.grace_minutes, seconds=1)
    return min(moment, just_late if is_late else terms.due)


def add_receipt(connection: Connection, arrived: Arrived) -> int:
    """Add a receipt; the same bytes of the same name, and student and assignment where known, are the same receipt."""
    table = tables.receipt
    student = connection.scalar(select(tables.student.c.id).where(tables.student.c.pid == arrived.pid))
    same = (table.c.file_sha256 == arrived.file_sha256) & (table.c.original_name == arrived.name)
    if arrived.assignment:
        same &= table.c.assignment == arrived.assignment
    if student is not None:
        same &= table.c.student_id == student
    known = connection.scalar(select(table.c.id).where(same))
    if known is not None:
        return int(known)
    line = {
        "received_at": arrived.received_at,
        "collected_at": now(),
        "file_sha256": arrived.file_sha256,
        "original_name": arrived.name,
        "source": arrived.source,
        "lms_ref": arrived.lms_ref or None,
        "student_id": student,
        "assignment": arrived.assignment,
        "status": arrived.status,
        "reason": arrived.reason,
        "told_by": arrived.told_by,
    }
    made = connection.execute(insert(table).values(**line))
    note(connection, "received", arrived.file_sha256, {"source": arrived.source, "status": arrived.status})
    return int(made.inserted_primary_key[0])  # type: ignore[index]  # one row was inserted


def claim_receipt(connection: Connection, arrived: Arrived) -> Receipt:
    """Write down that a person said whose a file is, and return its receipt, as it is then.

    A file that came in before and waits, nobody knowing whose it is, keeps its receipt with the platform's date.
    """
    table = tables.receipt
    student = connection.scalar(select(tables.student.c.id).where(tables.student.c.pid == arrived.pid))
    waits = (table.c.file_sha256 == arrived.file_sha256) & (table.c.submission_id.is_(None))
    waits &= table.c.assignment.in_(["", arrived.assignment])
    waits &= table.c.student_id.is_(None) | (table.c.student_id == student)
    known = connection.scalar(select(table.c.id).where(waits).order_by(table.c.id).limit(1))
    at = add_receipt(connection, arrived) if known is None else int(known)
    told = {"student_id": student, "assignment": arrived.assignment, "told_by": arrived.told_by}
    connection.execute(update(table).where(table.c.id == at).values(status="collected", reason="", **told))
    said = {"assignment": arrived.assignment, "pid": arrived.pid, "who": arrived.told_by}
    note(connection, "told-whose", arrived.file_sha256, said)
    return _receipt(connection.execute(_with_pid().where(table.c.id == at)).mappings().one())


def _with_pid() -> Select[Any]:
    table = tables.receipt
    return select(table, tables.student.c.pid).select_from(
        table.outerjoin(tables.student, table.c.student_id == tables.student.c.id)
    )


def settle_receipt(
    connection: Connection, receipt: int, status: Status, reason: str = "", submission: int | None = None
) -> None:
    """Write what became of a file; what was graded is known to be its student's.

    Once it is graded because a person said whose it is, nobody has to look any more at other arrivals of the same
    bytes: whom a platform named, and what a person said before. Where the workbook said it, nobody has to look at what
    was collected for another assignment by mistake.
    """
    table = tables.receipt
    told: dict[str, object] = {"status": status, "reason": reason}
    if submission is not None:
        whose = _whose(connection, submission)
        told |= {"submission_id": submission, "student_id": whose[0], "assignment": whose[1]}
    connection.execute(update(table).where(table.c.id == receipt).values(**told))
    if submission is not None:
        _settle_others(connection, receipt)


def _settle_others(connection: Connection, graded: int) -> None:
    table = tables.receipt
    one = connection.execute(select(table).where(table.c.id == graded)).mappings().one()
    same = table.c.file_sha256 == one["file_sha256"]
    if one["told_by"]:
        refused = (table.c.status == "unreadable") & (table.c.told_by != "")
        same &= (table.c.assignment == one["assignment"]) & ((table.c.status == "conflict") | refused)
    else:
        same &= table.c.assignment.not_in(["", one["assignment"]]) & table.c.status.in_(WAITING)
    others = connection.scalars(select(table.c.id).where(same)).all()
    if others:
        connection.execute(update(table).where(table.c.id.in_(others)).values(status="settled"))
        note(connection, "settled", one["file_sha256"], {"receipts": list(others), "who": one["told_by"]})


def _whose(connection: Connection, submission: int) -> tuple[int, str]:
    joined = tables.submission.join(tables.variant).join(tables.assignment)
    wanted = select(tables.variant.c.student_id, tables.assignment.c.slug).select_from(joined)
    row = connection.execute(wanted.where(tables.submission.c.id == submission)).one()
    return int(row[0]), str(row[1])


def receipts_with(connection: Connection, status: Status, assignment: str = "") -> tuple[Receipt, ...]:
    """Return receipts in the order in which the files were handed in."""
    table = tables.receipt
    wanted = _with_pid().where(table.c.status == status).order_by(table.c.received_at, table.c.id)
    if assignment:
        wanted = wanted.where(table.c.assignment == assignment)
    return tuple(_receipt(row) for row in connection.execute(wanted).mappings())


def receipt_of(connection: Connection, assignment: str, pid: str, attempt: int, source: str = "") -> Receipt | None:
    """Return the newest receipt of a student's attempt, of one source where it is named; None where there is none."""
    table = tables.receipt
    joined = table.join(tables.submission, table.c.submission_id == tables.submission.c.id).join(
        tables.student, table.c.student_id == tables.student.c.id
    )
    wanted = (
        select(table, tables.student.c.pid)
        .select_from(joined)
        .where((table.c.assignment == assignment) & (tables.student.c.pid == pid))
        .where(tables.submission.c.attempt == attempt)
        .order_by(table.c.id.desc())
    )
    if source:
        wanted = wanted.where(table.c.source == source)
    row = connection.execute(wanted.limit(1)).mappings().first()
    return None if row is None else _receipt(row)


def knows_file(connection: Connection, sha256: str, assignment: str, pid: str = "") -> str:
    """Return what became of these bytes when they came in before, from one student where one is named; "" if never."""
    table = tables.receipt
    same = (table.c.file_sha256 == sha256) & (table.c.assignment == assignment)
    if pid:
        same &= tables.student.c.pid == pid
    wanted = select(table.c.status).select_from(
        table.outerjoin(tables.student, table.c.student_id == tables.student.c.id)
    )
    return str(connection.scalar(wanted.where(same).order_by(table.c.id.desc()).limit(1)) or "")


def _receipt(row: object) -> Receipt:
    line = dict(row)  # type: ignore[call-overload]  # a row's mapping
    return Receipt(
        line["id"],
        Arrived(
            file_sha256=line["file_sha256"],
            name=line["original_name"],
            source=line["source"],
            received_at=line["received_at"],
            assignment=line["assignment"],
            pid=line["pid"] or "",
            lms_ref=line["lms_ref"] or "",
            status=line["status"],
            reason=line["reason"],
            told_by=line["told_by"],
        ),
    )

"""What was found when a class was compared: kept in the gradebook, only ever added to."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sqlalchemy import Connection, func, insert, select

from assignments import key as keys
from assignments.model import AnswerKey
from grader import tables
from grader.events import now
from grader.integrity import Evidence


@dataclass(frozen=True)
class Newest:
    """The newest workbook of one student: under which hash its bytes are kept, and how it was called."""

    pid: str
    file_sha256: str
    name: str


def newest_files(connection: Connection, assignment_id: str) -> tuple[Newest, ...]:
    """Return the newest attempt of every student who handed in."""
    joined = tables.submission.join(tables.variant).join(tables.assignment).join(tables.student)
    wanted = (
        select(tables.student.c.pid, tables.submission.c.file_sha256, tables.submission.c.original_name)
        .select_from(joined)
        .where(tables.assignment.c.slug == assignment_id)
        .order_by(tables.submission.c.attempt)
    )
    newest = {row[0]: Newest(*row) for row in connection.execute(wanted)}
    return tuple(newest[pid] for pid in sorted(newest))


def keys_of_class(connection: Connection, assignment_id: str) -> Mapping[str, AnswerKey]:
    """Return the newest key of every student by pseudonym."""
    joined = tables.answer_key.join(tables.variant).join(tables.assignment).join(tables.student)
    wanted = (
        select(tables.student.c.pid, tables.answer_key.c.key_json)
        .select_from(joined)
        .where(tables.assignment.c.slug == assignment_id)
        .order_by(tables.answer_key.c.id)
    )
    return {pid: keys.from_json(json.loads(text)) for pid, text in connection.execute(wanted)}


def add_findings(connection: Connection, assignment_id: str, found: Iterable[Evidence]) -> int:
    """Add what is not known yet; return how much that was."""
    at = connection.scalar(select(tables.assignment.c.id).where(tables.assignment.c.slug == assignment_id))
    ids = {row.pid: row.id for row in connection.execute(select(tables.student.c.pid, tables.student.c.id))}
    known = {_what(item) for item in findings_of(connection, assignment_id)}
    fresh = {_what(item): item for item in found if _what(item) not in known}
    for item in fresh.values():
        line = {
            "assignment_id": at,
            "student_a_id": ids[item.pid],
            "student_b_id": ids.get(item.other),
            "method": item.method,
            "statistic": item.statistic,
            "false_positive_rate": item.false_positive_rate,
            "evidence": item.words,
            "found_at": now(),
        }
        connection.execute(insert(tables.integrity_finding).values(**line))
    return len(fresh)


def _what(item: Evidence) -> tuple[str, str, str, str]:
    return item.pid, item.other, item.method, item.words


def findings_of(connection: Connection, assignment_id: str) -> tuple[Evidence, ...]:
    """Return what was found in an assignment, oldest first."""
    table = tables.integrity_finding
    one, other = tables.student.alias("one"), tables.student.alias("other")
    joined = (
        table.join(tables.assignment, table.c.assignment_id == tables.assignment.c.id)
        .join(one, table.c.student_a_id == one.c.id)
        .outerjoin(other, table.c.student_b_id == other.c.id)
    )
    wanted = (
        select(
            one.c.pid,
            func.coalesce(other.c.pid, ""),
            table.c.method,
            table.c.statistic,
            table.c.false_positive_rate,
            table.c.evidence,
        )
        .select_from(joined)
        .where(tables.assignment.c.slug == assignment_id)
        .order_by(table.c.id)
    )
    return tuple(Evidence(*row) for row in connection.execute(wanted))

"""What the grades of a class rest on, read back from the gradebook: findings of the runs that count, and their keys."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

from sqlalchemy import Connection, select

from grader import tables
from grader.gradebook import Gradebook, Row
from grader.items import Evidence
from grader.model import Finding, Outcome


def evidence_in(book: Gradebook, rows: Iterable[Row]) -> dict[str, Evidence]:
    """Return the evidence behind effective grades of one assignment, by pseudonym."""
    with book.reading() as connection:
        return {row.student.pid: _evidence(connection, row.run_id) for row in rows if row.run_id}


def _evidence(connection: Connection, run_id: int) -> Evidence:
    scores, runs, keys = tables.criterion_score, tables.grade_run, tables.answer_key
    wanted = select(scores).where(scores.c.grade_run_id == run_id).order_by(scores.c.position)
    findings = tuple(_finding(score) for score in connection.execute(wanted).mappings())
    joined = runs.join(keys, runs.c.answer_key_id == keys.c.id)
    text = connection.scalar(select(keys.c.key_json).select_from(joined).where(runs.c.id == run_id))
    key = json.loads(text) if text else {}
    return Evidence(findings, _known(key.get("values", {})), _known(key.get("expected_sd", {})))


def _finding(score: Any) -> Finding:
    detail = json.loads(score["detail_json"])
    return Finding(
        question_id=score["question"],
        aspect=score["aspect"],
        outcome=Outcome(score["outcome"]),
        points=score["points"],
        out_of=score["out_of"],
        message=detail["message"],
        numbers=detail["numbers"],
        mistake=score["mistake"],
        carried=bool(score["carried"]),
    )


def _known(values: Mapping[str, float | None]) -> dict[str, float]:
    """Return the numbers of a kept key that are known: an unknown one was kept as null."""
    return {name: value for name, value in values.items() if value is not None}

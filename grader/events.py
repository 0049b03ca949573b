"""What happened to a gradebook, one line each, chained by hash so that a changed or missing line shows."""

from __future__ import annotations

import datetime as dt
import hashlib
import json
from collections.abc import Mapping
from typing import Any

from sqlalchemy import Connection, insert, select

from grader.tables import event

_START = "0" * 64


def now() -> str:
    """Return the time in UTC, as it is stored."""
    return dt.datetime.now(dt.UTC).isoformat(timespec="milliseconds")


def note(connection: Connection, kind: str, subject: str, data: Mapping[str, Any]) -> None:
    """Add an event, in the same transaction as what it tells of."""
    previous = connection.scalar(select(event.c.hash).order_by(event.c.id.desc()).limit(1)) or _START
    line = {"at": now(), "kind": kind, "subject": subject, "data_json": json.dumps(data, sort_keys=True)}
    connection.execute(insert(event).values(**line, previous=previous, hash=_hash(previous, line)))


def is_whole(connection: Connection) -> bool:
    """Tell whether no event was changed, added in between, or taken out (except at the end)."""
    previous = _START
    for row in connection.execute(select(event).order_by(event.c.id)).mappings():
        line = {name: row[name] for name in ("at", "kind", "subject", "data_json")}
        if row["previous"] != previous or row["hash"] != _hash(previous, line):
            return False
        previous = row["hash"]
    return True


def _hash(previous: str, line: Mapping[str, str]) -> str:
    return hashlib.sha256((previous + json.dumps(line, sort_keys=True)).encode()).hexdigest()

"""The class list: a table of names and e-mail addresses, as a person or a learning platform writes it."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from grader.errors import RosterError
from vml_course.errors import FileMissingError

_LARGEST_BYTES = 5_000_000


@dataclass(frozen=True)
class Enrolled:
    """One line of a roster."""

    name: str
    email: str


def read_roster(path: Path) -> tuple[Enrolled, ...]:
    """Read a CSV with the columns `name` and `email` (comma, semicolon or tab).

    Raises
    ------
    FileMissingError, RosterError
    """
    if not path.is_file():
        hint = "Write one with the columns name,email."
        raise FileMissingError(path.name, "a roster", "no such file", hint)
    if path.stat().st_size > _LARGEST_BYTES:
        raise RosterError(path.name, "a class list", "a file of several megabytes")
    return _enrolled(path.name, _text(path))


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        return path.read_text(encoding="cp1252", errors="replace")


def _enrolled(name: str, text: str) -> tuple[Enrolled, ...]:
    first = text.partition("\n")[0]
    delimiter = max(",;\t", key=first.count)
    rows = csv.DictReader(io.StringIO(text), delimiter=delimiter)
    columns = {(column or "").strip().lower(): column for column in rows.fieldnames or ()}
    if not {"name", "email"} <= columns.keys():
        raise RosterError(name, "the columns name,email", ", ".join(columns) or "an empty file")
    found = []
    for row in rows:
        cells = {column: (row[columns[column]] or "").strip() for column in ("name", "email")}
        _check_row(f"{name}, line {rows.line_num}", cells, row.get(None))
        if any(cells.values()):
            found.append(Enrolled(" ".join(cells["name"].split()), cells["email"]))
    if not found:
        raise RosterError(name, "at least one student", "the columns only", "Write one line for each: name,email.")
    return _distinct(name, found)


def _check_row(where: str, cells: Mapping[str, str], beyond: object) -> None:
    """Refuse a line without a name, and one with more cells than columns: a name with a comma was not quoted."""
    if isinstance(beyond, list) and any(beyond):
        hint = 'Put a name that holds a comma in quotes: "Doe, Jane",jane@example.org'
        raise RosterError(where, "as many cells as columns", "more", hint)
    if cells["email"] and not cells["name"]:
        raise RosterError(where, "a name", f"only {cells['email'][:60]!r}")
    if cells["email"] and "@" not in cells["email"]:
        hint = "Does the name hold a comma? Put it in quotes."
        raise RosterError(where, "an e-mail address", repr(cells["email"][:60]), hint)


def _distinct(name: str, students: list[Enrolled]) -> tuple[Enrolled, ...]:
    seen: set[str] = set()
    for student in students:
        who = (student.email or student.name).casefold()
        if who in seen:
            raise RosterError(name, "each student once", f"{student.email or student.name!r} twice")
        seen.add(who)
    return tuple(students)

"""The class list, as a person or a learning platform writes it: Canvas, Moodle, Blackboard, Gradescope, plain CSV.

Which it is shows in the headings. Headings in other languages are understood by their content: the column that
holds e-mail addresses, the columns of names beside it.
"""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from grader.errors import RosterError
from grader.read.sniff import TEXT_TABLE, UNKNOWN, kind_of
from vml_course.errors import FileMissingError

_LARGEST_BYTES = 5_000_000
_LONGEST_CELL = 200

_EXPECTED = "a class list, a table of comma-separated values"
_SAVE_AS_CSV = "Export the list from the platform as CSV, or save it as CSV."

STRONG = ("email", "sis_id", "login", "canvas_id", "moodle_participant")
"""Kinds of identity that belong to one person only; a name may belong to several."""

_HEADINGS: Mapping[str, tuple[str, ...]] = {
    "name": ("name", "full name", "student", "student name", "vollständiger name", "nom complet", "nombre completo"),
    "first": ("first name", "firstname", "given name", "vorname", "prénom", "nombre", "nome", "voornaam"),
    "last": ("last name", "lastname", "surname", "family name", "nachname", "nom", "apellido(s)", "apellidos",
             "apellido", "cognome", "achternaam"),
    "email": ("email", "e-mail", "email address", "e-mail address", "e-mail-adresse", "mail", "adresse de courriel",
              "dirección de correo", "correo electrónico", "indirizzo email"),
    "sis_id": ("sis user id", "id number", "idnumber", "student id", "sid", "matrikelnummer", "id-nummer",
               "numéro d'identification", "número de id"),
    "login": ("sis login id", "username", "login", "user name", "anmeldename", "nom d'utilisateur"),
    "participant": ("identifier", "id", "id.", "identifiant", "identificador", "identificatore"),
}  # fmt: skip
_PARTICIPANT = re.compile(r"^\D*?\s?(\d{1,12})$")
_NOBODY = re.compile(r"\s*(points possible|student, test|test student)\s*", re.IGNORECASE)


@dataclass(frozen=True)
class Enrolled:
    """One line of a class list; `ids` holds what the platform knows the student by, by kind."""

    name: str
    email: str
    ids: Mapping[str, str] = field(default_factory=dict)

    @property
    def strong(self) -> dict[str, str]:
        """Everything that belongs to this person only, by kind."""
        return {**({"email": self.email} if self.email else {}), **self.ids}


def read_roster(path: Path) -> tuple[Enrolled, ...]:
    """Read a class list (CSV with comma, semicolon or tab; UTF-8, UTF-16 or Windows-1252).

    Raises
    ------
    FileMissingError, RosterError
    """
    if not path.is_file():
        hint = "Write one with the columns name,email."
        raise FileMissingError(path.name, "a roster", "no such file", hint)
    if path.stat().st_size > _LARGEST_BYTES:
        raise RosterError(path.name, "a class list", "a file of several megabytes")
    data = path.read_bytes()
    kind = kind_of(data)
    if data and kind not in {TEXT_TABLE, UNKNOWN}:  # a list of names alone has no sign of its own
        raise RosterError(path.name, _EXPECTED, kind, _SAVE_AS_CSV)
    return parse_roster(path.name, decoded(data))


def decoded(data: bytes) -> str:
    """Return the text of a CSV in any of the encodings that platforms and Excel write."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def parse_roster(name: str, text: str) -> tuple[Enrolled, ...]:
    """Read the text of a class list; `name` is for messages.

    Raises
    ------
    RosterError
    """
    headings, rows = _table(name, text)
    columns = _columns(headings, [cells for _, cells in rows])
    if not {"name", "first", "last"} & columns.keys():
        raise RosterError(name, "the columns name,email", ", ".join(headings) or "an empty file")
    found = []
    for line, cells in rows:
        if not _names_nobody(cells, columns):
            found.append(_student(f"{name}, line {line}", cells, columns, len(headings)))
    if not found:
        raise RosterError(name, "at least one student", "the columns only", "Write one line for each: name,email.")
    return _distinct(name, found)


def folded(text: str) -> str:
    """Return a text as it is compared: one way to write accents, no case, single spaces."""
    return " ".join(unicodedata.normalize("NFC", text).casefold().split())


def _table(name: str, text: str) -> tuple[list[str], list[tuple[int, list[str]]]]:
    if "\0" in text:
        raise RosterError(name, _EXPECTED, "a file that is no text", _SAVE_AS_CSV)
    first = next(iter(text.splitlines()), "")
    lines = io.StringIO(text, newline="")  # any line end, that of old Macs too
    reader = csv.reader(lines, delimiter=max(",;\t", key=first.count))
    try:
        rows = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader]
    except csv.Error as error:
        got = f"something else in line {reader.line_num}"  # a cell without an end, mostly
        raise RosterError(name, _EXPECTED, got, _SAVE_AS_CSV) from error
    return (rows[0][1], rows[1:]) if rows else ([], [])


# ---------------------------------------------------------------- which column is which


def _columns(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> dict[str, int]:
    """Return the column of each kind, by heading first, by content where no heading is known."""
    words = [folded(heading.strip('"')) for heading in headings]
    found: dict[str, int] = {}
    for kind, known in _HEADINGS.items():
        at = next((words.index(word) for word in known if word in words), None)
        if at is not None and at not in found.values():
            found[kind] = at
    if "email" not in found:
        at = next((k for k in range(len(words)) if _holds_addresses(rows, k)), None)
        if at is not None and at not in found.values():
            found["email"] = at
    if "participant" in found and {"name", "last"} & found.keys() and "section" in words:  # Canvas: the user's number
        found["canvas_id"] = found.pop("participant")
    return found


def _holds_addresses(rows: Iterable[Sequence[str]], column: int) -> bool:
    cells = [row[column] for row in rows if column < len(row) and row[column]]
    return bool(cells) and sum("@" in cell for cell in cells) >= 0.8 * len(cells)


# ---------------------------------------------------------------- one student


def _names_nobody(cells: Sequence[str], columns: Mapping[str, int]) -> bool:
    """Tell whether a row is empty, or one of those that Canvas writes beside students.

    Its points possible and its test student are called so; "Manual Posting" and "(read only)" stand below assignments.
    """
    if not any(cells) or _NOBODY.fullmatch(cells[0]):
        return True
    return "canvas_id" in columns and not any(cells[at] for at in columns.values() if at < len(cells))


def _student(where: str, cells: Sequence[str], columns: Mapping[str, int], width: int) -> Enrolled:
    if any(cells[width:]):
        hint = 'Put a name that holds a comma in quotes: "Doe, Jane",jane@example.org'
        raise RosterError(where, "as many cells as columns", "more", hint)
    said = {kind: _cell(where, cells, at) for kind, at in columns.items()}
    name = said.get("name") or " ".join(filter(None, (said.get("first"), said.get("last"))))
    login = said.get("login", "")
    email = said.get("email", "") or (login if "@" in login else "")  # a login is often the address
    if not name:
        raise RosterError(where, "a name", f"only {(email or next(filter(None, cells)))[:60]!r}")
    if email and "@" not in email:
        hint = "Does the name hold a comma? Put it in quotes."
        raise RosterError(where, "an e-mail address", repr(email[:60]), hint)
    ids = {kind: said[kind] for kind in ("sis_id", "login", "canvas_id") if said.get(kind)}
    participant = _PARTICIPANT.fullmatch(said.get("participant", ""))
    if participant:
        ids["moodle_participant"] = participant[1]
    return Enrolled(" ".join(name.split()), email, ids)


def _cell(where: str, cells: Sequence[str], at: int) -> str:
    text = cells[at] if at < len(cells) else ""
    if len(text) > _LONGEST_CELL or any(unicodedata.category(c) == "Cc" for c in text):
        raise RosterError(where, f"a line of at most {_LONGEST_CELL} characters in a cell", repr(text[:40]))
    return text


def _distinct(name: str, students: list[Enrolled]) -> tuple[Enrolled, ...]:
    """Refuse a person who stands there twice; two people of one name are told apart by anything else."""
    seen: set[tuple[str, str]] = set()
    for student in students:
        known = student.strong or {"name": student.name}
        for kind, value in known.items():
            who = (kind, folded(value))
            if who in seen:
                raise RosterError(name, "each student once", f"{value!r} twice")
            seen.add(who)
    return tuple(students)

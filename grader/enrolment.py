"""Taking a class list into the gradebook: who is known, who is new, who is no longer on it."""

from __future__ import annotations

import secrets
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from sqlalchemy import Connection, insert, select, update

from grader import tables
from grader.errors import RosterError
from grader.events import note, now
from grader.roster import STRONG, Enrolled, folded

_ALPHABET = "23456789abcdefghjkmnpqrstvwxyz"  # nothing that can be mistaken for something else
_PID_LENGTH = 8
ACTIVE, DROPPED = "active", "dropped"

Status = Literal["new", "known", "linked", "not listed"]


@dataclass(frozen=True)
class Student:
    """A student: pseudonym for every file, name and address for the instructor's eyes.

    `ids` holds what the learning platform knows the student by, by kind; `status` is `active` or `dropped`.
    """

    pid: str
    name: str = ""
    email: str = ""
    ids: Mapping[str, str] | None = None
    status: str = ACTIVE


@dataclass(frozen=True)
class Arrival:
    """What became of one line of a class list, or of a student who is not on it.

    `status` is `new`, `known` (by something that is this person's only), `linked` (known by name alone, where
    nothing speaks against it), or `not listed` (in the gradebook, not in the file; nothing is changed).
    """

    student: Student
    status: Status


def enrol_all(
    connection: Connection, people: Sequence[Enrolled], source: str = "roster", *, bring_back: bool = True
) -> tuple[Arrival, ...]:
    """Take in everybody on a class list, and tell of those who are not on it.

    Who was dropped and stands on the list is active again where `bring_back` says so.

    Raises
    ------
    RosterError
        When a line fits two students of the gradebook.
    """
    directory = _Directory(students_of(connection))
    arrivals: list[tuple[int, Status]] = []
    names = [_as_spoken(person.name) for person in people]
    for person in people:
        known, by_name = directory.find(person, source, is_alone=names.count(_as_spoken(person.name)) == 1)
        at = _add(connection) if known is None else known
        _remember(connection, at, person)
        arrivals.append((at, "new" if known is None else "linked" if by_name else "known"))
        if known is None:
            directory.add(at, person)
    for at in {at for at, _ in arrivals} & directory.dropped if bring_back else ():
        set_status(connection, directory.dropped_pid(at), ACTIVE)
    after = students_of(connection)
    listed = {at for at, _ in arrivals}
    missing = ((at, student) for at, student in after.items() if at not in listed and student.status == ACTIVE)
    return (
        *(Arrival(after[at], status) for at, status in arrivals),
        *(Arrival(student, "not listed") for _, student in missing),
    )


def students_of(connection: Connection) -> dict[int, Student]:
    """Return all students by id, in the order in which they came."""
    identities: dict[int, dict[str, str]] = {}
    for row in connection.execute(select(tables.student_identity)).mappings():
        identities.setdefault(row["student_id"], {})[row["kind"]] = row["value"]
    found = {}
    for row in connection.execute(select(tables.student).order_by(tables.student.c.id)).mappings():
        ids = identities.get(row["id"], {})
        name, email = ids.pop("name", ""), ids.pop("email", "")
        found[row["id"]] = Student(row["pid"], name, email, ids, row["status"])
    return found


def set_status(connection: Connection, pid: str, status: str) -> None:
    """Mark a student as active or dropped; grades stay."""
    connection.execute(update(tables.student).where(tables.student.c.pid == pid).values(status=status))
    note(connection, status, pid, {})


def forget(connection: Connection, pids: Iterable[str]) -> int:
    """Remove the names and addresses of these students, and nothing else; return of how many."""
    at = select(tables.student.c.id).where(tables.student.c.pid.in_(list(pids)))
    gone = set(
        connection.scalars(
            select(tables.student_identity.c.student_id).where(tables.student_identity.c.student_id.in_(at))
        )
    )
    connection.execute(tables.student_identity.delete().where(tables.student_identity.c.student_id.in_(gone)))
    note(connection, "forgotten", "roster", {"students": len(gone)})
    return len(gone)


class _Directory:
    """Who is known, by everything that is known of them."""

    def __init__(self, students: Mapping[int, Student]) -> None:
        self._by_strong: dict[tuple[str, str], int] = {}
        self._by_name: dict[str, list[int]] = {}
        self._strong: dict[int, dict[str, str]] = {}
        self._pids = {at: student.pid for at, student in students.items()}
        self.dropped = {at for at, student in students.items() if student.status == DROPPED}
        for at, student in students.items():
            self.add(at, Enrolled(student.name, student.email, student.ids or {}))

    def dropped_pid(self, at: int) -> str:
        """Return the pseudonym of a student who was known before."""
        return self._pids[at]

    def add(self, at: int, person: Enrolled) -> None:
        """Add a student."""
        self._strong[at] = dict(person.strong)
        self._by_name.setdefault(_as_spoken(person.name), []).append(at)
        for kind, value in person.strong.items():
            self._by_strong[kind, folded(value)] = at

    def find(self, person: Enrolled, source: str, *, is_alone: bool) -> tuple[int | None, bool]:
        """Return who this is, and whether only the name says so; None for somebody new.

        A number that Moodle gives for one assignment says nothing about who a student is in another one.
        """
        lasting = {kind: value for kind, value in person.strong.items() if kind != "moodle_participant"}
        fits = {self._by_strong.get((kind, folded(value))) for kind, value in lasting.items()} - {None}
        if len(fits) > 1:
            hint = "Two students have been taken for one or one for two: see vml roster list."
            raise RosterError(source, f"one student for {person.name!r}", f"{len(fits)} of the gradebook", hint)
        if fits:
            return fits.pop(), False
        same = self._by_name.get(_as_spoken(person.name), [])
        if len(same) == 1 and is_alone and not self._contradicts(same[0], lasting):
            return same[0], True
        return None, False

    def _contradicts(self, at: int, lasting: Mapping[str, str]) -> bool:
        known = self._strong[at]
        return any(kind in known and folded(known[kind]) != folded(value) for kind, value in lasting.items())


def _as_spoken(name: str) -> str:
    """Return a name for comparison; platforms write `Doe, Jane` or `Jane Doe`.

    >>> _as_spoken("Doe, Jane") == _as_spoken("Jane  Doe")
    True
    """
    last, comma, first = name.partition(",")
    is_turned = bool(comma and first.strip()) and "," not in first
    return folded(f"{first} {last}" if is_turned else name)


def _add(connection: Connection) -> int:
    pid = "".join(secrets.choice(_ALPHABET) for _ in range(_PID_LENGTH))
    made = connection.execute(insert(tables.student).values(pid=pid, created_at=now(), status=ACTIVE))
    note(connection, "enrolled", pid, {})
    return int(made.inserted_primary_key[0])  # type: ignore[index]  # one row was inserted


def _remember(connection: Connection, at: int, person: Enrolled) -> None:
    """Keep what a line says of a student; what it does not say stays as it was known."""
    table = tables.student_identity
    known = {
        row["kind"]: row["value"]
        for row in connection.execute(select(table).where(table.c.student_id == at)).mappings()
    }
    said = {"name": person.name, **{kind: person.strong[kind] for kind in STRONG if kind in person.strong}}
    for kind, value in said.items():
        if kind not in known:
            connection.execute(insert(table).values(student_id=at, kind=kind, value=value))
        elif known[kind] != value:
            mine = (table.c.student_id == at) & (table.c.kind == kind)
            connection.execute(update(table).where(mine).values(value=value))

"""Whose row of a platform's table it is: by what belongs to one person only, by name where that is one person's."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from grader.enrolment import Student
from grader.roster import folded

TWO_STUDENTS = "its numbers belong to two students of the gradebook: see vml roster list"
SAME_NAME = "the name alone does not say which student it is: import the class list of this platform"
NOBODY = "nobody of the gradebook: import the class list of this platform"
OTHER_NUMBERS = "the student of this name has other numbers"


@dataclass(frozen=True)
class Asked:
    """What a row says of a student: `ids` are pairs of kind and value, a login may be an address."""

    name: str
    ids: tuple[tuple[str, str], ...] = ()


class Directory:
    """The students of a course, by everything that is known of them.

    Parameters
    ----------
    students : iterable of Student
    asked : iterable of Asked
        All rows of the table: a name that stands there twice is nobody's.
    """

    def __init__(self, students: Iterable[Student], asked: Iterable[Asked]) -> None:
        self._by_id: dict[tuple[str, str], list[Student]] = {}
        self._by_name: dict[str, list[Student]] = {}
        for student in students:
            self._by_name.setdefault(folded(student.name), []).append(student)
            for kind, value in _ids_of(student).items():
                self._by_id.setdefault((kind, folded(value)), []).append(student)
        self._names_asked = [_plain_name(one.name) for one in asked]

    def find(self, asked: Asked) -> Student | str:
        """Return whose row it is, or why nobody can say."""
        found = {s.pid: s for kind, value in asked.ids if value for s in self._by_id.get((kind, folded(value)), [])}
        if len(found) > 1:
            return TWO_STUDENTS
        if found:
            return next(iter(found.values()))
        return self._by_its_name(asked)

    def _by_its_name(self, asked: Asked) -> Student | str:
        name = _plain_name(asked.name)
        same = self._by_name.get(name, []) if name else []
        if not same:
            return NOBODY
        if len(same) > 1 or self._names_asked.count(name) > 1:
            return SAME_NAME
        return OTHER_NUMBERS if _contradicts(same[0], asked.ids) else same[0]


def _ids_of(student: Student) -> dict[str, str]:
    return {**(student.ids or {}), **({"email": student.email} if student.email else {})}


def _contradicts(student: Student, ids: Sequence[tuple[str, str]]) -> bool:
    """Tell whether everything of one kind that a row says is another's: a login column may hold addresses."""
    known: Mapping[str, str] = _ids_of(student)
    return any(value and kind in known and ("@" in value) == ("@" in known[kind]) for kind, value in ids)


def _plain_name(name: str) -> str:
    """Return a name as it is compared.

    >>> _plain_name("Doe,  Jane")
    'jane doe'
    """
    last, comma, first = name.partition(",")
    return folded(f"{first} {last}" if comma else name)

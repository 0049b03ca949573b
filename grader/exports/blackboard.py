"""Blackboard: fills the grade centre's own download, to be uploaded again.

A student goes by the username, a column by the number in its heading; an unknown heading would make a new column of
text that counts in no total. So nothing is added to its own file: tab-separated UTF-16 that is called `.xls`, or CSV.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from grader.filling.cells import TextTable
from grader.filling.columns import chosen_column
from grader.filling.fill import Column, fill
from grader.filling.job import Export, Job, Line, template_of
from grader.filling.numbers import number_in, uses_comma
from grader.filling.people import Asked
from grader.roster import folded
from vml_course.errors import TableError

_EXPECTED = "the file that Blackboard's grade centre downloads"
_COLUMN = re.compile(r"\s*(?P<title>.*?)\s*\[(?P<about>[^\[\]]*)\]\s*\|\s*(?P<id>\d+)\s*")
_NUMBER = re.compile(r"\d+(?:[.,]\d+)?")
_WITHOUT_SCORE = frozenset({"", "-", "needs grading", "needs grading()"})

_LOGIN = frozenset({"username", "benutzername", "nom d'utilisateur", "nombre de usuario", "user name"})
_NUMBER_OF_PERSON = frozenset({"student id", "studenten-id", "id étudiant", "id de estudiante"})


@dataclass(frozen=True)
class _Heading:
    """A heading such as `Collision lab [Total Pts: 10 Score] |123456`."""

    title: str
    out_of: float | None


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Fill the assignment's column in Blackboard's own download.

    Raises
    ------
    InputError, TableError
        When the template is missing, is no such download, or has no column to fill.
    """
    template = template_of(job, _EXPECTED)
    table = TextTable(template.name, template.data)
    headings = _headings(table)
    at = chosen_column(table, {k: heading.title for k, heading in headings.items()}, job)
    numbers = (table.get(row, k) for row in range(1, len(table)) for k in headings)
    column = Column(at, headings[at].out_of, uses_comma(numbers, job.decimal), _WITHOUT_SCORE)
    lines = fill(table, column, dict(_people(table)), job)
    path.write_bytes(table.encoded())
    return lines


EXPORT = Export(
    write,
    "",  # as the template's: Blackboard tells tabs from commas by it
    template=_EXPECTED,
    hint="Take it in with Work Offline > Upload.",
)


def _headings(table: TextTable) -> Mapping[int, _Heading]:
    """Return the columns with a number of Blackboard's, which are the ones with grades."""
    matches = ((at, _COLUMN.fullmatch(heading)) for at, heading in enumerate(table.headings))
    found = {at: _Heading(match["title"], _most(match["about"])) for at, match in matches if match}
    if not found or _at(table, _LOGIN) is None:
        raise TableError(table.name, f"{_EXPECTED}, with Username", ", ".join(table.headings)[:120])
    return found


def _most(about: str) -> float | None:
    """Return the points possible: the number in `Total Pts: 10 Score`."""
    found = _NUMBER.search(about)
    return number_in(found[0]) if found else None


def _at(table: TextTable, words: frozenset[str]) -> int | None:
    return next((at for at, heading in enumerate(table.headings) if folded(heading) in words), None)


def _people(table: TextTable) -> Iterator[tuple[int, Asked]]:
    """Yield whose each row is; last and first name are the first two columns."""
    login, number = _at(table, _LOGIN), _at(table, _NUMBER_OF_PERSON)
    for row in range(1, len(table)):
        name = f"{table.get(row, 0)}, {table.get(row, 1)}"
        said = (("login", login), ("email", login), ("sis_id", number))
        ids = tuple((kind, table.get(row, at).strip()) for kind, at in said if at is not None)
        if any(value for _, value in ids):
            yield row, Asked(name.strip(" ,"), ids)

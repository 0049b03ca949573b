"""Canvas: fills the CSV that Gradebook > Export gives, to be taken in again with Gradebook > Import.

Canvas takes a blank for a change where a score exists, matches a column by the number in its heading, and reads the
last of comma and point as the decimal mark (`lib/gradebook_importer.rb` of canvas-lms): so nothing is added to its
own file, nothing emptied, and no mark is written between thousands.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from grader.filling.cells import TextTable
from grader.filling.columns import chosen_column
from grader.filling.fill import Column, fill
from grader.filling.job import Export, Job, Line, template_of
from grader.filling.numbers import number_in, uses_comma
from grader.filling.people import Asked
from grader.roster import folded
from vml_course.errors import TableError

_EXPECTED = "the CSV that the gradebook of Canvas exports"
_NUMBERED = re.compile(r"(?P<title>.*?)\s*\((?P<id>\d+)\)\s*")
_PEOPLE = re.compile(
    r"(student|lastname,firstname),id(,sis user id,sis login id|,sis login id)?"
    r"(,integration id)?(,root account)?,section"
)
_POINTS_POSSIBLE, _TEST_STUDENT = "points possible", frozenset({"student, test", "test student"})
_READ_ONLY = "(read only)"
_KINDS: Mapping[str, tuple[str, ...]] = {
    "id": ("canvas_id",),
    "sis user id": ("sis_id",),
    "sis login id": ("login", "email"),
}


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Fill the column of the assignment in Canvas's own export.

    Raises
    ------
    InputError, TableError
        When the template is missing, is no such export, or has no column to fill.
    """
    template = template_of(job, _EXPECTED)
    table = TextTable(template.name, template.data)
    section = _last_of_people(table)
    titles = {at: _title(table.get(0, at)) for at in range(section + 1, len(table.headings))}
    at = chosen_column(table, titles, job)
    possible = _points_possible(table)
    _refuse_read_only(table, possible, at)
    asked = dict(_people(table, section, possible))
    numbers = (table.get(row, k) for row in range(1, len(table)) for k in titles)
    out_of = number_in(table.get(possible, at)) if possible else None
    column = Column(at, out_of, uses_comma(numbers, job.decimal), frozenset({"", "-"}))
    lines = fill(table, column, asked, job, lambda row: _excused(table.get(row, at)))
    path.write_bytes(table.encoded())
    return lines


EXPORT = Export(
    write,
    ".csv",
    template=_EXPECTED,
    hint="Take it in with Gradebook > Import. Canvas shows every change before it makes it.",
)


def _last_of_people(table: TextTable) -> int:
    """Return the column `Section`, the last that tells who a student is."""
    words = [folded(heading) for heading in table.headings]
    at = words.index("section") if "section" in words else -1
    if at < 0 or not _PEOPLE.fullmatch(",".join(words[: at + 1])):
        raise TableError(
            table.name,
            f"{_EXPECTED}: Student, ID, SIS User ID, SIS Login ID, Section, in this order",
            ", ".join(table.headings[: max(at + 1, 4)])[:120],
            "Canvas would refuse it. Export the gradebook anew.",
        )
    return at


def _title(heading: str) -> str:
    numbered = _NUMBERED.fullmatch(heading)
    return numbered["title"] if numbered else heading


def _points_possible(table: TextTable) -> int:
    """Return the row with the points possible, 0 when there is none."""
    rows = range(1, len(table))
    return next((row for row in rows if folded(table.get(row, 0)) == _POINTS_POSSIBLE), 0)


def _refuse_read_only(table: TextTable, possible: int, at: int) -> None:
    if possible and _READ_ONLY in folded(table.get(possible, at)):
        raise TableError(
            f"{table.name}, column {table.get(0, at)!r}",
            "a column of an assignment",
            "one that Canvas reckons itself",
            "Choose another with --column.",
        )


def _people(table: TextTable, section: int, possible: int) -> Iterator[tuple[int, Asked]]:
    """Yield the rows of students; the first column may be split into last and first name."""
    words = [folded(heading) for heading in table.headings[: section + 1]]
    is_split = words[0] == "lastname"
    for row in range(max(possible, 0) + 1, len(table)):
        cells = table.row(row)
        name = ", ".join(cells[:2]) if is_split else cells[0]
        if not name.strip(" ,") or folded(name) in _TEST_STUDENT:
            continue
        said = zip(words, cells, strict=False)
        ids = tuple((kind, cell.strip()) for word, cell in said for kind in _KINDS.get(word, ()))
        yield row, Asked(name.strip(), ids)


def _excused(cell: str) -> str:
    return "excused (EX), which stays" if cell.strip().casefold() == "ex" else ""

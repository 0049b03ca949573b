"""Moodle: fills the grading worksheet that "Download grading worksheet" gives, to be uploaded again.

Its headings are demanded back in the teacher's language, and feedback is overwritten with what the worksheet says, an
empty cell included (`mod/assign/feedback/offline`): so nothing but grades is written into its own file.
"""

from __future__ import annotations

from pathlib import Path

from grader.filling.fill import Column, fill
from grader.filling.job import Export, Job, Line, template_of
from grader.filling.moodle_worksheet import EXPECTED, Worksheet, worksheet
from grader.filling.numbers import number_in, uses_comma
from grader.roster import folded

_NO = frozenset({"no", "nein", "non", "nee", "não", "nej", "nei", "nie", "ei", "ne"})


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Fill the grades of Moodle's own worksheet.

    Raises
    ------
    InputError, TableError
        When the template is missing, or is no such worksheet.
    """
    template = template_of(job, EXPECTED)
    sheet = worksheet(template.name, template.data)
    table, most = sheet.table, _most(sheet)
    numbers = (table.get(row, at) for row in sheet.rows for at in (sheet.grade, sheet.maximum))
    column = Column(sheet.grade, most, uses_comma(numbers, job.decimal), has_limit=True)
    lines = fill(table, column, sheet.people(), job, lambda row: _refused(sheet, row))
    path.write_bytes(table.encoded())
    return lines


EXPORT = Export(
    write,
    ".csv",
    template=EXPECTED,
    hint=(
        "Upload it with Upload grading worksheet, before the feedback files. Moodle leaves out grades that were "
        "changed there after the worksheet was downloaded: download a fresh one each time."
    ),
)


def _most(sheet: Worksheet) -> float | None:
    said = (number_in(sheet.table.get(row, sheet.maximum)) for row in sheet.rows)
    return next((value for value in said if value), None)


def _refused(sheet: Worksheet, row: int) -> str:
    """Say why Moodle would leave a grade out."""
    is_fixed = folded(sheet.table.get(row, sheet.maximum + 1)) in _NO
    return "locked or overridden in Moodle's gradebook" if is_fixed else ""

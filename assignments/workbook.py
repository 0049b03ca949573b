"""The student's workbook: written here with openpyxl, which writes only; returned files are read elsewhere.

The cells to fill carry defined names, `ans_<question>` and `unit_<question>`, so that a shifted row or a
translated sheet name loses nothing. The same variant always gives the same bytes: time stamps are fixed,
which also means that they tell nothing.
"""

from __future__ import annotations

import datetime as dt
import io
import math
import re
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from openpyxl import Workbook, load_workbook
from openpyxl.worksheet.worksheet import Worksheet

from assignments.model import Assignment, Variant
from assignments.sheets import TRACKING, add_answers, add_instructions, add_meta, add_tracking
from vml_course.errors import UnknownNameError
from vml_course.io.files import existing, replacing

_EPOCH = dt.datetime(2000, 1, 1)  # noqa: DTZ001 - Office's document properties know no zone
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)
_MODIFIED = re.compile(rb"(<dcterms:modified[^>]*>)[^<]*")


def write_workbook(path: Path, assignment: Assignment, variant: Variant, given: Mapping[str, float]) -> None:
    """Write the workbook that a student fills.

    Parameters
    ----------
    path : Path
        The `.xlsx` file.
    assignment : Assignment
    variant : Variant
        Only its code and signature are written.
    given : mapping of str to float
        What the student is told, by the id of the given number, in its unit.
    """
    book = Workbook()
    book.remove(book.worksheets[0])
    add_instructions(book, assignment, variant, given)
    add_answers(book, assignment)
    add_tracking(book, assignment)
    add_meta(book, assignment, variant)
    book.properties.title, book.properties.creator = assignment.title, "Virtual Mechanics Laboratory"
    _save(book, path)


def fill_workbook(
    source: Path,
    target: Path,
    answers: Mapping[str, float | str],
    units: Mapping[str, str],
    tracking: Mapping[str, Sequence[float]] | None = None,
) -> None:
    """Type a student's answers into a copy of a workbook.

    Parameters
    ----------
    source, target : Path
    answers : mapping of str to float or str
        By question id; a text is written as text, as Excel does with what it does not take for a number.
    units : mapping of str to str
        By question id.
    tracking : mapping of str to sequence of float, optional
        By column of the tracking sheet; NaN leaves the cell empty.

    Raises
    ------
    UnknownNameError
        When the workbook has no cell or column of that name.
    """
    book = load_workbook(existing(source), rich_text=True)
    for prefix, values in (("ans", answers), ("unit", units)):
        for question, value in values.items():
            _named_cell(book, f"{prefix}_{question}").value = value
    _fill_columns(book[TRACKING], tracking or {})
    _save(book, target)


def _named_cell(book: Workbook, name: str) -> Any:
    if name not in book.defined_names:
        raise UnknownNameError("cell", name, sorted(book.defined_names))
    sheet, place = next(book.defined_names[name].destinations)
    return book[sheet][place]


def _fill_columns(sheet: Worksheet, columns: Mapping[str, Sequence[float]]) -> None:
    header = {str(cell.value): cell.column for cell in sheet[1] if cell.value}
    for name, values in columns.items():
        if name not in header:
            raise UnknownNameError("column", name, header)
        for row, value in enumerate(values, start=2):
            number = float(value)
            sheet.cell(row, header[name]).value = number if math.isfinite(number) else None


def _save(book: Workbook, path: Path) -> None:
    book.properties.created = _EPOCH
    content = io.BytesIO()
    book.save(content)
    with replacing(path) as temporary:
        temporary.write_bytes(_without_clock(content))


def _without_clock(content: io.BytesIO) -> bytes:
    """Return the same workbook with every time stamp fixed."""
    result = io.BytesIO()
    with zipfile.ZipFile(content) as old, zipfile.ZipFile(result, "w", zipfile.ZIP_DEFLATED) as new:
        for member in old.infolist():
            data = old.read(member)
            if member.filename == "docProps/core.xml":
                data = _MODIFIED.sub(rb"\g<1>" + _EPOCH.isoformat().encode() + b"Z", data)
            fixed = zipfile.ZipInfo(member.filename, date_time=_ZIP_EPOCH)
            fixed.compress_type, fixed.external_attr = zipfile.ZIP_DEFLATED, 0o600 << 16
            new.writestr(fixed, data)
    return result.getvalue()

"""The tracking table: found by its headings wherever it stands, rows with stray text tolerated."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from grader.model import Kind
from grader.read.book import Book, Sheet
from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray
from vml_course.model.reading import read_number

_HEADING = re.compile(r"frame|step|t(ime)?_s|\w+_[xy]_(m|px)")
_LEAST_HEADINGS = 3
_ROWS_SEARCHED = 200


def read_table(book: Book) -> tuple[dict[str, FloatArray], set[str]]:
    """Return the columns of the tracking table by heading, and flags.

    Columns are of equal length; rows are kept where at least one position is a number. Without a table the
    mapping is empty.
    """
    for sheet in sorted(book.sheets, key=lambda sheet: not sheet.name.lower().startswith("tracking")):
        headings = _headings(sheet) if sheet.is_visible else None
        if headings is not None:
            return _columns(sheet, *headings)
    return {}, set()


def _headings(sheet: Sheet) -> tuple[int, dict[int, str]] | None:
    """Return the row of the headings and the heading of each column."""
    rows: dict[int, dict[int, str]] = {}
    for (row, column), cell in sheet.cells.items():
        if row <= _ROWS_SEARCHED and cell.kind is Kind.TEXT:
            name = re.sub(r"\W+", "_", cell.text.strip().lower()).strip("_")
            if _HEADING.fullmatch(name) and name not in rows.get(row, {}).values():
                rows.setdefault(row, {})[column] = name
    best = max(rows, key=lambda row: (len(rows[row]), -row), default=0)
    return (best, rows[best]) if best and len(rows[best]) >= _LEAST_HEADINGS else None


def _columns(sheet: Sheet, header: int, headings: Mapping[int, str]) -> tuple[dict[str, FloatArray], set[str]]:
    rows = sorted({row for row, column in sheet.cells if row > header and column in headings})
    strays = 0
    values = np.full((len(rows), len(headings)), np.nan)
    for i, row in enumerate(rows):
        for j, column in enumerate(headings):
            values[i, j], is_stray = _number(sheet, row, column)
            strays += is_stray
    names = list(headings.values())
    positions = [j for j, name in enumerate(names) if name.endswith(("_m", "_px"))]
    kept = np.isfinite(values[:, positions]).any(axis=1) if positions else np.zeros(len(rows), dtype=bool)
    flags = {"text-in-tracking"} if strays else set()
    return {name: values[kept, j] for j, name in enumerate(names)} if kept.any() else {}, flags


def _number(sheet: Sheet, row: int, column: int) -> tuple[float, bool]:
    cell = sheet.cells.get((row, column))
    if cell is None:
        return np.nan, False
    if cell.kind is Kind.NUMBER and cell.number is not None:
        return cell.number, False
    if cell.kind is not Kind.TEXT:
        return np.nan, True
    try:
        return read_number(cell.text), False
    except InputError:
        return np.nan, True

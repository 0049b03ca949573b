"""The tracking table: found by its headings wherever it stands, rows with stray text tolerated."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from grader.kind import Kind
from grader.read.book import Book, BookCell, Sheet
from grader.read.flags import Flag
from grader.read.headings import Heading, match_points, read_headings
from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray
from vml_course.model.reading import read_number

_LEAST_HEADINGS = 3
_ROWS_SEARCHED = 200
_DELIMITERS = "\t;,"
_STRAY = {
    Kind.DATE: Flag.DATES_IN_TRACKING,
    Kind.UNCACHED: Flag.UNCACHED_IN_TRACKING,
    Kind.ERROR: Flag.ERRORS_IN_TRACKING,
}
_DECIMAL_COMMA = re.compile(r"\s*[-+−]?([0-9]+,([0-9]{1,2}|[0-9]{4,})|0,[0-9]+)\s*")
_DECIMAL_POINT = re.compile(r"\s*[-+−]?[0-9]*\.[0-9]+\s*")


@dataclass(frozen=True, eq=False)
class Table:
    """A tracking table as it was found.

    Attributes
    ----------
    columns : mapping of str to float array, shape (n,)
        By our own names, NaN where nothing can be read; empty when there is no table.
    flags : set of Flag
    where : str
        The sheet.
    unnamed : tuple of str
        Points whose names are none of the assignment's.
    """

    columns: Mapping[str, FloatArray]
    flags: frozenset[Flag] = frozenset()
    where: str = ""
    unnamed: tuple[str, ...] = ()


def read_table(book: Book, points: Sequence[str] = ()) -> Table:
    """Return the tracking table: the first sheet with headings and numbers below, ours first.

    Rows are kept where at least one position is a number.

    Parameters
    ----------
    book : Book
    points : sequence of str
        The assignment's points; other programs' names are matched with them.
    """
    for sheet in sorted(book.sheets, key=_rank):
        found = _table(sheet, points) if sheet.is_visible else None
        if found is not None:
            return found
    return Table({})


def _rank(sheet: Sheet) -> int:
    name = sheet.name.lower()
    return 0 if name.startswith("tracking") else 1 if name.startswith("data") else 2


def _table(sheet: Sheet, points: Sequence[str]) -> Table | None:
    for candidate in (sheet, *(_split(sheet, delimiter) for delimiter in _DELIMITERS)):
        header, headings = _headings(candidate)
        if headings:
            table = _columns(candidate, header, headings)
            return _with_points(table, points) if table.columns else None
    return None


def _split(sheet: Sheet, delimiter: str) -> Sheet:
    """Return the sheet with the texts of its first column cut at a delimiter: a text file pasted as it was."""
    cells = {}
    for (row, column), cell in sheet.cells.items():
        if column == 1 and cell.kind is Kind.TEXT and delimiter in cell.text:
            for place, part in enumerate(cell.text.split(delimiter), start=1):
                if part.strip():
                    cells[row, place] = BookCell(Kind.TEXT, written=part.strip())
        elif column == 1:
            cells[row, column] = cell
    return replace(sheet, cells=cells)


def _headings(sheet: Sheet) -> tuple[int, dict[int, Heading]]:
    """Return the row with most headings, and the heading of each column; (0, {}) when there is none."""
    texts: dict[int, dict[int, str]] = {}
    for (row, column), cell in sheet.cells.items():
        if row <= _ROWS_SEARCHED and cell.kind is Kind.TEXT:
            texts.setdefault(row, {})[column] = cell.text[:80]
    rows = {row: read_headings(found, texts.get(row - 1, {})) for row, found in texts.items()}
    best = max(rows, key=lambda row: (len(rows[row]), -row), default=0)
    has_pair = best > 0 and any(heading.role == "y" for heading in rows[best].values())
    return (best, rows[best]) if has_pair and len(rows[best]) >= _LEAST_HEADINGS else (0, {})


def _columns(sheet: Sheet, header: int, headings: Mapping[int, Heading]) -> Table:
    rows = sorted({row for row, column in sheet.cells if row > header and column in headings})
    below = [[sheet.cells.get((row, column)) for row in rows] for column in headings]
    comma = _comma_is_decimal(cell.text for column in below for cell in column if cell and cell.kind is Kind.TEXT)
    flags: set[Flag] = set()
    columns: dict[str, FloatArray] = {}
    for heading, cells in zip(headings.values(), below, strict=True):
        values = np.array([_number(cell, flags, comma=comma) for cell in cells]) * heading.factor
        if not np.allclose(values, columns.get(heading.name, values), rtol=1e-6, equal_nan=True):
            flags.add(Flag.COLUMNS_TWICE)
        columns.setdefault(heading.name, values)
    positions = [column for name, column in columns.items() if name.endswith(("_m", "_px"))]
    kept = np.isfinite(positions).any(axis=0)
    if not kept.any():
        return Table({})
    return Table({name: column[kept] for name, column in columns.items()}, frozenset(flags), sheet.name)


def _comma_is_decimal(texts: Iterable[str]) -> bool:
    """Tell whether the table's texts use a decimal comma: some must, and none a point."""
    texts = list(texts)
    return any(map(_DECIMAL_COMMA.fullmatch, texts)) and not any(map(_DECIMAL_POINT.fullmatch, texts))


def _number(cell: BookCell | None, flags: set[Flag], *, comma: bool) -> float:
    """Return a cell's number, NaN when there is none; what is there instead is flagged."""
    if cell is None:
        return np.nan
    if cell.kind is Kind.NUMBER and cell.number is not None:
        return cell.number
    if cell.kind is Kind.TEXT:
        try:
            return read_number(cell.text.replace(",", ".") if comma and cell.text.count(",") == 1 else cell.text)
        except InputError:
            pass
    flags.add(_STRAY.get(cell.kind, Flag.TEXT_IN_TRACKING))
    return np.nan


def _with_points(table: Table, points: Sequence[str]) -> Table:
    """Give the points the assignment's names where these can be told."""
    names = list(dict.fromkeys(_point(name) for name in table.columns if _point(name)))
    meant = match_points(names, points)
    columns = {}
    for name, column in table.columns.items():
        point = _point(name)
        columns[meant.get(point, point) + name.removeprefix(point)] = column
    unnamed = tuple(name for name in names if name not in meant)
    # a point too many does no harm: only one that the assignment asks for must be there
    is_complete = set(points) <= set(meant.values())
    flags = table.flags | (set() if is_complete or not unnamed else {Flag.UNNAMED_POINTS})
    return Table(columns, frozenset(flags), table.where, () if is_complete else unnamed)


def other_points(columns: Iterable[str], points: Sequence[str]) -> list[str]:
    """Return the points of these columns that are none of the assignment's, in order.

    >>> other_points(["frame", "ball_x_m", "mass_a_x_px", "mass_a_y_px"], ["ball"])
    ['mass_a']
    """
    return sorted({_point(name) for name in columns} - {"", *points})


def _point(name: str) -> str:
    """Return the point of a column of positions; "" of a clock."""
    found = re.fullmatch(r"(.+)_[xy]_(m|px)", name)
    return found[1] if found else ""

"""A table as its file holds it: a header and rows of numbers or texts, each cell with its place."""

from __future__ import annotations

import csv
import io
import re
import warnings
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from openpyxl import load_workbook

from vml_course.errors import TableError
from vml_course.io.files import existing
from vml_course.model.arrays import FloatArray

TIME_NAMES = ("t_s", "t", "time_s")
HEADER_ROWS = 20  # a title, an empty line, notes may stand above the header
LARGEST_BYTES = 200_000_000
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_MISSING = ("", "nan", "#n/a")

Row = Sequence[Any]


@dataclass(frozen=True, eq=False, slots=True)
class Grid:
    """One table; `first_row` is the number of the first data row as a spreadsheet shows it."""

    file: str
    header: tuple[str, ...]
    rows: tuple[Row, ...]
    first_row: int
    decimal_comma: bool = False

    def numbers(self, column: str) -> FloatArray:
        """Return a column as numbers, shape (n,); an empty cell is NaN.

        Raises
        ------
        TableError
            When a cell holds text.
        """
        place = self.header.index(column)
        cells = (row[place] if place < len(row) else None for row in self.rows)
        return np.array([self._number(cell, column, number) for number, cell in enumerate(cells)], dtype=np.float64)

    def _number(self, cell: Any, column: str, number: int) -> float:
        if cell is None or (isinstance(cell, str) and cell.strip().lower() in _MISSING):
            return float("nan")
        if isinstance(cell, int | float) and not isinstance(cell, bool):
            return float(cell)
        text = str(cell).strip().replace("−", "-")
        plain = text.replace(",", ".") if self.decimal_comma else text
        if not _NUMBER.fullmatch(plain):
            where = f"{self.file}, column {column}, row {self.first_row + number}"
            raise TableError(where, "a number or an empty cell", repr(text[:40]))
        return float(plain)


def read_grid(path: Path) -> Grid:
    """Read the table of a CSV, text or XLSX file that has a column of times.

    Raises
    ------
    FileMissingError
    TableError
        When there is none, or the file is no table.
    """
    candidates = _xlsx_sheets if path.suffix.lower() == ".xlsx" else _text_rows
    for rows, decimal_comma in candidates(existing(path)):
        grid = _grid(path.name, rows, decimal_comma=decimal_comma)
        if grid is not None:
            return grid
    raise TableError(path.name, f"a header with a column {TIME_NAMES[0]} (or {TIME_NAMES[1]})", "none")


def _grid(file: str, rows: Iterable[Row], *, decimal_comma: bool) -> Grid | None:
    table = list(rows)
    for number, row in enumerate(table[:HEADER_ROWS]):
        header = tuple(str(cell).strip() if cell is not None else "" for cell in row)
        if not any(name in header for name in TIME_NAMES):
            continue
        doubled = {name for name in header if name and header.count(name) > 1}
        if doubled:
            raise TableError(file, "each column once", f"{', '.join(sorted(doubled))} twice")
        body = table[number + 1 :]
        while body and all(cell is None or str(cell).strip() == "" for cell in body[-1]):
            body.pop()
        return Grid(file, header, tuple(body), number + 2, decimal_comma)
    return None


def _text_rows(path: Path) -> Iterator[tuple[Iterable[Row], bool]]:
    """Split a text at tabs, at semicolons, at commas; only the last needs the point as decimal mark."""
    if path.stat().st_size > LARGEST_BYTES:
        raise TableError(path.name, f"a table below {LARGEST_BYTES // 1_000_000} MB", "a larger file")
    text = _decoded(path.read_bytes(), path.name)
    for delimiter in "\t;,":
        try:
            rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter))
        except csv.Error as error:
            raise TableError(path.name, "a table of text", "something that cannot be split into cells") from error
        yield rows, delimiter != ","


def _decoded(data: bytes, name: str) -> str:
    """Decode as spreadsheets write: UTF-8 with or without BOM, UTF-16 with BOM, else Windows' own page."""
    encodings = ("utf-16",) if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252")
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise TableError(name, "a table of text", "binary data")


def _xlsx_sheets(path: Path) -> Iterator[tuple[Iterable[Row], bool]]:
    """Yield the sheets, `Data` first; a workbook that unpacks to very much is refused before it is read."""
    try:
        sheets = _unpacked(path)
    except TableError:
        raise
    except Exception as error:  # damage inside a workbook surfaces in openpyxl as almost any exception
        raise TableError(path.name, "an Excel workbook (.xlsx)", "something else or a damaged file") from error
    yield from ((sheets[title], False) for title in sorted(sheets, key=lambda title: title != "Data"))


def _unpacked(path: Path) -> dict[str, list[Row]]:
    data = io.BytesIO(path.read_bytes())
    with zipfile.ZipFile(data) as archive:
        if sum(item.file_size for item in archive.infolist()) > LARGEST_BYTES:
            raise TableError(path.name, f"a workbook below {LARGEST_BYTES // 1_000_000} MB unpacked", "a larger one")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # openpyxl warns of styles and extensions that it leaves out
        book = load_workbook(data, read_only=True, data_only=True)
        return {sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in book.worksheets}

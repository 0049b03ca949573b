"""One sheet in one pass: values, kinds, formulas and number formats of its cells."""

from __future__ import annotations

import datetime as dt
import functools
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from grader.model import Kind
from grader.read import limits
from grader.read.errors import OUR_TEMPLATE, RefusedError
from grader.read.markup import Attributes, parse
from grader.read.parts import shows_date

_EPOCH = dt.datetime(1899, 12, 30)  # noqa: DTZ001 - days are counted without a zone
_EPOCH_1904 = dt.datetime(1904, 1, 1)  # noqa: DTZ001

Place = tuple[int, int]
"""Row and column, both from 1."""

_REFERENCE = re.compile(r"\$?([A-Za-z]{1,3})\$?([0-9]{1,7})")
_OTHER_WORKBOOK = re.compile(r"\[[^\[\]]+\][^\[\]!]*!")


class BookCell(NamedTuple):
    """A cell's value; `format` is its number format, "" for general. A tuple: a workbook has thousands."""

    kind: Kind
    number: float | None = None
    written: str = ""
    format: str = ""
    is_formula: bool = False

    @property
    def text(self) -> str:
        """What is written (of a date: the date, in ISO form), or the number in its shortest form."""
        return self.written if self.number is None or self.written else shortest(self.number)


@dataclass
class SheetContent:
    """What one sheet holds; `merges` are (first row, first column, last row, last column)."""

    cells: dict[Place, BookCell] = field(default_factory=dict)
    merges: list[tuple[int, int, int, int]] = field(default_factory=list)
    flags: set[str] = field(default_factory=set)


def place_of(reference: str) -> Place | None:
    """Return row and column of an address such as `$C$7`, None when it is none.

    >>> place_of("$C$7"), place_of("#REF!")
    ((7, 3), None)
    """
    found = _REFERENCE.fullmatch(reference)
    if found is None:
        return None
    return int(found[2]), _column(found[1])


@functools.lru_cache(maxsize=20_000)
def _column(letters: str) -> int:
    column = 0
    for letter in letters.upper():
        column = 26 * column + ord(letter) - 64
    return column


def address_of(place: Place) -> str:
    """Return the address of a row and column.

    >>> address_of((7, 28))
    'AB7'
    """
    row, column = place
    letters = ""
    while column:
        column, rest = divmod(column - 1, 26)
        letters = chr(65 + rest) + letters
    return f"{letters}{row}"


def read_sheet(
    content: bytes, strings: Sequence[str], formats: Sequence[str], *, is_1904: bool = False
) -> SheetContent:
    """Read a sheet's cells; those far away are left out and flagged `far-cells`.

    Raises
    ------
    RefusedError
        When it is damaged or holds too many cells.
    """
    reader = _SheetReader(strings, formats, _EPOCH_1904 if is_1904 else _EPOCH)
    parse(content, reader.start, reader.end, reader.text)
    return reader.sheet


class _SheetReader:
    """The state of the pass: where we are, and what was collected of the current cell."""

    def __init__(self, strings: Sequence[str], formats: Sequence[str], epoch: dt.datetime) -> None:
        self.sheet = SheetContent()
        self._strings, self._formats, self._epoch = strings, formats, epoch
        self._general = formats[0] if formats else ""
        self._row, self._column = 0, 0
        self._attributes: Attributes | None = None
        self._parts: dict[str, str] = {}
        self._into = ""
        self._in_phonetic = False

    def start(self, name: str, attributes: Attributes) -> None:
        if name == "c":
            place = place_of(attributes.get("r", ""))
            self._row, self._column = place or (self._row, self._column + 1)
            self._attributes, self._parts = attributes, {}
        elif self._attributes is not None:
            self._start_inside(name)
        elif name == "row":
            number = attributes.get("r", "")
            self._row = int(number) if number.isascii() and number.isdigit() and len(number) <= 7 else self._row + 1
            self._column = 0
        elif name == "mergeCell":
            self._merge(attributes.get("ref", ""))

    def text(self, part: str) -> None:
        if self._into and len(self._parts[self._into]) < limits.CELL_LENGTH:
            self._parts[self._into] += part

    def end(self, name: str) -> None:
        self._into = ""
        if name == "c" and self._attributes is not None:
            if self._parts:  # else it has a style only
                self._keep(self._attributes)
            self._attributes = None
        elif name == "rPh":
            self._in_phonetic = False

    def _start_inside(self, name: str) -> None:
        """Begin a part of a cell: its value, formula, or a run of its text, but no pronunciation guide."""
        self._in_phonetic = self._in_phonetic or name == "rPh"
        self._into = name if name in {"v", "f", "t"} and not self._in_phonetic else ""
        if self._into:
            self._parts.setdefault(self._into, "")

    def _keep(self, attributes: Attributes) -> None:
        if self._row > limits.ROWS or self._column > limits.COLUMNS:
            self.sheet.flags.add("far-cells")
            return
        formula = self._parts.get("f")
        if formula and "!" in formula and _OTHER_WORKBOOK.search(formula[: limits.CELL_LENGTH]):
            self.sheet.flags.add("formula-to-other-workbook")
        written = self._parts.get("v") or self._parts.get("t", "")
        cell = self._cell(attributes, written, is_formula=formula is not None)
        if cell.kind is not Kind.BLANK:
            self.sheet.cells[self._row, self._column] = cell
        if len(self.sheet.cells) > limits.CELLS:
            raise RefusedError(f"a workbook with more than {limits.CELLS} cells", OUR_TEMPLATE)

    def _cell(self, attributes: Attributes, written: str, *, is_formula: bool) -> BookCell:
        kind = attributes.get("t", "n")
        code = self._format(attributes["s"]) if "s" in attributes else self._general
        if kind == "n" and written:
            return self._number(written, code, is_formula=is_formula)
        if is_formula and not written and kind != "str":
            return BookCell(Kind.UNCACHED, format=code, is_formula=True)
        if kind in {"s", "str", "inlineStr"}:
            return _text_cell(self._string(written) if kind == "s" else written, code, is_formula=is_formula)
        if kind == "b":
            return BookCell(Kind.BOOL, written="TRUE" if written == "1" else "FALSE", is_formula=is_formula)
        if kind in {"e", "d"}:
            return BookCell(Kind.ERROR if kind == "e" else Kind.DATE, written=written[:40], is_formula=is_formula)
        return self._number(written, code, is_formula=is_formula)

    def _number(self, written: str, code: str, *, is_formula: bool) -> BookCell:
        if not written.strip():
            return BookCell(Kind.BLANK)
        try:
            number = float(written[:64])
        except ValueError as error:
            raise RefusedError("a damaged workbook") from error
        if not math.isfinite(number):
            return BookCell(Kind.ERROR, written=written[:40], is_formula=is_formula)
        if shows_date(code):
            return BookCell(Kind.DATE, number, _date_text(number, self._epoch), code, is_formula)
        return BookCell(Kind.NUMBER, number, "", code, is_formula)

    def _format(self, style: str) -> str:
        index = int(style) if style.isascii() and style.isdigit() and len(style) <= 6 else 0
        return self._formats[index] if index < len(self._formats) else ""

    def _string(self, written: str) -> str:
        if not (written.isascii() and written.isdigit() and len(written) <= 7 and int(written) < len(self._strings)):
            raise RefusedError("a damaged workbook")
        return self._strings[int(written)]

    def _merge(self, reference: str) -> None:
        first, _, last = reference.partition(":")
        corners = place_of(first), place_of(last or first)
        if corners[0] and corners[1] and len(self.sheet.merges) < limits.MERGES:
            self.sheet.merges.append((*corners[0], *corners[1]))


def _text_cell(text: str, code: str, *, is_formula: bool) -> BookCell:
    if not text.strip():
        return BookCell(Kind.BLANK)
    return BookCell(Kind.TEXT, written=text[: limits.TEXT_LENGTH], format=code, is_formula=is_formula)


def _date_text(days: float, epoch: dt.datetime) -> str:
    """Return the date, or the time of day, that a number of days shows as; "" when no calendar has it.

    >>> _date_text(45413.0, _EPOCH), _date_text(0.0625, _EPOCH)
    ('2024-05-01', '01:30:00')
    """
    try:
        moment = epoch + dt.timedelta(days=days)
    except OverflowError:
        return ""
    return moment.time().isoformat("seconds") if 0 <= days < 1 else moment.date().isoformat()


def shortest(number: float) -> str:
    """Return the shortest text of a number, without the noise of binary fractions.

    >>> shortest(0.1 + 0.2), shortest(15.0)
    ('0.3', '15')
    """
    return format(number + 0.0, ".15g")  # adding zero turns -0 into 0

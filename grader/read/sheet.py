"""One sheet in one pass: values, kinds, formulas and number formats of its cells."""

from __future__ import annotations

import datetime as dt
import decimal
import functools
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from grader.kind import Kind
from grader.read import limits
from grader.read.errors import OUR_TEMPLATE, RefusedError
from grader.read.flags import Flag
from grader.read.markup import Attributes, End, Start, parse
from grader.read.parts import shows_date

_FIFTEEN_DIGITS = decimal.Context(prec=15, rounding=decimal.ROUND_HALF_UP)
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
    flags: set[Flag] = field(default_factory=set)


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


_COLUMNS = {address_of((0, column))[:-1]: column for column in range(1, limits.COLUMNS + 1)}
"""The columns that are read, by their letters."""
_NUMBER = Kind.NUMBER  # looking a member up costs half as much as making a cell
_TEXTS = frozenset({"s", "str", "inlineStr"})
_WORDS = {"b": Kind.BOOL, "e": Kind.ERROR, "d": Kind.DATE}
"""What a cell says that it holds, where that is no number."""


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
    parse(content, reader.starts, reader.ends)
    return reader.sheet


class _Shown(NamedTuple):
    """How a style shows numbers: its format's code, and whether that makes dates of them."""

    code: str
    is_date: bool


class _Styles(dict[str, _Shown]):
    """How each style shows numbers, by what a cell says in `s`; each is worked out once."""

    def __init__(self, formats: Sequence[str]) -> None:
        super().__init__()
        self._formats = formats

    def __missing__(self, style: str) -> _Shown:
        index = int(style) if style.isascii() and style.isdigit() and len(style) <= 6 else 0
        code = self._formats[index] if index < len(self._formats) else ""
        shown = _Shown(code, shows_date(code))
        if len(self) < limits.STYLES:
            self[style] = shown
        return shown


class _SheetReader:
    """The state of the pass: where we are, and what was collected of the current cell.

    A workbook has thousands of cells: what most of them are, a number at the next place, takes the short way.
    """

    def __init__(self, strings: Sequence[str], formats: Sequence[str], epoch: dt.datetime) -> None:
        self.sheet = SheetContent()
        self._strings, self._styles, self._epoch = strings, _Styles(formats), epoch
        self._row, self._column = 0, 0
        self._line, self._line_text = 0, ""  # the row element that we are in; a cell may name another row
        self._attributes: Attributes = {}
        self._value = ""
        self._formula: str | None = None
        self._runs: list[str] = []
        self._runs_before_guide = 0
        self.starts: Mapping[str, Start] = {
            "c": self._start_cell, "row": self._start_row, "rPh": self._start_guide, "mergeCell": self._merge,
        }  # fmt: skip
        self.ends: Mapping[str, End] = {
            "c": self._end_cell, "v": self._end_value, "f": self._end_formula,
            "t": self._runs.append, "rPh": self._end_guide,
        }  # fmt: skip

    def _start_row(self, attributes: Attributes) -> None:
        number = attributes.get("r", "")
        is_number = number.isascii() and number.isdigit() and len(number) <= 7
        self._line, self._line_text = (int(number), number) if is_number else (self._row + 1, "")
        self._row, self._column = self._line, 0

    def _start_cell(self, attributes: Attributes) -> None:
        self._attributes, self._value, self._formula = attributes, "", None
        self._runs.clear()
        reference = attributes.get("r", "")
        column = _COLUMNS.get(reference.removesuffix(self._line_text))
        if column is not None:
            self._row, self._column = self._line, column
        else:
            self._row, self._column = place_of(reference) or (self._row, self._column + 1)

    def _start_guide(self, _: Attributes) -> None:
        self._runs_before_guide = len(self._runs)

    def _end_guide(self, _: str) -> None:
        del self._runs[self._runs_before_guide :]

    def _end_value(self, text: str) -> None:
        self._value = text

    def _end_formula(self, text: str) -> None:
        self._formula = text

    def _end_cell(self, _: str) -> None:
        written, formula = self._value or "".join(self._runs), self._formula
        if not written and formula is None:
            return  # a style only
        if self._row > limits.ROWS or self._column > limits.COLUMNS:
            self.sheet.flags.add(Flag.FAR_CELLS)
            return
        if formula and "!" in formula and _OTHER_WORKBOOK.search(formula[: limits.CELL_LENGTH]):
            self.sheet.flags.add(Flag.FORMULA_TO_OTHER_WORKBOOK)
        cell = self._cell(written, is_formula=formula is not None)
        cells = self.sheet.cells
        if cell is not None:
            cells[self._row, self._column] = cell
        if len(cells) > limits.CELLS:
            raise RefusedError(f"a workbook with more than {limits.CELLS} cells", OUR_TEMPLATE)

    def _cell(self, written: str, *, is_formula: bool) -> BookCell | None:
        """Return the current cell; None when it is blank after all."""
        kind, shown = self._attributes.get("t", "n"), self._styles[self._attributes.get("s", "")]
        if not written:
            return None if kind == "str" else BookCell(Kind.UNCACHED, None, "", shown.code, is_formula)
        if kind in _TEXTS:
            text = (self._string(written) if kind == "s" else written)[: limits.TEXT_LENGTH]
            return BookCell(Kind.TEXT, None, text, shown.code, is_formula) if text.strip() else None
        if kind in _WORDS:
            word = ("TRUE" if written == "1" else "FALSE") if kind == "b" else written[:40]
            return BookCell(_WORDS[kind], None, word, "", is_formula)
        return self._number(written, shown, is_formula=is_formula)

    def _number(self, written: str, shown: _Shown, *, is_formula: bool) -> BookCell | None:
        try:
            number = float(written)
        except ValueError as error:
            if not written.strip():
                return None
            raise RefusedError("a damaged workbook") from error
        code, is_date = shown
        if not math.isfinite(number):
            return BookCell(Kind.ERROR, None, written[:40], "", is_formula)
        if is_date:
            return BookCell(Kind.DATE, number, _date_text(number, self._epoch), code, is_formula)
        return BookCell(_NUMBER, number, "", code, is_formula)

    def _string(self, written: str) -> str:
        if not (written.isascii() and written.isdigit() and len(written) <= 7 and int(written) < len(self._strings)):
            raise RefusedError("a damaged workbook")
        return self._strings[int(written)]

    def _merge(self, attributes: Attributes) -> None:
        first, _, last = attributes.get("ref", "").partition(":")
        corners = place_of(first), place_of(last or first)
        if corners[0] and corners[1] and len(self.sheet.merges) < limits.MERGES:
            self.sheet.merges.append((*corners[0], *corners[1]))


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
    """Return the shortest text of a number to 15 digits, without the noise of binary fractions.

    Halves go away from zero, as LibreOffice has them when it saves: a number keeps its text there.

    >>> shortest(0.1 + 0.2), shortest(15.0), shortest(0.1941003263435765)
    ('0.3', '15', '0.194100326343577')
    """
    kept = float(_FIFTEEN_DIGITS.create_decimal(repr(float(number))))
    return format(kept + 0.0, ".15g")  # adding zero turns -0 into 0

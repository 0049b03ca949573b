"""Writing a workbook of plain values: no text becomes a formula or a link, whatever it looks like."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping

from xlsxwriter import Workbook
from xlsxwriter.format import Format
from xlsxwriter.worksheet import Worksheet

LONGEST_TEXT = 2000
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_NO_TITLE = re.compile(r"[\[\]:*?/\\]")
_LONGEST_TITLE = 28  # characters, so that a number may follow
_LINE_HEIGHT = 15.0  # points
_NOTE = {"author": "Feedback", "width": 360, "height": 140}

Style = Mapping[str, object]
"""Properties of a cell's format, as XlsxWriter names them."""


class PlainWorkbook:
    """A workbook that is being written.

    Parameters
    ----------
    title : str
        Of the document, for its properties.
    """

    def __init__(self, title: str) -> None:
        self._content = io.BytesIO()
        self._made = Workbook(self._content, {"in_memory": True})
        self._made.set_properties({"title": title, "author": title})
        self._formats: dict[tuple[tuple[str, object], ...], Format] = {}
        self._titles: set[str] = set()

    def sheet(self, name: str) -> PlainSheet:
        """Add a sheet under its name, or one like it that Excel allows and no other sheet has."""
        return PlainSheet(self, self._made.add_worksheet(self._title(name)))

    def content(self) -> bytes:
        """Return the file; nothing can be written afterwards."""
        self._made.close()
        return self._content.getvalue()

    def format(self, style: Style) -> Format | None:
        """Return the format of a style; each is kept once."""
        key = tuple(sorted(style.items()))
        if key and key not in self._formats:
            self._formats[key] = self._made.add_format(dict(style))
        return self._formats.get(key)

    def _title(self, name: str) -> str:
        """Return a title; Excel counts its characters as UTF-16 does, and takes no heed of capitals."""
        safe = _NO_TITLE.sub("_", _CONTROL.sub("", name)).encode("utf-16-le")[: 2 * _LONGEST_TITLE]
        plain = safe.decode("utf-16-le", "ignore").strip("'") or "Sheet"
        plain = "History_" if plain.lower() == "history" else plain  # Excel keeps this name for itself
        numbered = (f"{plain} {number}" for number in range(2, len(self._titles) + 3))
        title = next(title for title in (plain, *numbered) if title.lower() not in self._titles)
        self._titles.add(title.lower())
        return title


class PlainSheet:
    """A sheet that is being written; rows and columns count from 1. All its columns are printed on one page's width."""

    def __init__(self, book: PlainWorkbook, sheet: Worksheet) -> None:
        self._book, self._sheet = book, sheet
        sheet.set_landscape()
        sheet.fit_to_pages(1, 0)

    def text(self, row: int, column: int, text: str, style: Style | None = None) -> None:
        """Write a text as text: what looks like a formula stays a text, also when the cell is edited."""
        text = _plain(text)
        if text:
            quoted = {"quote_prefix": True} if text[0] in "=+-@" else {}
            self._sheet.write_string(row - 1, column - 1, text, self._book.format({**(style or {}), **quoted}))
        elif style:
            self._sheet.write_blank(row - 1, column - 1, None, self._book.format(style))

    def number(self, row: int, column: int, number: float, style: Style) -> None:
        """Write a number, to the 16 digits that XlsxWriter keeps."""
        self._sheet.write_number(row - 1, column - 1, number, self._book.format(style))

    def note(self, row: int, column: int, text: str) -> None:
        """Hang a note on a cell."""
        self._sheet.write_comment(row - 1, column - 1, _plain(text), _NOTE)

    def merge(self, top: int, left: int, bottom: int, right: int) -> None:
        """Merge cells; the first is written afterwards."""
        self._sheet.merge_range(top - 1, left - 1, bottom - 1, right - 1, "")

    def height(self, row: int, lines: int) -> None:
        """Make a row as high as so many lines of text: not every program finds that itself."""
        self._sheet.set_row(row - 1, _LINE_HEIGHT * lines)

    def width(self, column: int, width: float) -> None:
        """Make a column so many characters wide."""
        self._sheet.set_column(column - 1, column - 1, width)


def _plain(text: str) -> str:
    """Return a text that is safe in a cell; XlsxWriter takes one between <r> and </r> for markup of its own."""
    text = _CONTROL.sub("", text)[:LONGEST_TEXT]
    return f"{text} " if text.startswith("<r>") else text

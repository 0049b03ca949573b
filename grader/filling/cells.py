"""A table of separated values as it is written: everything that is not filled stays byte for byte.

The csv module would lose quotes, line ends and marks of encoding; platforms read their own files back by these.
"""

from __future__ import annotations

import codecs
import re

from vml_course.errors import TableError

_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_UNMARKED = ("utf-8", "cp1252")
_DELIMITERS = ",;\t"
_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # a spreadsheet would compute what begins like this
_LINE_END = re.compile(r"\r\n|\n|\r")


class TextTable:
    """Rows of cells, each as it is written in the file, quotes included.

    Parameters
    ----------
    name : str
        For messages.
    data : bytes
        UTF-8 with or without its mark, UTF-16 with it, or Windows-1252; separated by comma, semicolon or tab.

    Raises
    ------
    TableError
        When it is no such text.
    """

    def __init__(self, name: str, data: bytes) -> None:
        self.name = name
        self._mark, self._encoding = _encoding_of(name, data)
        text = data[len(self._mark) :].decode(self._encoding)
        self.delimiter = max(_DELIMITERS, key=lambda mark: len(_split(text, mark, rows=1)[0][0]))
        self._rows, self._ends = _split(text, self.delimiter)

    def __len__(self) -> int:
        return len(self._rows)

    @property
    def headings(self) -> tuple[str, ...]:
        """The cells of the first row."""
        return self.row(0)

    def row(self, at: int) -> tuple[str, ...]:
        """Return what the cells of a row say."""
        return tuple(map(_said, self._rows[at]))

    def get(self, row: int, column: int) -> str:
        """Return what a cell says; "" where the row is shorter."""
        cells = self._rows[row]
        return _said(cells[column]) if column < len(cells) else ""

    def put(self, row: int, column: int, text: str) -> None:
        """Write a cell; it is quoted where it was, where all headings are, or where it has to be."""
        cells = self._rows[row]
        cells += [""] * (column + 1 - len(cells))
        likes_quotes = cells[column].startswith('"') or (not cells[column] and self._quotes_everything)
        must = any(mark in text for mark in (self.delimiter, '"', "\r", "\n"))
        cells[column] = '"{}"'.format(text.replace('"', '""')) if likes_quotes or must else text

    @property
    def _quotes_everything(self) -> bool:
        return all(cell.startswith('"') for cell in self._rows[0])

    def encoded(self) -> bytes:
        """Return the file."""
        rows = zip(self._rows, self._ends, strict=True)
        text = "".join(self.delimiter.join(cells) + end for cells, end in rows)
        return self._mark + text.encode(self._encoding)


def _encoding_of(name: str, data: bytes) -> tuple[bytes, str]:
    mark, encoding = next(((mark, e) for mark, e in _MARKS if data.startswith(mark)), (b"", ""))
    for candidate in (encoding,) if encoding else _UNMARKED:
        try:
            text = data[len(mark) :].decode(candidate)
        except UnicodeDecodeError:
            continue
        if text.strip() and "\0" not in text:
            return mark, candidate
    hint = "Give the file as the platform exported it, not saved by another program."
    raise TableError(name, "a table of separated values (CSV)", "something else", hint)


def _split(text: str, delimiter: str, rows: int = 0) -> tuple[list[list[str]], list[str]]:
    """Return the cells of each row and the line ends; of the first `rows` rows where that is not 0."""
    field = re.compile(rf'"(?:[^"]|"")*"[^{delimiter}\r\n]*|[^{delimiter}\r\n]*')
    found: list[list[str]] = [[]]
    ends: list[str] = []
    at = 0
    while True:
        cell = field.match(text, at)
        written = cell[0] if cell else ""
        found[-1].append(written)
        at += len(written)
        if text.startswith(delimiter, at):
            at += 1
            continue
        end = _LINE_END.match(text, at)
        ends.append(end[0] if end else "")
        at = end.end() if end else at
        if end is None or at == len(text) or len(ends) == rows:
            return found, ends
        found.append([])


def _said(cell: str) -> str:
    """Return what a cell says.

    >>> _said('"Doe, ""J"" Jane"')
    'Doe, "J" Jane'
    """
    if len(cell) > 1 and cell.startswith('"') and cell.endswith('"'):
        return cell[1:-1].replace('""', '"')
    return cell


def harmless(text: str) -> str:
    """Return a text that a spreadsheet will not compute.

    >>> harmless("=SUM(A1)"), harmless("Ann")
    ("'=SUM(A1)", 'Ann')
    """
    return f"'{text}" if text.startswith(_FORMULA) else text

"""From the bytes that a student sent to plain cells, and from cells to answers.

`read_workbook` turns any bytes into a `Book` or one polite line; `find_submission` looks the answers up in it.
"""

from __future__ import annotations

from grader.read.book import Book, BookCell, ReadRequest, read_workbook
from grader.read.errors import ReaderFailedError, UnreadableError
from grader.read.locate import claims_of, find_submission
from grader.read.worker import Reader, read_isolated

__all__ = [
    "Book",
    "BookCell",
    "ReadRequest",
    "Reader",
    "ReaderFailedError",
    "UnreadableError",
    "claims_of",
    "find_submission",
    "read_isolated",
    "read_workbook",
]

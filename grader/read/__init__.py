"""From the bytes that a student sent to plain cells; answers are found in these by `grader.read.locate`.

The process that reads starts with this package: it imports the standard library and our errors only.
"""

from __future__ import annotations

from grader.read.book import Book, BookCell, ReadRequest, read_workbook
from grader.read.errors import ReaderFailedError, UnreadableError
from grader.read.worker import Reader, read_isolated

__all__ = [
    "Book",
    "BookCell",
    "ReadRequest",
    "Reader",
    "ReaderFailedError",
    "UnreadableError",
    "read_isolated",
    "read_workbook",
]

"""Received files, kept as they came: by the hash of their bytes, written once, never changed."""

from __future__ import annotations

import hashlib
from pathlib import Path

from vml_course.errors import FileMissingError
from vml_course.io.shelf import Shelf

FOLDER = "inbox"
LARGEST_BYTES = 50 * 2**20  # of a file that is kept; the reader's own limit is lower


def keep(shelf: Shelf, data: bytes) -> str:
    """Keep bytes that came in, once; return their SHA-256."""
    sha256 = hashlib.sha256(data).hexdigest()
    if not shelf.exists(kept_name(sha256)):
        shelf.write(kept_name(sha256), data, read_only=True)
    return sha256


def kept_name(sha256: str) -> str:
    """Return where the bytes with this hash lie."""
    return f"{FOLDER}/{sha256[:2]}/{sha256}"


def received_bytes(file: Path) -> bytes:
    """Return the bytes of a file that came in.

    Raises
    ------
    FileMissingError
        When there is no such file, it cannot be read, or is far too large to be a workbook.
    """
    try:
        size = file.stat().st_size if file.is_file() else -1
        if size > LARGEST_BYTES:
            raise FileMissingError(file.name, "a workbook", f"a file of {size // 2**20} MB")
        return file.read_bytes()
    except OSError as error:
        raise FileMissingError(file.name, "a file that can be read", error.strerror or "no such file") from error

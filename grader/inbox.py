"""Received files, kept as they came: by the hash of their bytes, written once, never changed."""

from __future__ import annotations

import hashlib
from pathlib import Path

from vml_course.errors import FileMissingError
from vml_course.io.files import replacing

FOLDER = "inbox"
LARGEST_BYTES = 50 * 2**20  # of a file that is kept; the reader's own limit is lower


def receive(course_folder: Path, file: Path) -> bytes:
    """Keep a copy of a file in the course's inbox and return its bytes.

    Raises
    ------
    FileMissingError
        When there is no such file, it cannot be read, or is far too large to be a workbook.
    """
    data = _bytes(file)
    sha = hashlib.sha256(data).hexdigest()
    kept = course_folder / FOLDER / sha[:2] / sha
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        with replacing(kept) as temporary:
            temporary.write_bytes(data)
            temporary.chmod(0o444)
    return data


def _bytes(file: Path) -> bytes:
    try:
        size = file.stat().st_size if file.is_file() else -1
        if size > LARGEST_BYTES:
            raise FileMissingError(file.name, "a workbook", f"a file of {size // 2**20} MB")
        return file.read_bytes()
    except OSError as error:
        raise FileMissingError(file.name, "a file that can be read", error.strerror or "no such file") from error

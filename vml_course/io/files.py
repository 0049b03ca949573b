"""Files as a whole: nothing half-written, one fingerprint."""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from vml_course.errors import FileFormatError, FileMissingError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary name beside `path`; it takes the place of `path` only when the block ends well.

    Raises
    ------
    FileMissingError
        When the folder does not exist.
    FileFormatError
        When the file cannot be replaced, for example because it is open in Excel.
    """
    check_folder(path)
    temporary = path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")
    try:
        yield temporary
        temporary.replace(path)
    except PermissionError as error:
        raise FileFormatError(
            str(path), "a file that may be written", "no permission", "Close it in other programs."
        ) from error
    finally:
        temporary.unlink(missing_ok=True)


def check_folder(path: Path) -> None:
    """Refuse a file name whose folder does not exist.

    Raises
    ------
    FileMissingError
    """
    if not path.parent.is_dir():
        raise FileMissingError(str(path), "an existing folder to write into", f"no folder {path.parent}")


def existing(path: Path) -> Path:
    """Return `path` when it is a file.

    Raises
    ------
    FileMissingError
    """
    if not path.is_file():
        raise FileMissingError(str(path), "an existing file", "a folder" if path.is_dir() else "no such file")
    return path


def sha256_of(path: Path) -> str:
    """Return the SHA-256 of a file's bytes, as 64 hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()

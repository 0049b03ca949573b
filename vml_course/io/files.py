"""Files as a whole: nothing half-written, one fingerprint."""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
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
        with suppress(OSError):  # where it could not be made, it need not be removed
            temporary.unlink(missing_ok=True)


def check_folder(path: Path) -> None:
    """Refuse a file name that cannot be written: no such folder, a folder in the way, no right to write.

    Raises
    ------
    FileMissingError, FileFormatError
    """
    if not path.parent.is_dir():
        raise FileMissingError(str(path), "an existing folder to write into", f"no folder {path.parent}")
    if path.is_dir():
        raise FileFormatError(str(path), "the name of a file", "a folder")
    trial = path.with_name(f".{secrets.token_hex(8)}")
    try:
        trial.touch(exist_ok=False)
        trial.unlink()
    except OSError as error:
        raise FileFormatError(str(path), "a folder that may be written into", error.strerror) from error


def check_not_source(path: Path, sources: Iterable[Path]) -> None:
    """Refuse to write over a file that is read, or twice to one file.

    Raises
    ------
    FileFormatError
    """
    if path.resolve() in {source.resolve() for source in sources}:
        raise FileFormatError(str(path), "a name of its own", "that of another file of this command")


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


def sha256_of_all(paths: Iterable[Path]) -> str:
    """Return the SHA-256 of the bytes of several files one after the other (`cat folder/* | sha256sum`)."""
    digest = hashlib.sha256()
    for path in paths:
        with path.open("rb") as file:
            while piece := file.read(1 << 20):
                digest.update(piece)
    return digest.hexdigest()

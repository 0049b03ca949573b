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
    temporary = _beside(path)
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


@contextmanager
def replacing_together(*paths: Path) -> Iterator[tuple[Path, ...]]:
    """Give temporary names beside files of one folder; all take their places when the block ends well, or none does.

    Older files are moved aside first, so that one which is held by another program stops all.

    Raises
    ------
    FileMissingError, FileFormatError
        As `replacing`.
    """
    for path in paths:
        check_folder(path)
    temporaries = tuple(map(_beside, paths))
    try:
        yield temporaries
        _take_places(temporaries, paths)
    except PermissionError as error:
        held = str(error.filename or paths[0].parent)
        raise FileFormatError(
            held, "a file that may be written", "no permission", "Close it in other programs."
        ) from error
    finally:
        for temporary in temporaries:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)


def _take_places(temporaries: Iterable[Path], paths: tuple[Path, ...]) -> None:
    older, placed = {path: _beside(path) for path in paths if path.exists()}, []
    try:
        for path, aside in older.items():
            path.replace(aside)
        for temporary, path in zip(temporaries, paths, strict=True):
            temporary.replace(path)
            placed.append(path)
    except BaseException:
        for path in placed:
            path.unlink(missing_ok=True)
        for path, aside in older.items():
            if aside.exists():
                aside.replace(path)
        raise
    for aside in older.values():
        aside.unlink(missing_ok=True)


def _beside(path: Path) -> Path:
    return path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")


@contextmanager
def making_folder(folder: Path) -> Iterator[None]:
    """Make a folder and its parents for a block; where the block fails, those that were made are removed again.

    Raises
    ------
    FileFormatError
        When it cannot be made.
    """
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        _make(folder)
        yield
    except BaseException:
        for path in missing:
            with suppress(OSError):  # never one that holds something
                path.rmdir()
        raise


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileFormatError(str(folder), "a folder to write into", error.strerror or str(error)) from error


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

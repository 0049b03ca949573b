"""A place for files that go together: a folder of this machine, or an object store by URL (s3://, memory://, ...).

Names are relative and use slashes. What is written is there whole or not at all: a folder's file takes its name when
it is complete, an object store shows an object when it was sent to its end.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol
from urllib.parse import urlsplit

from fsspec.core import url_to_fs  # type: ignore[import-untyped]

from vml_course.errors import FileMissingError, InputError
from vml_course.io.files import replacing


class Shelf(Protocol):
    """What both kinds of place can do; errors are those of `vml_course.errors`."""

    def place(self, name: str = "") -> str:
        """Return where something lies, as a person is told."""
        ...

    def read(self, name: str) -> bytes:
        """Return a file's bytes; FileMissingError when there is none."""
        ...

    def write(self, name: str, data: bytes, *, read_only: bool = False) -> None:
        """Write a file, whole or not at all; `read_only` where the place knows such a thing."""
        ...

    def exists(self, name: str) -> bool:
        """Tell whether there is such a file."""
        ...

    def names(self, folder: str = "") -> frozenset[str]:
        """Return the names of the files and folders in a folder; none when there is no such folder."""
        ...

    def put_files(self, name: str, files: Mapping[str, bytes], last: str) -> None:
        """Put a folder with these files in place of `name`; the one called `last` appears after all others."""
        ...


def open_shelf(place: str | Path) -> Shelf:
    """Return the shelf at a path or URL.

    Raises
    ------
    InputError
        When nothing that is installed understands the URL.
    """
    url = urlsplit(str(place))
    if len(url.scheme) < 2:  # a path; one letter is a drive of Windows
        return FolderShelf(Path(place))
    if url.scheme == "file":
        return FolderShelf(Path(url_to_fs(str(place))[1]))
    try:
        files, root = url_to_fs(str(place))
    except (ImportError, ValueError) as error:
        hint = "For s3:// install: pip install 'vml-course[s3]'" if url.scheme == "s3" else ""
        raise InputError(str(place), "a folder or the URL of an object store", str(error), hint) from error
    return StoreShelf(files, str(root), url.scheme)


class FolderShelf:
    """A folder of this machine."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def place(self, name: str = "") -> str:
        """Return the path."""
        return str(self._path(name))

    def read(self, name: str) -> bytes:
        """Return a file's bytes."""
        path = self._path(name)
        try:
            return path.read_bytes()
        except OSError as error:
            raise FileMissingError(str(path), "a file that can be read", error.strerror or "none") from error

    def write(self, name: str, data: bytes, *, read_only: bool = False) -> None:
        """Write a file, whole or not at all."""
        path = self._path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as temporary:
            temporary.write_bytes(data)
            if read_only:
                temporary.chmod(0o444)

    def exists(self, name: str) -> bool:
        """Tell whether there is such a file."""
        return self._path(name).is_file()

    def names(self, folder: str = "") -> frozenset[str]:
        """Return the names in a folder."""
        path = self._path(folder)
        return frozenset(entry.name for entry in path.iterdir()) if path.is_dir() else frozenset()

    def put_files(self, name: str, files: Mapping[str, bytes], last: str) -> None:  # noqa: ARG002 - all appear at once
        """Put a folder in place of `name` by renaming it; what a killed run left beside goes first."""
        path = self._path(name)
        made, older = path.with_name(f".{path.name}.new"), path.with_name(f".{path.name}.old")
        for left in (made, older):
            shutil.rmtree(left, ignore_errors=True)
        made.mkdir(parents=True)
        for file, data in files.items():
            (made / _checked(file)).write_bytes(data)
        if path.exists():
            path.replace(older)
        made.replace(path)
        shutil.rmtree(older, ignore_errors=True)

    def _path(self, name: str) -> Path:
        return self.folder / _checked(name) if name else self.folder


class StoreShelf:
    """An object store, through fsspec."""

    def __init__(self, files: Any, root: str, scheme: str) -> None:
        self._files, self._root, self._scheme = files, root.rstrip("/"), scheme

    def place(self, name: str = "") -> str:
        """Return the URL."""
        return f"{self._scheme}://{self._path(name).lstrip('/')}"

    def read(self, name: str) -> bytes:
        """Return an object's bytes."""
        try:
            return bytes(self._files.cat_file(self._path(name)))
        except (OSError, KeyError) as error:
            raise FileMissingError(self.place(name), "a file that can be read", _reason(error)) from error

    def write(self, name: str, data: bytes, *, read_only: bool = False) -> None:  # noqa: ARG002 - its keeper's rules
        """Write an object; stores show it when it was sent to its end."""
        self._send(self._path(name), data)

    def exists(self, name: str) -> bool:
        """Tell whether there is such an object."""
        return bool(self._files.isfile(self._path(name)))

    def names(self, folder: str = "") -> frozenset[str]:
        """Return the names below a prefix, asked anew: others write there, too."""
        self._files.invalidate_cache()
        try:
            found = self._files.ls(self._path(folder), detail=False)
        except FileNotFoundError:
            return frozenset()
        except OSError as error:
            raise FileMissingError(self.place(folder), "a place that can be listed", _reason(error)) from error
        return frozenset(str(path).rstrip("/").rpartition("/")[2] for path in found)

    def put_files(self, name: str, files: Mapping[str, bytes], last: str) -> None:
        """Send every file, `last` after the others; what an older folder had beside goes."""
        older = self.names(name)
        for file in sorted(files, key=lambda file: file == last):
            self._send(f"{self._path(name)}/{_checked(file)}", files[file])
        for gone in older - set(files):
            self._files.rm(f"{self._path(name)}/{gone}", recursive=True)

    def _send(self, path: str, data: bytes) -> None:
        try:
            self._files.pipe_file(path, data)
        except OSError as error:
            raise FileMissingError(f"{self._scheme}://{path}", "a place to write to", _reason(error)) from error

    def _path(self, name: str) -> str:
        return f"{self._root}/{_checked(name)}" if name else self._root


def _checked(name: str) -> str:
    """Refuse a name that leads out of the shelf: names come from pseudonyms and hashes only."""
    if name.startswith("/") or "\\" in name or any(part in ("", ".", "..") for part in name.split("/")):
        raise InputError("name", "a relative name inside the course", repr(name))
    return name


def _reason(error: BaseException) -> str:
    return str(error).splitlines()[0][:200] if str(error) else type(error).__name__

"""What learning platforms take: a zip for each student, and one bundle of all.

Only stored, never compressed: videos do not shrink, and the same content is the same bytes with any compressor.
Time stamps are fixed. Names are pseudonyms; whoever knows a platform's number for a student may add it.
"""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from vml_course.io.shelf import Shelf

BUNDLE = "bundle-moodle.zip"
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)
_READABLE = 0o644 << 16

Contents = list[tuple[str, int, int]]


def zip_bytes(files: Mapping[str, bytes]) -> bytes:
    """Return a zip of files; the same files give the same bytes.

    >>> zip_bytes({"b": b"2", "a": b"1"}) == zip_bytes({"a": b"1", "b": b"2"})
    True
    """
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_STORED) as archive:
        for name in sorted(files):
            archive.writestr(_member(name), files[name])
    return content.getvalue()


def moodle_folder(pid: str, participant: str) -> str:
    """Return the folder in which Moodle looks for a participant's feedback files.

    Moodle takes the number only; the first word may be anything without an underscore.

    >>> moodle_folder("k3m9x2ab", "48213")
    'k3m9x2ab_48213_assignsubmission_file'
    """
    return f"{pid.replace('_', '-')}_{participant}_assignsubmission_file"


def write_bundle(shelf: Shelf, path: str, zips: Mapping[str, str]) -> bool:
    """Write one zip of all students' files, a folder for each; return whether anything changed.

    Parameters
    ----------
    shelf : Shelf
    path : str
        Where the bundle goes on the shelf.
    zips : mapping of str to str
        Each student's zip on the shelf, by the name of the folder in the bundle.
    """
    wanted = [line for name, zip_ in _sorted(zips) for line in _contents(shelf, zip_, name)]
    if shelf.exists(path) and _contents(shelf, path) == wanted:
        return False
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "bundle.zip"
        with zipfile.ZipFile(made, "w", zipfile.ZIP_STORED) as bundle:
            for name, data in _members(shelf, zips):
                bundle.writestr(_member(name), data)
        shelf.send(made, path)
    return True


def _members(shelf: Shelf, zips: Mapping[str, str]) -> Iterator[tuple[str, bytes]]:
    for folder, path in _sorted(zips):
        with shelf.open(path) as file, zipfile.ZipFile(file) as archive:
            yield from ((f"{folder}/{member.filename}", archive.read(member)) for member in archive.infolist())


def _sorted(zips: Mapping[str, str]) -> Iterable[tuple[str, str]]:
    return sorted(zips.items())


def _contents(shelf: Shelf, path: str, folder: str = "") -> Contents:
    """Return name, length and checksum of each member; short to read, whatever the size."""
    try:
        with shelf.open(path) as file, zipfile.ZipFile(file) as archive:
            prefix = f"{folder}/" if folder else ""
            return [(prefix + m.filename, m.file_size, m.CRC) for m in archive.infolist()]
    except zipfile.BadZipFile:
        return []


def _member(name: str) -> zipfile.ZipInfo:
    member = zipfile.ZipInfo(name, date_time=_ZIP_EPOCH)
    member.external_attr, member.create_system = _READABLE, 3  # as written on any system
    return member

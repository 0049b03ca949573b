"""What learning platforms take: a zip for each student, and one bundle of all.

Only stored, never compressed: videos do not shrink, and the same content is the same bytes with any compressor.
Time stamps are fixed. Names are pseudonyms; whoever knows a platform's number for a student may add it.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from vml_course.io.files import replacing

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


def write_bundle(path: Path, zips: Mapping[str, Path]) -> bool:
    """Write one zip of all students' files, a folder for each; return whether anything changed.

    Parameters
    ----------
    path : Path
    zips : mapping of str to Path
        Each student's zip, by the name of the folder in the bundle.
    """
    if path.is_file() and _contents(path) == [line for name, zip_ in _sorted(zips) for line in _contents(zip_, name)]:
        return False
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_STORED) as bundle:
        for name, data in _members(zips):
            bundle.writestr(_member(name), data)
    return True


def _members(zips: Mapping[str, Path]) -> Iterator[tuple[str, bytes]]:
    for folder, path in _sorted(zips):
        with zipfile.ZipFile(path) as archive:
            yield from ((f"{folder}/{member.filename}", archive.read(member)) for member in archive.infolist())


def _sorted(zips: Mapping[str, Path]) -> Iterable[tuple[str, Path]]:
    return sorted(zips.items())


def _contents(path: Path, folder: str = "") -> Contents:
    """Return name, length and checksum of each member; short to read, whatever the size."""
    try:
        with zipfile.ZipFile(path) as archive:
            prefix = f"{folder}/" if folder else ""
            return [(prefix + m.filename, m.file_size, m.CRC) for m in archive.infolist()]
    except zipfile.BadZipFile:
        return []


def _member(name: str) -> zipfile.ZipInfo:
    member = zipfile.ZipInfo(name, date_time=_ZIP_EPOCH)
    member.external_attr, member.create_system = _READABLE, 3  # as written on any system
    return member

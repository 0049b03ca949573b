"""What learning platforms take: zips that are the same bytes for the same files.

Only stored, never compressed: videos do not shrink, and the same content is the same bytes with any compressor.
Time stamps are fixed. Names are pseudonyms; whoever knows a platform's number for a student may add it.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping

_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)
_READABLE = 0o644 << 16


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


def unzipped(content: bytes) -> dict[str, bytes]:
    """Return the files of a zip that `zip_bytes` made."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _member(name: str) -> zipfile.ZipInfo:
    member = zipfile.ZipInfo(name, date_time=_ZIP_EPOCH)
    member.external_attr, member.create_system = _READABLE, 3  # as written on any system
    return member

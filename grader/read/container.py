"""The ZIP archive around a workbook: checked before anything is unpacked, and unpacked within limits.

`zipfile` is trusted to list the directory only. Declared sizes are not believed: the inflater stops by itself.
"""

from __future__ import annotations

import io
import struct
import zipfile
import zlib
from collections.abc import Iterable
from dataclasses import dataclass

from grader.read import limits
from grader.read.errors import OUR_TEMPLATE, SAVE_AS, RefusedError

_CENTRAL = b"PK\x01\x02"
_LOCAL = b"PK\x03\x04"
_LOCAL_LENGTH = 30


@dataclass(frozen=True)
class Member:
    """Where a member's packed bytes lie, and what they claim to be."""

    start: int
    packed: int
    size: int
    crc: int
    deflated: bool


@dataclass(frozen=True)
class Container:
    """A checked archive; member names are lower case with forward slashes, and are asked for so."""

    data: bytes
    members: dict[str, Member]

    def __contains__(self, name: str) -> bool:
        return name in self.members

    def read(self, name: str) -> bytes:
        """Unpack one member, never more than it declared.

        Raises
        ------
        RefusedError
            When the member is missing or damaged.
        """
        member = self.members.get(name)
        if member is None:
            raise RefusedError("a workbook with missing parts")
        content = _unpack(self.data[member.start : member.start + member.packed], member)
        if len(content) != member.size or zlib.crc32(content) != member.crc:
            raise RefusedError("a damaged workbook")
        return content


def open_container(data: bytes) -> Container:
    """List and check an archive.

    Raises
    ------
    RefusedError
        Too many members, too large, packed too tightly, encrypted, overlapping, or named twice.
    """
    if data.count(_CENTRAL) > 2 * limits.MEMBERS:
        raise RefusedError(f"an archive of more than {limits.MEMBERS} parts", SAVE_AS)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = archive.infolist()
    except Exception as error:  # zipfile leaks struct, codec and index errors
        raise RefusedError("a damaged or incomplete upload") from error
    _check_sizes(entries)
    return Container(data, _placed(data, entries))


def _check_sizes(entries: list[zipfile.ZipInfo]) -> None:
    if len(entries) > limits.MEMBERS:
        raise RefusedError(f"an archive of more than {limits.MEMBERS} parts", SAVE_AS)
    if sum(entry.file_size for entry in entries) > limits.TOTAL_BYTES:
        raise RefusedError("a workbook that unpacks to more than 96 MB", OUR_TEMPLATE)
    for entry in entries:
        _check_entry(entry)


def _check_entry(entry: zipfile.ZipInfo) -> None:
    if entry.flag_bits & 0x1:
        raise RefusedError("a password-protected archive", "Remove the password and save it again.")
    if entry.compress_type not in {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}:
        raise RefusedError("a workbook packed in an unusual way", SAVE_AS)
    too_tight = entry.file_size > limits.RATIO_FROM_BYTES and entry.file_size > limits.RATIO * entry.compress_size
    if entry.file_size > limits.MEMBER_BYTES or too_tight:
        raise RefusedError("a workbook with a part that unpacks to an unreasonable size", OUR_TEMPLATE)


def _placed(data: bytes, entries: Iterable[zipfile.ZipInfo]) -> dict[str, Member]:
    """Find each member's bytes, refusing doubles and overlaps (two readers could see two different workbooks)."""
    members: dict[str, Member] = {}
    end = 0
    for entry in sorted(entries, key=lambda entry: entry.header_offset):
        name = entry.filename.replace("\\", "/").lstrip("/").lower()
        member = _member(data, entry)
        if name in members:
            raise RefusedError("a workbook that holds the same part twice")
        if entry.header_offset < end:
            raise RefusedError("a workbook whose parts overlap")
        end = member.start + member.packed
        members[name] = member
    return members


def _member(data: bytes, entry: zipfile.ZipInfo) -> Member:
    at = entry.header_offset
    header = data[at : at + _LOCAL_LENGTH]
    if at < 0 or len(header) < _LOCAL_LENGTH or not header.startswith(_LOCAL):
        raise RefusedError("a damaged or incomplete upload")
    start = at + _LOCAL_LENGTH + sum(struct.unpack_from("<2H", header, 26))  # a name and an extra field lie between
    if start + entry.compress_size > len(data):
        raise RefusedError("a damaged or incomplete upload")
    return Member(start, entry.compress_size, entry.file_size, entry.CRC, entry.compress_type == zipfile.ZIP_DEFLATED)


def _unpack(packed: bytes, member: Member) -> bytes:
    if not member.deflated:
        return packed
    inflater = zlib.decompressobj(-15)
    try:
        return inflater.decompress(packed, member.size + 1)
    except zlib.error as error:
        raise RefusedError("a damaged workbook") from error

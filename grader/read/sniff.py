"""What a file really is, by its first bytes: names and endings are not believed."""

from __future__ import annotations

from grader.read.errors import OUR_TEMPLATE, SAVE_AS, UNPACKED, RefusedError
from grader.read.limits import FILE_BYTES

TEXT_TABLE, UNKNOWN = "a text table (CSV)", "a file of unknown kind"
_OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_SIGNATURES = (
    (b"%PDF", "a PDF document", OUR_TEMPLATE),
    (b"\x89PNG", "a picture (PNG)", OUR_TEMPLATE),
    (b"\xff\xd8\xff", "a picture (JPEG)", OUR_TEMPLATE),
    (b"GIF8", "a picture (GIF)", OUR_TEMPLATE),
    (b"Rar!", "a RAR archive", UNPACKED),
    (b"7z\xbc\xaf", "a 7z archive", UNPACKED),
    (b"\x1f\x8b", "a gzip archive", UNPACKED),
    (b"{\\rtf", "a text document (RTF)", OUR_TEMPLATE),
    (b"ID3", "a sound file", OUR_TEMPLATE),
    (b"L\0\0\0\x01\x14\x02\0", "a shortcut to a file", "Hand in the workbook itself, not a shortcut to it."),
)


def require_zip(data: bytes) -> None:
    """Return when `data` starts like a ZIP archive, which every .xlsx is.

    Raises
    ------
    RefusedError
        It says what the file is instead, and what to do.
    """
    if not data:
        raise RefusedError("an empty file", "The upload was damaged; hand it in again.")
    if len(data) > FILE_BYTES:
        limit = f"{FILE_BYTES // 2**20} MB"
        raise RefusedError(
            f"a file of {len(data) / 2**20:.0f} MB (limit {limit})",
            "Delete pictures and unused sheets, then save again.",
        )
    if data.startswith((b"PK\x03\x04", b"PK\x05\x06")):
        return
    raise _other(data)


def kind_of(data: bytes) -> str:
    """Return what a file is, in words: "a PDF document". Its start is enough, but for a workbook."""
    try:
        require_zip(data)
    except RefusedError as error:
        return error.got
    return "a workbook or another document" if b"[Content_Types].xml" in data else "a zip archive"


def _other(data: bytes) -> RefusedError:
    if data.startswith(_OLE):
        return _ole(data)
    for signature, what, hint in _SIGNATURES:
        if data.startswith(signature):
            return RefusedError(what, hint)
    if data[4:8] == b"ftyp" or data.startswith(b"RIFF"):
        return RefusedError("a video", "Hand in the workbook, not the video.")
    return _text(data)


def _ole(data: bytes) -> RefusedError:
    if "EncryptedPackage".encode("utf-16-le") in data:
        return RefusedError(
            "a password-protected workbook", "Remove the password (File, Info, Protect) and save it again."
        )
    if "WordDocument".encode("utf-16-le") in data:
        return RefusedError("an old Word document (.doc)", OUR_TEMPLATE)
    return RefusedError("an old Excel workbook (.xls)", SAVE_AS)


def _text(data: bytes) -> RefusedError:
    head = data[:4096]
    start = head.lstrip(b"\xef\xbb\xbf \t\r\n").lower()
    if start.startswith((b"<!doctype html", b"<html", b"<table")):
        return RefusedError("a web page", f"{OUR_TEMPLATE} If this is it, saved as a web page: {SAVE_AS}")
    if start.startswith(b"{") and b"doc_id" in start:
        return RefusedError("a link to an online document", "There choose File, Download, Microsoft Excel (.xlsx).")
    if start.startswith(b"<?xml"):
        return RefusedError("an XML file", SAVE_AS)
    if b"\0" in head and not head.startswith((b"\xff\xfe", b"\xfe\xff")):
        return RefusedError(UNKNOWN, SAVE_AS)
    if any(mark in head for mark in (b",", b";", b"\t")):
        return RefusedError(TEXT_TABLE, SAVE_AS)
    return RefusedError(UNKNOWN, SAVE_AS)

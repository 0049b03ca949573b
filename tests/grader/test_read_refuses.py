"""What is no workbook, or a dangerous one, ends in one polite line."""

from __future__ import annotations

import io
import struct
import zipfile
import zlib

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from grader.read import ReadRequest, UnreadableError, limits, read_workbook
from grader.read.container import open_container
from grader.read.errors import RefusedError
from grader.read.locate import claims_of, find_submission
from vml_course.errors import InputError


def members(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {info.filename: archive.read(info) for info in archive.infolist()}


def pack(parts: dict[str, bytes]) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in parts.items():
            archive.writestr(name, part)
    return content.getvalue()


def refusal(data: bytes, name: str = "w.xlsx") -> str:
    with pytest.raises(UnreadableError) as caught:
        read_workbook(ReadRequest(name, data))
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(f"{name}: expected an Excel workbook (.xlsx), got ")
    return message


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "empty file"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"\0" * 600, "old Excel workbook (.xls)"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + "EncryptedPackage".encode("utf-16-le"), "password-protected"),
        (b"name;value\ne;0,7\n", "CSV"),
        (b"name,value\ne,0.7\n", "CSV"),
        ("name\tvalue\n".encode("utf-16"), "CSV"),
        (b"<html><table><tr><td>0.7", "web page"),
        (b"<?xml version='1.0'?><Workbook/>", "XML"),
        (b"%PDF-1.7", "PDF"),
        (b"\x89PNG\r\n", "picture"),
        (b"\0\0\0\x20ftypisom", "video"),
        (b"RIFF1234AVI ", "video"),
        (b"Rar!\x1a", "RAR"),
        (b"hello", "unknown kind"),
        (b"\0\1\2\3,", "unknown kind"),
        (b"PK\x03\x04 and then nothing", "incomplete upload"),
    ],
)
def test_other_files_are_named_for_what_they_are(data, words):
    assert words in refusal(data)


def test_a_file_that_is_too_large_is_not_looked_at():
    assert "limit 10 MB" in refusal(b"PK\x03\x04" + bytes(limits.FILE_BYTES))


@pytest.mark.parametrize("keep", [0.1, 0.5, 0.9, 0.999])
def test_a_truncated_upload_is_asked_for_again(good_bytes, keep):
    assert "damaged" in refusal(good_bytes[: int(len(good_bytes) * keep)])


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"mimetype": b"application/vnd.oasis.opendocument.spreadsheet", "content.xml": b"<a/>"}, ".ods"),
        ({"Index/Document.iwa": b"x"}, "Numbers"),
        ({"[Content_Types].xml": b"<a/>", "xl/workbook.bin": b"x"}, ".xlsb"),
        ({"[Content_Types].xml": b"<a/>", "word/document.xml": b"<a/>"}, "Word"),
        ({"[Content_Types].xml": b"<a/>", "ppt/presentation.xml": b"<a/>"}, "presentation"),
        ({"a.txt": b"x"}, "ZIP archive"),
        ({"a.xlsx": b"PK", "b.xlsx": b"PK"}, "ZIP archive"),
    ],
)
def test_other_archives_are_named_for_what_they_are(parts, words):
    assert words in refusal(pack(parts))


def test_a_zip_with_one_workbook_in_it_is_unwrapped_once(good_bytes):
    book = read_workbook(ReadRequest("w.zip", pack({"folder/w.xlsx": good_bytes, "__MACOSX/._w.xlsx": b"x"})))
    assert "zipped" in book.flags
    assert claims_of(book).code == "CODE1"
    assert "ZIP archive" in refusal(pack({"x.xlsx": pack({"w.xlsx": good_bytes})}))


# ---------------------------------------------------------------- bombs

SHEET = "xl/worksheets/sheet2.xml"


@pytest.mark.parametrize("part", [SHEET, "xl/sharedStrings.xml", "xl/styles.xml", "xl/media/image1.png"])
def test_a_bomb_in_any_part_is_refused_by_its_declared_size(good_bytes, part):
    data = pack({**members(good_bytes), part: b" " * (limits.MEMBER_BYTES + 1)})
    assert "unreasonable size" in refusal(data)


def test_a_part_that_packs_too_tightly_is_refused(good_bytes):
    assert "unreasonable size" in refusal(pack({**members(good_bytes), "xl/media/a.png": bytes(8 * 2**20)}))


def test_many_large_parts_are_refused(good_bytes):
    noise = bytes(range(256)) * 4096 * 16
    parts = {f"xl/media/{i}.bin": noise for i in range(7)}
    assert "96 MB" in refusal(pack({**members(good_bytes), **parts}))


def test_a_header_that_lies_about_its_size_stops_the_inflater():
    """The directory declares 10 bytes; the packed bytes hold 50 MB."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    packed = packer.compress(bytes(50 * 2**20)) + packer.flush()
    name = b"[Content_Types].xml"
    local = struct.pack("<4s5H3I2H", b"PK\x03\x04", 20, 0, 8, 0, 0, 0, len(packed), 10, len(name), 0) + name + packed
    central = struct.pack(
        "<4s6H3I5H2I", b"PK\x01\x02", 20, 20, 0, 8, 0, 0, 0, len(packed), 10, len(name), 0, 0, 0, 0, 0, 0
    )
    directory = central + name
    end = struct.pack("<4s4H2IH", b"PK\x05\x06", 0, 0, 1, 1, len(directory), len(local), 0)
    container = open_container(local + directory + end)
    with pytest.raises(RefusedError, match="damaged"):
        container.read("[content_types].xml")


def test_overlapping_parts_are_refused(good_bytes):
    """Two directory entries that share one local entry: each reader could see another workbook."""
    parts = {"a.bin": b"x" * 400, "b.bin": b"y" * 400}
    data = bytearray(pack(parts))
    second = data.rindex(b"PK\x01\x02")
    data[second + 42 : second + 46] = struct.pack("<I", 0)
    assert "overlap" in refusal(bytes(data))


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("name", [SHEET, SHEET.upper(), "\\" + SHEET.replace("/", "\\")])
def test_a_part_that_is_there_twice_is_refused(good_bytes, name):
    content = io.BytesIO(good_bytes)
    with zipfile.ZipFile(content, "a") as archive:
        info = zipfile.ZipInfo("x")
        info.filename = name
        archive.writestr(info, b"<worksheet/>")
    assert "twice" in refusal(content.getvalue())


def test_too_many_parts_are_refused(good_bytes):
    assert "parts" in refusal(pack({f"{i}": b"" for i in range(limits.MEMBERS + 1)}))
    assert "parts" in refusal(pack({f"{i}": b"" for i in range(2 * limits.MEMBERS + 1)}))


def test_an_encrypted_part_is_refused(good_bytes):
    data = bytearray(good_bytes)
    at = data.index(b"PK\x01\x02")
    data[at + 8] |= 1
    assert "password" in refusal(bytes(data))


def test_an_unusual_packing_is_refused(good_bytes):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("[Content_Types].xml", b"<a/>")
    assert "unusual" in refusal(content.getvalue())


@pytest.mark.parametrize("part", ["xl/workbook.xml", SHEET, "xl/styles.xml", "_rels/.rels"])
@pytest.mark.parametrize(
    "head",
    [
        b'<!DOCTYPE a [<!ENTITY x "aaaaaaaaaa"><!ENTITY y "&x;&x;&x;&x;&x;&x;">]>',
        b'<!DOCTYPE a SYSTEM "file:///etc/hostname">',
        b'<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/hostname">]>',
    ],
)
def test_document_types_are_refused_wherever_they_stand(good_bytes, part, head):
    parts = members(good_bytes)
    body = parts[part].partition(b"?>")[2] or parts[part]
    assert "document type" in refusal(pack({**parts, part: head + body}))


@pytest.mark.parametrize(
    ("part", "content", "words"),
    [
        (SHEET, b"<a>" * (limits.XML_DEPTH + 1) + b"</a>" * (limits.XML_DEPTH + 1), "too many cells"),
        (SHEET, b"<worksheet><sheetData><row><c><v>x</v></c></row></sheetData></worksheet>", "damaged"),
        (SHEET, b"<worksheet><sheetData><row><c t='s'><v>999999</v></c></row></sheetData></worksheet>", "damaged"),
        (SHEET, b"<worksheet><sheetData>", "damaged"),
        (SHEET, b"\xff\xfe<", "damaged"),
        ("xl/workbook.xml", b"<workbook><sheets>" + b"<sheet name='a'/>" * 65 + b"</sheets></workbook>", "sheets"),
        (
            "xl/styles.xml",
            b"<styleSheet><cellXfs>" + b"<xf/>" * (limits.STYLES + 1) + b"</cellXfs></styleSheet>",
            "styles",
        ),
    ],
)
def test_broken_and_oversized_parts_are_refused(good_bytes, part, content, words):
    assert words in refusal(pack({**members(good_bytes), part: content}))


def test_too_many_cells_are_refused(good_bytes, monkeypatch):
    monkeypatch.setattr(limits, "CELLS", 50)
    assert "cells" in refusal(good_bytes)


def test_a_workbook_without_our_code_is_told_so(good_bytes):
    parts = members(good_bytes)
    parts["xl/workbook.xml"] = parts["xl/workbook.xml"].replace(b'name="_meta"', b'name="other"')
    with pytest.raises(UnreadableError, match="without our variant code"):
        claims_of(read_workbook(ReadRequest("w.xlsx", pack(parts))))


def test_a_strange_file_name_stays_on_one_line():
    with pytest.raises(UnreadableError) as caught:
        read_workbook(ReadRequest("a\nb\x1b[31m" + "c" * 300, b""))
    assert len(str(caught.value)) < 250
    assert str(caught.value).isprintable()


# ---------------------------------------------------------------- anything at all


def ends_politely(data: bytes, assignment) -> None:
    try:
        find_submission(read_workbook(ReadRequest("w.xlsx", data)), assignment.questions)
    except InputError as error:
        if "\n" in str(error):
            raise


@given(
    st.binary(max_size=400), st.sampled_from([b"", b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", b"PK\x05\x06"])
)
@settings(max_examples=150, deadline=None)
def test_any_bytes_end_politely(assignment, data, head):
    ends_politely(head + data, assignment)


@given(st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.integers(0, 255)), min_size=1, max_size=6))
@settings(max_examples=120, deadline=None)
def test_any_changed_byte_ends_politely(assignment, good_bytes, changes):
    data = bytearray(good_bytes)
    for place, value in changes:
        data[int(place * len(data))] = value
    ends_politely(bytes(data), assignment)


TOKENS = [
    b"",
    b"<",
    b">",
    b'"',
    b"&#0;",
    b"&amp;",
    b"<c>",
    b"</c>",
    b"-1",
    b"1e999",
    b"99999999999",
    b"A1",
    b"\xff",
    b"<f>",
    b"t=",
]


@given(
    st.sampled_from(
        [
            "xl/workbook.xml",
            SHEET,
            "xl/worksheets/sheet3.xml",
            "xl/worksheets/sheet4.xml",
            "xl/styles.xml",
            "xl/_rels/workbook.xml.rels",
            "_rels/.rels",
        ]
    ),
    st.lists(
        st.tuples(st.floats(0, 1, exclude_max=True), st.integers(0, 12), st.sampled_from(TOKENS)),
        min_size=1,
        max_size=4,
    ),
)
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_changed_markup_ends_politely(assignment, good_bytes, part, changes):
    parts = members(good_bytes)
    content = parts[part]
    for place, length, token in changes:
        at = int(place * len(content))
        content = content[:at] + token + content[at + length :]
    ends_politely(pack({**parts, part: content}), assignment)

"""An archive is believed in nothing: what it declares is checked against what it holds."""

from __future__ import annotations

import struct
import zipfile
import zlib

import corpus
import pytest

from grader.read import ReadRequest, UnreadableError, read_workbook
from grader.read.container import open_container
from grader.read.errors import RefusedError
from grader.read.sniff import kind_of

TYPES = "[Content_Types].xml"


def test_an_archive_with_a_password_is_told_to_be_saved_without():
    data = bytearray(corpus.pack({TYPES: b"<Types/>"}))
    data[data.index(b"PK\x01\x02") + 8] |= 1
    with pytest.raises(UnreadableError, match=r"a password-protected archive.*Remove the password"):
        read_workbook(ReadRequest("w.xlsx", bytes(data)))


@pytest.mark.parametrize("packing", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_an_archive_packed_in_another_way_is_told_to_be_saved_as_a_workbook(packing):
    with pytest.raises(UnreadableError, match=r"packed in an unusual way.*File, Save As"):
        read_workbook(ReadRequest("w.xlsx", corpus.pack({TYPES: b"<Types/>"}, packing)))


@pytest.mark.parametrize("packing", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize(("field", "value"), [(16, b"\0\0\0\0"), (24, b"\x05\0\0\0"), (24, b"\xff\0\0\0")])
def test_a_part_with_another_sum_or_length_than_declared_is_damaged(packing, field, value):
    data = bytearray(corpus.pack({TYPES: b"<Types></Types>"}, packing))
    directory = data.index(b"PK\x01\x02")
    data[directory + field : directory + field + 4] = value
    with pytest.raises(RefusedError, match="a damaged workbook"):
        open_container(bytes(data)).read(TYPES.lower())


@pytest.mark.parametrize("name", ["/xl/a.xml", "//xl/a.xml", "\\xl\\a.xml", "XL/A.xml"])
def test_a_part_has_one_name_however_it_is_written(name):
    info = zipfile.ZipInfo("x")
    info.filename = name
    container = open_container(corpus.pack({info: b"<a/>"}))
    assert list(container.members) == ["xl/a.xml"]
    assert "xl/a.xml" in container
    assert container.read("xl/a.xml") == b"<a/>"


def test_what_some_programs_write_before_a_part_is_passed_over():
    info = zipfile.ZipInfo("a.xml")
    info.extra = b"\xfe\xca\x04\0more"
    assert open_container(corpus.pack({info: b"<a/>"})).read("a.xml") == b"<a/>"


def test_a_part_may_end_where_the_file_ends_and_not_beyond():
    content = b"<Types/>"
    packed, crc = corpus.deflated(content), zlib.crc32(content)
    entry = (b"a.xml", packed, len(content), crc)
    before = len(corpus.raw_archive([(*entry, 0)], b""))
    data = corpus.raw_archive([(*entry, before)], b"") + corpus.local(*entry)
    assert open_container(data).read("a.xml") == content
    with pytest.raises(RefusedError, match="incomplete upload"):
        open_container(data[:-1])


def test_a_part_that_would_lie_before_the_file_is_an_incomplete_upload():
    """Python counts it from the end, where another part could lie in wait."""
    content = b"<Types/>"
    packed, name, crc = corpus.deflated(content), TYPES.encode(), zlib.crc32(content)
    behind = corpus.local(b"", packed, len(content), crc)
    body = corpus.local(name, packed, len(content), crc)
    data = corpus.raw_archive([(name, packed, len(content), crc, 0)], body)
    directory_at = struct.pack("<I", len(body) + len(behind))  # so that 0 is so far before the file
    data = data[:-6] + directory_at + data[-2:] + behind
    with pytest.raises(RefusedError, match="incomplete upload"):
        open_container(data)


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (b"%PDF-1.7", "a PDF document"),
        (b"a;b\n1;2\n", "a text table (CSV)"),
        (b"PK\x03\x04 and so on", "a zip archive"),
        (b"PK\x03\x04 [Content_Types].xml", "a workbook or another document"),
        (b"PK\x03\x04 [content_types].xml", "a zip archive"),
    ],
)
def test_what_a_file_is_has_a_name(data, kind):
    assert kind_of(data) == kind

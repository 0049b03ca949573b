"""Every hostile or foreign file ends in one polite line, after little work."""

from __future__ import annotations

import zipfile
import zlib

import corpus
import pytest

from grader.read import ReadRequest, UnreadableError, container, limits, markup, read_workbook
from grader.read.locate import claims_of


def refusal(data: bytes) -> str:
    with pytest.raises(UnreadableError) as caught:
        read_workbook(ReadRequest("w.xlsx", data))
    message = str(caught.value)
    assert message.startswith("w.xlsx: expected an Excel workbook (.xlsx), got ")
    assert message.isprintable()
    assert caught.value.hint
    return message


@pytest.fixture
def work(monkeypatch):
    """How many bytes were unpacked and how many bytes of markup were read."""
    done = {"unpacked": 0, "parsed": 0}
    unpack, create = container._unpack, markup.expat.ParserCreate

    def counted(packed, member):
        content = unpack(packed, member)
        done["unpacked"] += len(content)
        return content

    class Parser:
        def __init__(self):
            object.__setattr__(self, "inner", create())

        def __setattr__(self, name, value):
            setattr(self.inner, name, value)

        def Parse(self, content, is_final):  # noqa: N802 - expat's name
            done["parsed"] += len(content)
            return self.inner.Parse(content, is_final)

    monkeypatch.setattr(container, "_unpack", counted)
    monkeypatch.setattr(markup.expat, "ParserCreate", Parser)
    return done


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("name", corpus.HOSTILE)
def test_a_hostile_file_is_refused_before_much_work_is_done(good_bytes, work, name):
    make, words = corpus.HOSTILE[name]
    assert words in refusal(make(good_bytes))
    assert work["unpacked"] < 2**20
    assert work["parsed"] < 2**18


AGAIN = ("header lies", "a sheet twice", "401 entries", "an entry inside")  # damaged on the way
TOO_MANY_PARTS = ("1000 parts",)


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("name", corpus.HOSTILE)
def test_a_hostile_file_is_told_what_to_do(good_bytes, name):
    with pytest.raises(UnreadableError) as caught:
        read_workbook(ReadRequest("w.xlsx", corpus.HOSTILE[name][0](good_bytes)))
    words = "save it again" if name.startswith(AGAIN) else "File, Save As" if name in TOO_MANY_PARTS else "Type your"
    assert words in caught.value.hint


@pytest.mark.parametrize("name", corpus.OTHER_FORMATS)
def test_another_format_is_named_for_what_it_is(good_bytes, name):
    make, words = corpus.OTHER_FORMATS[name]
    assert words in refusal(make(good_bytes))


WHAT_TO_DO = {
    "nothing": "hand it in again",
    "password": "Remove the password",
    "old .doc": "the workbook that came with your video",
    "docx": "the workbook that came with your video",
    "pptx": "the workbook that came with your video",
    "numbers": "Export To",
    **dict.fromkeys(("zip of no workbook", "zip of two workbooks"), "not packed"),
    **dict.fromkeys(("zip in a zip", "zip in a zip, named so"), "not packed"),
    **dict.fromkeys(("half an upload", "the tail cut off"), "save it again"),
    "a shortcut of a cloud drive": "File, Download",
    "a shortcut of Windows": "not a shortcut",
    "pdf": "the workbook that came with your video",
}


@pytest.mark.parametrize("name", corpus.OTHER_FORMATS)
def test_another_format_is_told_what_to_do(good_bytes, name):
    with pytest.raises(UnreadableError) as caught:
        read_workbook(ReadRequest("w.xlsx", corpus.OTHER_FORMATS[name][0](good_bytes)))
    assert WHAT_TO_DO.get(name, "File, Save As, Excel Workbook (.xlsx)") in caught.value.hint


WHAT_HELPS = {
    "picture": "Type your answers into the workbook that came with your video",
    "RTF": "Type your answers into the workbook",
    "sound": "Type your answers into the workbook",
    "archive": "Hand in the workbook itself, not packed",
    "a video": "Hand in the workbook, not the video",
    "incomplete upload": "save it again",
}


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"\x89PNG", "a picture (PNG)"),
        (b"\xff\xd8\xff", "a picture (JPEG)"),
        (b"GIF89a", "a picture (GIF)"),
        (b"7z\xbc\xaf", "a 7z archive"),
        (b"\x1f\x8b", "a gzip archive"),
        (b"{\\rtf1", "a text document (RTF)"),
        (b"ID3", "a sound file"),
        (b"RIFF....AVI ", "a video"),
        (b"....ftypmp42", "a video"),
        (b"...ftyp.", "unknown kind"),
        (b" \t\r\n<HTML>", "a web page"),
        (b"<table>", "a web page"),
        (b"{'url': 1}", "unknown kind"),
        (b"doc_id", "unknown kind"),
        (b"\xfe\xff\0a\0;", "CSV"),
        (b"\xff\xfea\0;\0", "CSV"),
        (b"a,b", "CSV"),
        (b"a\0;", "unknown kind"),
        (b"a" * 4095 + b";", "CSV"),
        (b"a" * 4096 + b";", "unknown kind"),
        (b"PK\x05\x06", "incomplete upload"),
    ],
)
def test_a_file_is_known_by_its_first_bytes(data, words):
    with pytest.raises(UnreadableError) as caught:
        read_workbook(ReadRequest("w.xlsx", data))
    assert words in caught.value.got
    told = next((hint for what, hint in WHAT_HELPS.items() if what in words), "File, Save As, Excel Workbook (.xlsx)")
    assert told in caught.value.hint


@pytest.mark.parametrize("folder", ["", "Doe Jane_4711_assignsubmission_file/"])
def test_one_workbook_in_a_zip_is_unwrapped_once(good_bytes, folder):
    data = corpus.pack({f"{folder}w.xlsx": good_bytes, "__MACOSX/._w.xlsx": b"x", "notes.txt": b"x"})
    book = read_workbook(ReadRequest("w.zip", data))
    assert book.flags == ("zipped",)
    assert claims_of(book).assignment_id == "soccer-kick"


@pytest.mark.parametrize("at", [26, 28])
def test_a_part_that_would_lie_beyond_the_file_is_an_incomplete_upload(good_bytes, at):
    data = bytearray(good_bytes)
    last = data.rindex(b"PK\x03\x04")
    data[last + at : last + at + 2] = b"\xff\xff"
    assert "incomplete" in refusal(bytes(data))


def test_a_header_that_is_none_is_an_incomplete_upload(good_bytes):
    data = bytearray(good_bytes)
    data[data.rindex(b"PK\x03\x04")] = 0
    assert "incomplete" in refusal(bytes(data))


def test_damaged_packing_is_a_damaged_workbook(good_bytes):
    name, content = b"[Content_Types].xml", b"<a/>"
    packed = b"\xff" * 20
    body = corpus.local(name, packed, len(content), zlib.crc32(content))
    data = corpus.raw_archive([(name, packed, len(content), zlib.crc32(content), 0)], body)
    with pytest.raises(container.RefusedError, match="damaged"):
        container.open_container(data).read("[content_types].xml")
    assert "missing" in refusal_of_part(data, "xl/absent.xml")


def refusal_of_part(data: bytes, name: str) -> str:
    with pytest.raises(container.RefusedError) as caught:
        container.open_container(data).read(name)
    return str(caught.value)


def test_a_stored_part_is_read_as_it_is(good_bytes):
    stored = corpus.pack(corpus.members(good_bytes), zipfile.ZIP_STORED)
    assert claims_of(read_workbook(ReadRequest("w.xlsx", stored))).code == "CODE1"


def test_many_cells_over_several_sheets_are_refused(good_bytes, monkeypatch):
    grid = [[1.0] * 10] * 10
    data = corpus.Dialect().write({"a": grid, "b": grid, "c": grid})
    monkeypatch.setattr(limits, "CELLS", 250)
    assert "more than 250 cells" in refusal(data)


def test_strange_names_do_not_grow_the_memory(monkeypatch):
    monkeypatch.setattr(limits, "XML_NAMES", 2)
    seen = []
    handlers = markup._ByName({"b": seen.append})
    for name in ["a", "x:b", "y:b", "b", "c", "y:b"]:
        handler = handlers[name]
        if handler is not None:
            handler(name)
    assert seen == ["x:b", "y:b", "b", "y:b"]
    assert len(handlers) == 2


def test_more_elements_than_any_workbook_has_are_refused_before_they_are_read(work, monkeypatch):
    monkeypatch.setattr(limits, "XML_ELEMENTS", 3)
    markup.parse(b"<a><b></b><b/></a>", {})
    read = work["parsed"]
    with pytest.raises(container.RefusedError, match="far too many cells"):
        markup.parse(b"<a><b></b><b/><b/></a>", {})
    assert work["parsed"] == read


def test_the_text_of_an_element_is_what_stands_in_it_alone():
    said = []
    markup.parse(b"<a>no<v>1&amp;2</v>no<w><v/>no</w><v>3</v></a>", {}, {"v": said.append})
    assert said == ["1&2", "", "3"]

"""A workbook is its sheets, names and flags, wherever its parts lie and whichever process read it."""

from __future__ import annotations

import hashlib
import pickle

import corpus
import pytest

from grader.kind import Kind
from grader.read import BookCell, ReadRequest, UnreadableError, limits, read_workbook
from grader.read.book import Sheet
from grader.read.flags import Flag

TYPES = "[Content_Types].xml"
ONE = b'<worksheet><sheetData><c r="A1"><v>1</v></c></sheetData></worksheet>'
FAR = b'<worksheet><sheetData><c r="A30000"><v>1</v></c></sheetData></worksheet>'
BLANK = BookCell(Kind.BLANK)


def relations(*targets: tuple[str, str, str]) -> bytes:
    """A relations part of (id, kind, target)."""
    lines = "".join(f'<Relationship Id="{i}" Type="http://x/{kind}" Target="{to}"/>' for i, kind, to in targets)
    return f"<Relationships>{lines}</Relationships>".encode()


def workbook(sheets: str = '<sheet name="a" id="a"/>', **parts: bytes) -> bytes:
    """A small workbook of one sheet `a`; `parts` come on top."""
    targets = ("a", "worksheet", "worksheets/a.xml"), ("b", "worksheet", "worksheets/b.xml")
    own = {
        TYPES: b"<Types/>",
        "_rels/.rels": relations(("w", "officeDocument", "xl/workbook.xml")),
        "xl/workbook.xml": f"<workbook>{sheets}</workbook>".encode(),
        "xl/_rels/workbook.xml.rels": relations(*targets, ("c", "chartsheet", "chartsheets/c.xml")),
        "xl/worksheets/a.xml": ONE,
        "xl/worksheets/b.xml": ONE,
    }
    return corpus.pack({**own, **parts})


def read(data: bytes, name: str = "w.xlsx"):
    return read_workbook(ReadRequest(name, data))


# ---------------------------------------------------------------- sheets


def test_a_sheet_is_its_name_cells_merged_ranges_and_whether_it_is_seen():
    states = ("visible", "hidden", "veryHidden")
    listed = "".join(f'<sheet name="{state}" state="{state}" id="a"/>' for state in states)
    merged = ONE.replace(b"</sheetData>", b'</sheetData><mergeCell ref="A1:B2"/>')
    book = read(workbook(listed, **{"xl/worksheets/a.xml": merged}))
    cells, merges = {(1, 1): BookCell(Kind.NUMBER, 1.0)}, ((1, 1, 2, 2),)
    assert book.sheets == tuple(Sheet(state, state == "visible", cells, merges) for state in states)


def test_every_cell_of_a_merged_range_shows_the_value_of_its_corner():
    value, beside = BookCell(Kind.NUMBER, 7.0), BookCell(Kind.TEXT, None, "x")
    sheet = Sheet("s", is_visible=True, cells={(2, 2): value, (3, 3): beside}, merges=((2, 2, 4, 3), (6, 1, 6, 2)))
    inside = {(row, column): value for row in (2, 3, 4) for column in (2, 3)} | {(3, 3): beside}
    assert {(row, column): sheet.at((row, column)) for row, column in inside} == inside
    around = [(1, 2), (5, 2), (2, 1), (2, 4), (3, 1), (3, 4), (1, 1), (5, 4)]
    assert [sheet.at(place) for place in around] == [BLANK] * len(around)
    assert [sheet.at((6, column)) for column in (1, 2, 3)] == [BLANK] * 3


def test_a_chart_sheet_and_one_without_a_part_are_passed_over():
    listed = '<sheet name="chart" id="c"/><sheet name="lost" id="z"/><sheet name="a" id="a"/>'
    assert [sheet.name for sheet in read(workbook(listed)).sheets] == ["a"]


def test_sheets_have_so_many_cells_together_and_no_more(monkeypatch):
    data = workbook('<sheet name="a" id="a"/><sheet name="b" id="b"/>')
    monkeypatch.setattr(limits, "CELLS", 2)
    assert len(read(data).sheets) == 2
    monkeypatch.setattr(limits, "CELLS", 1)
    with pytest.raises(UnreadableError, match="more than 1 cells"):
        read(data)


def test_days_of_a_whole_workbook_are_counted_from_1904():
    parts = {
        "xl/_rels/workbook.xml.rels": relations(("a", "worksheet", "worksheets/a.xml"), ("s", "styles", "styles.xml")),
        "xl/styles.xml": b'<styleSheet><cellXfs><xf numFmtId="14"/></cellXfs></styleSheet>',
        "xl/worksheets/a.xml": ONE.replace(b'r="A1"', b'r="A1" s="0"'),
    }
    book = read(workbook('<workbookPr date1904="1"/><sheet name="a" id="a"/>', **parts))
    assert book.sheets[0].at((1, 1)).written == "1904-01-02"
    assert book.flags == (Flag.DATE_SYSTEM_1904,)
    plain = read(workbook('<workbookPr/><sheet name="a" id="a"/>', **parts))
    assert plain.flags == ()


# ---------------------------------------------------------------- parts


@pytest.mark.parametrize("path", ["book.xml", "xl/workbook2.xml", "deep/er/book.xml"])
def test_a_workbook_lies_where_its_package_says(path):
    folder, _, file = path.rpartition("/")
    parts = {
        "_rels/.rels": relations(("p", "core-properties", "docProps/core.xml"), ("w", "officeDocument", path)),
        path: b'<workbook><sheet name="there" id="x"/></workbook>',
        f"{folder}/_rels/{file}.rels".removeprefix("/"): relations(("x", "worksheet", "/xl/worksheets/a.xml")),
    }
    assert [sheet.name for sheet in read(workbook(**parts)).sheets] == ["there"]


def test_a_package_that_does_not_say_has_its_workbook_in_the_usual_place():
    parts = corpus.members(workbook())
    del parts["_rels/.rels"]
    assert [sheet.name for sheet in read(corpus.pack(parts)).sheets] == ["a"]


@pytest.mark.parametrize("missing", ["xl/_rels/workbook.xml.rels", "xl/worksheets/a.xml"])
def test_a_workbook_that_lacks_a_part_is_told_to_be_saved_again(missing):
    parts = corpus.members(workbook())
    del parts[missing]
    with pytest.raises(UnreadableError, match=r"a workbook with missing parts.*save it again"):
        read(corpus.pack(parts))


def test_a_list_of_texts_that_is_missing_is_one_without_texts():
    lists = relations(("s", "sharedStrings", "s.xml"), ("f", "styles", "f.xml"), ("a", "worksheet", "worksheets/a.xml"))
    book = read(workbook(**{"xl/_rels/workbook.xml.rels": lists}))
    assert book.sheets[0].cells == {(1, 1): BookCell(Kind.NUMBER, 1.0)}


# ---------------------------------------------------------------- what a person should know


@pytest.mark.parametrize(
    ("parts", "flags"),
    [
        ({}, ()),
        ({"xl/vbaProject.bin": b"x"}, (Flag.MACROS,)),
        ({"xl/externalLinks/externalLink1.xml": b"<a/>"}, (Flag.LINKS,)),
        ({"xl/worksheets/a.xml": FAR}, (Flag.FAR_CELLS,)),
        (
            {"xl/vbaProject.bin": b"x", "xl/externalLinks/_rels/e.xml.rels": b"<a/>", "xl/worksheets/a.xml": FAR},
            (Flag.FAR_CELLS, Flag.LINKS, Flag.MACROS),
        ),
    ],
)
def test_macros_links_and_far_cells_are_flagged_together(parts, flags):
    book = read(workbook('<sheet name="a" id="a"/><sheet name="b" id="b"/>', **parts))
    assert book.flags == tuple(sorted(flags))


def test_a_message_shows_a_file_name_in_letters_that_can_be_seen():
    with pytest.raises(UnreadableError) as caught:
        read(b"", "a\nb\0 Größe.xlsx")
    assert str(caught.value).startswith("a?b? Größe.xlsx: expected")


def test_a_book_knows_its_file_and_its_names():
    data = workbook('<sheet name="a" id="a"/><definedName name="Ans_e">a!$A$1</definedName>')
    book = read(data, "Doe.xlsx")
    assert (book.name, book.names) == ("Doe.xlsx", {"ans_e": "a!$A$1"})
    assert book.file_sha256 == hashlib.sha256(data).hexdigest()


@pytest.mark.parametrize("name", ["w.xlsx", "w.xlsm", "W.XLSM"])
def test_a_zipped_workbook_is_read_under_the_name_and_the_hash_of_the_archive(name):
    inner = workbook('<sheet name="a" id="a"/><definedName name="n">a!$A$1</definedName>', **{"vbaProject.bin": b"x"})
    data = corpus.pack({name: inner})
    book, plain = read(data, "Doe.zip"), read(inner)
    assert (book.name, book.file_sha256) == ("Doe.zip", hashlib.sha256(data).hexdigest())
    assert (book.sheets, book.names, book.flags) == (plain.sheets, plain.names, (Flag.MACROS, Flag.ZIPPED))


# ---------------------------------------------------------------- between processes


@pytest.mark.parametrize("cells", [{}, {(1, 2): BookCell(Kind.NUMBER, 1.5, "", "0.0", True), (3, 1): BLANK}])
def test_a_sheet_that_has_travelled_is_the_same(cells):
    sheet = Sheet("s", is_visible=False, cells=cells, merges=((1, 2, 3, 4),))
    arrived = pickle.loads(pickle.dumps(sheet))  # noqa: S301 - our own
    assert arrived == sheet
    assert all(isinstance(cell, BookCell) for cell in arrived.cells.values())


@pytest.mark.parametrize(
    "damaged",
    [
        (((1, 2), (1,)), ((Kind.BLANK, Kind.BLANK),)),  # two rows, one column
        (((1, 2), (1, 2)), ((Kind.BLANK,),)),  # two places, one cell
    ],
)
def test_columns_that_do_not_fit_are_no_sheet(damaged):
    """What is left would stand in the wrong place, or be missing unseen."""
    with pytest.raises(ValueError, match="shorter"):
        Sheet("s", is_visible=True, cells={}).__setstate__({"cells": damaged})

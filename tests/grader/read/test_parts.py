"""The parts of a workbook as markup: what is refused with which hint, and what odd programs leave out."""

from __future__ import annotations

import contextlib

import pytest

from grader.kind import Kind
from grader.read import BookCell, limits
from grader.read.errors import AGAIN, OUR_TEMPLATE, RefusedError
from grader.read.markup import parse
from grader.read.parts import read_directory, read_formats, read_relations
from grader.read.sheet import read_sheet


@contextlib.contextmanager
def refuses(words: str, hint: str = OUR_TEMPLATE):
    with pytest.raises(RefusedError, match=words) as caught:
        yield
    assert caught.value.hint == hint


def sheet(cells: str):
    return read_sheet(f"<worksheet><sheetData>{cells}</sheetData></worksheet>".encode(), [], ["", "0.0", "yyyy"])


# ---------------------------------------------------------------- markup


@pytest.mark.parametrize("text", ["<!DOCTYPE a><a/>", '<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>'])
def test_a_document_type_is_refused(text):
    with refuses("a document type declaration"):
        parse(text.encode(), {})


@pytest.mark.parametrize("text", ["", "<a>", "<a></b>", "<a>&b;</a>", "a", "<a/><b/>"])
def test_what_is_no_markup_or_stops_midway_is_damaged(text):
    with refuses("a damaged workbook", AGAIN):
        parse(text.encode(), {})


def test_so_many_elements_and_no_more(monkeypatch):
    monkeypatch.setattr(limits, "XML_ELEMENTS", 3)
    parse(b"<a><b></b><c/></a>", {})
    with refuses("far too many cells"):
        parse(b"<a><b></b><c/><c/></a>", {})


def test_depth_is_counted_from_where_we_are(monkeypatch):
    monkeypatch.setattr(limits, "XML_DEPTH", 3)
    with refuses("far too many cells"):
        parse(b"<a><b><c/><c><d/></c></b></a>", {})


def test_a_list_that_is_too_long_is_refused_with_a_hint(monkeypatch):
    monkeypatch.setattr(limits, "SHEETS", 1)
    with refuses("more than 1 sheets"):
        read_directory(b"<a><sheet/><sheet/></a>")
    monkeypatch.setattr(limits, "CELLS", 1)
    with refuses("more than 1 cells"):
        sheet('<c r="A1"><v>1</v></c><c r="B1"><v>1</v></c>')


# ---------------------------------------------------------------- lists


@pytest.mark.parametrize("is_first", [True, False])
def test_a_name_of_the_workbook_counts_before_one_of_a_single_sheet(is_first):
    both = ['<definedName name="e">A!B1</definedName>', '<definedName name="e" localSheetId="1">B!B1</definedName>']
    found = read_directory(f"<a>{''.join(both if is_first else both[::-1])}</a>".encode())
    assert found.names == {"e": "A!B1"}


def test_a_name_of_a_single_sheet_counts_where_there_is_no_other():
    assert read_directory(b'<a><definedName name="e" localSheetId="0">A!B1</definedName></a>').names == {"e": "A!B1"}


def test_a_path_in_capitals_leads_to_the_same_member():
    found = read_relations(b'<a><Relationship Id="a" Target="/XL/Styles.xml"/></a>', "xl")
    assert found["a"].target == "xl/styles.xml"


def test_a_format_without_a_code_is_general():
    assert read_formats(b'<a><numFmt numFmtId="200"/><cellXfs><xf numFmtId="200"/></cellXfs></a>') == [""]


# ---------------------------------------------------------------- cells


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ('s="2"><v>0</v>', BookCell(Kind.DATE, 0.0, "00:00:00", "yyyy")),
        ('s="2"><v>1</v>', BookCell(Kind.DATE, 1.0, "1899-12-31", "yyyy")),
        ('s="2"><v>1e12</v>', BookCell(Kind.DATE, 1e12, "", "yyyy")),  # no calendar has it
        ('s="7"><v>1.5</v>', BookCell(Kind.NUMBER, 1.5, "", "")),
        ('s="x"><v>1.5</v>', BookCell(Kind.NUMBER, 1.5, "", "")),
        ('t="str"><v> \t</v>', None),
    ],
)
def test_a_cell_with_an_odd_date_style_or_text(cell, expected):
    assert sheet(f'<c r="A1" {cell}</c>').cells.get((1, 1)) == expected

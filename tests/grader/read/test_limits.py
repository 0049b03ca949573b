"""Each limit is held at its very edge: what is as large as allowed is read, one more is refused, cut or flagged."""

from __future__ import annotations

import struct

import corpus
import pytest

from grader.kind import Kind
from grader.read import BookCell, ReadRequest, UnreadableError, limits, read_workbook
from grader.read.book import shown_name
from grader.read.container import open_container
from grader.read.errors import RefusedError
from grader.read.flags import Flag
from grader.read.markup import parse
from grader.read.parts import read_directory, read_formats, read_relations, read_strings
from grader.read.sheet import address_of, place_of, read_sheet, shortest
from grader.read.sniff import require_zip


def sheet(cells: str, strings=(), formats=()):
    return read_sheet(f"<worksheet><sheetData>{cells}</sheetData></worksheet>".encode(), strings, formats)


def refuses(words: str):
    return pytest.raises(RefusedError, match=words)


def times(count: int, element: str, within: str = "a") -> bytes:
    return f"<{within}>{element * count}</{within}>".encode()


def test_the_last_row_and_the_last_column_are_read():
    found = sheet('<c r="A20000"><v>1</v></c><c r="IV1"><v>2</v></c>')
    assert (found.cells[20_000, 1].number, found.cells[1, 256].number, found.flags) == (1, 2, set())
    for place in ("A20001", "IW1"):
        beyond = sheet(f'<c r="{place}"><v>1</v></c>')
        assert (beyond.cells, beyond.flags) == ({}, {Flag.FAR_CELLS})


@pytest.mark.parametrize(("address", "column"), [("Z9", 26), ("AA9", 27), ("AB9", 28), ("AZ9", 52), ("AAA9", 703)])
def test_columns_are_counted_in_letters(address, column):
    assert (place_of(address), address_of((9, column))) == ((9, column), address)


def test_a_row_says_its_number_or_is_the_next():
    cell = "<c><v>1</v></c>"
    found = sheet(f'<row r="5">{cell}</row><row>{cell}</row><row r="12345678">{cell}</row>')  # too long for a number
    assert set(found.cells) == {(5, 1), (6, 1), (7, 1)}
    far = sheet(f'<row r="1000000">{cell}</row>')
    assert (far.cells, far.flags) == ({}, {Flag.FAR_CELLS})


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ('s="1"><v>1.5</v>', BookCell(Kind.NUMBER, 1.5, "", "0.0")),
        ('s="1"><f>B1</f><v>1.5</v>', BookCell(Kind.NUMBER, 1.5, "", "0.0", True)),
        ('s="1"><f>B1</f>', BookCell(Kind.UNCACHED, None, "", "0.0", True)),
        ('s="2"><v>45413</v>', BookCell(Kind.DATE, 45413.0, "2024-05-01", "yyyy")),
        ('s="2"><f>B1</f><v>0.5</v>', BookCell(Kind.DATE, 0.5, "12:00:00", "yyyy", True)),
        (f"><f>B1</f><v>1e{'9' * 40}</v>", BookCell(Kind.ERROR, None, "1e" + "9" * 38, "", True)),
        ('t="e" s="1"><v>#N/A</v>', BookCell(Kind.ERROR, None, "#N/A")),
        ('t="b"><f>B1</f><v>1</v>', BookCell(Kind.BOOL, None, "TRUE", "", True)),
        ('t="str" s="1"><f>B1</f><v>a</v>', BookCell(Kind.TEXT, None, "a", "0.0", True)),
        ('t="inlineStr" s="1"><is><t>a</t></is>', BookCell(Kind.TEXT, None, "a", "0.0")),
    ],
)
def test_a_cell_is_read_whole(cell, expected):
    assert sheet(f'<c r="A1" {cell}</c>', formats=["", "0.0", "yyyy"]).cells == {(1, 1): expected}


def test_days_are_counted_from_1904_where_the_workbook_says_so():
    content = b'<c r="A1" s="0"><v>1</v></c>'
    assert read_sheet(content, [], ["yyyy"], is_1904=True).cells[1, 1].written == "1904-01-02"


def test_a_text_is_known_by_its_place_in_the_list():
    def text(index: str):
        return sheet(f'<c r="A1" t="s"><v>{index}</v></c>', ["a", "b"]).cells[1, 1].written

    assert (text("0"), text("1"), text("0000001")) == ("a", "b", "b")
    for index in ("2", "-1", "x", "²", "00000001"):
        with refuses("a damaged workbook"):
            text(index)


def test_what_is_no_number_is_damaged():
    with refuses("a damaged workbook"):
        sheet('<c r="A1"><v>one</v></c>')


@pytest.mark.parametrize(("number", "text"), [(-0.0, "0"), (1e-7, "1e-07"), (1e300, "1e+300"), (-2.5, "-2.5")])
def test_a_number_has_its_shortest_text(number, text):
    assert shortest(number) == text


@pytest.mark.parametrize(
    ("number", "code"),
    [
        *((number, "date") for number in ("14", "22", "27", "36", "45", "47", "50", "58")),
        *((number, "") for number in ("0", "13", "23", "26", "37", "44", "48", "49", "59", "1400000", "²", "x")),
        *((number, "0%") for number in ("9", "10")),
        ("164", ""),  # general, by a number of its own
        ("165", "0.0"),
    ],
)
def test_styles_have_the_code_of_their_number(number, code):
    own = '<numFmt numFmtId="164" formatCode="General"/><numFmt numFmtId="165" formatCode="0.0"/>'
    styles = f'<a><xf numFmtId="14"/>{own}<cellXfs><xf numFmtId="{number}"/><xf/></cellXfs><xf numFmtId="14"/></a>'
    assert read_formats(styles.encode()) == [code, ""]


def test_relations_lead_to_members():
    lines = (
        '<Relationship Id="a" Type="http://x/worksheet" Target="worksheets/Sheet1.xml"/>'
        '<Relationship Id="b" Type="http://x/styles" Target="/xl/styles.xml"/>'
        '<Relationship Id="c" Type="http://x/styles" Target="..\\other.xml"/>'
        '<Relationship Id="d" Type="http://x/hyperlink" Target="http://x" TargetMode="External"/>'
    )
    found = read_relations(f"<a>{lines}<Relationship/></a>".encode(), "xl")
    assert {key: (r.target, r.type) for key, r in found.items()} == {
        "a": ("xl/worksheets/sheet1.xml", "worksheet"),
        "b": ("xl/styles.xml", "styles"),
        "c": ("other.xml", "styles"),
        "": ("xl", ""),
    }


@pytest.mark.parametrize(("said", "is_1904"), [("1", True), ("True", True), ("0", False), ("", False), (None, False)])
def test_a_directory_lists_sheets_names_and_the_date_system(said, is_1904):
    system = "<workbookPr/>" if said is None else f'<workbookPr date1904="{said}"/>'
    sheets = '<sheet name="A" r:id="rId1" xmlns:r="x"/><sheet state="hidden"/>'
    names = '<definedName name="Ans_E">A!$B$1</definedName><definedName>x</definedName>'
    found = read_directory(f"<a>{system}{sheets}{names}</a>".encode())
    assert found.sheets == [("A", "visible", "rId1"), ("", "hidden", "")]
    assert (found.names, found.is_1904) == ({"ans_e": "A!$B$1", "": "x"}, is_1904)


def test_shared_texts_are_whole_and_without_pronunciation():
    runs = "<si><r><t>a</t></r><rPh><t>no</t></rPh><r><t>b</t></r></si><si><t>c</t></si><si/>"
    assert read_strings(f"<sst>{runs}</sst>".encode()) == ["ab", "c", ""]


def test_so_many_cells_and_no_more(monkeypatch):
    monkeypatch.setattr(limits, "CELLS", 2)
    two = '<row r="1"><c><v>1</v></c><c><v>2</v></c></row>'
    assert len(sheet(two).cells) == 2
    with refuses("more than 2 cells"):
        sheet(two + '<row r="2"><c><v>3</v></c></row>')


def test_so_many_cells_of_all_sheets_and_no_more(monkeypatch):
    data = corpus.Dialect().write({"a": [[1.0, 2.0]], "b": [[3.0]]})
    monkeypatch.setattr(limits, "CELLS", 3)
    assert sum(len(s.cells) for s in read_workbook(ReadRequest("w", data)).sheets) == 3
    monkeypatch.setattr(limits, "CELLS", 2)
    with pytest.raises(UnreadableError, match="more than 2 cells"):
        read_workbook(ReadRequest("w", data))


def test_so_many_merged_ranges_and_no_more(monkeypatch):
    monkeypatch.setattr(limits, "MERGES", 2)
    merges = "".join(f'<mergeCell ref="A{row}:B{row}"/>' for row in (1, 2, 3))
    assert sheet(merges).merges == [(1, 1, 1, 2), (2, 1, 2, 2)]
    assert sheet('<mergeCell ref="C3"/>').merges == [(3, 3, 3, 3)]
    assert sheet('<mergeCell ref="#REF!:B2"/><mergeCell ref="A1:#REF!"/><mergeCell/>').merges == []


def test_texts_are_cut(monkeypatch):
    monkeypatch.setattr(limits, "TEXT_LENGTH", 5)
    assert sheet('<c r="A1" t="str"><v>1234567</v></c>').cells[1, 1].written == "12345"
    assert read_strings(b"<sst><si><t>1234567</t></si></sst>") == ["12345"]
    names = b'<workbook><definedName name="a">1234567</definedName></workbook>'
    assert read_directory(names).names == {"a": "12345"}
    styles = b'<a><numFmt numFmtId="200" formatCode="1234567"/><cellXfs><xf numFmtId="200"/></cellXfs></a>'
    assert read_formats(styles) == ["12345"]
    assert sheet(f'<c r="A1" t="e"><v>{"x" * 41}</v></c>').cells[1, 1].written == "x" * 40


def test_a_formula_is_searched_so_far_and_no_farther(monkeypatch):
    def flags(formula: str):
        return sheet(f'<c r="A1"><f>{formula}</f><v>1</v></c>').flags

    monkeypatch.setattr(limits, "CELL_LENGTH", 8)
    assert flags("[a.x]b!A1") == {Flag.FORMULA_TO_OTHER_WORKBOOK}
    assert flags("  [a.x]b!A1") == flags("[a.x]A1") == flags("b!A1") == set()


@pytest.mark.parametrize(
    ("name", "read", "element", "words"),
    [
        ("SHEETS", read_directory, '<sheet name="a"/>', "more than 3 sheets"),
        ("STRINGS", read_strings, "<si/>", "more than 3 texts"),
        ("STYLES", lambda content: read_formats(b"<s>" + content + b"</s>"), "<xf/>", "more than 3 styles"),
    ],
)
def test_lists_are_so_long_and_no_longer(monkeypatch, name, read, element, words):
    monkeypatch.setattr(limits, name, 3)
    read(times(3, element, "cellXfs"))
    with refuses(words):
        read(times(4, element, "cellXfs"))


@pytest.mark.parametrize(
    ("name", "read", "element", "words"),
    [
        ("NAMES", read_directory, '<definedName name="n{}">A</definedName>', "more than 3 names"),
        ("MEMBERS", lambda c: read_relations(c, ""), '<Relationship Id="{}" Target="x"/>', "more than 3 relations"),
        ("STYLES", read_formats, '<numFmt numFmtId="{}" formatCode="0"/>', "more than 3 styles"),
    ],
)
def test_things_with_names_are_so_many_and_no_more(monkeypatch, name, read, element, words):
    monkeypatch.setattr(limits, name, 3)
    read(f"<a>{''.join(element.format(i % 3) for i in range(9))}</a>".encode())
    with refuses(words):
        read(f"<a>{''.join(element.format(i) for i in range(4))}</a>".encode())


def test_markup_is_so_deep_and_no_deeper(monkeypatch):
    monkeypatch.setattr(limits, "XML_DEPTH", 3)
    parse(b"<a><b><c/><c/></b><b><c/></b></a>", {})
    with refuses("far too many cells"):
        parse(b"<a><b><c><d/></c></b></a>", {})


def test_markup_is_read_to_its_end_in_pieces(monkeypatch):
    monkeypatch.setattr("grader.read.markup._CHUNK", 3)
    said = []
    parse("<a><v>1é2</v><v>結</v></a>".encode(), {}, {"v": said.append})
    assert said == ["1é2", "結"]


# ---------------------------------------------------------------- the archive


def archive(*sizes: tuple[int, int]) -> bytes:
    """An archive of parts that declare (size, packed bytes), with nothing true in them."""
    body, entries = b"", []
    for number, (size, packed) in enumerate(sizes):
        name = f"{number}.xml".encode()
        entries.append((name, bytes(packed), size, 0, len(body)))
        body += corpus.local(name, bytes(packed), size, 0)
    return corpus.raw_archive(entries, body)


def test_a_file_is_so_large_and_no_larger(monkeypatch):
    monkeypatch.setattr("grader.read.sniff.FILE_BYTES", 3 * 2**20)
    require_zip(b"PK\x03\x04" + bytes(3 * 2**20 - 4))
    with pytest.raises(RefusedError, match=r"a file of 3 MB \(limit 3 MB\)") as caught:
        require_zip(b"PK\x03\x04" + bytes(3 * 2**20 - 3))
    assert "Delete pictures" in caught.value.hint


def test_parts_are_so_many_and_no_more(monkeypatch):
    monkeypatch.setattr(limits, "MEMBERS", 3)
    assert len(open_container(archive(*[(1, 1)] * 3)).members) == 3
    with refuses("more than 3 parts"):
        open_container(archive(*[(1, 1)] * 4))


def test_more_marks_of_parts_than_two_for_each_are_refused_unlisted(monkeypatch):
    """A directory of millions is not even listed."""
    monkeypatch.setattr(limits, "MEMBERS", 1)
    assert len(open_container(b"PK\x01\x02" + archive((1, 1))).members) == 1
    listed = []
    monkeypatch.setattr("grader.read.container.zipfile.ZipFile", lambda *_: listed.append(1))
    with refuses("more than 1 parts") as caught:
        open_container(b"PK\x01\x02" * 3)
    assert "File, Save As" in caught.value.hint
    assert listed == []


def test_parts_unpack_to_so_much_and_no_more(monkeypatch):
    monkeypatch.setattr(limits, "TOTAL_BYTES", 100)
    open_container(archive((60, 10), (40, 10)))
    with refuses("more than 96 MB"):
        open_container(archive((60, 10), (41, 10)))


def test_a_part_unpacks_to_so_much_and_no_more(monkeypatch):
    monkeypatch.setattr(limits, "MEMBER_BYTES", 100)
    open_container(archive((100, 10)))
    with refuses("unreasonable size"):
        open_container(archive((101, 10)))


def test_large_parts_are_packed_so_tightly_and_no_tighter(monkeypatch):
    monkeypatch.setattr(limits, "RATIO_FROM_BYTES", 1000)
    monkeypatch.setattr(limits, "RATIO", 10)
    open_container(archive((1000, 1)))
    open_container(archive((1100, 110)))
    with refuses("unreasonable size"):
        open_container(archive((1101, 110)))


def test_parts_may_touch_but_not_overlap():
    data = bytearray(archive((4, 4), (4, 4)))
    assert [member.start for member in open_container(bytes(data)).members.values()] == [35, 74]
    first = data.index(b"PK\x01\x02")
    data[first + 20 : first + 24] = struct.pack("<I", 5)  # its packed bytes reach into the next header
    with refuses("overlap"):
        open_container(bytes(data))


@pytest.mark.parametrize(("length", "shown"), [(80, "n" * 80), (81, "n" * 77 + "...")])
def test_a_file_name_is_shown_so_long(length, shown):
    assert shown_name("n" * length) == shown

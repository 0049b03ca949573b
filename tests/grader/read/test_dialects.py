"""A workbook says the same whichever program wrote it."""

from __future__ import annotations

import io
import zipfile

import corpus
import numpy as np
import openpyxl
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grader.model import Kind
from grader.read import ReadRequest, UnreadableError, limits, read_workbook
from grader.read.flags import Flag
from grader.read.locate import find_submission
from grader.read.sheet import read_sheet

META = [["format", "1"], ["assignment", "soccer-kick"], ["variant_code", "CODE1"], ["signature", "signed"]]
ANSWERS = [
    ["A soccer kick: answers"],
    ["Coefficient of restitution", "e", ("C4/C5", 0.73), None, 6.0, "within 2 %"],
    ["Moment of inertia of the leg about the knee", "I", "1,9", "kg m^2", 6.0],
    ["Speed of the foot just before the impact", "v_f1", 15, "m/s", 1],
    ["Velocity of the ball just after the impact", "v_b2", True, "m/s", 1.5],
]
TRACKING = [
    ["frame", "t_s", "ball_x_m", "ball_y_m"],
    *([i, i / 480, 0.01 * i, ("C2*2", -0.25)] for i in range(20)),
]
NAMES = {"ans_e": "Answers!$C$2", "unit_I": "Answers!$D$3", "ans_I": "'Answers'!$C$3"}


def read(data: bytes, assignment):
    return find_submission(read_workbook(ReadRequest("w.xlsx", data)), assignment.questions, {}, assignment.points)


@pytest.mark.parametrize("name", corpus.DIALECTS)
def test_every_dialect_is_read_alike(assignment, name):
    data = corpus.DIALECTS[name]().write({"Answers": ANSWERS, "Tracking": TRACKING, "_meta": META}, NAMES)
    submission = read(data, assignment)
    assert (submission.code, submission.assignment_id) == ("CODE1", "soccer-kick")
    assert [submission.answer(q).found_by for q in ("e", "I", "v_f1")] == ["name", "name", "label"]
    assert submission.answer("e").number == 0.73
    assert (submission.answer("I").text, submission.answer("I").unit_text) == ("1,9", "kg m^2")
    assert submission.answer("v_f1").number == 15
    assert submission.answer("v_b2").kind is Kind.BOOL
    np.testing.assert_array_equal(submission.tracking["ball_x_m"], 0.01 * np.arange(20))
    np.testing.assert_array_equal(submission.tracking["ball_y_m"], -0.25)
    assert submission.flags == ()


def test_pandas_writes_no_names_and_is_read_by_labels(assignment):
    content = io.BytesIO()
    with pd.ExcelWriter(content, engine="openpyxl") as writer:
        rows = [
            [cell[1] if isinstance(cell, tuple) else cell for cell in [*row, *[None] * (6 - len(row))]]
            for row in ANSWERS
        ]
        pd.DataFrame(rows).to_excel(writer, sheet_name="Answers", index=True, header=True)
        table = [[cell[1] if isinstance(cell, tuple) else cell for cell in row] for row in TRACKING[1:]]
        pd.DataFrame(table, columns=TRACKING[0]).to_excel(writer, sheet_name="Tracking", startrow=3)
        pd.DataFrame(META).to_excel(writer, sheet_name="_meta", index=False, header=False)
    submission = read(content.getvalue(), assignment)
    assert (submission.answer("e").number, submission.answer("e").found_by) == (0.73, "label")
    assert submission.tracking["ball_y_m"].tolist() == [-0.25] * 20


def test_odd_values_of_other_programs(assignment):
    cells = (
        '<c r="A1"><f t="shared" ref="A1:A2" si="0">B1</f><v>1.5</v></c><c r="B1"><f t="shared" si="0"/><v>2.5</v></c>'
        '<c r="C1"><f>X1</f></c><c r="D1" t="str"><f>IF(1,"","")</f><v></v></c><c r="E1" t="e"><v>#N/A</v></c>'
        '<c r="F1" t="n"/><c r="G1" t="n"><v></v></c><c r="H1" t="d"><v>2026-05-01</v></c>'
        '<c r="I1"><v>1e999</v></c><c r="J1" t="b"><v>0</v></c><c r="K1" s="77"><v> 3 </v></c>'
        '<c r="L1" s="x"><v>4</v></c><c r="M1" vm="1"><v>5</v><extLst><ext/></extLst></c><c r="?"><v>6</v></c>'
        '<c r="P1" t="inlineStr"><is><t>a</t><rPh><t>no</t></rPh><t>b</t></is></c>'
        '<c r="Q1" t="s"><v/></c><c r="S1"><v> </v></c><c r="R1" t="s"><f>X1</f></c>'
        '<c r="T4"><v>7</v></c><c><v>8</v></c>'
    )
    data = corpus.Dialect().write({"s": [[1.0]]})
    sheet = f'<worksheet><sheetData><row r="x">{cells}</row></sheetData><f>stray</f></worksheet>'
    data = corpus.with_parts(data, **{"xl/worksheets/sheet1.xml": sheet.encode()})
    at = read_workbook(ReadRequest("w.xlsx", data)).sheets[0].at
    read_cells = [(at((1, c)).kind.value, at((1, c)).text) for c in range(1, 20)]
    assert [at((4, c)).text for c in (20, 21)] == ["7", "8"]  # the row that the cell itself names
    assert read_cells == [
        ("number", "1.5"),
        ("number", "2.5"),
        ("uncached", ""),
        ("blank", ""),
        ("error", "#N/A"),
        ("blank", ""),
        ("blank", ""),
        ("date", "2026-05-01"),
        ("error", "1e999"),
        ("bool", "FALSE"),
        ("number", "3"),
        ("number", "4"),
        ("number", "5"),
        ("number", "6"),
        ("blank", ""),
        ("text", "ab"),
        ("blank", ""),
        ("uncached", ""),
        ("blank", ""),
    ]


def test_a_cell_stands_where_it_says_whatever_row_it_is_in():
    cells = '<row r="2"><c r="B7"><v>1</v></c><c r="C2"><v>2</v></c><c><v>3</v></c><c r="$E$2"><v>4</v></c></row>'
    cells += '<row><c r="A1"><v>5</v></c></row><row r="2"><c r="a2"><v>6</v></c><c r="IW2"><v>7</v></c></row>'
    sheet = read_sheet(f"<worksheet><sheetData>{cells}</sheetData></worksheet>".encode(), [], [])
    places = {place: cell.number for place, cell in sheet.cells.items()}
    assert places == {(7, 2): 1, (2, 3): 2, (2, 4): 3, (2, 5): 4, (1, 1): 5, (2, 1): 6}
    assert sheet.flags == {Flag.FAR_CELLS}


def test_more_styles_than_are_remembered_are_read_alike(monkeypatch):
    cells = "".join(f'<c r="A{row}" s="{row % 3}"><v>{row}</v></c>' for row in range(1, 13))
    sheet = f"<worksheet><sheetData>{cells}</sheetData></worksheet>".encode()
    formats = ["", "0.00", "yyyy"]
    before = read_sheet(sheet, [], formats).cells
    monkeypatch.setattr(limits, "STYLES", 1)
    assert read_sheet(sheet, [], formats).cells == before
    assert [before[row, 1].kind for row in (1, 2, 3)] == [Kind.NUMBER, Kind.DATE, Kind.NUMBER]


def test_a_long_formula_costs_no_more_than_a_short_one():
    formula = "<f>" + "[" * 1_000_000 + "!</f><v>1</v>"
    data = corpus.Dialect().write({"s": [[1.0]]})
    sheet = f"<worksheet><sheetData><row><c>{formula}</c></row></sheetData></worksheet>"
    noise = {"xl/worksheets/sheet1.xml": sheet.encode()}
    book = read_workbook(ReadRequest("w", corpus.pack({**corpus.members(data), **noise}, zipfile.ZIP_STORED)))
    assert book.flags == ()
    assert book.sheets[0].at((1, 1)).number == 1


def test_a_coloured_column_of_many_rows_is_no_attack():
    data = corpus.Dialect().write({"s": [[1.0]]})
    rows = "".join(f'<row r="{i}"><c r="A{i}" s="1"/></row>' for i in range(2, 30_000))
    sheet = f'<worksheet><sheetData><row r="1"><c r="A1"><v>7</v></c></row>{rows}</sheetData></worksheet>'
    book = read_workbook(ReadRequest("w", corpus.with_parts(data, **{"xl/worksheets/sheet1.xml": sheet.encode()})))
    assert (book.flags, len(book.sheets[0].cells)) == ((), 1)


# ---------------------------------------------------------------- laws

VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.floats(-1e300, 1e300),
    st.integers(-(2**52), 2**52),
    st.text(st.characters(min_codepoint=32, max_codepoint=0x2FFF, exclude_categories=["Cs", "Cc"]), max_size=40).filter(
        lambda text: not text.startswith(("=", "#")) and "_x" not in text.lower()
    ),
)


@given(st.lists(st.lists(VALUES, max_size=8), max_size=8), st.sampled_from(["Plain", "O'Neil & <Söhne>", "結果"]))
@settings(deadline=None, max_examples=40)
def test_what_openpyxl_writes_is_read_back(grid, title):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = title
    for row in grid:
        sheet.append(row)
    content = io.BytesIO()
    book.save(content)
    found = read_workbook(ReadRequest("w.xlsx", content.getvalue())).sheets[0]
    assert found.name == title
    for r, row in enumerate(grid, start=1):
        for c, value in enumerate(row, start=1):
            assert same(found.at((r, c)), value)


def same(cell, value) -> bool:
    if value is None or (isinstance(value, str) and not value.strip()):
        return cell.kind is Kind.BLANK
    if isinstance(value, bool):
        return (cell.kind, cell.text) == (Kind.BOOL, str(value).upper())
    if isinstance(value, str):
        return (cell.kind, cell.text) == (Kind.TEXT, value)
    return cell.kind is Kind.NUMBER and cell.number == pytest.approx(value, rel=1e-15, abs=0)


@given(st.binary(max_size=300), st.sampled_from([b"", b"PK\x03\x04", corpus.OLE, b"%PDF", b"{", b"<"]))
@settings(deadline=None, max_examples=100)
def test_any_bytes_end_as_a_submission_or_one_polite_sentence(assignment, data, head):
    try:
        said = read(head + data, assignment).code
    except UnreadableError as error:  # nothing else may come
        said = str(error)
    assert said.isprintable()

"""The annotated copy: plain values and what was found; nothing that was active in the student's file."""

from __future__ import annotations

import io
import zipfile
from dataclasses import replace

import openpyxl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from assignments.terms import Terms
from grader import annotated
from grader.annotated import FEEDBACK, annotated_workbook
from grader.feedback import Report
from grader.grade import grade
from grader.model import Kind
from grader.read import Book, BookCell, ReadRequest, UnreadableError, read_workbook
from grader.read.book import Sheet
from grader.read.locate import find_submission


def opened(data: bytes) -> openpyxl.Workbook:
    return openpyxl.load_workbook(io.BytesIO(data))


def copy_of(desk, book: Book, **changes) -> bytes:
    """The copy of a book; one without a variant code comes with the answers of the right workbook."""
    whole = book if any(sheet.name == "_meta" for sheet in book.sheets) else book_of(desk)
    submission = find_submission(whole, desk.assignment.questions)
    report = Report(desk.assignment, submission, desk.key, grade(submission, desk.key, desk.assignment))
    return annotated_workbook(replace(report, **changes), book)


def book_of(desk, **changes) -> Book:
    return read_workbook(ReadRequest("w.xlsx", desk.workbook(changes).read_bytes()))


def sheet_of(cells, name="Answers", merges=()) -> Book:
    return Book("w.xlsx", (Sheet(name, True, cells, merges),), {}, (), "")


def text_of(sheet) -> str:
    return "\n".join(str(cell) for line in sheet.iter_rows(values_only=True) for cell in line if cell is not None)


def test_the_first_sheet_says_what_was_found(desk):
    sheet = opened(copy_of(desk, book_of(desk, e=0.1))).worksheets[0]
    assert sheet.title == FEEDBACK
    text = text_of(sheet)
    assert "A soccer kick: feedback" in text
    assert "Processing" in text
    assert "✗ wrong" in text
    assert f"{desk.truth['e']:g}" in text


def test_every_answer_is_coloured_and_has_a_note(desk):
    made = opened(copy_of(desk, book_of(desk, e=0.1)))
    notes = [cell.comment.text for line in made["Answers"] for cell in line if cell.comment]
    assert len(notes) == len(desk.assignment.questions)
    assert sum(note.startswith("✗ wrong") for note in notes) == 1


def test_values_come_over_as_they_were(desk):
    book = book_of(desk)
    made = opened(copy_of(desk, book))
    before = next(sheet for sheet in book.sheets if sheet.name == "Tracking")
    for (row, column), cell in before.cells.items():
        if cell.kind is Kind.NUMBER:
            assert made["Tracking"].cell(row, column).value == pytest.approx(cell.number)


def test_nothing_true_is_in_it_while_attempts_remain(desk):
    data = copy_of(desk, book_of(desk, v_b2=1.0), show_truth=False)
    everything = "\n".join(text_of(sheet) for sheet in opened(data))
    assert f"{desk.truth['v_b2']:g}" not in everything
    assert "True value (later)" in everything
    never = copy_of(desk, book_of(desk), show_truth=False, terms=Terms(true_values="never"))
    assert "True value (not shown)" in text_of(opened(never).worksheets[0])


def test_the_copy_cannot_be_handed_in(desk):
    """It carries no variant code: the sheet that holds it stays behind."""
    data = copy_of(desk, book_of(desk))
    assert "_meta" not in opened(data).sheetnames
    with pytest.raises(UnreadableError, match="variant code"):
        find_submission(read_workbook(ReadRequest("w.xlsx", data)), desk.assignment.questions)


def test_formulas_macros_and_links_stay_behind(desk, tmp_path):
    path = desk.workbook()
    made = openpyxl.load_workbook(path)
    made["Answers"]["I3"] = "='[Friend.xlsx]Answers'!C7"
    made["Answers"]["I4"] = '=HYPERLINK("http://example.org","look")'
    made["Answers"]["I5"] = "look"
    made["Answers"]["I5"].hyperlink = "http://example.org"
    made.save(path)
    with zipfile.ZipFile(path, "a") as packed:
        packed.writestr("xl/vbaProject.bin", b"macro")
    data = copy_of(desk, read_workbook(ReadRequest("w.xlsx", path.read_bytes())))
    members = zipfile.ZipFile(io.BytesIO(data))
    sheets = b"".join(members.read(name) for name in members.namelist() if name.startswith("xl/worksheets/sheet"))
    assert b"<f>" not in sheets
    assert b"hyperlink" not in sheets
    assert not any("vba" in name or "externalLink" in name for name in members.namelist())
    assert b"example.org" not in sheets


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    text=st.text(max_size=60),
    start=st.sampled_from(["", "=", "+", "-", "@", "=cmd|' /C calc'!A0", "<r>", "<r>&", "<r></r></si><si>"]),
    end=st.sampled_from(["", "</r>", "</t></r>"]),
)
def test_any_text_stays_a_text(desk, text, start, end):
    book = sheet_of({(1, 1): BookCell(Kind.TEXT, None, start + text + end), (1, 2): BookCell(Kind.TEXT, None, "next")})
    sheet = opened(copy_of(desk, book))["Answers"]
    cell = sheet.cell(1, 1)
    assert cell.data_type in {"s", "n", "inlineStr"}
    assert cell.value is None or isinstance(cell.value, str)
    assert cell.value is None or cell.value.startswith(start.replace("\r", ""))
    assert sheet.cell(1, 2).value == "next"


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(names=st.lists(st.text(max_size=40) | st.just("History"), min_size=1, max_size=4))
def test_any_names_of_sheets_make_a_workbook_that_opens(desk, names):
    sheets = tuple(Sheet(name, True, {(1, 1): BookCell(Kind.NUMBER, 1.0)}) for name in names if name != "_meta")
    made = opened(copy_of(desk, Book("w.xlsx", sheets, {}, (), "")))
    assert len(made.sheetnames) == 1 + len(sheets)
    assert len({name.lower() for name in made.sheetnames}) == len(made.sheetnames)


@pytest.mark.parametrize(
    ("cell", "shown"),
    [
        (BookCell(Kind.UNCACHED, is_formula=True), "(a formula that was never worked out)"),
        (BookCell(Kind.ERROR, None, "#REF!"), "#REF!"),
        (BookCell(Kind.NUMBER, float("inf")), "inf"),
        (BookCell(Kind.NUMBER, 0.25, "", "0.0%"), 0.25),
        (BookCell(Kind.NUMBER, 2.0, "", "[Red]0;[$-409]@"), 2),
        (BookCell(Kind.DATE, 45000.0, "2023-03-15", "yyyy"), "2023-03-15"),
    ],
)
def test_every_kind_of_cell_comes_over_as_a_value(desk, cell, shown):
    assert opened(copy_of(desk, sheet_of({(2, 3): cell})))["Answers"]["C2"].value == shown


def test_merged_cells_stay_merged_and_are_not_in_the_way(desk):
    book = book_of(desk)
    answers = next(sheet for sheet in book.sheets if sheet.name == "Answers")
    merged = replace(answers, merges=((6, 2, 7, 3), (900, 1, 901, 4)))
    others = tuple(sheet for sheet in book.sheets if sheet.name != "Answers")
    made = opened(copy_of(desk, replace(book, sheets=(merged, *others))))
    assert len(made["Answers"].merged_cells.ranges) == 2


def test_a_merge_of_all_of_a_sheet_and_one_over_another_are_left_out(desk):
    """Written out cell by cell the first would never end; the second damages a workbook."""
    in_a_row = tuple((row, 5, row, 6) for row in range(1, 600))
    far = (1_048_575, 16_383, 1_048_576, 16_384)
    merges = (*in_a_row, (1, 1, 1_048_576, 16_384), far, (0, 1, 9, 1), (2, 2, 3, 3), (3, 3, 4, 4), (1, 1, 2, 2))
    merges += ((6, 4, 5, 5), (9, 1, 8, 1))
    cells = {(2, 2): BookCell(Kind.NUMBER, 1.0), (3, 3): BookCell(Kind.NUMBER, 2.0)}
    made = opened(copy_of(desk, sheet_of(cells, "Notes", merges=merges)))["Notes"]
    assert [str(merge) for merge in made.merged_cells.ranges] == ["B2:C3"]
    assert made["B2"].value == 1


def test_an_answer_that_stands_far_away_is_not_gone_to(desk):
    """XlsxWriter visits every row and column up to the last that is written."""
    far = sheet_of({(1, 1): BookCell(Kind.NUMBER, 1.0)}, "Answers")
    whole = book_of(desk)
    submission = find_submission(whole, desk.assignment.questions)
    answer = replace(submission.answer("e"), where="Answers!XFD1048576")
    there = replace(submission, answers={**submission.answers, "e": answer})
    report = Report(desk.assignment, there, desk.key, grade(submission, desk.key, desk.assignment))
    sheet = opened(annotated_workbook(report, far))["Answers"]
    assert (sheet.max_row, sheet.max_column) < (100, 100)


def test_a_copy_stays_small_whatever_was_handed_in(desk, monkeypatch):
    monkeypatch.setattr(annotated, "_MOST_CELLS", 3)
    many = tuple(
        Sheet(f"S{n}", True, {(row, 1): BookCell(Kind.NUMBER, float(row)) for row in range(1, 6)}) for n in range(64)
    )
    made = opened(copy_of(desk, Book("w.xlsx", many, {}, (), "")))
    assert len(made.sheetnames) == 21
    assert [cell.value for cell in made["S0"]["A"]] == [1, 2, 3, None, "(more was left out here)"]


def test_an_answer_that_was_left_out_is_coloured_too(desk):
    made = opened(copy_of(desk, book_of(desk, e=None)))["Answers"]
    (cell,) = (cell for line in made for cell in line if cell.comment and cell.comment.text.startswith("✗ wrong"))
    assert cell.value is None
    assert cell.fill.fgColor.rgb == "FFF9E6E4"


def test_rows_are_as_high_as_their_texts_and_pages_hold_all_columns(desk):
    """LibreOffice finds no height by itself: sentences would lie over one another."""
    made = opened(copy_of(desk, book_of(desk, e=0.1)))
    usual = 15  # points: not written
    heights = {cell.row: made[FEEDBACK].row_dimensions[cell.row].height or usual for cell in made[FEEDBACK]["G"]}
    said = {cell.row: cell.value for cell in made[FEEDBACK]["G"] if cell.value}
    assert all(heights[row] >= 15 * (text.count("\n") + 1) for row, text in said.items())
    assert max(heights[row] for row in said) > 30
    assert all(sheet.sheet_properties.pageSetUpPr.fitToPage for sheet in made.worksheets)


def test_long_texts_run_on_and_notes_of_several_lines_are_seen(desk):
    cells = {(1, 1): BookCell(Kind.TEXT, written="x" * 45), (2, 1): BookCell(Kind.TEXT, written="a\nb\nc")}
    cells |= {(3, 1): BookCell(Kind.TEXT, written="y" * 20), (3, 2): BookCell(Kind.NUMBER, 1.0)}
    made = opened(copy_of(desk, sheet_of(cells, merges=((1, 1, 1, 4), (5, 1, 6, 2)))))["Answers"]
    assert 22 <= made.column_dimensions["A"].width < 23  # with what Excel adds at its sides
    assert made.row_dimensions[2].height == 45
    assert [str(merge) for merge in made.merged_cells.ranges] == ["A5:B6"]

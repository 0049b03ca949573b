"""An annotated copy of a student's workbook: what was read from it, written anew, with a sheet of feedback in front.

The student's file is never edited: only plain values come over, so no macro, link, formula or picture of it reaches
anybody's hands. The copy carries no variant code and cannot be handed in by mistake.
"""

from __future__ import annotations

import io
import itertools
import math
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence

from openpyxl import Workbook
from openpyxl.cell.cell import MergedCell
from openpyxl.comments import Comment
from openpyxl.styles import Alignment, Font, PatternFill
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from assignments.sheets import META
from assignments.words import symbol_text
from grader.feedback import Line, Report, hints_of, line_of, standing_of, steps_of
from grader.kind import Kind
from grader.levels import levels_of
from grader.page import earned_text, points_text
from grader.read.book import Book, Sheet
from grader.read.sheet import BookCell, place_of

FEEDBACK = "Feedback"
LONGEST_TEXT = 2000
_AUTHOR = "Feedback"
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_NO_TITLE = re.compile(r"[\[\]:*?/\\]")
_PLAIN_FORMAT = re.compile(r"[0#?.,%E+\- ]{1,30}")
_WIDEST, _MOST_MERGES, _MOST_LINES = 50.0, 500, 20
_COLUMN_WIDTHS, _LINE_HEIGHT = (44, 22, 22, 14, 14, 12, 70), 15.0  # of the sheet of feedback: characters, points

_TITLE, _BOLD = Font(name="Calibri", size=16, bold=True), Font(name="Calibri", bold=True)
_TOP = Alignment(vertical="top", wrap_text=True)
_FILLS: Mapping[str, PatternFill] = {
    outcome: PatternFill("solid", fgColor=colour)
    for outcome, colour in (
        ("right", "E6F2EA"), ("carried", "E6F2EA"), ("partial", "FBF0D9"), ("wrong", "F9E6E4"), ("unsure", "E9E9F5"),
    )
}  # fmt: skip


def annotated_workbook(report: Report, book: Book) -> bytes:
    """Return the annotated copy as an `.xlsx` file.

    With `show_truth` off it holds no true value, as the page.

    Parameters
    ----------
    report : Report
    book : Book
        The cells that the reader read from the student's file.
    """
    made = Workbook()
    first = made.worksheets[0]
    first.title = FEEDBACK
    lines = {question.id: line_of(report, question) for question in report.assignment.questions}
    _write_feedback(first, report, lines)
    copies = {}
    for sheet in book.sheets:
        if sheet.name != META:
            copies[sheet.name] = _copied(made, sheet)
    _annotate(copies, report, lines)
    made.properties.creator = made.properties.title = f"{report.assignment.title}: feedback"
    content = io.BytesIO()
    made.save(content)
    return content.getvalue()


# ---------------------------------------------------------------- the sheet of feedback


def _write_feedback(sheet: Worksheet, report: Report, lines: Mapping[str, Line]) -> None:
    row = _write_lines(sheet, 1, _summary(report))
    sheet.cell(1, 1).font = _TITLE
    row = _write_lines(sheet, row + 1, [f"{number}. {step}" for number, step in enumerate(steps_of(report), start=1)])
    row = _write_table(sheet, row + 1, _levels(report))
    last = _write_table(sheet, row + 1, _answers(report, lines))
    for place in range(row + 2, last):
        outcome = list(lines.values())[place - row - 2].verdict.outcome
        sheet.cell(place, 4).fill = _FILLS[outcome]
    for column, width in enumerate(_COLUMN_WIDTHS, start=1):
        sheet.column_dimensions[get_column_letter(column)].width = width
    _print_across(sheet)


def _print_across(sheet: Worksheet) -> None:
    """Print all columns on one landscape page's width."""
    sheet.page_setup.orientation, sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight = "landscape", 1, 0
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)


def _summary(report: Report) -> list[str]:
    counts = report.row or report.grade
    points = points_text(counts.points, is_provisional=counts.is_provisional)
    return [
        f"{report.assignment.title}: feedback",
        f"{report.key.student}, attempt {report.attempt}: {points} of {points_text(counts.out_of)} points",
        *(f"Decided by a person: {text}" for text in report.adjustments),
        *standing_of(report).sentences,
        *(f"Where to look, {_plain(cells)}: {hint}" for cells, hint in hints_of(report)),
        "This copy is for reading: it holds values only. Go on working in your own workbook, and hand that one in.",
    ]


def _plain(markup: object) -> str:
    return re.sub(r"<[^>]*>", "", str(markup))


def _levels(report: Report) -> list[Sequence[str]]:
    levels = levels_of(report.grade, report.assignment)
    return [("Level", "Points"), *((level.name, earned_text(level.findings)) for level in levels)]


def _answers(report: Report, lines: Mapping[str, Line]) -> list[Sequence[str]]:
    expected = "True value" if report.show_truth else "True value (later)"
    symbols = {question.id: symbol_text(question.symbol) for question in report.assignment.questions}
    head = ("Question", "You wrote", expected, "Result", "Points", "Cell", "What was found")
    return [head, *(_answer(line, symbols[id_]) for id_, line in lines.items())]


def _answer(line: Line, symbol: str) -> Sequence[str]:
    truth = f"{line.truth} ({line.band})" if line.band else line.truth
    verdict = f"{line.verdict.mark} {line.verdict.word}"
    return f"{line.label}, {symbol}", line.own, truth, verdict, line.points, line.where, _said(line)


def _said(line: Line) -> str:
    return "\n".join(f"{verdict.mark} {aspect.capitalize()}. {message}" for verdict, aspect, message in line.findings)


def _write_lines(sheet: Worksheet, row: int, lines: Iterable[str]) -> int:
    """Write sentences below one another; return the row after them."""
    for line in lines:
        _write(sheet, row, 1, str(_plain(line)))
        row += 1
    return row


def _write_table(sheet: Worksheet, row: int, table: Sequence[Sequence[str]]) -> int:
    """Write a table, its head in bold; return the row after it."""
    for at, line in enumerate(table):
        for column, text in enumerate(line, start=1):
            _write(sheet, row + at, column, text)
            cell = sheet.cell(row + at, column)
            cell.alignment = _TOP
            if at == 0:
                cell.font = _BOLD
        sheet.row_dimensions[row + at].height = _LINE_HEIGHT * max(map(_lines_of, line, _COLUMN_WIDTHS))
    return row + len(table)


def _lines_of(text: str, width: float) -> int:
    """Return how many lines a text takes in a column so wide: not every program finds the height of a row itself."""
    return sum(max(len(textwrap.wrap(line, int(width))), 1) for line in text.split("\n"))


# ---------------------------------------------------------------- what was read


def _copied(made: Workbook, sheet: Sheet) -> Worksheet:
    """Write a sheet's values anew; one that was hidden is shown."""
    copy: Worksheet = made.create_sheet(_title(sheet.name, made.sheetnames))
    widths: dict[int, int] = {}
    for (row, column), cell in sheet.cells.items():
        _write_cell(copy, row, column, cell)
        if "\n" in cell.text:
            copy.row_dimensions[row].height = _LINE_HEIGHT * min(cell.text.count("\n") + 1, _MOST_LINES)
        if cell.kind is not Kind.TEXT or (row, column + 1) in sheet.cells:  # else it runs on over empty cells
            widths[column] = max(widths.get(column, 0), len(cell.text))
    for column, width in widths.items():
        copy.column_dimensions[get_column_letter(column)].width = min(max(width + 2.0, 9.0), _WIDEST)
    several = (merge for merge in sheet.merges if merge[0] < merge[2])  # in one row texts run on as they do merged
    for top, left, bottom, right in itertools.islice(several, _MOST_MERGES):
        copy.merge_cells(start_row=top, start_column=left, end_row=bottom, end_column=right)
    _print_across(copy)
    return copy


def _title(name: str, taken: Sequence[str]) -> str:
    """Return a sheet's name as Excel allows it, and unlike the others."""
    plain = _NO_TITLE.sub("_", _CONTROL.sub("", name)).strip("'")[:28] or "Sheet"
    lower = {title.lower() for title in taken}
    numbered = (f"{plain} {number}" for number in range(2, len(taken) + 3))
    return next(title for title in (plain, *numbered) if title.lower() not in lower)


def _write_cell(sheet: Worksheet, row: int, column: int, cell: BookCell) -> None:
    if cell.kind is Kind.NUMBER and cell.number is not None and math.isfinite(cell.number):
        target = sheet.cell(row, column)
        target.value = cell.number
        if _PLAIN_FORMAT.fullmatch(cell.format):
            target.number_format = cell.format
    elif cell.kind is Kind.UNCACHED:
        _write(sheet, row, column, "(a formula that was never worked out)")
    elif cell.kind is not Kind.BLANK:
        _write(sheet, row, column, cell.text)


def _write(sheet: Worksheet, row: int, column: int, text: str) -> None:
    """Write a text as text: what looks like a formula stays a text, also when the cell is edited."""
    text = _CONTROL.sub("", text)[:LONGEST_TEXT]
    if not text:
        return
    cell = sheet.cell(row, column)
    cell.value = text
    cell.data_type = "s"
    cell.quotePrefix = text[0] in "=+-@"


# ---------------------------------------------------------------- notes at the answers


def _annotate(copies: Mapping[str, Worksheet], report: Report, lines: Mapping[str, Line]) -> None:
    """Colour each answer's cell, and say in a note what its colour says."""
    for id_, line in lines.items():
        sheet_name, _, address = report.submission.answer(id_).where.rpartition("!")
        place = place_of(address)
        sheet = copies.get(sheet_name.strip("'"))
        if sheet is None or place is None:
            continue
        cell = sheet.cell(*place)
        if isinstance(cell, MergedCell):
            continue
        cell.fill = _FILLS[line.verdict.outcome]
        text = f"{line.verdict.mark} {line.verdict.word}, {line.points} points\n{_said(line)}"
        cell.comment = Comment(_CONTROL.sub("", text)[:LONGEST_TEXT], _AUTHOR, height=140, width=360)

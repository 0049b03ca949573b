"""What the sheets of a student's workbook look like: cells, colours, drop-downs, nothing about files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from openpyxl import Workbook
from openpyxl.cell.rich_text import CellRichText, TextBlock
from openpyxl.cell.text import InlineFont
from openpyxl.styles import Alignment, Border, Font, NamedStyle, PatternFill, Protection, Side
from openpyxl.utils import get_column_letter
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.datavalidation import DataValidation
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from assignments.model import NOBODY, Assignment, Given, Question, Variant
from assignments.words import split_symbol, tolerance_text, tracking_columns
from vml_course.model.units import UNITS

INSTRUCTIONS, ANSWERS, TRACKING, META = "Instructions", "Answers", "Tracking", "_meta"
FORMAT_VERSION = "1"  # of this layout
TRACKING_ROWS = 600

_INK, _PALE, _LINE, _TYPE_HERE = "1F3B4D", "E8EEF2", "B8C4CC", "FFF6D6"
_TITLE = Font(name="Calibri", size=18, bold=True, color=_INK)
_HEAD = Font(name="Calibri", size=11, bold=True, color="FFFFFF")
_GROUP = Font(name="Calibri", size=12, bold=True, color=_INK)
_BODY = Font(name="Calibri", size=11)
_QUIET = Font(name="Calibri", size=10, color="5B6B75")
_SUBSCRIPT = InlineFont(rFont="Calibri", sz=11, vertAlign="subscript")
_HEAD_FILL = PatternFill("solid", fgColor=_INK)
_GROUP_FILL = PatternFill("solid", fgColor=_PALE)
_TYPE_FILL = PatternFill("solid", fgColor=_TYPE_HERE)
_SIDE = Side(style="thin", color=_LINE)
_THIN = Border(left=_SIDE, right=_SIDE, top=_SIDE, bottom=_SIDE)
_NOTHING_FILL = PatternFill("lightUp", fgColor=_LINE)
_OPEN = Protection(locked=False)
_TYPE_HERE_STYLE = "Type here"
_TOP = Alignment(horizontal="left", vertical="center", wrap_text=True, indent=1)
_MIDDLE = Alignment(horizontal="center", vertical="center", wrap_text=True)


@dataclass(frozen=True)
class Look:
    """How one cell looks."""

    font: Font = _BODY
    alignment: Alignment = _TOP
    fill: PatternFill | None = None
    border: Border | None = None


_TEXT = Look()
_CELL = Look(border=_THIN)
_CENTRE = Look(alignment=_MIDDLE, border=_THIN)
_HEADER = Look(font=_HEAD, alignment=_MIDDLE, fill=_HEAD_FILL, border=_THIN)
_HINT = Look(font=_QUIET, border=_THIN)


def add_instructions(book: Workbook, assignment: Assignment, variant: Variant, given: Mapping[str, float]) -> None:
    """Add the first sheet: what to do, and the student's own numbers."""
    sheet = _sheet(book, INSTRUCTIONS, widths=(4, 62, 11, 14, 11))
    _put(sheet, 1, 1, assignment.title, Look(font=_TITLE, alignment=Alignment(vertical="center")))
    sheet.row_dimensions[1].height = 30
    _line(sheet, 2, assignment.summary)
    row = 4
    for number, step in enumerate(_steps(assignment), start=1):
        _put(sheet, row, 1, number, Look(font=_GROUP, alignment=Alignment(horizontal="center", vertical="top")))
        sheet.merge_cells(start_row=row, start_column=2, end_row=row, end_column=5)
        _put(sheet, row, 2, step, Look(alignment=Alignment(vertical="top", wrap_text=True)))
        sheet.row_dimensions[row].height = 17.0 * (1 + len(step) // 105)
        row += 1
    _given_table(sheet, row + 1, assignment.givens, given)
    footer = f"Workbook {variant.code}, made for you only: your numbers differ from everybody else's."
    _put(sheet, row + 4 + len(assignment.givens), 1, footer, Look(font=_QUIET, alignment=Alignment()))


def add_answers(book: Workbook, assignment: Assignment) -> None:
    """Add the sheet of answers: a named value cell and a named unit cell for each question."""
    sheet = _sheet(book, ANSWERS, widths=(52, 9, 18, 13, 9, 25, 70))
    _put(sheet, 1, 1, f"{assignment.title}: answers", Look(font=_TITLE, alignment=Alignment(vertical="center")))
    sheet.row_dimensions[1].height = 30
    _line(
        sheet, 2, "Type in the coloured cells: the number alone, its unit beside it. 0.73 and 0,73 are both understood."
    )
    _header(sheet, 4, ("Quantity", "Symbol", "Value", "Unit", "Points", "Full points", "Hint"))
    row = 5
    for group, questions in assignment.question_groups().items():
        _group_row(sheet, row, group, questions)
        for question in questions:
            row += 1
            _question_row(book, sheet, row, question)
        row += 1
    _units_lists(sheet, assignment)
    _put(sheet, row, 4, "Total", Look(font=_GROUP, alignment=_MIDDLE))
    _put(sheet, row, 5, assignment.total_points, Look(font=_GROUP, alignment=_MIDDLE))
    sheet.freeze_panes = "A5"


def add_tracking(book: Workbook, assignment: Assignment) -> None:
    """Add the sheet for the measured positions: header in row 1, open rows below."""
    columns = tracking_columns(assignment.points)
    # One style of its own for thousands of cells: styles set cell by cell took half of the time of a workbook.
    book.add_named_style(NamedStyle(_TYPE_HERE_STYLE, font=_BODY, fill=_TYPE_FILL, border=_THIN, protection=_OPEN))
    sheet = _sheet(book, TRACKING, widths=(*(13.0 for _ in columns), 3, 60))
    _header(sheet, 1, columns)
    note = Look(font=_QUIET, alignment=Alignment(vertical="top"))
    for row, text in enumerate(_TRACKING_NOTES, start=2):
        _put(sheet, row, len(columns) + 2, text, note)
    for column in range(1, len(columns) + 1):
        sheet.column_dimensions[get_column_letter(column)].protection = _OPEN
        for row in range(2, TRACKING_ROWS + 2):
            sheet.cell(row, column).style = _TYPE_HERE_STYLE
    sheet.protection.sheet = False  # a whole export, headings and all, may be pasted over it
    sheet.freeze_panes = "A2"
    sheet.print_title_rows = "1:1"


def add_meta(book: Workbook, assignment: Assignment, variant: Variant) -> None:
    """Add the hidden sheet by which a returned workbook is recognised; it holds no answer."""
    sheet = book.create_sheet(META)
    rows = [
        ("format", FORMAT_VERSION),
        ("assignment", assignment.id),
        ("assignment_version", assignment.version),
        ("variant_code", variant.code),
        ("signature", variant.signature),
    ]
    if variant.student == NOBODY:
        rows.append(("purpose", "practice"))
    for row in rows:
        sheet.append(row)
    sheet.sheet_state = "veryHidden"
    sheet.protection.sheet = True


# ---------------------------------------------------------------- words

_TRACKING_NOTES = (
    "Paste the positions that you measured: one row a frame, values only.",
    "You may paste the whole sheet Data of vml track at A1, headings too.",
    "t_s in seconds of real time, positions in metres, x to the right, y up.",
    "Leave a cell empty where a point was lost; never copy the row before.",
    "The frames from 40 ms before to 40 ms after the impact are enough.",
)


_STEPS = f"""\
Read the handout: it shows the first picture of your video, the points to follow and the signs.
Measure your video: enter the true frame rate, calibrate with the known length, track {{points}}.
Paste the measured positions into the sheet "{TRACKING}": seconds and metres, y up. They support your answers. \
The whole sheet "Data" of an export of vml track may be pasted over it at A1, headings too.
Fill the coloured cells of the sheet "{ANSWERS}": a number, and its unit from the list beside it. \
Keep at least four digits on the way and give at least three.
Save as an Excel workbook (.xlsx) and hand in this file. Leave the names of the sheets as they are; \
you may add sheets of your own.
"""


def _steps(assignment: Assignment) -> list[str]:
    return _STEPS.format(points=", ".join(assignment.points)).splitlines()


# ---------------------------------------------------------------- rows


def _given_table(sheet: Worksheet, row: int, givens: Sequence[Given], values: Mapping[str, float]) -> None:
    _put(sheet, row, 2, "Given values", Look(font=_GROUP))
    _header(sheet, row + 1, ("Quantity", "Symbol", "Value", "Unit"), first_column=2)
    for offset, given in enumerate(givens, start=2):
        _put(sheet, row + offset, 2, given.label, _CELL)
        _put(sheet, row + offset, 3, _rich(given.symbol), _CENTRE)
        _put(sheet, row + offset, 4, values[given.id], _CENTRE)
        _put(sheet, row + offset, 5, given.unit, _CENTRE)


def _group_row(sheet: Worksheet, row: int, group: str, questions: Iterable[Question]) -> None:
    points = sum(question.points for question in questions)
    for column in range(1, 8):
        _put(sheet, row, column, None, Look(fill=_GROUP_FILL, border=_THIN))
    sheet.row_dimensions[row].height = 20
    _put(sheet, row, 1, group.title(), Look(font=_GROUP, fill=_GROUP_FILL, border=_THIN))
    _put(sheet, row, 5, points, Look(font=_GROUP, alignment=_MIDDLE, fill=_GROUP_FILL, border=_THIN))


def _question_row(book: Workbook, sheet: Worksheet, row: int, question: Question) -> None:
    texts = (question.label, _rich(question.symbol), None, None, question.points, tolerance_text(question))
    for column, (value, look) in enumerate(zip(texts, (_CELL, *5 * (_CENTRE,)), strict=True), start=1):
        _put(sheet, row, column, value, look)
    _put(sheet, row, 7, question.hint, _HINT)
    sheet.row_dimensions[row].height = 21
    _open_cell(book, sheet, row, 3, f"ans_{question.id}")
    _check_number(sheet, f"C{row}", question)
    if question.dimension == "number":
        _put(sheet, row, 4, None, Look(fill=_NOTHING_FILL, border=_THIN))
        _name(book, sheet, row, 4, f"unit_{question.id}")
    else:
        _open_cell(book, sheet, row, 4, f"unit_{question.id}")


def _open_cell(book: Workbook, sheet: Worksheet, row: int, column: int, name: str) -> None:
    cell = sheet.cell(row, column)
    cell.protection, cell.fill, cell.border, cell.alignment = _OPEN, _TYPE_FILL, _THIN, _MIDDLE
    _name(book, sheet, row, column, name)


def _name(book: Workbook, sheet: Worksheet, row: int, column: int, name: str) -> None:
    book.defined_names[name] = DefinedName(name, attr_text=f"{sheet.title}!${get_column_letter(column)}${row}")


def _check_number(sheet: Worksheet, cell: str, question: Question) -> None:
    """Warn, but do not refuse: in another language's Excel `0.73` or `0,73` may arrive as text."""
    check = DataValidation(type="decimal", operator="between", formula1="-1000000000", formula2="1000000000")
    check.errorStyle, check.allow_blank, check.showErrorMessage = "warning", True, True
    check.errorTitle, check.error = (
        "Is this a number?",
        "Type the number alone; the unit goes into the next cell. Keep it?",
    )
    check.showInputMessage, check.promptTitle, check.prompt = (
        True,
        question.label[:32],
        question.hint[:250] or "A number.",
    )
    sheet.add_data_validation(check)
    check.add(cell)


def _units_lists(sheet: Worksheet, assignment: Assignment) -> None:
    """Offer the units of each dimension as a drop-down; another one may be typed after a warning."""
    rows = {cell.value: cell.row for cell in sheet["A"] if cell.value}
    for dimension in dict.fromkeys(q.dimension for q in assignment.questions if q.dimension != "number"):
        check = DataValidation(type="list", formula1=f'"{",".join(UNITS[dimension])}"', allow_blank=True)
        check.errorStyle, check.showErrorMessage = "warning", True
        check.errorTitle, check.error = "Another unit?", "Choose a unit from the list if you can. Keep it?"
        sheet.add_data_validation(check)
        for question in assignment.questions:
            if question.dimension == dimension:
                check.add(f"D{rows[question.label]}")


# ---------------------------------------------------------------- cells


def _sheet(book: Workbook, title: str, widths: Sequence[float]) -> Worksheet:
    sheet: Worksheet = book.create_sheet(title)
    sheet.sheet_view.showGridLines = False
    for column, width in enumerate(widths, start=1):
        sheet.column_dimensions[get_column_letter(column)].width = width
    sheet.protection.sheet = True
    sheet.protection.formatColumns = sheet.protection.formatRows = sheet.protection.formatCells = (
        False  # False: allowed
    )
    sheet.page_setup.orientation, sheet.page_setup.paperSize = "landscape", 9
    sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight = 1, 0
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    return sheet


def _put(sheet: Worksheet, row: int, column: int, value: object, look: Look = _TEXT) -> None:
    cell = sheet.cell(row, column)
    cell.value = value  # type: ignore[assignment]  # str, number, rich text or None
    cell.font, cell.alignment = look.font, look.alignment
    if look.fill is not None:
        cell.fill = look.fill
    if look.border is not None:
        cell.border = look.border


def _line(sheet: Worksheet, row: int, text: str) -> None:
    _put(sheet, row, 1, text, Look(font=_QUIET, alignment=Alignment(vertical="center")))


def _header(sheet: Worksheet, row: int, titles: Iterable[str], first_column: int = 1) -> None:
    for column, title in enumerate(titles, start=first_column):
        _put(sheet, row, column, title, _HEADER)
    sheet.row_dimensions[row].height = 20


def _rich(symbol: str) -> object:
    """Write `v_f1` as v with a subscript."""
    letter, below = split_symbol(symbol)
    return CellRichText(letter, TextBlock(_SUBSCRIPT, below)) if below else letter

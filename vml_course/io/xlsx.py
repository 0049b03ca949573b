"""A tracked clip as an Excel workbook: plain tables, real numbers, empty cells where nothing was measured."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from openpyxl import Workbook
from openpyxl.styles import Alignment, Font
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.table import Table, TableStyleInfo
from openpyxl.worksheet.worksheet import Worksheet

from vml_course.io.about import calibration_facts, readme_lines, settings_facts, software
from vml_course.io.columns import Column, data_columns, quality_columns
from vml_course.io.files import replacing
from vml_course.model.tracked import Tracked

BOLD = Font(name="Calibri", size=11, bold=True)
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def write_xlsx(path: Path, tracked: Tracked) -> None:
    """Write the workbook; sheets as `SHEETS` says, after the sheet ReadMe."""
    data, quality = data_columns(tracked), quality_columns(tracked)
    book = Workbook()
    book.properties.creator = software()
    _write_readme(book, readme_lines(tracked))
    _add_table(book, "Data", data)
    _add_table(book, "Quality", quality)
    _add_facts(book, "Calibration", ("key", "value", "unit"), calibration_facts(tracked))
    _add_facts(book, "Settings", ("key", "value", "unit"), settings_facts(tracked))
    _add_facts(book, "Columns", ("name", "meaning", "unit", "frame_of_reference", "source"), _dictionary(data, quality))
    with replacing(path) as temporary:
        book.save(temporary)


def _dictionary(*tables: Sequence[Column]) -> list[tuple[str, ...]]:
    known = {column.name: column for table in tables for column in table}
    return [(one.name, one.meaning, one.unit, one.reference, one.source) for one in known.values()]


def _write_readme(book: Workbook, lines: Iterable[tuple[str, str]]) -> None:
    sheet = book.worksheets[0]
    sheet.title = "ReadMe"
    for row, (label, text) in enumerate(lines, start=1):
        put(sheet, row, 1, label)
        put(sheet, row, 2, text)
        sheet.cell(row, 1).font = BOLD
        sheet.cell(row, 2).alignment = Alignment(wrap_text=True, vertical="top")
    sheet.column_dimensions["A"].width, sheet.column_dimensions["B"].width = 22, 90
    _print_on_one_width(sheet)


def _add_table(book: Workbook, title: str, columns: Sequence[Column]) -> None:
    sheet = book.create_sheet(title)
    for place, column in enumerate(columns, start=1):
        put(sheet, 1, place, column.name)
        for row, value in enumerate(column.values, start=2):
            put(sheet, row, place, value, column.display)
        sheet.column_dimensions[get_column_letter(place)].width = max(10, len(column.name) + 4)
    _finish(sheet, title, len(columns), 1 + len(columns[0].values), freeze="D2" if title == "Data" else "C2")


def _add_facts(book: Workbook, title: str, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    sheet = book.create_sheet(title)
    for row, values in enumerate([header, *rows], start=1):
        for place, value in enumerate(values, start=1):
            put(sheet, row, place, value)
    for place in range(1, len(header) + 1):
        longest = max(len(str(values[place - 1])) for values in [header, *rows])
        sheet.column_dimensions[get_column_letter(place)].width = min(max(10, longest + 3), 80)
    _finish(sheet, title, len(header), 1 + len(rows), freeze="A2")


def _finish(sheet: Worksheet, title: str, width: int, height: int, freeze: str) -> None:
    """Freeze the header and name the table, so that formulas and pandas can ask for it by name."""
    sheet.freeze_panes = freeze
    _print_on_one_width(sheet)
    for cell in sheet[1]:
        cell.font = BOLD
    table = Table(displayName=f"tbl{title}", ref=f"A1:{get_column_letter(width)}{max(height, 2)}")
    table.tableStyleInfo = TableStyleInfo(name="TableStyleLight1", showRowStripes=True)
    sheet.add_table(table)


def _print_on_one_width(sheet: Worksheet) -> None:
    sheet.page_setup.orientation, sheet.page_setup.fitToHeight = "landscape", 0
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)


def put(sheet: Worksheet, row: int, place: int, value: Any, display: str = "General") -> None:
    """Write one cell: NaN stays empty, and a text is a text even when it looks like a formula."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or (isinstance(value, float) and not np.isfinite(value)):
        return
    cell = sheet.cell(row, place)
    if isinstance(value, str):
        cell.value = _CONTROL.sub(" ", value)
        cell.data_type = "s"
        cell.quotePrefix = value.startswith(("=", "+", "-", "@"))
    else:
        cell.value = value
        cell.number_format = display

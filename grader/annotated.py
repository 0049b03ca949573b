"""An annotated copy of a student's workbook: what was read from it, written anew, with a sheet of feedback in front.

The student's file is never edited: only plain values come over, so no macro, link, formula or picture of it reaches
anybody's hands. The copy carries no variant code and cannot be handed in by mistake.
"""

from __future__ import annotations

import itertools
import math
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence

from assignments.sheets import META
from assignments.words import symbol_text
from grader.feedback import Line, Report, hints_of, line_of, standing_of, steps_of
from grader.kind import Kind
from grader.levels import levels_of
from grader.page import earned_text, points_text
from grader.plain_workbook import PlainSheet, PlainWorkbook, Style
from grader.read import limits
from grader.read.book import Book, Sheet
from grader.read.sheet import BookCell, place_of

FEEDBACK = "Feedback"
_PLAIN_FORMAT = re.compile(r"[0#?.,%E+\- ]{1,30}")
_WIDEST, _MOST_LINES = 50.0, 20
_MOST_SHEETS, _MOST_CELLS, _MOST_MERGES, _LARGEST_MERGE = 20, 50_000, 100, 1000  # of a sheet: a bomb stays small
_COLUMN_WIDTHS = (44, 22, 22, 14, 14, 12, 70)  # of the sheet of feedback: characters
_RESULT = 3  # its column of results, which is coloured

_TITLE, _TOP, _HEAD = {"font_size": 16, "bold": True}, {"valign": "top", "text_wrap": True}, {"bold": True}
_FILLS: Mapping[str, Style] = {
    "right": {"bg_color": "#E6F2EA"},
    "carried": {"bg_color": "#E6F2EA"},
    "partial": {"bg_color": "#FBF0D9"},
    "wrong": {"bg_color": "#F9E6E4"},
    "unsure": {"bg_color": "#E9E9F5"},
}
_BLANK = BookCell(Kind.BLANK)

Place = tuple[int, int]


def annotated_workbook(report: Report, book: Book) -> bytes:
    """Return the annotated copy as an `.xlsx` file.

    With `show_truth` off it holds no true value, as the page.

    Parameters
    ----------
    report : Report
    book : Book
        The cells that the reader read from the student's file.
    """
    made = PlainWorkbook(f"{report.assignment.title}: feedback")
    lines = {question.id: line_of(report, question) for question in report.assignment.questions}
    _write_feedback(made.sheet(FEEDBACK), report, lines)
    answers = _answer_cells(report, lines)
    for sheet in book.sheets[:_MOST_SHEETS]:
        if sheet.name != META:
            _copy(made.sheet(sheet.name), sheet, answers.get(sheet.name, {}))
    return made.content()


# ---------------------------------------------------------------- the sheet of feedback


def _write_feedback(page: PlainSheet, report: Report, lines: Mapping[str, Line]) -> None:
    title, *rest = _summary(report)
    page.text(1, 1, title, _TITLE)
    row = _write_lines(page, 2, rest)
    row = _write_lines(page, row + 1, [f"{number}. {step}" for number, step in enumerate(steps_of(report), start=1)])
    row = _write_table(page, row + 1, _levels(report), ())
    _write_table(page, row + 1, _answers(report, lines), [_FILLS[line.verdict.outcome] for line in lines.values()])
    for column, width in enumerate(_COLUMN_WIDTHS, start=1):
        page.width(column, width)


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
    hidden = "True value (not shown)" if report.terms.true_values == "never" else "True value (later)"
    expected = "True value" if report.show_truth else hidden
    symbols = {question.id: symbol_text(question.symbol) for question in report.assignment.questions}
    head = ("Question", "You wrote", expected, "Result", "Points", "Cell", "What was found")
    return [head, *(_answer(line, symbols[id_]) for id_, line in lines.items())]


def _answer(line: Line, symbol: str) -> Sequence[str]:
    truth = f"{line.truth} ({line.band})" if line.band else line.truth
    verdict = f"{line.verdict.mark} {line.verdict.word}"
    return f"{line.label}, {symbol}", line.own, truth, verdict, line.points, line.where, _said(line)


def _said(line: Line) -> str:
    return "\n".join(f"{verdict.mark} {aspect.capitalize()}. {message}" for verdict, aspect, message in line.findings)


def _write_lines(page: PlainSheet, row: int, lines: Iterable[str]) -> int:
    """Write sentences below one another; return the row after them."""
    for line in lines:
        page.text(row, 1, _plain(line))
        row += 1
    return row


def _write_table(page: PlainSheet, row: int, table: Sequence[Sequence[str]], fills: Sequence[Style]) -> int:
    """Write a table, its head in bold, the results in their colours; return the row after it."""
    for at, line in enumerate(table):
        for column, text in enumerate(line):
            ink = _HEAD if at == 0 else fills[at - 1] if fills and column == _RESULT else {}
            page.text(row + at, column + 1, text, {**_TOP, **ink})
        page.height(row + at, max(map(_lines_of, line, _COLUMN_WIDTHS)))
    return row + len(table)


def _lines_of(text: str, width: float) -> int:
    """Return how many lines a text takes in a column so wide: not every program finds the height of a row itself."""
    return sum(max(len(textwrap.wrap(line, int(width))), 1) for line in text.split("\n"))


# ---------------------------------------------------------------- what was read


def _copy(page: PlainSheet, sheet: Sheet, answers: Mapping[Place, Line]) -> None:
    """Write a sheet's values anew, answers in their colours with a note; one that was hidden is shown."""
    covered = _merge(page, sheet)
    shown = {place: line for place, line in answers.items() if _is_near(place) and place not in covered}
    places = sorted((sheet.cells.keys() | shown.keys()) - covered)
    for place in places[:_MOST_CELLS]:
        _write_cell(page, place, sheet.cells.get(place, _BLANK), shown.get(place))
    if len(places) > _MOST_CELLS:
        page.text(places[_MOST_CELLS][0] + 1, 1, "(more was left out here)")
    for place, line in shown.items():
        page.note(*place, f"{line.verdict.mark} {line.verdict.word}, {line.points} points\n{_said(line)}")
    _size(page, sheet)


def _merge(page: PlainSheet, sheet: Sheet) -> set[Place]:
    """Merge ranges over several rows (in one row texts run on as they do merged), but none over half a sheet.

    Return the places that show no value of their own.
    """
    merged, covered = set[Place](), set[Place]()
    for top, left, bottom, right in itertools.islice(filter(_is_worth_merging, sheet.merges), _MOST_MERGES):
        inside = set(itertools.product(range(top, bottom + 1), range(left, right + 1)))
        if merged.isdisjoint(inside):
            page.merge(top, left, bottom, right)
            merged |= inside
            covered |= inside - {(top, left)}
    return covered


def _is_worth_merging(merge: tuple[int, int, int, int]) -> bool:
    top, left, bottom, right = merge
    is_small = top < bottom and left <= right and (bottom - top + 1) * (right - left + 1) <= _LARGEST_MERGE
    return is_small and _is_near((top, left)) and _is_near((bottom, right))


def _is_near(place: Place) -> bool:
    """Tell whether a place is where the reader reads: writing to one far away would take minutes."""
    return 1 <= place[0] <= limits.ROWS and 1 <= place[1] <= limits.COLUMNS


def _size(page: PlainSheet, sheet: Sheet) -> None:
    """Give columns the width of their values, and rows the height of their texts."""
    widths: dict[int, int] = {}
    for (row, column), cell in sheet.cells.items():
        text = cell.text
        if "\n" in text:
            page.height(row, min(text.count("\n") + 1, _MOST_LINES))
        if cell.kind is not Kind.TEXT or (row, column + 1) in sheet.cells:  # else it runs on over empty cells
            widths[column] = max(widths.get(column, 0), len(text))
    for column, width in widths.items():
        page.width(column, min(max(width + 2.0, 9.0), _WIDEST))


def _write_cell(page: PlainSheet, place: Place, cell: BookCell, answer: Line | None) -> None:
    style = _FILLS[answer.verdict.outcome] if answer else {}
    if cell.kind is Kind.NUMBER and cell.number is not None and math.isfinite(cell.number):
        plain = {"num_format": cell.format} if _PLAIN_FORMAT.fullmatch(cell.format) else {}
        page.number(*place, cell.number, {**style, **plain})
    elif cell.kind is Kind.UNCACHED:
        page.text(*place, "(a formula that was never worked out)", style)
    else:
        page.text(*place, "" if cell.kind is Kind.BLANK else cell.text, style)


def _answer_cells(report: Report, lines: Mapping[str, Line]) -> dict[str, dict[Place, Line]]:
    """Return by sheet and place where the answers stand."""
    found: dict[str, dict[Place, Line]] = {}
    for id_, line in lines.items():
        sheet_name, _, address = report.submission.answer(id_).where.rpartition("!")
        place = place_of(address)
        if place is not None:
            found.setdefault(sheet_name.strip("'"), {})[place] = line
    return found

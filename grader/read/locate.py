"""Where the answers are: by defined name first, then by label, then at the template's own address."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from assignments.model import Question
from grader.kind import Kind
from grader.model import Answer, Submission
from grader.read.book import Book, BookCell, Sheet
from grader.read.errors import OUR_TEMPLATE, UnreadableError
from grader.read.flags import Flag
from grader.read.sheet import Place, address_of, place_of, shortest
from grader.read.table import read_table
from vml_course.model.arrays import FloatArray

_IN_BRACKETS = re.compile(r"[(\[][^()\[\]]*[)\]]")  # a unit or symbol behind a label
_LABEL_LENGTH = 200
_LABEL_REACH = 4  # how many columns right of a label an answer may stand
_META_SHEET = "_meta"
SEVERAL = "several"
"""How an answer was found when several cells carry its label and say different things."""
_NO_ANSWERS = ("tracking", "instructions", _META_SHEET)  # our own sheets without answers


_Labels = dict[str, list[tuple[Sheet, Place]]]


@dataclass(frozen=True)
class Claims:
    """What a workbook says it is: its variant's code, assignment and version, the signature, what it is for."""

    code: str
    assignment_id: str
    signature: str = ""
    version: str = ""
    purpose: str = ""


def claims_of(book: Book) -> Claims:
    """Return what the hidden sheet says.

    Raises
    ------
    UnreadableError
        When the workbook was not made by us, or the sheet is gone.
    """
    sheet = next((sheet for sheet in book.sheets if sheet.name.lower().startswith(_META_SHEET)), None)
    said = dict(_pairs(sheet)) if sheet else {}
    code, assignment = said.get("variant_code"), said.get("assignment")
    if not code or not assignment:
        raise UnreadableError(book.name, "one without our variant code", OUR_TEMPLATE, "the workbook of your video")
    return Claims(
        code, assignment, said.get("signature", ""), said.get("assignment_version", ""), said.get("purpose", "")
    )


def _pairs(sheet: Sheet) -> Iterator[tuple[str, str]]:
    """Yield each text of column A with the text beside it."""
    for (row, column), cell in sheet.cells.items():
        if column == 1 and cell.kind is Kind.TEXT:
            yield cell.text.strip().lower(), sheet.at((row, 2)).text.strip()


def find_submission(
    book: Book,
    questions: Iterable[Question],
    template: Mapping[str, str] | None = None,
    points: Sequence[str] = (),
    claims: Claims | None = None,
) -> Submission:
    """Return the answers to these questions and the tracking table.

    Parameters
    ----------
    book : Book
    questions : iterable of Question
    template : mapping of str to str, optional
        Where the template has its answer cells, as `Answers!C7` by question id.
    points : sequence of str, optional
        The assignment's points, with which the names in the table are matched.
    claims : Claims, optional
        What a person says that it is; asked of the workbook when not given.

    Raises
    ------
    UnreadableError
        When nobody says what it is, and the workbook carries no variant code.
    """
    claims = claims or claims_of(book)
    labels = _labels(book)
    answers = {q.id: _answer(book, labels, q, (template or {}).get(q.id, "")) for q in questions}
    table = read_table(book, points)
    return Submission(
        name=book.name,
        assignment_id=claims.assignment_id,
        code=claims.code,
        answers=answers,
        tracking=table.columns,
        flags=tuple(sorted({*book.flags, *table.flags, *_hidden(book)})),
        file_sha256=book.file_sha256,
        content_sha256=_content_sha256(answers, table.columns),
    )


def _answer(book: Book, labels: _Labels, question: Question, address: str) -> Answer:
    named = _by_reference(book, book.names.get(f"ans_{question.id}".lower(), ""))
    labelled = _by_label(labels, question)
    if named is not None and not (labelled is not None and _has_shifted(*named, question, labelled)):
        unit = _by_reference(book, book.names.get(f"unit_{question.id}".lower(), ""))
        return _made(*named, unit[0].at(unit[1]) if unit else None, "name")
    if labelled is not None:
        return labelled
    templated = _by_reference(book, address)
    if templated is not None:
        sheet, (row, column) = templated
        return _made(sheet, (row, column), sheet.at((row, column + 1)), "address")
    return Answer()


def _has_shifted(sheet: Sheet, place: Place, question: Question, labelled: Answer) -> bool:
    """Tell whether a row was inserted and the name stayed behind: the label stands in another row, with its answer.

    A name whose row carries the label is right; so is one whose cell was moved by hand, away from an empty place.
    """
    wanted = {_plain(text) for text in (question.label, question.symbol, question.id) if text}
    beside = [_plain(sheet.at((place[0], column)).text) for column in range(1, place[1])]
    if wanted & set(beside) or labelled.where == f"{sheet.name}!{address_of(place)}":
        return False
    return labelled.kind is not Kind.BLANK or any(beside)


def _made(sheet: Sheet, place: Place, unit: BookCell | None, found_by: str) -> Answer:
    cell = sheet.at(place)
    unit_text = unit.text.strip() if unit is not None and unit.kind is Kind.TEXT else ""
    unit_text = unit_text or _unit_shown(cell.format)
    return Answer(
        cell.kind, cell.number, cell.text.strip(), unit_text[:40], f"{sheet.name}!{address_of(place)}", found_by
    )


def _unit_shown(code: str) -> str:
    """Return the unit that a number format writes behind its number, as `0.00" m/s"` does; "" when it writes none."""
    found = re.search(r'[0#?]"([^"]{1,20})"[^"]*$', code.partition(";")[0])
    return found[1].strip() if found else ""


def _by_reference(book: Book, reference: str) -> tuple[Sheet, Place] | None:
    """Follow `'Sheet name'!$C$7` (or the first cell of a range)."""
    sheet_text, bang, cells = reference.strip().lstrip("=").rpartition("!")
    place = place_of(cells.partition(":")[0])
    if not bang or place is None:
        return None
    wanted = sheet_text.strip("'").replace("''", "'").lower()
    sheet = next((sheet for sheet in book.sheets if sheet.name.lower() == wanted), None)
    return (sheet, place) if sheet is not None else None


def _by_label(labels: _Labels, question: Question) -> Answer | None:
    """Find a label, and the answer to the right of it; None when there is none.

    Of several cells with the same label the first counts when they say the same, or one alone says anything;
    otherwise it is left to a person.
    """
    several: list[Answer] = []
    for wanted in (question.label, question.symbol, question.id):
        found = labels.get(_plain(wanted), []) if wanted else []
        answers = [_beside(sheet, place, question) for sheet, place in found]
        said = {(a.kind, a.text, a.unit_text): a for a in reversed(answers) if a.kind is not Kind.BLANK}
        if len(said) == 1 or len(answers) == 1:
            return next(iter(said.values()), answers[0])
        several = several or list(reversed(said.values()))
    return _unclear(several) if several else None


def _labels(book: Book) -> _Labels:
    """Return where each text stands, by its plain form, on the sheets that may hold answers."""
    labels: _Labels = {}
    for sheet in book.sheets:
        if sheet.is_visible and not sheet.name.lower().startswith(_NO_ANSWERS):
            for place, cell in sheet.cells.items():
                if cell.kind is Kind.TEXT:
                    labels.setdefault(_plain(cell.text), []).append((sheet, place))
    return labels


def find_beside(book: Book, label: str) -> float | None:
    """Return the one number to the right of a label on a visible sheet, such as a given one; None without one."""
    found = {
        cell.number
        for sheet in book.sheets
        if sheet.is_visible
        for (row, column), text in sheet.cells.items()
        if text.kind is Kind.TEXT and _plain(text.text) == _plain(label)
        for cell in (sheet.at((row, column + step)) for step in range(1, _LABEL_REACH + 1))
        if cell.kind is Kind.NUMBER
    }
    return found.pop() if len(found) == 1 else None


def _unclear(answers: Sequence[Answer]) -> Answer:
    """Return an answer that no one can read as a number: all that was found."""
    text, where = (", ".join(getattr(a, name) for a in answers[:4]) for name in ("text", "where"))
    return Answer(Kind.TEXT, None, text, "", where, SEVERAL)


def _beside(sheet: Sheet, label: Place, question: Question) -> Answer:
    row, column = label
    skipped = {_plain(question.symbol), _plain(question.id)}
    after_symbol = False
    for step in range(1, _LABEL_REACH + 1):
        cell = sheet.at((row, column + step))
        is_symbol = cell.kind is Kind.TEXT and _plain(cell.text) in skipped
        is_there = cell.kind is not Kind.BLANK and not is_symbol and place_is_new(sheet, (row, column + step), label)
        if is_there or after_symbol:  # right of the symbol stands the answer, or nothing: never the unit or the points
            return _made(sheet, (row, column + step), sheet.at((row, column + step + 1)), "label")
        after_symbol = is_symbol
    return Answer(where=f"{sheet.name}!{address_of((row, column + 1))}", found_by="label")


def place_is_new(sheet: Sheet, place: Place, label: Place) -> bool:
    """Tell whether `place` does not merely show the label's own merged cell."""
    return place in sheet.cells or sheet.at(place) is not sheet.at(label)


def _plain(text: str) -> str:
    """Return a text for comparison: no case, no spaces, nothing in brackets, no punctuation at the end."""
    straight = unicodedata.normalize("NFKC", text[:_LABEL_LENGTH]).casefold()
    return re.sub(r"[\s_:=.]+", "", _IN_BRACKETS.sub("", straight) or straight)


def _hidden(book: Book) -> set[Flag]:
    ours = (_META_SHEET, "_")
    return {Flag.HIDDEN_SHEET} if any(not s.is_visible and not s.name.startswith(ours) for s in book.sheets) else set()


def _content_sha256(answers: Mapping[str, Answer], tracking: Mapping[str, FloatArray]) -> str:
    """Return a hash of what is said, to the 15 digits that LibreOffice keeps: saving it there says nothing new."""
    content = repr(sorted((k, a.kind.value, a.text, a.unit_text) for k, a in answers.items()))
    columns = repr([(name, list(map(shortest, column.tolist()))) for name, column in sorted(tracking.items())])
    return hashlib.sha256((content + columns).encode()).hexdigest()

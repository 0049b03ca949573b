"""What a student's cell says as a quantity: value in SI, how exactly it was written, or why it says nothing."""

from __future__ import annotations

import re
from dataclasses import dataclass

from assignments.model import Question
from grader.kind import Kind
from grader.model import Answer, Outcome
from grader.read.locate import SEVERAL
from vml_course.errors import AmbiguousNumberError, InputError, UncalibratedUnitError
from vml_course.model.reading import UNITS, Reading, read_number, read_quantity
from vml_course.model.typed_text import straighten

_EXACT_DIGITS = 6  # a number with this many digits was computed, not rounded by a person
_WRITTEN = re.compile(
    r"[-+]? ?(?P<body>[0-9.,]+(?: [0-9]{3}(?![0-9])[0-9.,]*)*)(?:[eE](?P<e>[-+]?[0-9]{1,9}))?(?P<ten> ?[·*x] ?10)?"
)


@dataclass(frozen=True)
class Stated:
    """A number that could be read.

    Attributes
    ----------
    value : float
        In the question's SI unit.
    half_unit : float
        Half of the last written digit, same unit; 0 when the number was not rounded.
    text : str
        As the student sees it, with unit.
    unit_given : bool
    in_pixels : bool
        The unit says honestly that it is pixels.
    uncertainty : float or None
        What was written behind ±, in the question's SI unit; None when nothing was.
    """

    value: float
    half_unit: float
    text: str
    unit_given: bool
    in_pixels: bool = False
    uncertainty: float | None = None


@dataclass(frozen=True)
class Unstated:
    """Why a cell says no quantity, in words for the student, and how it is to be judged."""

    outcome: Outcome
    reason: str


def state(answer: Answer, question: Question) -> Stated | Unstated:
    """Read one answer as the quantity that the question asks for; never raises."""
    if answer.found_by == SEVERAL:
        reason = f"Several cells carry this label ({answer.where}) and say different things: {answer.text}. Keep one."
        return Unstated(Outcome.UNSURE, f"{reason} A person will look at it.")
    if answer.kind is Kind.NUMBER:
        return _from_text(answer, f"{answer.text} {answer.unit_text}", question)
    if answer.kind is Kind.TEXT:
        return _from_typed_text(answer, question)
    return _NOTHING[answer.kind](answer)


def _blank(_: Answer) -> Unstated:
    return Unstated(Outcome.WRONG, "Nothing is written here.")


def _bool(_: Answer) -> Unstated:
    return Unstated(Outcome.WRONG, "The cell says TRUE or FALSE, not a number.")


def _error(answer: Answer) -> Unstated:
    return Unstated(
        Outcome.WRONG, f"The formula in this cell ends in an error ({answer.text}). Check the cells that it uses."
    )


def _uncached(_: Answer) -> Unstated:
    reason = "The formula was never worked out. Open the workbook in Excel, press Ctrl+Alt+F9, save, hand in again."
    return Unstated(Outcome.UNSURE, reason)


def _date(answer: Answer) -> Unstated:
    number = f" and holds the number {answer.number:.15g}" if answer.number is not None else ""
    reason = (
        f"The cell shows a date, {answer.text}{number}: the spreadsheet took what you typed for one. "
        "Set the cell's format to Number and type your value again. A person will look at it."
    )
    return Unstated(Outcome.UNSURE, reason)


_NOTHING = {Kind.BLANK: _blank, Kind.BOOL: _bool, Kind.ERROR: _error, Kind.UNCACHED: _uncached, Kind.DATE: _date}


def _from_typed_text(answer: Answer, question: Question) -> Stated | Unstated:
    """Read typed text: a unit behind the number wins over the unit cell."""
    text = answer.read_as or answer.text
    try:
        read_number(text)
    except InputError:
        return _from_text(answer, text, question)
    return _from_text(answer, f"{text} {answer.unit_text}", question)


def _from_text(answer: Answer, text: str, question: Question) -> Stated | Unstated:
    try:
        reading = read_quantity(text, question.dimension, question.unit)
    except UncalibratedUnitError:
        return _in_pixels(text, question)
    except AmbiguousNumberError as error:
        return Unstated(Outcome.UNSURE, f"'{answer.text}' can be read in two ways. {error.hint}".strip())
    except InputError as error:
        return _unreadable(error)
    written = answer.read_as or answer.text
    shown = written if text.strip() == written else f"{written} {reading.unit}".strip()
    half_unit, is_given = _half_unit(text, reading, question), not reading.unit_assumed
    return Stated(reading.value, half_unit, shown, is_given, uncertainty=reading.uncertainty)


def _in_pixels(text: str, question: Question) -> Stated | Unstated:
    try:
        value = read_quantity(text, f"pixel_{question.dimension}").value
    except InputError as error:  # the value is in metres and its uncertainty in pixels
        return _unreadable(error)
    return Stated(value, 0.0, text.strip(), unit_given=True, in_pixels=True)


def _unreadable(error: InputError) -> Unstated:
    """Leave every text that is no quantity to a person: it may mean something."""
    return Unstated(Outcome.UNSURE, f"Expected {error.expected}, got {error.got}. A person will look at it.")


def _half_unit(text: str, reading: Reading, question: Question) -> float:
    """Return half of the last written digit in SI; 0 for zero, and for a number that no person rounded."""
    found = _WRITTEN.match(straighten(text, question.id))
    if found is None or found["ten"] or reading.value == 0:
        return 0.0
    body = found["body"]
    if len(re.sub(r"\D", "", body).lstrip("0")) >= _EXACT_DIGITS:
        return 0.0
    mark = max(body.rfind("."), body.rfind(","))
    decimals = len(body) - mark - 1 if mark >= 0 else 0
    power = int(found["e"] or 0) - decimals
    factor = UNITS[question.dimension].get(reading.unit, 0.0)
    return 0.5 * 10.0**power * factor if abs(power) < 300 else 0.0

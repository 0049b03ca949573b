"""Moodle's grading worksheet: which column is which, in any language, and whose row is whose.

The headings are in the language of the teacher who downloads it: the columns are found by their headings in common
languages, or else by what stands in them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from grader.filling.cells import TextTable
from grader.filling.numbers import number_in
from grader.filling.people import Asked
from grader.roster import folded
from vml_course.errors import TableError

EXPECTED = "the grading worksheet that Moodle gives for this assignment"

_PARTICIPANT = re.compile(r"\s*\D+?\s*(\d{1,12})\s*")
_ADDRESS = re.compile(r"\s*\S+@\S+\s*")
_MAXIMUM = frozenset({
    "maximum grade", "bestwertung", "note maximale", "note maximum", "calificación máxima", "puntuación máxima",
    "valutazione massima", "maximumcijfer", "maximale beoordeling", "nota máxima",
})  # fmt: skip
_NUMBER_OF_PERSON = frozenset({
    "id number", "id-nummer", "numéro d'identification", "número de id", "codice identificativo",
})  # fmt: skip


@dataclass(frozen=True)
class Worksheet:
    """Where the columns of a worksheet are; -1 where there is none. The first is always the participant's number."""

    table: TextTable
    name: int
    email: int
    number: int
    grade: int
    maximum: int

    @property
    def rows(self) -> range:
        """The rows of participants."""
        return range(1, len(self.table))

    def participant(self, row: int) -> str:
        """Return the number of a participant in this one assignment."""
        found = _PARTICIPANT.fullmatch(self.table.get(row, 0))
        return found[1] if found else ""

    def people(self) -> dict[int, Asked]:
        """Return whose each row is.

        The participant's number is another one in every assignment of Moodle's, so it is looked at only where the
        worksheet says nothing else: with blind marking.
        """
        return {row: self._asked(row) for row in self.rows if any(cell.strip() for cell in self.table.row(row))}

    def _asked(self, row: int) -> Asked:
        said = (("email", self.email), ("login", self.email), ("sis_id", self.number))
        ids = tuple((kind, self.table.get(row, at).strip()) for kind, at in said if at > 0)
        if self.is_blind:
            return Asked(self.table.get(row, 0), (("moodle_participant", self.participant(row)),))
        return Asked(self.table.get(row, self.name) if self.name > 0 else "", ids)

    @property
    def is_blind(self) -> bool:
        """Whether it says nothing of who the participants are."""
        return max(self.name, self.email, self.number) < 0


def worksheet(name: str, data: bytes) -> Worksheet:
    """Find the columns of a worksheet in any language.

    Raises
    ------
    TableError
        When it is none.
    """
    table = TextTable(name, data)
    rows, words = range(1, len(table)), [folded(heading) for heading in table.headings]
    if not rows or not all(_PARTICIPANT.fullmatch(table.get(row, 0)) for row in rows if table.get(row, 0).strip()):
        raise TableError(name, EXPECTED, ", ".join(table.headings)[:120] or "nothing")
    maximum = next((at for at, word in enumerate(words) if word in _MAXIMUM), None)
    if maximum is None:
        maximum = next((at for at in range(2, len(words)) if _is_maximum(table, at)), None)
    if maximum is None or maximum < 2:
        hint = "Choose Grade > Type: Point in the assignment's settings, and download the worksheet again."
        raise TableError(name, "a worksheet with a column of maximum grades", ", ".join(table.headings)[:120], hint)
    before = range(1, maximum - 1)
    email = next((at for at in before if _holds(table, at, _ADDRESS)), -1)
    number = next((at for at in before if words[at] in _NUMBER_OF_PERSON), -1)
    is_named = email > 1 or number > 1 or _is_of_names(table, maximum)
    return Worksheet(table, 1 if is_named else -1, email, number, maximum - 1, maximum)


def _is_maximum(table: TextTable, at: int) -> bool:
    """Tell whether a column holds one positive number throughout, right of a column of grades or blanks."""
    rows = range(1, len(table))
    said = {table.get(row, at).strip() for row in rows}
    value = number_in(said.pop()) if len(said) == 1 else None
    grades = (table.get(row, at - 1).strip() for row in rows)
    return bool(value and value > 0) and all(cell in ("", "-") or number_in(cell) is not None for cell in grades)


def _holds(table: TextTable, at: int, pattern: re.Pattern[str]) -> bool:
    said = [cell for row in range(1, len(table)) if (cell := table.get(row, at)).strip()]
    return bool(said) and sum(pattern.fullmatch(cell) is not None for cell in said) >= 0.8 * len(said)


def _is_of_names(table: TextTable, maximum: int) -> bool:
    """Tell whether the second column holds names: with blind marking the status of the work stands there."""
    said = [table.get(row, 1).strip() for row in range(1, len(table))]
    return maximum > 3 and len(set(said)) == len(said)

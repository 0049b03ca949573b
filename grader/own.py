"""The numbers that a student worked with, gathered from the cells, and what follows from them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from assignments.model import AnswerKey, Question
from assignments.textbook import textbook_of
from assignments.theory import Formula, Numbers, Textbook, value_of
from grader.model import Submission
from grader.stated import Stated, state

_LARGEST_ROUNDING = 0.05  # numbers rounded more coarsely than this prove nothing about a formula


@dataclass(frozen=True)
class OwnNumbers:
    """What a student wrote as an impact, with half of the last written digit of each number."""

    numbers: Numbers
    half_units: Mapping[str, float]

    def value(self, formula: Formula) -> float:
        """Return what a formula gives, NaN when it cannot be worked out."""
        return value_of(formula, self.numbers)

    def rounding(self, formula: Formula) -> float:
        """Return how much rounding of the written numbers usually moves a formula's value, never more than 5 %."""
        return min(self.spread(formula, self.half_units), _LARGEST_ROUNDING * abs(self.value(formula)))

    def worst_rounding(self, formula: Formula) -> float:
        """Return how much it can move it when all errors go the same way, never more than 5 %."""
        return min(sum(self._moves(formula, self.half_units)), _LARGEST_ROUNDING * abs(self.value(formula)))

    def spread(self, formula: Formula, off: Mapping[str, float]) -> float:
        """Return how far a formula's value moves when each field is off by so much, independently of the others."""
        return math.hypot(*self._moves(formula, off))

    def _moves(self, formula: Formula, off: Mapping[str, float]) -> Iterator[float]:
        value = self.value(formula)
        for name, step in off.items():
            moved = replace(self.numbers, **{name: getattr(self.numbers, name) + step})
            move = abs(value_of(formula, moved) - value)
            if step > 0 and math.isfinite(move):
                yield move

    def with_arm(self, length: float) -> OwnNumbers:
        """Return the same velocities on another arm, in metres."""
        return replace(self, numbers=replace(self.numbers, L=length))


def true_numbers(key: AnswerKey) -> Numbers:
    """Return the impact as it was."""
    book = textbook_of(key.scene)
    known = {item.field: key.values[item.id] for item in book.measured if item.id in key.values}
    return _record(book, key, {**book.resting(key.values), **known})


def own_numbers(submission: Submission, key: AnswerKey, questions: Mapping[str, Question]) -> tuple[OwnNumbers, ...]:
    """Return the student's numbers in each way in which they can be read.

    A number may come from its own cell or, as v = omega L, from another one: the textbook knows the ways, the cells as
    they stand first. Nothing is returned when too little was written.
    """
    book = textbook_of(key.scene)
    stated: dict[str, Stated] = {}
    for item in book.measured:
        reading = state(submission.answer(item.id), questions[item.id]) if item.id in questions else None
        if isinstance(reading, Stated):
            stated[item.field] = reading
    values = {**book.resting(questions), **{field: reading.value for field, reading in stated.items()}}
    halves = {item.field: stated[item.field].half_unit if item.field in stated else 0.0 for item in book.measured}
    return tuple(OwnNumbers(_record(book, key, way), halves) for way in book.complete(values, key.given))


def _record(book: Textbook, key: AnswerKey, values: Mapping[str, float]) -> Numbers:
    px_per_m = key.truth.get("px_per_m", key.values.get("px_per_m", math.nan))
    return book.record(values, key.given, px_per_m)

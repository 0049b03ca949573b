"""The numbers that a student worked with, gathered from the cells, and what follows from them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial
from itertools import islice

from assignments.model import AnswerKey, Question
from assignments.textbook import textbook_of
from assignments.theory import Formula, Numbers, Textbook, Values, value_of
from grader.model import Submission
from grader.stated import Stated, state

_LARGEST_ROUNDING = 0.05  # numbers rounded more coarsely than this prove nothing about a formula
_NUDGE = 0.01  # of a number, to see whether a formula depends on it


@dataclass(frozen=True, eq=False)
class OwnNumbers:
    """What a student wrote as an impact, in one way to read it.

    Attributes
    ----------
    written : mapping of str to float
        The numbers by their field, SI units; 0 for what rests unasked.
    build : callable
        How the record of the formulas' numbers is made of them, such as with v = omega L.
    half_units : mapping of str to float
        Half of the last written digit of each number, 0 where it was not rounded.
    """

    written: Values
    build: Callable[[Values], Numbers]
    half_units: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def numbers(self) -> Numbers:
        """The numbers as formulas take them."""
        return self.build(self.written)

    def value(self, formula: Formula) -> float:
        """Return what a formula gives, NaN when it cannot be worked out."""
        return value_of(formula, self.numbers)

    def rounding(self, formula: Formula) -> float:
        """Return how much rounding of the written numbers usually moves a formula's value, never more than 5 %."""
        return min(math.hypot(*self._rounding_moves(formula)), _LARGEST_ROUNDING * abs(self.value(formula)))

    def worst_rounding(self, formula: Formula) -> float:
        """Return how much it can move it when all errors go the same way, never more than 5 %."""
        return min(sum(self._rounding_moves(formula)), _LARGEST_ROUNDING * abs(self.value(formula)))

    def spread(self, formula: Formula, off: Mapping[str, float]) -> float:
        """Return how far a formula's value moves when each field is off by so much, independently of the others."""
        return math.hypot(*self._moves(formula, self._off_by(off)))

    def made_from(self, formula: Formula) -> frozenset[str]:
        """Return the fields that a formula's value is made from."""
        value = self.value(formula)
        nudged = ((name, self._moved(name, _NUDGE * (abs(number) or 1.0))) for name, number in self.written.items())
        return frozenset(name for name, numbers in nudged if value_of(formula, numbers) != value)

    def with_arm(self, length: float) -> OwnNumbers:
        """Return the same velocities on another arm, in metres."""
        return replace(self, build=lambda values: replace(self.build(values), L=length))

    @cached_property
    def _rounded_away(self) -> tuple[Numbers, ...]:
        return tuple(self._off_by(self.half_units))

    def _rounding_moves(self, formula: Formula) -> Iterator[float]:
        return self._moves(formula, self._rounded_away)

    def _off_by(self, off: Mapping[str, float]) -> Iterator[Numbers]:
        return (self._moved(name, step) for name, step in off.items() if step > 0 and name in self.written)

    def _moved(self, name: str, step: float) -> Numbers:
        return self.build({**self.written, name: self.written[name] + step})

    def _moves(self, formula: Formula, others: Iterator[Numbers] | tuple[Numbers, ...]) -> Iterator[float]:
        value = self.value(formula)
        return (move for numbers in others if math.isfinite(move := abs(value_of(formula, numbers) - value)))


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
    stated = {
        name: reading
        for name, id_ in field_ids(key, questions).items()
        if isinstance(reading := state(submission.answer(id_), questions[id_]), Stated)
    }
    written = {**book.resting(questions), **{name: reading.value for name, reading in stated.items()}}
    half_units = {name: reading.half_unit for name, reading in stated.items()}
    ways = len(list(book.complete(written, key.given)))
    return tuple(OwnNumbers(written, partial(_in_way, book, key, which), half_units) for which in range(ways))


def field_ids(key: AnswerKey, questions: Mapping[str, Question]) -> dict[str, str]:
    """Return the question behind each field of the formulas' numbers; `own_phi` is the conclusion phi as written."""
    book = textbook_of(key.scene)
    known = {item.name for item in fields(book.numbers)}
    concluded = {f"own_{item.id}": item.id for item in book.concluded}
    ids = {item.field: item.id for item in book.measured if item.id in questions}
    return ids | {name: id_ for name, id_ in concluded.items() if name in known and id_ in questions}


def _in_way(book: Textbook, key: AnswerKey, which: int, written: Values) -> Numbers:
    return _record(book, key, next(islice(book.complete(written, key.given), which, None)))


def _record(book: Textbook, key: AnswerKey, values: Values) -> Numbers:
    px_per_m = key.truth.get("px_per_m", key.values.get("px_per_m", math.nan))
    return book.record(values, key.given, px_per_m)

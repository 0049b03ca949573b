"""The numbers that a student worked with, gathered from the cells, and what follows from them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from assignments.mistakes import ImpactNumbers
from assignments.model import AnswerKey, Question
from grader.model import Submission
from grader.stated import Stated, state

Formula = Callable[[ImpactNumbers], float]

_FIELDS = {"v_f1": "v1", "v_f2": "v2", "v_b1": "u1", "v_b2": "u2", "omega1": "omega1", "omega2": "omega2"}
_LARGEST_ROUNDING = 0.05  # numbers rounded more coarsely than this prove nothing about a formula


@dataclass(frozen=True)
class OwnNumbers:
    """What a student wrote as an impact, with half of the last written digit of each number."""

    numbers: ImpactNumbers
    half_units: Mapping[str, float]

    def value(self, formula: Formula) -> float:
        """Return what a formula gives, NaN when it cannot be worked out."""
        return value_of(formula, self.numbers)

    def rounding(self, formula: Formula) -> float:
        """Return how much rounding of the written numbers can move a formula's value, never more than 5 %."""
        value = self.value(formula)
        moves = (
            self.value(_after(formula, replace(self.numbers, **{name: getattr(self.numbers, name) + half}))) - value
            for name, half in self.half_units.items()
            if half > 0
        )
        total = math.hypot(*(move for move in moves if math.isfinite(move)))
        return min(total, _LARGEST_ROUNDING * abs(value))

    def with_arm(self, length: float) -> OwnNumbers:
        """Return the same velocities on another arm, in metres."""
        return replace(self, numbers=replace(self.numbers, L=length))


def _after(formula: Formula, numbers: ImpactNumbers) -> Formula:
    return lambda _: formula(numbers)


def value_of(formula: Formula, numbers: ImpactNumbers) -> float:
    """Return a formula's value, NaN where it divides by zero."""
    try:
        value = float(formula(numbers))
    except (ZeroDivisionError, OverflowError, ValueError, TypeError):
        return math.nan
    return value if math.isfinite(value) else math.nan


def true_numbers(key: AnswerKey) -> ImpactNumbers:
    """Return the impact as it was."""
    return _impact(key, {symbol: key.values.get(id_, math.nan) for id_, symbol in _FIELDS.items()})


def own_numbers(submission: Submission, key: AnswerKey, questions: Mapping[str, Question]) -> tuple[OwnNumbers, ...]:
    """Return the student's numbers in each way in which they can be read.

    The foot's speed may come from its own cells or from omega L, and omega from its own cells or from v / L;
    each complete way is returned, the cells as they stand first. Nothing is returned when too little was written.
    """
    stated: dict[str, Stated] = {}
    for id_, symbol in _FIELDS.items():
        reading = state(submission.answer(id_), questions[id_]) if id_ in questions else None
        if isinstance(reading, Stated):
            stated[symbol] = reading
    values = {symbol: reading.value for symbol, reading in stated.items()}
    halves = {symbol: reading.half_unit for symbol, reading in stated.items()}
    return tuple(
        OwnNumbers(_impact(key, way), {name: halves.get(name, 0.0) for name in _FIELDS.values()})
        for way in _ways(values, key.given.get("L", math.nan))
    )


def _ways(values: Mapping[str, float], length: float) -> Iterator[dict[str, float]]:
    if not {"u1", "u2"} <= values.keys():
        return
    has_foot, has_omega = {"v1", "v2"} <= values.keys(), {"omega1", "omega2"} <= values.keys()
    if has_foot and has_omega:
        yield dict(values)
    if has_omega:
        yield {**values, "v1": values["omega1"] * length, "v2": values["omega2"] * length}
    if has_foot:
        yield {**values, "omega1": values["v1"] / length, "omega2": values["v2"] / length}


def _impact(key: AnswerKey, values: Mapping[str, float]) -> ImpactNumbers:
    return ImpactNumbers(
        **values,
        m=key.given.get("m", math.nan),
        L=key.given.get("L", math.nan),
        D=key.given.get("D", math.nan),
        S=key.truth.get("px_per_m", key.values.get("px_per_m", math.nan)),
    )

"""Which of several mistakes that fit is the likely one: how often each leads to the very digits that are written.

Cells hold rounded numbers, so that several mistakes may come near one answer. A student goes on with the numbers that
they wrote, or with those that they had before rounding: both count alike. Other answers of the same workbook, where
they follow rightly, tell which of the two it was, and where within the last digit the numbers lie.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from assignments.theory import Formula, Numbers, value_of
from grader.own import OwnNumbers
from grader.stated import Stated

CLEAR = 20.0
"""A mistake stays beside another one unless that one is so many times as likely."""

_DRAWS = 400
_EXACT = 5e-6  # relative: how well a number that no person rounded is known
_ODD = 0.02  # how likely it is to miss the digits with the right mistake: a constant of fewer digits, say

_ROOTS = tuple(math.sqrt(prime) for prime in (2, 3, 5, 7, 11, 13, 17, 19, 23))
"""Their multiples, less whole numbers, fill a cube evenly (Richtmyer's sequence); no textbook measures more numbers."""

Weighted = tuple[float, Numbers]
"""Numbers that a student may have worked with, and how likely they are."""


@dataclass(frozen=True)
class Cell:
    """An answer, and the formulas that it may come from."""

    stated: Stated
    formulas: tuple[Formula, ...]

    def comes_from(self, numbers: Numbers) -> bool:
        """Tell whether a formula gives these very digits."""
        value = self.stated.value
        width = max(self.stated.half_unit, _EXACT * abs(value))
        return any(abs(value_of(formula, numbers) - value) <= width for formula in self.formulas)


def likely(stated: Stated, mistakes: Mapping[str, Formula], way: OwnNumbers, others: Sequence[Cell]) -> tuple[str, ...]:
    """Return the codes of mistakes without those that are far less likely than the likeliest.

    Parameters
    ----------
    stated : Stated
        The answer.
    mistakes : mapping of str to formula
        Those that fit it, by code; at least one.
    way : OwnNumbers
    others : sequence of Cell
        The other answers, with their right formulas.
    """
    if len(mistakes) == 1:
        return tuple(mistakes)
    worlds = _worlds(way, others)
    odd = _ODD * sum(weight for weight, _ in worlds)
    chances = {code: odd + _chance(Cell(stated, (formula,)), worlds) for code, formula in mistakes.items()}
    best = max(chances.values())
    return tuple(code for code, chance in chances.items() if CLEAR * chance >= best)


def _chance(cell: Cell, worlds: Sequence[Weighted]) -> float:
    return sum(weight for weight, numbers in worlds if cell.comes_from(numbers))


def _worlds(way: OwnNumbers, others: Sequence[Cell]) -> list[Weighted]:
    """Return the numbers as written and before rounding; only those that the other answers agree with, if any do."""
    worlds = [(1.0, way.numbers), *((1 / _DRAWS, numbers) for numbers in _before_rounding(way))]
    agreed = [(weight, numbers) for weight, numbers in worlds if all(cell.comes_from(numbers) for cell in others)]
    return agreed or worlds


def _before_rounding(way: OwnNumbers) -> Iterator[Numbers]:
    """Yield numbers that read as they are written once they are rounded, evenly spread over the last digits."""
    halves = {name: half for name, half in way.half_units.items() if half > 0}
    for k in range(1, _DRAWS + 1):
        moved = {
            name: getattr(way.numbers, name) + half * (2.0 * (k * root % 1.0) - 1.0)
            for (name, half), root in zip(halves.items(), _ROOTS, strict=False)
        }
        yield replace(way.numbers, **moved)

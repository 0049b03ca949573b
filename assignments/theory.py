"""What a textbook of an impact says: what is measured, what follows from it, and how that commonly goes wrong.

A file in `assignments/textbook` holds one `Textbook`, that of an impact model. Key, variants and grader ask it, and
know of no scene themselves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from vml_course.errors import InputError, UnknownNameError
from vml_course.model.solution import Estimate
from vml_course.model.truth import ImpactTruth
from vml_course.synth.scene import Scene, scene_class

Numbers = Any
"""A frozen record of the numbers that formulas take, one class a textbook; every field is a float in SI units."""

Formula = Callable[[Numbers], float]
Values = Mapping[str, float]


@dataclass(frozen=True)
class Met:
    """An impact as it was or as the scene promises it: states, what is told of it, and the scene's parameters."""

    impact: ImpactTruth
    given: Values
    parameters: Values


@dataclass(frozen=True)
class Measured:
    """A number that is measured on the video.

    Attributes
    ----------
    id : str
        Of the question.
    field : str
        Which field of the numbers it is.
    true : callable
        How an impact gives it.
    may_rest : bool
        Whether it may be left unasked where the body is at rest; it is 0 then.
    symbol : str
        The solver's symbol of it, "" where that is the question's id.
    factor : callable
        What the solver's estimate is multiplied with, of the given numbers: -1 where its sign is another one.
    """

    id: str
    field: str
    true: Callable[[Met], float]
    may_rest: bool = False
    symbol: str = ""
    factor: Callable[[Values], float] = lambda _: 1.0


@dataclass(frozen=True)
class Concluded:
    """A number that follows from measured ones, by `formula`; an impact gives it by `true`.

    `text` is the formula in print: ids of questions and given numbers in braces, for symbols or for numbers. `also`
    holds other right ways; on measured numbers they give slightly other values.
    """

    id: str
    text: str
    formula: Formula
    true: Callable[[Met], float]
    also: tuple[Formula, ...] = ()

    @property
    def formulas(self) -> tuple[Formula, ...]:
        """Every right way."""
        return (self.formula, *self.also)


@dataclass(frozen=True)
class Mistake:
    """One common mistake: what was done, and the number that it leads to.

    Attributes
    ----------
    code : str
        The same code is the same mistake in every textbook.
    quantity : str
        Id of the conclusion that it spoils.
    about : str
        The mistake in a few words; words in braces are the scene's names or the questions' symbols.
    formula : callable
    hint : str
        What a student reads, with braces as in `about`; "" where a general sentence will do.
    scene : str
        The only scene in which it can be made, "" for every one.
    """

    code: str
    quantity: str
    about: str
    formula: Formula
    hint: str = ""
    scene: str = ""

    def value(self, numbers: Numbers) -> float:
        """Return the wrong value; NaN where the mistake cannot be made with these numbers."""
        return value_of(self.formula, numbers)


def value_of(formula: Formula, numbers: Numbers) -> float:
    """Return a formula's value, NaN where it cannot be worked out."""
    try:
        value = float(formula(numbers))
    except (ZeroDivisionError, OverflowError, ValueError, TypeError):
        return math.nan
    return value if math.isfinite(value) else math.nan


Ways = Callable[[Values, Values], Iterable[Values]]


@dataclass(frozen=True)
class Textbook:
    """Everything that is particular to one impact model.

    Attributes
    ----------
    model : str
        The impact model's name.
    numbers : type
        Record of the formulas' numbers; a field without a value is NaN.
    measured, concluded
    mistakes : mapping of str to Mistake
        By code, commonest first.
    is_possible : callable
        Whether numbers that a student wrote describe a possible impact; trivial ones make the rest easy.
    told : callable
        Which fields the given numbers fill; by default each the field of its own letter.
    ways : callable, optional
        In which ways the fields that were written, with those that are told, complete all measured fields;
        by default they must all be written.
    facts : mapping of str to callable
        Further fields that only the truth knows.
    unfit : callable
        Why a drawn impact cannot be asked about, "" when it can.
    """

    model: str
    numbers: type[Any]
    measured: tuple[Measured, ...]
    concluded: tuple[Concluded, ...]
    mistakes: Mapping[str, Mistake]
    is_possible: Callable[[Numbers], bool]
    told: Callable[[Values], Values] = dict
    ways: Ways | None = None
    facts: Mapping[str, Callable[[Met], float]] | None = None
    unfit: Callable[[Numbers], str] = lambda _: ""

    @property
    def answerable(self) -> tuple[str, ...]:
        """Ids of the questions whose truth this textbook knows."""
        return tuple(self._truths())

    def true(self, question: str, met: Met) -> float:
        """Return the true answer to a question (KeyError where the textbook does not know it)."""
        return float(self._truths()[question](met))

    def _truths(self) -> dict[str, Callable[[Met], float]]:
        measured = {item.id: item.true for item in self.measured}
        return measured | {item.id: item.true for item in self.concluded}

    def conclusion(self, question: str) -> Concluded:
        """Return a conclusion by its question.

        Raises
        ------
        UnknownNameError
        """
        found = {item.id: item for item in self.concluded}
        if question not in found:
            raise UnknownNameError("conclusion", question, found)
        return found[question]

    def mistakes_about(self, quantity: str, scene: str = "") -> tuple[Mistake, ...]:
        """Return the mistakes that lead to a wrong `quantity`, those of other scenes left out."""
        return tuple(m for m in self.mistakes.values() if m.quantity == quantity and m.scene in {"", scene or m.scene})

    def resting(self, asked: Iterable[str]) -> dict[str, float]:
        """Return the fields that are 0 because nothing asks for them."""
        covered = {item.field for item in self.measured if item.id in set(asked)}
        return {item.field: 0.0 for item in self.measured if item.may_rest and item.field not in covered}

    def complete(self, values: Values, given: Values) -> Iterator[Values]:
        """Yield each way in which written fields make up all measured fields, as they stand first."""
        if self.ways is not None:
            yield from self.ways(values, self.told(given))
        elif {item.field for item in self.measured} <= values.keys():
            yield values

    def record(self, values: Values, given: Values, px_per_m: float = math.nan) -> Numbers:
        """Return the numbers as the record that formulas take; S is the scale of the picture."""
        known = {**self.told(given), "S": px_per_m, **values}
        return self.numbers(**{field.name: known.get(field.name, math.nan) for field in fields(self.numbers)})

    def solved(self, estimates: Mapping[str, Estimate], asked: Iterable[str], given: Values) -> dict[str, Estimate]:
        """Return a solver's estimates by question, in the signs of this textbook, beside its other ones.

        A conclusion that is asked and that the solver does not name follows by its formula; its standard deviation is
        that of measured numbers that are off independently of one another, NaN where one is not known.
        """
        found, asked = dict(estimates), set(asked)
        for item in self.measured:
            symbol = item.symbol or item.id
            if symbol in estimates:
                one, factor = estimates[symbol], item.factor(given)
                found[item.id] = Estimate(factor * one.value, abs(factor) * one.sd)
        fields_of = {item.field: found[item.id] for item in self.measured if item.id in found.keys() & asked}
        for conclusion in self.concluded:
            if conclusion.id in asked - found.keys():
                follows = self._follows(conclusion.formula, fields_of, self.resting(asked), given)
                found |= {conclusion.id: follows} if math.isfinite(follows.value) else {}
        return found

    def _follows(self, formula: Formula, measured: Mapping[str, Estimate], resting: Values, given: Values) -> Estimate:
        """Return what a formula gives; each number that is off by its sd moves it."""
        values = {**resting, **{name: one.value for name, one in measured.items()}}
        value = value_of(formula, self.record(values, given))
        moved = ({**values, name: one.value + one.sd} for name, one in measured.items())
        moves = (value_of(formula, self.record(numbers, given)) - value for numbers in moved)
        return Estimate(value, math.hypot(*moves))

    def numbers_of(self, met: Met) -> Numbers:
        """Return the numbers of an impact."""
        facts = {name: fact(met) for name, fact in (self.facts or {}).items()}
        return self.record({item.field: item.true(met) for item in self.measured} | facts, met.given)


def unknown(symbol: str) -> Callable[[Met], float]:
    """Return how an impact gives one of its scene's unknowns."""
    return lambda met: met.impact.unknown(symbol)


def by_code(*mistakes: Mistake) -> dict[str, Mistake]:
    """Return mistakes by their codes."""
    return {mistake.code: mistake for mistake in mistakes}


def promised(name: str, parameters: Values) -> Met:
    """Return the impact that a scene promises with these parameters, in closed form.

    Raises
    ------
    InputError
        When the scene refuses the parameters, or has no impact.
    """
    settings: dict[str, Any] = dict(parameters)
    scene = scene_class(name)(**settings)
    if not isinstance(scene, Scene):
        raise InputError("scene", "a scene with an impact", name)
    law = scene.law()
    answer = law.answer()
    impact = ImpactTruth(
        time_s=0.0,
        frame_before=0,
        contact_m=np.zeros(2),
        normal=np.array(law.normal),
        arm_m=law.arm_m,
        impulse_xy_N_s=answer.impulse_N_s,
        before=law.before,
        after=answer.after,
        mass=law.mass,
        striker=law.striker,
        struck=law.struck,
        unknowns={},
    )
    numbers = {field: value for field, value in asdict(scene).items() if not isinstance(value, str)}
    return Met(impact, scene.given(), numbers)


def along(velocity_m_s: Any, direction: Any) -> float:
    """Return the component of a velocity along a unit vector."""
    return float(velocity_m_s[0] * direction[0] + velocity_m_s[1] * direction[1])

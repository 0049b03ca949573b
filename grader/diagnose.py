"""Which mistake explains a wrong answer: the catalogue evaluated on the student's own numbers, then on the truth.

A mistake is named only where its value fits what is written, the right formula does not, and the next mistake
does not either. Where several fit equally, they are reported as a group; where many do, nothing is said.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median

from assignments.model import AnswerKey, Question
from assignments.names import names_in
from assignments.textbook import textbook_of
from assignments.theory import Formula, Mistake, Numbers, Textbook, value_of
from grader.arm import CODE as ARM
from grader.arm import arm_hint
from grader.concluding import follows_from
from grader.hints import hint_for
from grader.model import Diagnosis, Factor, Outcome, Submission
from grader.own import OwnNumbers, own_numbers, true_numbers
from grader.stated import Stated, state
from grader.weighing import Cell, likely

OWN_TOLERANCE = 0.005
FINE_TOLERANCE = 0.0005  # beyond the printed digits
COARSE = 0.03  # of its value: who writes one digit only fits some mistake or other
LARGEST_GROUP = 3
_LEAST_CELLS = 3  # that tell how many digits a student writes
TRUTH_TOLERANCE: Mapping[str, float] = {"e": 0.03, "I": 0.08}
_USUAL_TRUTH_TOLERANCE = 0.05
_CLEAR = 3.0  # a best fit on the truth must be this much closer than the next


@dataclass(frozen=True)
class Candidate:
    """A mistake's value, and how much the rounding of the numbers behind it can move it."""

    code: str
    value: float
    rounding: float = 0.0


def diagnose_factors(
    factors: Iterable[Factor], key: AnswerKey, questions: Mapping[str, Question]
) -> tuple[Diagnosis, ...]:
    """Put the common factors of velocities and angular velocities into words."""
    subjects = {"velocity": "velocities", "angular_velocity": "angular velocities"}
    return tuple(
        Diagnosis(subjects[questions[f.ids[0]].dimension], f.codes, _factor_hint(f, key), "truth", f.ids)
        for f in factors
        if len(f.codes) <= LARGEST_GROUP
    )


def _factor_hint(factor: Factor, key: AnswerKey) -> str:
    return arm_hint(factor, key) if factor.codes == (ARM,) else hint_for(factor.codes)


def diagnose_answer(
    quantity: str, submission: Submission, key: AnswerKey, questions: Mapping[str, Question]
) -> Diagnosis | None:
    """Name the mistake in a conclusion; None where it is right, unreadable, or nothing explains it clearly."""
    stated = state(submission.answer(quantity), questions[quantity])
    if not isinstance(stated, Stated):
        return None
    ways, book = own_numbers(submission, key, questions), textbook_of(key.scene)
    right, mistakes = book.conclusion(quantity).formulas, book.mistakes_about(quantity, key.scene)
    if any(follows_from(stated, way, formula) for way in ways for formula in right):
        return None
    digits = usual_digits(submission, questions)
    if digits and _sharp(stated, digits).half_unit > COARSE * abs(stated.value):
        return None
    others = _other_cells(quantity, submission, book, questions, digits)
    sharp_ways = [_sharp_way(way, digits) for way in ways]
    codes, basis = _from_own(_sharp(stated, digits), sharp_ways, mistakes, others), "own"
    codes = codes or _from_own(stated, ways, mistakes, others)
    if not codes:
        codes, basis = _from_truth(stated.value, key, questions[quantity], mistakes), "truth"
    if not 1 <= len(codes) <= LARGEST_GROUP:
        return None
    return Diagnosis(quantity, codes, hint_for(codes, names_in(key.scene, questions.values())), basis, (quantity,))


def _candidate(code: str, formula: Formula, way: OwnNumbers) -> Candidate:
    return Candidate(code, way.value(formula), way.rounding(formula))


def _fits(stated: Stated, candidate: Candidate, tolerance: float) -> bool:
    return _misfit(stated, candidate, tolerance) <= 1


def _misfit(stated: Stated, candidate: Candidate, tolerance: float) -> float:
    """Return the distance in units of what is tolerated: below 1 it fits."""
    allowed = max(tolerance * abs(candidate.value), stated.half_unit + candidate.rounding)
    distance = abs(stated.value - candidate.value)
    return distance / allowed if allowed > 0 and math.isfinite(distance) else math.inf


def _other_cells(
    quantity: str, submission: Submission, book: Textbook, questions: Mapping[str, Question], digits: int
) -> tuple[Cell, ...]:
    """Return the other conclusions that can be read, with their right formulas."""
    asked = [item for item in book.concluded if item.id != quantity and item.id in questions]
    stated = [(item, state(submission.answer(item.id), questions[item.id])) for item in asked]
    return tuple(Cell(_sharp(one, digits), item.formulas) for item, one in stated if isinstance(one, Stated))


def _from_own(
    stated: Stated, ways: Sequence[OwnNumbers], mistakes: Sequence[Mistake], others: Sequence[Cell]
) -> tuple[str, ...]:
    """Match on each way to read the student's own numbers; the first that explains the answer counts."""
    for way in ways:
        candidates = (_candidate(mistake.code, mistake.formula, way) for mistake in mistakes)
        codes = matching(stated, (candidate for candidate in candidates if math.isfinite(candidate.value)))
        if codes:
            formulas = {mistake.code: mistake.formula for mistake in mistakes if mistake.code in codes}
            return likely(stated, formulas, way, others)
    return ()


def usual_digits(submission: Submission, questions: Mapping[str, Question]) -> int:
    """Return how many digits this student writes: a cell that holds 0.7 may have been typed as 0.700.

    >>> from grader.model import Answer, Kind, Submission
    >>> cells = {name: Answer(Kind.NUMBER, float(text), text) for name, text in zip("abc", ("12.4", "0.7", "3.05"))}
    >>> asked = {name: Question(name, name, name, "number", "", 1.0, "", 0.0, "") for name in cells}
    >>> usual_digits(Submission("w.xlsx", "a", "", cells, {}), asked)
    3
    """
    stated = (state(submission.answer(id_), question) for id_, question in questions.items())
    rounded = [one for one in stated if isinstance(one, Stated) and one.half_unit > 0]
    if len(rounded) < _LEAST_CELLS:
        return 0
    return round(median(_digits(one.value, one.half_unit) for one in rounded))


def _digits(value: float, half_unit: float) -> float:
    return math.floor(math.log10(abs(value))) - math.log10(2 * half_unit) + 1


def _sharper(value: float, half_unit: float, digits: int) -> float:
    if value == 0 or digits == 0:
        return half_unit
    return min(half_unit, 0.5 * 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1))


def _sharp(stated: Stated, digits: int) -> Stated:
    return replace(stated, half_unit=_sharper(stated.value, stated.half_unit, digits))


def _sharp_way(way: OwnNumbers, digits: int) -> OwnNumbers:
    halves = {name: _sharper(getattr(way.numbers, name), half, digits) for name, half in way.half_units.items()}
    return replace(way, half_units=halves)


def matching(stated: Stated, candidates: Iterable[Candidate]) -> tuple[str, ...]:
    """Return the codes that fit: to the printed digits if any does, else to half a percent."""
    candidates = list(candidates)
    for tolerance in (FINE_TOLERANCE, OWN_TOLERANCE):
        codes = tuple(c.code for c in candidates if _fits(stated, c, tolerance))
        if codes:
            return codes
    return ()


def _from_truth(value: float, key: AnswerKey, question: Question, mistakes: Sequence[Mistake]) -> tuple[str, ...]:
    """Match on the true numbers, which the student's measurement only resembles: only clear cases count."""
    truth = key.values[question.id]
    if abs(value - truth) <= 2 * question.tolerance * abs(truth):
        return ()
    fits = sorted(_distances(value, true_numbers(key), mistakes))
    near = TRUTH_TOLERANCE.get(question.id, _USUAL_TRUTH_TOLERANCE)
    close = [(distance, code) for distance, code in fits if distance <= near]
    if not close:
        return ()
    return tuple(code for distance, code in fits if distance <= max(_CLEAR * close[0][0], near))


def _distances(value: float, numbers: Numbers, mistakes: Iterable[Mistake]) -> Iterable[tuple[float, str]]:
    for mistake in mistakes:
        expected = value_of(mistake.formula, numbers)
        if math.isfinite(expected) and expected != 0:
            yield abs(value / expected - 1), mistake.code


def needs_diagnosis(outcomes: Iterable[tuple[str, Outcome]]) -> bool:
    """Tell whether there is something to explain: a right value is explained by the truth, whatever else would fit."""
    found = dict(outcomes)
    is_right = found.get("value") is Outcome.RIGHT
    return not is_right and any(
        found.get(aspect, Outcome.RIGHT) is not Outcome.RIGHT for aspect in ("formula", "value")
    )

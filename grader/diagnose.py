"""Which mistake explains a wrong answer: the catalogue evaluated on the student's own numbers, then on the truth.

A mistake is named only where its value fits what is written, the right formula does not, and the next mistake
does not either. Where several fit equally, they are reported as a group; where many do, nothing is said.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from assignments.mistakes import ImpactNumbers, mistakes_about
from assignments.model import AnswerKey, Question
from grader.arm import CODE as ARM
from grader.arm import arm_hint
from grader.hints import hint_for
from grader.model import Diagnosis, Factor, Outcome, Submission
from grader.own import OwnNumbers, own_numbers, true_numbers, value_of
from grader.stated import Stated, state

OWN_TOLERANCE = 0.005
FINE_TOLERANCE = 0.0005  # beyond the printed digits
LARGEST_GROUP = 3
TRUTH_TOLERANCE: Mapping[str, float] = {"e": 0.03, "I": 0.08}
_CLEAR = 3.0  # a best fit on the truth must be this much closer than the next

_RIGHT = {"e": lambda n: n.e, "I": lambda n: n.I}


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
    """Name the mistake in `e` or `I`; None where it is right, unreadable, or nothing explains it clearly."""
    stated = state(submission.answer(quantity), questions[quantity])
    if not isinstance(stated, Stated):
        return None
    ways = own_numbers(submission, key, questions)
    codes, basis = _from_own(quantity, stated, ways), "own"
    if not codes and not any(_fits(stated, _right(quantity, way), OWN_TOLERANCE) for way in ways):
        codes, basis = _from_truth(quantity, stated.value, key, questions[quantity].tolerance), "truth"
    if not 1 <= len(codes) <= LARGEST_GROUP:
        return None
    return Diagnosis(quantity, codes, hint_for(codes), basis, (quantity,))


def _right(quantity: str, way: OwnNumbers) -> Candidate:
    return Candidate("", way.value(_RIGHT[quantity]), way.rounding(_RIGHT[quantity]))


def _fits(stated: Stated, candidate: Candidate, tolerance: float) -> bool:
    return _misfit(stated, candidate, tolerance) <= 1


def _misfit(stated: Stated, candidate: Candidate, tolerance: float) -> float:
    """Return the distance in units of what is tolerated: below 1 it fits."""
    allowed = max(tolerance * abs(candidate.value), stated.half_unit + candidate.rounding)
    distance = abs(stated.value - candidate.value)
    return distance / allowed if allowed > 0 and math.isfinite(distance) else math.inf


def _from_own(quantity: str, stated: Stated, ways: Sequence[OwnNumbers]) -> tuple[str, ...]:
    """Match on each way to read the student's own numbers; the first that explains the answer counts."""
    for way in ways:
        if _fits(stated, _right(quantity, way), OWN_TOLERANCE):
            return ()
    for way in ways:
        codes = matching(stated, _candidates(quantity, way))
        if codes:
            return codes
    return ()


def _candidates(quantity: str, way: OwnNumbers) -> list[Candidate]:
    found = ((m.code, m.formula) for m in mistakes_about(quantity))
    values = (Candidate(code, way.value(formula), way.rounding(formula)) for code, formula in found)
    return [candidate for candidate in values if math.isfinite(candidate.value)]


def matching(stated: Stated, candidates: Iterable[Candidate]) -> tuple[str, ...]:
    """Return the codes that fit: to the printed digits if any does, else to half a percent."""
    candidates = list(candidates)
    for tolerance in (FINE_TOLERANCE, OWN_TOLERANCE):
        codes = tuple(c.code for c in candidates if _fits(stated, c, tolerance))
        if codes:
            return codes
    return ()


def _from_truth(quantity: str, value: float, key: AnswerKey, tolerance: float) -> tuple[str, ...]:
    """Match on the true numbers, which the student's measurement only resembles: only clear cases count."""
    truth = key.values[quantity]
    if abs(value - truth) <= 2 * tolerance * abs(truth):
        return ()
    numbers = true_numbers(key)
    fits = sorted(_distances(quantity, value, numbers))
    close = [(distance, code) for distance, code in fits if distance <= TRUTH_TOLERANCE[quantity]]
    if not close:
        return ()
    rivals = [code for distance, code in fits if distance <= max(_CLEAR * close[0][0], TRUTH_TOLERANCE[quantity])]
    return tuple(rivals) if len(rivals) <= LARGEST_GROUP else ()


def _distances(quantity: str, value: float, numbers: ImpactNumbers) -> Iterable[tuple[float, str]]:
    for mistake in mistakes_about(quantity):
        expected = value_of(mistake.formula, numbers)
        if math.isfinite(expected) and expected != 0:
            yield abs(value / expected - 1), mistake.code


def needs_diagnosis(outcomes: Iterable[tuple[str, Outcome]]) -> bool:
    """Tell whether an answer's formula or value was not found right."""
    return any(outcome is not Outcome.RIGHT for aspect, outcome in outcomes if aspect in {"formula", "value"})

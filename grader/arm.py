"""Another arm than the given L, used throughout: it shows in the foot's speed and in I alike.

With omega, v = omega L' and I = m L' (u2 - u1) / (omega1 - omega2) of the student's own numbers, L' can be worked
out twice. Where both agree, and L' is not L, the student worked rightly with another length: one slip, paid once.
(Another mass shows in I alone: the catalogue of mistakes has it.)
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from assignments.mistakes import ImpactNumbers
from assignments.model import AnswerKey, Question
from assignments.names import names_in
from grader.model import Factor, Submission
from grader.own import OwnNumbers, own_numbers
from grader.stated import Stated, state

CODE = "K12"
AGREE = 0.015
"""The two ways to work out the arm agree this well."""

APART = 0.03
"""An arm is another one from this on."""

_FOOT = ("v_f1", "v_f2")
_NAME_WITHIN = 0.01


def find_arm(submission: Submission, key: AnswerKey, questions: Mapping[str, Question]) -> Factor | None:
    """Return the factor of the arm that e and I were worked out with; None where it is L, or there is no one arm."""
    length = key.given.get("L", math.nan)
    arms = [*_from_foot(submission, questions), _from_inertia(submission, key, questions)]
    if len(arms) < 3 or not all(math.isfinite(arm) and arm > 0 for arm in arms):
        return None
    arm = arms[-1]
    is_one = all(abs(other / arm - 1) <= AGREE for other in arms)
    if not is_one or not abs(arm / length - 1) > APART:
        return None
    return Factor((CODE,), _rounded(arm / length, key), _FOOT)


def with_arm(way: OwnNumbers, factor: Factor) -> OwnNumbers:
    """Return the numbers with the arm that the student used."""
    return way.with_arm(way.numbers.L * factor.value)


def arm_hint(factor: Factor, key: AnswerKey) -> str:
    """Say which arm the numbers fit; both arm and L are the student's own and given, no truth."""
    length, striker = key.given["L"], names_in(key.scene)["Striker"]
    name = next((f" ({name})" for name, value in _named(key) if abs(factor.value / value - 1) <= _NAME_WITHIN), "")
    return (
        f"{striker} speed and I fit an arm of {factor.value * length:.3g} m{name} instead of L = {length:.4g} m. "
        "Use the L of your handout, in metres; it is counted once."
    )


def _from_foot(submission: Submission, questions: Mapping[str, Question]) -> Iterator[float]:
    for foot, omega in zip(_FOOT, ("omega1", "omega2"), strict=True):
        if foot in questions and omega in questions:
            speed, rate = (state(submission.answer(id_), questions[id_]) for id_ in (foot, omega))
            if isinstance(speed, Stated) and isinstance(rate, Stated) and rate.value:
                yield speed.value / rate.value


def _from_inertia(submission: Submission, key: AnswerKey, questions: Mapping[str, Question]) -> float:
    ways = own_numbers(submission, key, questions)
    inertia = state(submission.answer("I"), questions["I"]) if "I" in questions else None
    numbers = ways[0].numbers if ways else None
    if not isinstance(numbers, ImpactNumbers) or not isinstance(inertia, Stated):  # only a body on a pivot has an arm
        return math.nan
    per_metre = numbers.m * (numbers.u2 - numbers.u1)
    return inertia.value * (numbers.omega1 - numbers.omega2) / per_metre if per_metre else math.nan


def _named(key: AnswerKey) -> Iterator[tuple[str, float]]:
    yield from (("half of L", 0.5), ("twice L", 2.0), ("L in centimetres", 100.0), ("L in feet", 3.28084))
    diameter = key.given.get("D", math.nan) / key.given["L"]
    for name, part in (("R", diameter / 2), ("D", diameter)):
        yield from ((f"L − {name}", 1 - part), (f"L + {name}", 1 + part), (f"{name} of the ball", part))


def _rounded(ratio: float, key: AnswerKey) -> float:
    """Return the exact ratio where it has a name, so that rounding of the answers does not blur it."""
    return next((value for _, value in _named(key) if abs(ratio / value - 1) <= _NAME_WITHIN), ratio)

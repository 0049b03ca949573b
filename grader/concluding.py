"""How a number that follows from others is judged: does it follow from the student's own, is it right, whose error."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from assignments.pinned_body import has_moved
from assignments.textbook import textbook_of
from assignments.theory import Concluded, Formula
from assignments.words import symbol_text
from grader.arm import CODE as ARM
from grader.arm import with_arm
from grader.clicks import spread_of_concluded
from grader.judging import (
    PARTIAL_REACH,
    UNIT_SHARE,
    judge_unit,
    judge_unstated,
    judge_value,
    tolerance_of,
    truth_of,
)
from grader.model import Asked, Factor, Finding, Outcome
from grader.own import OwnNumbers, field_ids, own_numbers
from grader.stated import Stated, Unstated, state
from grader.support import supported

FORMULA_TOLERANCE = 0.005
"""A result follows from the student's own numbers when it agrees this well, or to the printed digits."""

_FORMULA_SHARE = 0.5
_SIGNED = frozenset({"velocity", "angular_velocity", "acceleration", "angle"})
"""Dimensions of conclusions that may be negative; all others are sizes."""


@dataclass(frozen=True)
class _Root:
    """From what an answer follows: the own numbers in one way to read them, and one of the right formulas."""

    way: OwnNumbers
    formula: Formula
    ids: frozenset[str]


def judge_concluded(asked: Asked) -> tuple[Finding, ...]:
    """Judge unit, formula and value of a number that is computed from the measured ones."""
    question = asked.question
    concluded = textbook_of(asked.key.scene).conclusion(question.id)
    stated = state(asked.submission.answer(question.id), question)
    if isinstance(stated, Unstated):
        return (judge_unstated(asked, stated),)
    ways = _ways(asked)
    root = _root(asked, stated, ways, concluded)
    has_unit = question.dimension != "number"
    share = 1.0 - _FORMULA_SHARE - (UNIT_SHARE if has_unit else 0.0)
    value = supported(asked, _value(asked, stated, share * question.points, root), tolerance_of(asked).half_width)
    return (
        *((judge_unit(asked, stated),) if has_unit else ()),
        _formula(asked, stated, ways[0].value(concluded.formula) if ways else None, root),
        value,
    )


def _ways(asked: Asked) -> tuple[OwnNumbers, ...]:
    """Return the student's own numbers; with the arm that they worked with, where that is another than L."""
    ways = own_numbers(asked.submission, asked.key, asked.questions)
    arm = _arm_of(asked)
    return ways if arm is None else (*(with_arm(way, arm) for way in ways), *ways)


def _arm_of(asked: Asked) -> Factor | None:
    return next((factor for factor in asked.factors if factor.codes == (ARM,)), None)


def _root(asked: Asked, stated: Stated, ways: tuple[OwnNumbers, ...], concluded: Concluded) -> _Root | None:
    """Return what the answer follows from, None where it follows from nothing that was written."""
    for way in ways:
        for formula in concluded.formulas:
            if follows_from(stated, way, formula):
                ids = field_ids(asked.key, asked.questions)
                made_from = way.made_from(formula) & ids.keys()
                return _Root(way, formula, frozenset(ids[name] for name in made_from))
    return None


def follows_from(stated: Stated, way: OwnNumbers, formula: Formula) -> bool:
    """Tell whether a value is what `formula` gives with the student's own numbers."""
    expected = way.value(formula)
    if math.isnan(expected):
        return False
    half_width = max(FORMULA_TOLERANCE * abs(expected), stated.half_unit + way.worst_rounding(formula))
    return abs(stated.value - expected) <= half_width


# ---------------------------------------------------------------- the formula


def _formula(asked: Asked, stated: Stated, from_own: float | None, root: _Root | None) -> Finding:
    numbers = {"value": stated.value} | ({} if from_own is None else {"from_own": from_own})
    outcome, message = _of_formula(asked, stated, has_numbers=from_own is not None, root=root)
    points = asked.question.points * _FORMULA_SHARE
    earned = 0.0 if outcome is Outcome.WRONG else points
    return Finding(asked.question.id, "formula", outcome, earned, points, message, numbers)


def _of_formula(asked: Asked, stated: Stated, *, has_numbers: bool, root: _Root | None) -> tuple[Outcome, str]:
    """Say whether the answer follows from what was written; what cannot be known costs nothing."""
    if root is not None:
        return Outcome.RIGHT, "Right: it follows from the numbers that you wrote."
    if abs(stated.value - truth_of(asked)) <= tolerance_of(asked).half_width:
        why = "it does not follow from the numbers that you wrote"
        why = why if has_numbers else "the numbers that it should follow from are missing"
        return Outcome.UNSURE, f"The value is right, but {why}; a person will look at it."
    if _unread(asked):
        return Outcome.UNSURE, f"It should follow from {_unread(asked)}, which could not be read; a person will look."
    if has_numbers:
        return (
            Outcome.WRONG,
            "It does not follow from the numbers that you wrote (within 0.5 % or the digits you gave).",
        )
    return Outcome.WRONG, "The numbers that it should follow from are missing, so the formula cannot be judged."


def _unread(asked: Asked) -> str:
    """Return the symbols of the numbers behind this one that only a person can read."""
    needed = [asked.questions[id_] for id_ in asked.question.needs if id_ in asked.questions]
    readings = ((question, state(asked.submission.answer(question.id), question)) for question in needed)
    unread = (q for q, reading in readings if isinstance(reading, Unstated) and reading.outcome is Outcome.UNSURE)
    return ", ".join(symbol_text(question.symbol) for question in unread)


# ---------------------------------------------------------------- the value


def _value(asked: Asked, stated: Stated, points: float, root: _Root | None) -> Finding:
    """Judge the value; an error that was counted where it arose costs nothing here."""
    if root is None:
        value = judge_value(asked, stated, points, spread=0.0)
        return _left_open(value) if _unread(asked) and value.outcome is not Outcome.RIGHT else value
    why_not = _why_not_followed(asked, root)
    spread = 0.0 if why_not else spread_of_concluded(asked, root.way, root.formula)
    value = judge_value(asked, stated, points, spread)
    if value.outcome is Outcome.RIGHT:
        return value
    if why_not:
        message = f"{value.message} It follows from your numbers, but {why_not}, so it counts here too."
        return replace(value, message=message)
    if _builds_on_an_error(asked, root):
        message = "It follows from your numbers; their error is counted where it arose and costs nothing here."
        return replace(value, outcome=Outcome.RIGHT, points=points, message=message, mistake="", carried=True)
    return value


def _left_open(value: Finding) -> Finding:
    message = "Whether it follows from your numbers cannot be said before a person has read them."
    return replace(value, outcome=Outcome.UNSURE, points=value.out_of, message=message, mistake="")


def _why_not_followed(asked: Asked, root: _Root) -> str:
    """Say why own numbers make the rest too easy, "" where they are a possible impact.

    Where one wrong arm explains them, their e may be anything: half of L alone can lift it over 2.
    """
    left_out = [symbol_text(asked.questions[id_].symbol) for id_ in sorted(root.ids) if _is_left_out(asked, id_)]
    if left_out:
        return f"a 0 for {', '.join(left_out)} makes it easy"
    numbers = root.way.numbers
    if _arm_of(asked) is not None:
        is_possible = has_moved(numbers)
    else:
        is_signed = asked.question.dimension in _SIGNED
        is_possible = textbook_of(asked.key.scene).is_possible(numbers)
        is_possible = is_possible and (is_signed or root.way.value(root.formula) > 0)
    return "" if is_possible else "they describe no possible impact"


def _is_left_out(asked: Asked, question_id: str) -> bool:
    """Tell whether a number is a bare 0 that is none."""
    source = replace(asked, question=asked.questions[question_id])
    stated = state(asked.submission.answer(question_id), source.question)
    is_zero = isinstance(stated, Stated) and stated.value == 0
    return is_zero and abs(truth_of(source)) > PARTIAL_REACH * tolerance_of(source).half_width


def _builds_on_an_error(asked: Asked, root: _Root) -> bool:
    """Tell whether a number behind this one was found wrong, or right but for an error that was counted elsewhere."""
    if _arm_of(asked) is not None:  # the arm is in e by the foot's speed, and in I by itself
        return True
    factored = {question_id for factor in asked.factors for question_id in factor.ids}
    return bool(root.ids & (asked.charged | asked.carried | factored))

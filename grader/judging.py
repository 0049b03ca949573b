"""How one number is judged: tolerance, partial credit, follow-through. Shared by all checks."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from assignments.pinned_body import has_moved
from assignments.textbook import textbook_of
from assignments.theory import Concluded, Formula
from grader.arm import CODE as ARM
from grader.arm import with_arm
from grader.clicks import spread_of_concluded, spread_of_measured
from grader.model import Asked, Factor, Finding, Outcome
from grader.own import OwnNumbers, own_numbers
from grader.remarks import remarks_on_number, z_score
from grader.stated import Stated, Unstated, state
from grader.support import supported

SDS = 3.0
"""A tolerance is never narrower than this many standard deviations of what the variant's video allows."""

PARTIAL_REACH = 2.0
"""Half of the points are given up to this many tolerances."""

FORMULA_TOLERANCE = 0.005
"""A result follows from the student's own numbers when it agrees this well, or to the printed digits."""

_UNIT_SHARE, _FORMULA_SHARE = 0.1, 0.5

# Which question's error a common factor comes from: it costs points there, once.
_SOURCES = {"K1": "px_per_m", "K1b": "px_per_m", "K5": "px_per_m", "K5b": "px_per_m", "K7": "px_per_m"}
# Pixels are no slip but a step left out: following it for full points would make calibration worthless.
_SKIPPED = frozenset({"K1", "K1b", "K1c"})
_RATE_SOURCES = {"K2": "fps", "K8": "fps"}


@dataclass(frozen=True)
class Tolerance:
    """Half-width of full credit, in SI, with the words for it."""

    half_width: float
    words: str


def tolerance_of(asked: Asked) -> Tolerance:
    """Return max(the assignment's tolerance, 3 sd of the variant), in numbers and in words."""
    question, truth = asked.question, abs(asked.key.values[asked.question.id])
    half_width = max(question.tolerance * truth, question.floor, SDS * asked.key.expected_sd.get(question.id, 0.0))
    if half_width < 0.2 * truth:
        return Tolerance(half_width, f"within {100 * half_width / truth:.2g} %")
    return Tolerance(half_width, f"within {half_width:.2g} {question.unit}".rstrip())


# ---------------------------------------------------------------- a measured number


def judge_measured(asked: Asked, explain: Callable[[Asked, Stated], str] | None = None) -> tuple[Finding, ...]:
    """Judge unit and value of a number that is measured on the video.

    Parameters
    ----------
    asked : Asked
    explain : function, optional
        Given a wrong value, returns the code of a mistake that explains it, or "".
    """
    stated = state(asked.submission.answer(asked.question.id), asked.question)
    if isinstance(stated, Unstated):
        return (_unstated(asked, stated),)
    points = asked.question.points * (1 - _UNIT_SHARE)
    value = _measured_value(asked, stated, points, spread_of_measured(asked))
    if explain is not None and value.outcome in {Outcome.WRONG, Outcome.PARTIAL} and not value.mistake:
        value = _with_mistake(value, explain(asked, stated))
    return _unit(asked, stated), value


def _with_mistake(finding: Finding, code: str) -> Finding:
    return Finding(**{**vars(finding), "mistake": code})


def _unstated(asked: Asked, stated: Unstated) -> Finding:
    points = asked.question.points
    earned = points if stated.outcome is Outcome.UNSURE else 0.0
    return Finding(asked.question.id, "value", stated.outcome, earned, points, stated.reason)


def _unit(asked: Asked, stated: Stated) -> Finding:
    question, share = asked.question, asked.question.points * _UNIT_SHARE
    if stated.in_pixels:
        message = f"The unit says pixels; {question.unit} was asked for."
        return Finding(question.id, "unit", Outcome.WRONG, 0.0, share, message)
    if not stated.unit_given:
        message = f"No unit is given; the number was read in {question.unit}."
        return Finding(question.id, "unit", Outcome.WRONG, 0.0, share, message)
    return Finding(question.id, "unit", Outcome.RIGHT, share, share, "The unit fits.")


def _measured_value(asked: Asked, stated: Stated, points: float, spread: float) -> Finding:
    """Judge a value; `spread` is how far off clicks by hand may leave it."""
    truth, tolerance = asked.key.values[asked.question.id], tolerance_of(asked)
    numbers = {"value": stated.value, "truth": truth, "tolerance": tolerance.half_width}
    distance = abs(stated.value - truth)

    numbers |= {} if stated.uncertainty is None else {"uncertainty": stated.uncertainty, "z": z_score(stated, truth)}
    remarks = list(remarks_on_number(stated, asked.question, asked.key, tolerance.half_width))

    def finding(outcome: Outcome, share: float, message: str, mistake: str = "", *, carried: bool = False) -> Finding:
        at, message = asked.question.id, " ".join([message, *remarks])
        return Finding(at, "value", outcome, share * points, points, message, numbers, mistake, carried)

    if distance <= tolerance.half_width and not stated.in_pixels:
        return finding(Outcome.RIGHT, 1.0, f"Right: {tolerance.words} of the true value.")
    factor = _factor_of(asked, stated.value, tolerance.half_width)
    if factor is not None:
        is_carried = _is_paid(asked, factor) and factor.codes[0] not in _SKIPPED
        return finding(*_factored(asked, factor), carried=is_carried)
    if distance <= PARTIAL_REACH * tolerance.half_width:
        return finding(Outcome.PARTIAL, 0.5, f"Close, but not {tolerance.words}, which earns full points.")
    if abs(stated.value + truth) <= tolerance.half_width:
        return finding(Outcome.PARTIAL, 0.5, "The size is right, the sign is not. Which direction is positive?", "K6")
    if distance <= spread:
        return finding(Outcome.PARTIAL, 0.5, f"As near as points clicked by hand allow, but not {tolerance.words}.")
    return finding(Outcome.WRONG, 0.0, f"Not right: full points are given {tolerance.words}.")


def _factor_of(asked: Asked, value: float, half_width: float) -> Factor | None:
    truth = asked.key.values[asked.question.id]
    for factor in asked.factors:
        if asked.question.id in factor.ids and abs(value / factor.value - truth) <= PARTIAL_REACH * half_width:
            return factor
    return None


def _factored(asked: Asked, factor: Factor) -> tuple[Outcome, float, str, str]:
    """Judge a number that is right but for a factor that all of its kind share."""
    code = factor.codes[0] if len(factor.codes) == 1 else ""
    if code in _SKIPPED:
        return (
            Outcome.PARTIAL,
            0.5,
            "Consistent with your other numbers, but still in pixels: half of the points.",
            code,
        )
    if _is_paid(asked, factor):
        message = "Consistent with your other numbers: off by the same factor, which is counted only once."
        return Outcome.RIGHT, 1.0, message, code
    message = "This and the numbers like it are all off by one and the same factor; it is counted here, once."
    return Outcome.WRONG, 0.0, message, code


def _is_paid(asked: Asked, factor: Factor) -> bool:
    """Tell whether the factor has cost points before: at its source, or at the first number that carries it."""
    sources = {table[code] for table in (_SOURCES, _RATE_SOURCES) for code in factor.codes if code in table}
    return bool(sources & asked.charged) or asked.question.id != factor.ids[0]


# ---------------------------------------------------------------- a number that follows from others


def judge_concluded(asked: Asked) -> tuple[Finding, ...]:
    """Judge unit, formula and value of a number that is computed from the measured ones."""
    question = asked.question
    concluded = textbook_of(asked.key.scene).conclusion(question.id)
    stated = state(asked.submission.answer(question.id), question)
    if isinstance(stated, Unstated):
        return (_unstated(asked, stated),)
    has_unit = question.dimension != "number"
    ways = _ways(asked)
    formula_finding = _formula(asked, stated, ways, concluded)
    share = 1.0 - _FORMULA_SHARE - (_UNIT_SHARE if has_unit else 0.0)
    follows = formula_finding.outcome is Outcome.RIGHT and _is_gated_in(asked, ways, concluded.formula)
    spread = spread_of_concluded(asked, ways[0], concluded.formula) if follows else 0.0
    value = _concluded_value(asked, stated, question.points * share, spread, follows=follows)
    value = supported(asked, value, tolerance_of(asked).half_width)
    if formula_finding.outcome is Outcome.RIGHT and not follows and value.outcome is Outcome.WRONG:
        value = replace(value, message=f"{value.message} {_NOT_FOLLOWED}")
    return (*((_unit(asked, stated),) if has_unit else ()), formula_finding, value)


_NOT_FOLLOWED = "It follows from your numbers, but they describe no possible impact, so it counts here too."


def _ways(asked: Asked) -> tuple[OwnNumbers, ...]:
    """Return the student's own numbers; with the arm that they worked with, where that is another than L."""
    ways = own_numbers(asked.submission, asked.key, asked.questions)
    arm = _arm_of(asked)
    return ways if arm is None else (*(with_arm(way, arm) for way in ways[:1]), *ways)


def _arm_of(asked: Asked) -> Factor | None:
    return next((factor for factor in asked.factors if factor.codes == (ARM,)), None)


def _formula(asked: Asked, stated: Stated, ways: tuple[OwnNumbers, ...], concluded: Concluded) -> Finding:
    question, points = asked.question, asked.question.points * _FORMULA_SHARE
    close = abs(stated.value - asked.key.values[question.id]) <= tolerance_of(asked).half_width
    numbers = {"value": stated.value}
    if ways:
        numbers["from_own"] = ways[0].value(concluded.formula)
    if any(follows_from(stated, way, formula) for way in ways for formula in concluded.formulas):
        message = "Right: it follows from the numbers that you wrote."
        return Finding(question.id, "formula", Outcome.RIGHT, points, points, message, numbers)
    if close:
        message = (
            "The value is right, but it does not follow from the numbers that you wrote; a person will look at it."
        )
        if not ways:
            message = (
                "The value is right, but the numbers that it should follow from are missing; a person will look at it."
            )
        return Finding(question.id, "formula", Outcome.UNSURE, points, points, message, numbers)
    message = "It does not follow from the numbers that you wrote (within 0.5 % or the digits you gave)."
    if not ways:
        message = "The numbers that it should follow from are missing, so the formula cannot be judged."
    return Finding(question.id, "formula", Outcome.WRONG, 0.0, points, message, numbers)


def follows_from(stated: Stated, way: OwnNumbers, formula: Formula) -> bool:
    """Tell whether a value is what `formula` gives with the student's own numbers."""
    expected = way.value(formula)
    if math.isnan(expected):
        return False
    half_width = max(FORMULA_TOLERANCE * abs(expected), stated.half_unit + way.worst_rounding(formula))
    return abs(stated.value - expected) <= half_width


def _is_gated_in(asked: Asked, ways: tuple[OwnNumbers, ...], formula: Formula) -> bool:
    """Tell whether the own numbers are a possible impact: a trivial one must not make the rest easy.

    Where one wrong arm explains them, their e may be anything: half of L alone can lift it over 2.
    """
    n = ways[0].numbers
    if _arm_of(asked) is not None:
        return has_moved(n)
    return textbook_of(asked.key.scene).is_possible(n) and ways[0].value(formula) > 0


def _concluded_value(asked: Asked, stated: Stated, points: float, spread: float, *, follows: bool) -> Finding:
    finding = _measured_value(asked, stated, points, spread)
    if finding.outcome in {Outcome.WRONG, Outcome.PARTIAL} and follows and _builds_on_an_error(asked):
        message = "It follows from your numbers; their error is counted where it arose and costs nothing here."
        at, numbers = asked.question.id, finding.numbers
        return Finding(at, "value", Outcome.RIGHT, points, points, message, numbers, "", carried=True)
    return finding


def _builds_on_an_error(asked: Asked) -> bool:
    """Tell whether a number that this one needs was found wrong, or right but for a common factor."""
    factored = {question_id for factor in asked.factors for question_id in factor.ids}
    if _arm_of(asked) is not None:  # the arm is in e by the foot's speed, and in I by itself
        return True
    return bool(set(asked.question.needs) & (asked.charged | factored))

"""How a measured number is judged: tolerance, partial credit, a factor that many numbers share. Used by all checks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from assignments.words import tolerance_text
from grader.clicks import spread_of_measured
from grader.model import Asked, Factor, Finding, Outcome
from grader.remarks import remarks_on_number, z_score
from grader.stated import Stated, Unstated, state
from vml_course.errors import InputError

SDS = 3.0
"""A tolerance is never narrower than this many standard deviations of what the variant's video allows."""

PARTIAL_REACH = 2.0
"""Half of the points are given up to this many tolerances."""

UNIT_SHARE = 0.1

# Slips of the scale and of the clock: an error of one source, which costs points there, once.
_OF_LENGTH = frozenset({"K1", "K1b", "K3", "K3b", "K3c", "K4", "K4b", "K5", "K5b", "K7"})
_OF_TIME = frozenset({"K2", "K2b", "K8"})
# Pixels are no slip but a step left out: following it for full points would make calibration worthless.
_SKIPPED = frozenset({"K1", "K1b", "K1c"})


@dataclass(frozen=True)
class Tolerance:
    """Half-width of full credit, in SI, with the words for it."""

    half_width: float
    words: str


def tolerance_of(asked: Asked) -> Tolerance:
    """Return max(the assignment's tolerance, 3 sd of the variant), in numbers and in words.

    The words are those of the workbook, or tell of the sd: a floor as a share of the truth would give that away.
    """
    question, truth = asked.question, abs(truth_of(asked))
    sd = asked.key.expected_sd.get(question.id, 0.0)
    usual, allowed = max(question.tolerance * truth, question.floor), SDS * sd if math.isfinite(sd) else 0.0
    if usual >= allowed:
        return Tolerance(usual, tolerance_text(question))
    if allowed < 0.2 * truth:
        return Tolerance(allowed, f"within {100 * allowed / truth:.2g} %")
    return Tolerance(allowed, f"within {allowed:.2g} {question.unit}".rstrip())


def truth_of(asked: Asked) -> float:
    """Return the true value.

    Raises
    ------
    InputError
        When the key does not know it: that is no fault of a student.
    """
    truth = asked.key.values.get(asked.question.id, math.nan)
    if not math.isfinite(truth):
        raise InputError("answer key", f"a true value of {asked.question.id}", truth)
    return truth


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
        return (judge_unstated(asked, stated),)
    points = asked.question.points * (1 - UNIT_SHARE)
    value = judge_value(asked, stated, points, spread_of_measured(asked))
    if explain is not None and value.outcome is not Outcome.RIGHT and not value.mistake:
        value = replace(value, mistake=explain(asked, stated))
    return judge_unit(asked, stated), value


def judge_unstated(asked: Asked, stated: Unstated) -> Finding:
    """Judge an answer that says no quantity; what a person has to read keeps its points."""
    points = asked.question.points
    earned = points if stated.outcome is Outcome.UNSURE else 0.0
    return Finding(asked.question.id, "value", stated.outcome, earned, points, stated.reason)


def judge_unit(asked: Asked, stated: Stated) -> Finding:
    """Judge whether a unit was given, and one that was asked for."""
    question, share = asked.question, asked.question.points * UNIT_SHARE
    if stated.in_pixels:
        message = f"The unit says pixels; {question.unit} was asked for."
        return Finding(question.id, "unit", Outcome.WRONG, 0.0, share, message)
    if not stated.unit_given:
        message = f"No unit is given; the number was read in {question.unit}."
        return Finding(question.id, "unit", Outcome.WRONG, 0.0, share, message)
    return Finding(question.id, "unit", Outcome.RIGHT, share, share, "The unit fits.")


# ---------------------------------------------------------------- the value


@dataclass(frozen=True)
class _Verdict:
    outcome: Outcome
    share: float
    message: str
    mistake: str = ""
    carried: bool = False


def judge_value(asked: Asked, stated: Stated, points: float, spread: float) -> Finding:
    """Judge a value by whatever speaks most for it.

    Parameters
    ----------
    asked : Asked
    stated : Stated
    points : float
        What it is worth.
    spread : float
        How far off clicks by hand may leave it, SI units.
    """
    truth, tolerance = truth_of(asked), tolerance_of(asked)
    verdict = max(_verdicts(asked, stated.value, tolerance, spread), key=lambda one: one.share)
    is_near = _is_near(stated.value, truth, tolerance)
    remarks = remarks_on_number(stated, asked.question, asked.key, tolerance.half_width, is_near=is_near)
    numbers = {"value": stated.value, "truth": truth, "tolerance": tolerance.half_width}
    if stated.uncertainty:
        numbers |= {"uncertainty": stated.uncertainty, "z": z_score(stated, truth)}
    return Finding(
        question_id=asked.question.id,
        aspect="value",
        outcome=verdict.outcome,
        points=verdict.share * points,
        out_of=points,
        message=" ".join([verdict.message, *remarks]),
        numbers=numbers,
        mistake=verdict.mistake,
        carried=verdict.carried,
    )


def _is_near(value: float, truth: float, tolerance: Tolerance) -> bool:
    """Tell whether a value is of the size asked for, by a factor of two."""
    return abs(abs(value) - abs(truth)) <= max(abs(truth) / 2, PARTIAL_REACH * tolerance.half_width)


def _verdicts(asked: Asked, value: float, tolerance: Tolerance, spread: float) -> Iterator[_Verdict]:
    """Yield all that can be said of a value; of what earns the same, the first holds."""
    truth, half_width, words = truth_of(asked), tolerance.half_width, tolerance.words
    distance = abs(value - truth)
    if distance <= half_width:
        yield _Verdict(Outcome.RIGHT, 1.0, f"Right: {words} of the true value.")
    factor = _factor_of(asked, value, PARTIAL_REACH * half_width)
    if factor is not None:
        yield _factored(asked, factor)
    if distance <= PARTIAL_REACH * half_width:
        yield _Verdict(Outcome.PARTIAL, 0.5, f"Close, but not {words}, which earns full points.")
    if abs(value + truth) <= half_width:
        yield _Verdict(Outcome.PARTIAL, 0.5, "The size is right, the sign is not. Which direction is positive?", "K6")
    if distance <= spread:
        yield _Verdict(Outcome.PARTIAL, 0.5, f"As near as points clicked by hand allow, but not {words}.")
    yield _Verdict(Outcome.WRONG, 0.0, f"Not right: full points are given {words}.")


# ---------------------------------------------------------------- a factor that many numbers share


def _factor_of(asked: Asked, value: float, reach: float) -> Factor | None:
    truth = truth_of(asked)
    for factor in asked.factors:
        if any(abs(value / ratio - truth) <= reach for ratio in _ratios(asked, factor)):
            return factor
    return None


def _ratios(asked: Asked, factor: Factor) -> Iterator[float]:
    """Yield what the factor makes of this question's number: an acceleration takes the velocities' slips over."""
    if asked.question.id in factor.ids:
        yield factor.value
    elif asked.question.dimension == "acceleration" and _is_of_velocities(asked, factor):
        if _OF_LENGTH & set(factor.codes):
            yield factor.value
        if _OF_TIME & set(factor.codes):
            yield factor.value**2


def _is_of_velocities(asked: Asked, factor: Factor) -> bool:
    return asked.questions[factor.ids[0]].dimension == "velocity"


def _factored(asked: Asked, factor: Factor) -> _Verdict:
    """Judge a number that is right but for a factor that all of its kind share."""
    code = factor.codes[0] if len(factor.codes) == 1 else ""
    if set(factor.codes) <= _SKIPPED:
        message = "Consistent with your other numbers, but still in pixels: half of the points."
        return _Verdict(Outcome.PARTIAL, 0.5, message, code)
    if _is_paid(asked, factor):
        message = "Consistent with your other numbers: off by the same factor, which is counted only once."
        return _Verdict(Outcome.RIGHT, 1.0, message, code, carried=True)
    message = "This and the numbers like it are all off by one and the same factor; it is counted here, once."
    return _Verdict(Outcome.WRONG, 0.0, message, code)


def _is_paid(asked: Asked, factor: Factor) -> bool:
    """Tell whether the factor costs points elsewhere: at its source, or at the first number that carries it."""
    codes = set(factor.codes)
    if codes & _OF_TIME and "fps" in asked.charged:
        return True
    if codes & _OF_LENGTH and _is_of_velocities(asked, factor) and "px_per_m" in asked.charged:
        return True
    one_clock = (other for other in asked.factors if other is factor or codes & _OF_TIME & set(other.codes))
    return asked.question.id != next(one_clock).ids[0]

"""What is said of digits and of a stated uncertainty; neither costs points."""

from __future__ import annotations

import math
from collections.abc import Iterator

from assignments.model import AnswerKey, Question
from grader.stated import Stated

TOO_FINE = 50.0  # a last digit this much finer than the uncertainty says nothing
FAR_SDS = 3.0
TOO_WIDE = 5.0  # tolerances


def remarks_on_number(
    stated: Stated, question: Question, key: AnswerKey, half_width: float, *, is_near: bool = True
) -> Iterator[str]:
    """Yield what a number's digits and its own uncertainty say, one sentence each.

    Parameters
    ----------
    stated : Stated
    question : Question
    key : AnswerKey
    half_width : float
        Of full credit, SI units.
    is_near : bool
        Whether the value is of the size asked for: digits of pixels or of another clock say nothing.
    """
    if is_near and question.dimension != "rate":  # a frame rate is read off, not rounded: 480 is 480.0
        yield from _digits(stated, key.expected_sd.get(question.id, 0.0), half_width)
    if stated.uncertainty:
        yield _uncertainty(stated.value - key.values[question.id], stated.uncertainty, half_width)


def _digits(stated: Stated, sd: float, half_width: float) -> Iterator[str]:
    if stated.half_unit > half_width:
        yield "It is rounded too coarsely for the tolerance: give one digit more."
    elif 0 < 2 * TOO_FINE * stated.half_unit < sd:
        digits = significant_digits(stated.value, sd)
        yield f"Its last digits say more than the video can tell: {digits} significant digits are enough."


def z_score(stated: Stated, truth: float) -> float:
    """Return how many of the student's own uncertainties a value is away from the truth; NaN where none is stated."""
    return (stated.value - truth) / stated.uncertainty if stated.uncertainty else math.nan


def significant_digits(value: float, sd: float) -> int:
    """Return how many digits a value deserves: the last one is of the size of the standard deviation.

    >>> significant_digits(0.7333, 0.002), significant_digits(1.88, 0.05), significant_digits(24.0, 30.0)
    (3, 3, 1)
    """
    if value == 0 or sd <= 0:
        return 1
    return max(1, math.floor(math.log10(abs(value))) - math.floor(math.log10(sd)) + 1)


def _uncertainty(off: float, uncertainty: float, half_width: float) -> str:
    if abs(off) > FAR_SDS * uncertainty:
        return "Your ± is too small: the true value lies far outside of it."
    if uncertainty > TOO_WIDE * half_width:
        return "Your ± is far wider than the video needs."
    return "Your ± fits the true value."

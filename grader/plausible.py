"""A comma that can stand for two things, in a cell whose quantity can have one of the two values only.

Typed `9,703` is 9.703 to half of the world and 9703 to the other half. As a foot's speed in m/s it is 9.703.
Where both readings or none is plausible, it stays a question for a person.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from assignments.model import Question
from grader.kind import Kind
from grader.model import Answer, Submission
from grader.stated import Stated, state

FACTOR = 30.0
"""A reading is plausible within this factor of the truth, where the truth is known and not zero."""

RANGES: Mapping[str, tuple[float, float]] = {
    "velocity": (0.0, 300.0),
    "angular_velocity": (0.0, 1000.0),
    "acceleration": (0.0, 1000.0),
    "number": (0.0, 1.5),
    "inertia": (0.0, 100.0),
    "mass": (0.0, 100.0),
    "energy": (0.0, 1e4),
    "scale": (1.0, 1e5),
    "rate": (10.0, 1e5),
}
"""Sizes that a quantity can have, in SI units, by its dimension."""

_TWO_WAYS = re.compile(r"(?<![0-9.,])([1-9][0-9]{0,2}),([0-9]{3})(?![0-9.,])")


def settle_readings(
    submission: Submission, questions: Mapping[str, Question], truth: Mapping[str, float] | None = None
) -> Submission:
    """Return the submission with `read_as` filled in where one reading alone is plausible.

    Parameters
    ----------
    submission : Submission
    questions : mapping of str to Question
    truth : mapping of str to float, optional
        True values by question id, SI units; without it only `RANGES` decide.
    """
    answers = {
        name: replace(answer, read_as=_meant(answer, questions[name], (truth or {}).get(name, math.nan)))
        if answer.kind is Kind.TEXT and name in questions
        else answer
        for name, answer in submission.answers.items()
    }
    return replace(submission, answers=answers)


def _meant(answer: Answer, question: Question, truth: float) -> str:
    found = _TWO_WAYS.findall(answer.text)
    if len(found) != 1 or question.dimension not in RANGES:
        return ""
    readings = [replace(answer, read_as=_TWO_WAYS.sub(form, answer.text)) for form in (r"\1.\2", r"\1\2")]
    plausible = list(_plausible(readings, question, truth))
    return plausible[0] if len(plausible) == 1 else ""


def _plausible(readings: list[Answer], question: Question, truth: float) -> Iterator[str]:
    low, high = RANGES[question.dimension]
    for answer in readings:
        stated = state(answer, question)
        if isinstance(stated, Stated) and not stated.in_pixels and low <= abs(stated.value) <= high:
            is_near = not math.isfinite(truth) or truth == 0 or 1 / FACTOR <= abs(stated.value / truth) <= FACTOR
            if is_near:
                yield answer.read_as

"""Common factors: velocities that are all wrong in the same way tell what was forgotten.

Wrong units, scales and frame rates cancel in e and mostly in I, so they can only be seen in the velocities.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence

from assignments.model import AnswerKey, Question
from grader.arm import find_arm
from grader.model import Factor, Submission
from grader.stated import Stated, state

SPREAD = 0.04
"""Numbers share a factor when their ratios to the truth agree this well."""

MATCH = 0.025
"""A factor has a name when the name's factor is this close."""

CLEAR = 3.0
"""And so many times closer than the right value: what scatters about the truth has no name."""

CLOSE = 0.1
"""A factor as close as this to 1 has to be in every number that was written: two of three that scatter are so soon."""

_PLAYBACK = (24.0, 25.0, 29.97, 30.0, 50.0, 59.94, 60.0)
_FAR = 1e9  # a number this far off tells of no slip of units
_DEG, _RPM = 180 / math.pi, 30 / math.pi
_VAGUE = frozenset({"K7", "K8"})  # "your own scale (rate)" is said only where nothing more definite fits


def find_factors(submission: Submission, key: AnswerKey, questions: Mapping[str, Question]) -> tuple[Factor, ...]:
    """Return the named factors of the velocities and of the angular velocities, none where they are right.

    A common factor of the foot's speeds that I shares is another arm than L: it comes first.
    """
    speeds, rates = (_asked(questions, dimension) for dimension in ("velocity", "angular_velocity"))
    kinds = [(speeds, _velocity_names), (rates, _omega_names)]
    if len(speeds) < 2 and len(rates) < 2:  # time alone is in both
        kinds = [([*speeds, *rates], _rate_names)]
    factors = (_factor(asked, submission, key, names(submission, key, questions)) for asked, names in kinds)
    found = [factor for factor in factors if factor is not None]
    arm = find_arm(submission, key, questions)
    if arm is not None:  # explains more than any factor of the foot's speeds alone
        return (arm, *(factor for factor in found if not set(factor.ids) <= set(arm.ids)))
    return tuple(found)


def _asked(questions: Mapping[str, Question], dimension: str) -> list[Question]:
    return [q for q in questions.values() if q.dimension == dimension and q.group != "conclusion"]


def _factor(
    asked: Sequence[Question], submission: Submission, key: AnswerKey, names: Iterable[tuple[str, float]]
) -> Factor | None:
    """Return the named factor that these questions' numbers share, None without one."""
    ratios = _ratios(submission, key, asked)
    shared = _shared(ratios)
    if shared is None:
        return None
    factor, ids = shared
    codes = _codes(factor, names, max(question.tolerance for question in asked))
    if abs(factor - 1) < CLOSE and len(ids) < len(ratios):
        codes = tuple(code for code in codes if code in _VAGUE)  # these the student has written down
    return Factor(codes, factor, ids) if codes else None


def _ratios(submission: Submission, key: AnswerKey, asked: Iterable[Question]) -> dict[str, float]:
    """Return the ratios to the truth; a number that is nearly 0 beside others of its kind tells of no factor."""
    known = [question for question in asked if question.id in key.values]
    largest: dict[str, float] = {}
    for question in known:
        size = abs(key.values[question.id])
        largest[question.dimension] = max(size, largest.get(question.dimension, 0.0))
    ratios = {}
    for question in known:
        stated, truth = state(submission.answer(question.id), question), key.values[question.id]
        if isinstance(stated, Stated) and abs(truth) > 0.05 * largest[question.dimension]:
            ratios[question.id] = stated.value / truth
    return {question_id: ratio for question_id, ratio in ratios.items() if 1 / _FAR < abs(ratio) < _FAR}


def _shared(ratios: Mapping[str, float]) -> tuple[float, tuple[str, ...]] | None:
    """Return the factor that most of the numbers share, with their ids; None when fewer than two do."""
    if len(ratios) < 2:
        return None
    middle = statistics.median_low(ratios.values())
    ids = tuple(id_ for id_, ratio in ratios.items() if abs(ratio / middle - 1) <= SPREAD)
    if len(ids) < 2 or 2 * len(ids) <= len(ratios):
        return None
    return statistics.fmean(ratios[id_] for id_ in ids), ids


def _codes(factor: float, names: Iterable[tuple[str, float]], tolerance: float) -> tuple[str, ...]:
    if abs(factor - 1) <= max(tolerance, MATCH):
        return ()
    near = min(MATCH, abs(factor - 1) / CLEAR)
    fits = tuple(
        dict.fromkeys(
            code
            for code, value in names
            if math.isfinite(value) and abs(value - 1) > 2 * MATCH and abs(factor - value) <= near * abs(value)
        )
    )
    return tuple(code for code in fits if code not in _VAGUE) or fits


def _velocity_names(
    submission: Submission, key: AnswerKey, questions: Mapping[str, Question]
) -> Iterable[tuple[str, float]]:
    scale = key.truth.get("px_per_m", math.nan)
    fps = key.truth.get("fps", math.nan)
    yield from (("K1", scale), ("K1b", scale**2), ("K1b", 1 / scale), ("K1c", scale / fps))
    yield from (("K3", 3.28084), ("K3b", 39.3701), ("K3c", 3.6), ("K4", 100.0), ("K4b", 1000.0), ("K6", -1.0))
    yield from (("K5", 2.0), ("K5b", 0.5))
    own_scale = _own(submission, questions, "px_per_m")
    if own_scale:
        yield "K7", scale / own_scale
    yield from _rate_names(submission, key, questions)


def _omega_names(
    submission: Submission, key: AnswerKey, questions: Mapping[str, Question]
) -> Iterable[tuple[str, float]]:
    yield from (("K9", _DEG), ("K9b", _RPM), ("K9c", 1 / _DEG), ("K6", -1.0), ("K5", 2.0), ("K5b", 0.5))
    yield from _rate_names(submission, key, questions)


def _rate_names(
    submission: Submission, key: AnswerKey, questions: Mapping[str, Question]
) -> Iterable[tuple[str, float]]:
    fps = key.truth.get("fps", math.nan)
    yield from (("K2", rate / fps) for rate in _PLAYBACK)
    yield "K2b", 1 / fps
    own_rate = _own(submission, questions, "fps")
    if own_rate:
        yield "K8", own_rate / fps


def _own(submission: Submission, questions: Mapping[str, Question], question_id: str) -> float:
    if question_id not in questions:
        return 0.0
    stated = state(submission.answer(question_id), questions[question_id])
    return stated.value if isinstance(stated, Stated) else 0.0

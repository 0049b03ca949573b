"""Submissions with one planted mistake, or none, and what the grader says of each."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

import numpy as np
from support.students import (
    concluded,
    desk_of,
    measured,
    numbers_of,
    scales_of,
    submission_of,
    table,
    tables_of,
    typed,
)  # fmt: skip

from assignments.load import load_assignment
from grader.grade import grade
from grader.model import Outcome
from grader.plausible import settle_readings

NOISES_PX = (0.02, 1.0)
DIGITS = (3, 4)
SLIP_SHARE = 0.15  # of the planted mistakes
RIGHT_KINDS = ("told", "formula", "value", "measured", "review")
SLIPS = ("K1", "K1b", "K1c", "K2", "K2b", "K3", "K3b", "K3c", "K4", "K4b", "K5", "K5b", "K6", "K9", "K9b", "K9c")
SPEEDS, RATES = "velocity", "angular_velocity"


@dataclass(frozen=True)
class Batch:
    """So many submissions to one variant of one assignment."""

    assignment: str
    variant: int
    seed: int
    planted: int
    right: int


def plant(batch: Batch) -> Counter:
    """Return how often what happened, by (kind, assignment, quantity, mistake, what was said)."""
    rng = np.random.default_rng([batch.seed, batch.variant, *batch.assignment.encode()])
    secret = bytes(rng.integers(0, 256, 32, dtype=np.uint8))
    desk = desk_of(load_assignment(batch.assignment), secret, f"s{batch.variant}")
    said: Counter = Counter()
    for student in _students(desk, batch.planted, rng):
        said += _told(desk, student, rng)
    for student in _students(desk, batch.right, rng):
        said += _right(desk, student)
    return said


# ---------------------------------------------------------------- students


@dataclass(frozen=True, eq=False)
class Student:
    """What one student measured, how they type, and where their points lie."""

    exact: dict
    digits: int
    from_typed: bool
    noise_px: float
    xy_px: np.ndarray
    px_per_m: float

    def written(self, values):
        return {name: typed(value, self.digits) for name, value in values.items()}

    @property
    def worked_with(self):
        return self.written(self.exact) if self.from_typed else self.exact


def _students(desk, count, rng):
    for noise_px, number in zip(NOISES_PX, (count // 2, count - count // 2), strict=True):
        if number == 0:
            continue
        scales = scales_of(desk, noise_px, number, rng)
        tables = tables_of(desk, noise_px, number, rng)
        values = measured(desk, tables, scales)
        for k in range(number):
            exact = {name: float(column[k]) for name, column in values.items() if name in desk.asked}
            yield Student(
                exact, int(rng.choice(DIGITS)), bool(rng.integers(2)), noise_px, tables[k], float(scales[k])
            )  # fmt: skip


# ---------------------------------------------------------------- one mistake


def _told(desk, student, rng):
    is_slip = rng.random() < SLIP_SHARE
    while True:
        made = _slip(desk, student, rng) if is_slip else _mistake(desk, student, rng)
        if made is not None:
            break
    (kind, quantity, code), values, unseen = made
    result = grade(submission_of(desk, values), desk.key, desk.assignment)
    said = Counter({(kind, desk.assignment.id, quantity, code, _verdict(result, quantity, code)): 1})
    return said + Counter({("unseen", desk.assignment.id, quantity, code, "unseen"): unseen})


def _mistake(desk, student, rng):
    """Plant one of the textbook's mistakes in one conclusion; those that leave it within tolerance are drawn again."""
    quantities = [item.id for item in desk.book.concluded if item.id in desk.asked]
    numbers = numbers_of(desk, student.worked_with)
    right, unseen = concluded(desk, numbers), 0
    for _ in range(200):
        quantity = quantities[rng.integers(len(quantities))]
        mistakes = desk.book.mistakes_about(quantity, desk.assignment.scene)
        mistake = mistakes[rng.integers(len(mistakes))]
        value = typed(mistake.value(numbers), student.digits)
        if not math.isfinite(value):
            continue
        if abs(value - right[quantity]) <= desk.asked[quantity].tolerance * abs(right[quantity]):
            unseen += 1
            continue
        values = {**student.written(student.exact), **student.written(right), quantity: value}
        return ("planted", quantity, mistake.code), values, unseen
    return None


def _slip(desk, student, rng):
    """Plant one slip of unit, scale or rate in all velocities, or all rates; conclusions follow from them."""
    code = SLIPS[rng.integers(len(SLIPS))]
    exact = {**student.exact}
    for name, question in desk.asked.items():
        if name in exact and question.group != "conclusion":
            exact[name] *= _factor(code, question.dimension, desk)
    if code in {"K2", "K2b"}:
        exact["fps"] = 30.0 if code == "K2" else exact["fps"]
    changed = [name for name in exact if exact[name] != student.exact[name] and name != "fps"]
    if len([name for name in changed if abs(desk.key.values[name]) > 0]) < 2:
        return None
    worked = {name: typed(value, student.digits) for name, value in exact.items()} if student.from_typed else exact
    values = {**student.written(exact), **student.written(concluded(desk, numbers_of(desk, worked)))}
    return ("slip", "velocities", code), values, 0


def _factor(code, dimension, desk):
    scale, fps = desk.key.truth["px_per_m"], desk.key.truth["fps"]
    speeds = {
        "K1": scale, "K1b": scale**2, "K1c": scale / fps, "K2": 30 / fps, "K2b": 1 / fps, "K3": 3.28084, "K3b": 39.3701,
        "K3c": 3.6, "K4": 100.0, "K4b": 1000.0, "K5": 2.0, "K5b": 0.5, "K6": -1.0,
    }  # fmt: skip
    rates = {"K2": 30 / fps, "K2b": 1 / fps, "K9": math.degrees(1), "K9b": 30 / math.pi, "K9c": math.radians(1)}
    return {SPEEDS: speeds, RATES: rates}.get(dimension, {}).get(code, 1.0)


def _verdict(result, quantity, code):
    """Return whether the mistake was told alone, in a group, not at all, or another one was."""
    told = [d for d in result.diagnosis if quantity in {"velocities", d.subject}]
    codes = {c for d in told for c in d.codes}
    if code in codes:
        return "unique" if any(d.codes == (code,) for d in told) else "group"
    return "none" if not told else "wrong"


# ---------------------------------------------------------------- none


def _right(desk, student):
    right = concluded(desk, numbers_of(desk, student.worked_with))
    values = {**student.written(student.exact), **student.written(right)}
    submission = submission_of(desk, values, table(desk, student.xy_px, student.px_per_m))
    result = grade(settle_readings(submission, desk.asked, desk.key.values), desk.key, desk.assignment)
    wrong = {Outcome.WRONG}
    ends = {quantity for quantity in right if quantity in desk.asked}
    happened = {
        "told": bool(result.diagnosis),
        "formula": any(f.outcome in wrong and f.aspect == "formula" for f in result.findings),
        "value": any(f.outcome in wrong and f.question_id in ends and f.aspect == "value" for f in result.findings),
        "measured": any(f.outcome in wrong and f.question_id not in ends and f.out_of for f in result.findings),
        "review": result.status != "ok",
        "all": True,
        "points": False,
    }
    at = ("right", desk.assignment.id, student.noise_px)
    said = Counter({(*at, kind, "yes"): int(happened[kind]) for kind in happened})
    return said + Counter({(*at, "points", "yes"): round(100 * result.points)})

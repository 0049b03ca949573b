"""Every assignment of the catalogue is graded: full points for what is right, and each mistake is told."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from assignments.key import answer_key
from assignments.load import assignment_ids, load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.textbook import textbook_of
from assignments.theory import Mistake, value_of
from assignments.variants import draw_variant
from grader.diagnose import diagnose_answer
from grader.grade import grade
from grader.model import Outcome
from vml_course.model.camera import Camera
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate

SECRET = bytes(range(32))
NOISE = 0.001  # of a measured number: a careful line
ALIKE = 0.02  # wrong values that are nearer to the right one are drawn again or cannot be told


@dataclass(frozen=True)
class Class:
    """An assignment, and the true key of one variant."""

    assignment: Assignment
    key: AnswerKey


@cache
def class_of(name: str) -> Class:
    assignment = load_assignment(name)
    variant = draw_variant(assignment, SECRET, "s0")
    scene = scene_class(assignment.scene)(**variant.parameters, **assignment.words)
    truth = simulate(scene, Camera(**variant.camera), variant.seed)
    return Class(assignment, answer_key(assignment, variant, truth, None, "0" * 64))


def written(assignment: Assignment, key: AnswerKey, rng: np.random.Generator | None = None) -> dict[str, float]:
    """What a student writes: measured numbers to five digits, and conclusions from those, to four."""
    book = textbook_of(assignment.scene)
    asked = [question.id for question in assignment.questions]
    values = {name: key.values[name] for name in asked}
    if rng is not None:
        for item in book.measured:
            if item.id in values:
                values[item.id] *= 1 + rng.normal(0, NOISE)
    values = {name: float(f"{value:.5g}") for name, value in values.items()}
    numbers = own(assignment, key, values)
    conclusions = {item.id: value_of(item.formula, numbers) for item in book.concluded if item.id in asked}
    return {**values, **{name: float(f"{value:.4g}") for name, value in conclusions.items()}}


def table_of(assignment: Assignment, key: AnswerKey, noise_px: float = 0.0, seed: int = 0) -> dict[str, np.ndarray]:
    """The tracking table of a student who tracked rightly, in metres."""
    at_px = key.xy_px[:, [key.points.index(point) for point in assignment.points]]
    off_px = noise_px * np.random.default_rng(seed).standard_normal(at_px.shape)
    xy_m = (at_px + off_px) * np.array([1.0, -1.0]) / key.truth["px_per_m"]
    columns = {"frame": key.frame.astype(float), "t_s": key.time_s}
    for number, point in enumerate(assignment.points):
        columns |= {f"{point}_x_m": xy_m[:, number, 0], f"{point}_y_m": xy_m[:, number, 1]}
    return columns


def own(assignment: Assignment, key: AnswerKey, values):
    book = textbook_of(assignment.scene)
    fields = {item.field: values[item.id] for item in book.measured if item.id in values}
    (first, *_) = book.complete({**book.resting(values), **fields}, key.given)
    return book.record(first, key.given, key.truth["px_per_m"])


def asked_mistakes(assignment: Assignment) -> list[Mistake]:
    book = textbook_of(assignment.scene)
    asked = {question.id for question in assignment.questions}
    return [m for quantity in asked for m in book.mistakes_about(quantity, assignment.scene) if m.quantity in asked]


@pytest.mark.parametrize("name", assignment_ids())
def test_a_perfect_student_earns_everything(kit, name):
    taught = class_of(name)
    table = table_of(taught.assignment, taught.key, noise_px=0.02)
    submission = kit.submission_of(taught.assignment, written(taught.assignment, taught.key), tracking=table)
    result = grade(submission, taught.key, taught.assignment)
    assert (result.points, result.out_of, result.status) == (20.0, 20.0, "ok"), result.findings
    assert result.diagnosis == ()


@pytest.mark.parametrize("name", assignment_ids())
def test_a_careful_student_is_never_told_a_mistake(kit, name):
    taught, rng = class_of(name), np.random.default_rng(3)
    for _ in range(20):
        values = written(taught.assignment, taught.key, rng)
        result = grade(kit.submission_of(taught.assignment, values), taught.key, taught.assignment)
        assert result.diagnosis == ()
        assert all(f.outcome is Outcome.RIGHT for f in result.findings if f.aspect == "formula")


@pytest.mark.parametrize("name", assignment_ids())
def test_an_error_of_measurement_costs_once(kit, name):
    """A wrong number that conclusions rest on loses its own value; what rightly follows from it loses nothing."""
    taught = class_of(name)
    book = textbook_of(taught.assignment.scene)
    needed = {need for question in taught.assignment.questions for need in question.needs}
    measured = [item.id for item in book.measured if item.id in needed]
    for spoilt in measured:
        values, question = written(taught.assignment, taught.key), taught.assignment.question(spoilt)
        off = 5 * max(question.tolerance * abs(values[spoilt]), question.floor)
        values[spoilt] = float(f"{values[spoilt] + off:.5g}")
        numbers = own(taught.assignment, taught.key, values)
        if not book.is_possible(numbers):
            continue
        followed = {c.id: value_of(c.formula, numbers) for c in book.concluded if c.id in values}
        values |= {conclusion: float(f"{value:.4g}") for conclusion, value in followed.items()}
        result = grade(kit.submission_of(taught.assignment, values), taught.key, taught.assignment)
        assert result.points == pytest.approx(20 - 0.9 * question.points), (spoilt, result.findings)


def tally(kit, taught: Class, code: str, count: int = 10) -> Counter:
    """How a planted mistake is told, by students who measured the same video."""
    mistake, rng, found = textbook_of(taught.assignment.scene).mistakes[code], np.random.default_rng(7), Counter()
    questions = {question.id: question for question in taught.assignment.questions}
    for _ in range(count):
        values = written(taught.assignment, taught.key, rng)
        numbers = own(taught.assignment, taught.key, values)
        value, right = mistake.value(numbers), values[mistake.quantity]
        if not math.isfinite(value) or abs(value / right - 1) < ALIKE:
            continue
        values[mistake.quantity] = float(f"{value:.4g}")
        submission = kit.submission_of(taught.assignment, values)
        diagnosis = diagnose_answer(mistake.quantity, submission, taught.key, questions)
        codes = diagnosis.codes if diagnosis else ()
        found["none" if not codes else "wrong" if code not in codes else "unique" if len(codes) == 1 else "group"] += 1
    return found


@pytest.mark.parametrize("name", assignment_ids())
def test_a_mistake_that_is_kept_apart_is_named_and_nearly_always_alone(kit, name):
    """Apart from one another by 2 %; a rarer mistake, or the noise of one's own numbers, may come near."""
    taught, found = class_of(name), Counter()
    for code in taught.assignment.separation.mistakes:
        one = tally(kit, taught, code)
        assert one["unique"] + one["group"] == one.total() > 0, (code, one)
        found += one
    assert found["unique"] / found.total() >= 0.95, found


@pytest.mark.parametrize("name", assignment_ids())
def test_every_other_mistake_is_named_alone_or_in_a_group(kit, name):
    taught = class_of(name)
    for mistake in asked_mistakes(taught.assignment):
        found = tally(kit, taught, mistake.code, count=3)
        assert found["wrong"] == 0, (mistake.code, found)


@pytest.mark.parametrize("name", assignment_ids())
def test_a_told_mistake_costs_its_conclusion_only(kit, name):
    taught = class_of(name)
    code = taught.assignment.separation.mistakes[0]
    mistake = textbook_of(taught.assignment.scene).mistakes[code]
    values = written(taught.assignment, taught.key)
    wrong = mistake.value(own(taught.assignment, taught.key, values))
    result = grade(
        kit.submission_of(taught.assignment, {**values, mistake.quantity: float(f"{wrong:.4g}")}),
        taught.key,
        taught.assignment,
    )
    unit = 0.1 if taught.assignment.question(mistake.quantity).dimension != "number" else 0.0
    lost = taught.assignment.question(mistake.quantity).points * (1 - unit)
    assert result.points == pytest.approx(20 - lost)
    assert [d.codes for d in result.diagnosis] == [(code,)]

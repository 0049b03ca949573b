"""Benches to judge single answers on: an assignment, a key and a table that supports it; no file, no video."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment, Question
from assignments.textbook import textbook_of
from grader.checks import check_named
from grader.factors import find_factors
from grader.model import Asked, Finding, Submission
from grader.tracked import FromTable
from grader.trajectory import TrajectoryFit, fit_trajectory

Answers = Mapping[str, float | str]


@dataclass(frozen=True)
class Bench:
    """One variant; `table` is what its tracking table says."""

    kit: ModuleType
    assignment: Assignment
    key: AnswerKey
    table: FromTable

    @property
    def truth(self) -> Mapping[str, float]:
        return self.key.values

    def question(self, question_id: str) -> Question:
        return self.assignment.question(question_id)

    def submission(self, answers: Answers | None = None, units: Mapping[str, str] | None = None) -> Submission:
        return self.kit.submission_of(self.assignment, {**self.truth, **(answers or {})}, units)

    def asked(self, question_id: str, answers: Answers | None = None, units=None, **changes: Any) -> Asked:
        submission = self.submission(answers, units)
        questions = {question.id: question for question in self.assignment.questions}
        facts: dict[str, Any] = {
            "factors": find_factors(submission, self.key, questions),
            "questions": questions,
            "table": self.table,
        }
        return Asked(submission, self.key, questions[question_id], **{**facts, **changes})

    def judge(self, question_id: str, answers: Answers | None = None, units=None, **changes: Any) -> dict[str, Finding]:
        """Judge one answer; findings by aspect."""
        asked = self.asked(question_id, answers, units, **changes)
        return {finding.aspect: finding for finding in check_named(asked.question.check)(asked)}

    def value(self, question_id: str, answer: float | str, **changes: Any) -> Finding:
        return self.judge(question_id, {question_id: answer}, **changes)["value"]

    def with_question(self, question_id: str, **changes: Any) -> Bench:
        questions = tuple(replace(q, **changes) if q.id == question_id else q for q in self.assignment.questions)
        return replace(self, assignment=replace(self.assignment, questions=questions))

    def with_key(self, **changes: Any) -> Bench:
        merged = {name: {**getattr(self.key, name), **change} for name, change in changes.items()}
        return replace(self, key=replace(self.key, **merged))

    def with_table(self, **changes: Any) -> Bench:
        return replace(self, table=replace(self.table, **changes))


@pytest.fixture(scope="session")
def fit(kit) -> TrajectoryFit:
    """A table of the kick without any error."""
    numbers = kit.impact()
    found = fit_trajectory(kit.table_of(kit.trajectory_m(numbers)), kit.key_of(numbers))
    assert found is not None
    return found


@pytest.fixture(scope="session")
def kick(kit, assignment, fit) -> Bench:
    numbers = kit.impact()
    key = kit.key_of(numbers)
    return Bench(kit, assignment, key, FromTable(fit, dict(key.values), {}))


@pytest.fixture(scope="session")
def bench_of(kit, fit) -> Callable[..., Bench]:
    """Make a bench of another assignment, from the fields of its textbook's numbers."""

    def make(name: str, given: Mapping[str, float], **fields: float) -> Bench:
        assignment = load_assignment(name)
        book = textbook_of(assignment.scene)
        numbers = book.record(fields, given)
        values = {item.id: getattr(numbers, item.field) for item in book.measured}
        values |= {item.id: item.formula(numbers) for item in book.concluded}
        values |= {"px_per_m": kit.SCALE, "fps": kit.FPS}
        asked = {question.id for question in assignment.questions}
        key = kit.key_of(kit.impact(), assignment_id=name, scene=assignment.scene, given=given)
        key = replace(key, values={id_: float(value) for id_, value in values.items() if id_ in asked})
        return Bench(kit, assignment, key, FromTable(fit, dict(key.values), {}))

    return make


@pytest.fixture(scope="session")
def pucks(bench_of) -> Bench:
    """Two pucks that meet at 0.6 rad."""
    m, mass, e, phi, a1x = 0.2, 0.3, 0.7, 0.6, 2.0
    impulse = (1 + e) * a1x * math.cos(phi) / (1 / mass + 1 / m)
    jx, jy = impulse * math.cos(phi), impulse * math.sin(phi)
    velocities = {"a1x": a1x, "a2x": a1x - jx / mass, "a2y": -jy / mass, "b2x": jx / m, "b2y": jy / m}
    return bench_of("two-pucks", {"m": m}, **velocities, a1y=0.0, b1x=0.0, b1y=0.0)


@pytest.fixture(scope="session")
def hammer(kit, bench_of) -> Bench:
    """A hammer and a block that slides on."""
    n = kit.impact(omega=5.0)
    fields = {"v1": n.v1, "v2": n.v2, "u1": n.u1, "u2": n.u2, "omega1": n.omega1, "omega2": n.omega2}
    return bench_of("hammer-and-block", {"m": n.m, "L": n.L, "g": 9.81}, **fields, a=4.0)


@pytest.fixture(scope="session")
def pendulum(bench_of) -> Bench:
    """A ballistic pendulum; both ways to its inertia agree."""
    m, big, d, c, v, inertia, g = 0.05, 0.4, 0.35, 0.3, 10.0, 0.05, 9.80665
    omega2 = m * v * d / (inertia + m * d**2)
    cosine = 1 - 0.5 * (inertia + m * d**2) * omega2**2 / ((big * c + m * d) * g)
    given = {"m": m, "M": big, "d": d, "c": c, "g": g}
    return bench_of("ballistic-pendulum", given, v=v, omega2=omega2, theta=math.acos(cosine))


@pytest.fixture(scope="session")
def bounce(bench_of) -> Bench:
    """A spinning ball on a floor."""
    given = {"m": 0.6, "R": 0.12, "k": 0.6}
    spin = -1.6 / (0.6 * 0.12)
    fields = {"u1": -4.0, "u2": 3.0, "w1": 3.4, "w2": 1.8, "omega1": 20.0, "omega2": 20.0 + spin}
    return bench_of("spinning-ball", given, **fields)


@pytest.fixture(scope="session")
def smoothed() -> Callable[[np.ndarray, int], np.ndarray]:
    """Take the moving mean of positions, shape (n, p, 2), over so many frames."""

    def mean(xy: np.ndarray, width: int) -> np.ndarray:
        half = width // 2
        padded = np.pad(xy, ((half, half), (0, 0), (0, 0)), mode="edge")
        return np.stack([padded[k : k + len(xy)] for k in range(width)]).mean(axis=0)

    return mean

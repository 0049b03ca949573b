"""Planted mistakes are named: measured over many random variants, as arithmetic, without files."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from assignments.mistakes import MISTAKES, ImpactNumbers
from assignments.textbook import every_mistake
from grader.diagnose import diagnose_answer
from grader.factors import find_factors
from grader.hints import HINTS, KINEMATIC, about, hint_for
from tests.impacts import numbers_of_impact

SCALE = 500.0
VARIANTS = 150
NOISE_M_S = 0.015  # of a velocity: a careful straight line over 20 ms

# Mistakes that give the same number by identity, or nearly always: the group is the right answer.
PLANTED_E = ("E1", "E2", "E3", "E4", "E5", "E7", "E10", "E11", "E12", "E13", "E19")
PLANTED_I = ("I1", "I2", "I4", "I6", "I6d", "I7", "I8", "I9", "I13", "I14", "I16", "I17")


def random_impact(rng: np.random.Generator) -> ImpactNumbers:
    """A variant within the assignment's ranges: slowdown r decides I, as the generator draws it."""
    e, r = rng.uniform(0.35, 0.9), rng.uniform(0.1, 0.4)
    m, length = rng.uniform(0.2, 0.6), rng.uniform(0.4, 0.7)
    while 0.42 <= m <= 0.48:
        m = rng.uniform(0.2, 0.6)
    given = {
        "e": e,
        "I": m * length**2 * (1 + e - r) / r,
        "m": m,
        "L": length,
        "omega1": rng.uniform(6, 18) / length,
        "D": rng.uniform(0.2, 0.24),
    }
    return numbers_of_impact(given, px_per_m=SCALE)


def measured(n: ImpactNumbers, rng: np.random.Generator) -> ImpactNumbers:
    v1, v2, u2 = (float(f"{v + rng.normal(0, NOISE_M_S):.5g}") for v in (n.v1, n.v2, n.u2))
    return replace(n, v1=v1, v2=v2, u2=u2, omega1=float(f"{v1 / n.L:.5g}"), omega2=float(f"{v2 / n.L:.5g}"))


def written(kit, n: ImpactNumbers, quantity: str, value: float, digits: int = 4) -> dict[str, float]:
    return {**kit.true_values(n), quantity: float(f"{value:.{digits}g}")}


def tally(kit, assignment, code: str, digits: int = 4, count: int = VARIANTS) -> dict[str, float]:
    """Return the shares of unique and right, right within a group, and wrong diagnoses."""
    mistake, rng = MISTAKES[code], np.random.default_rng(sum(map(ord, code)))
    questions = {question.id: question for question in assignment.questions}
    found = {"unique": 0, "group": 0, "wrong": 0, "none": 0}
    done = 0
    while done < count:
        truth = random_impact(rng)
        own = measured(truth, rng)
        value = mistake.value(own)
        right = {"e": own.e, "I": own.I}[mistake.quantity]
        if not math.isfinite(value) or abs(value / right - 1) < 0.02:
            continue  # the variant generator draws again
        done += 1
        submission = kit.submission_of(assignment, written(kit, own, mistake.quantity, value, digits))
        diagnosis = diagnose_answer(mistake.quantity, submission, kit.key_of(truth), questions)
        codes = diagnosis.codes if diagnosis else ()
        kind = "none" if not codes else "wrong" if code not in codes else "unique" if len(codes) == 1 else "group"
        found[kind] += 1
    return {kind: number / count for kind, number in found.items()}


@pytest.mark.parametrize("code", PLANTED_E)
def test_a_planted_mistake_in_e_is_named(kit, assignment, code):
    shares = tally(kit, assignment, code)
    assert shares["unique"] >= 0.95, shares
    assert shares["wrong"] <= 0.01, shares


@pytest.mark.parametrize("code", PLANTED_I)
def test_a_planted_mistake_in_i_is_named(kit, assignment, code):
    shares = tally(kit, assignment, code)
    assert shares["unique"] >= 0.94, shares
    assert shares["wrong"] <= 0.01, shares


def test_right_answers_are_not_diagnosed(kit, assignment):
    rng = np.random.default_rng(5)
    questions = {question.id: question for question in assignment.questions}
    for _ in range(200):
        truth = random_impact(rng)
        own = measured(truth, rng)
        submission = kit.submission_of(assignment, kit.rounded(kit.true_values(own), 3))
        assert diagnose_answer("e", submission, kit.key_of(truth), questions) is None
        assert diagnose_answer("I", submission, kit.key_of(truth), questions) is None


def test_without_own_velocities_the_truth_is_the_basis(kit, desk):
    questions = {question.id: question for question in desk.assignment.questions}
    only_e = {"e": float(f"{-desk.numbers.e:.4g}")}
    diagnosis = diagnose_answer("e", kit.submission_of(desk.assignment, only_e), desk.key, questions)
    assert diagnosis is not None
    assert (diagnosis.basis, "E5" in diagnosis.codes) == ("truth", True)


@pytest.mark.parametrize("value", [0.0, 1e9, -1e9, 123.4])
def test_numbers_that_nothing_explains_are_left_alone(kit, desk, value):
    questions = {question.id: question for question in desk.assignment.questions}
    submission = kit.submission_of(desk.assignment, {**desk.truth, "e": value})
    assert diagnose_answer("e", submission, desk.key, questions) is None


# ---------------------------------------------------------------- common factors

VELOCITIES = ("v_f1", "v_f2", "v_b1", "v_b2")
OMEGAS = ("omega1", "omega2")


@pytest.mark.parametrize(
    ("ids", "factor", "code"),
    [
        (VELOCITIES, SCALE, "K1"),
        (VELOCITIES, SCALE**2, "K1b"),
        (VELOCITIES, 1 / SCALE, "K1b"),
        (VELOCITIES, SCALE / 480, "K1c"),
        (VELOCITIES, 30 / 480, "K2"),
        (VELOCITIES, 60 / 480, "K2"),
        (VELOCITIES, 3.28084, "K3"),
        (VELOCITIES, 100.0, "K4"),
        (VELOCITIES, 1000.0, "K4b"),
        (VELOCITIES, 3.6, "K3c"),
        (VELOCITIES, 2.0, "K5"),
        (VELOCITIES, -1.0, "K6"),
        (OMEGAS, 57.29578, "K9"),
        (OMEGAS, 9.549297, "K9b"),
        (OMEGAS, -1.0, "K6"),
        (OMEGAS, 30 / 480, "K2"),
        (OMEGAS, 1 / 480, "K2b"),
    ],
)
def test_a_common_factor_is_named(kit, assignment, ids, factor, code):
    rng = np.random.default_rng(3)
    questions = {question.id: question for question in assignment.questions}
    named = 0
    for _ in range(40):
        truth = random_impact(rng)
        own = kit.true_values(measured(truth, rng))
        values = {**own, **{name: own[name] * factor for name in ids}}
        factors = find_factors(kit.submission_of(assignment, values), kit.key_of(truth), questions)
        expected = (code,) if abs(factor - 1) > 0.05 else ()
        named += tuple(f.codes for f in factors) == ((expected,) if expected else ())
    assert named == 40


def test_right_velocities_share_no_factor(kit, assignment):
    rng = np.random.default_rng(4)
    questions = {question.id: question for question in assignment.questions}
    for _ in range(100):
        truth = random_impact(rng)
        values = kit.true_values(measured(truth, rng))
        assert find_factors(kit.submission_of(assignment, values), kit.key_of(truth), questions) == ()


def test_a_scale_of_ones_own_is_found_in_the_velocities(kit, desk):
    questions = {question.id: question for question in desk.assignment.questions}
    wrong = {"px_per_m": SCALE / 1.15, **{name: desk.truth[name] * 1.15 for name in VELOCITIES}}
    (factor,) = find_factors(kit.submission_of(desk.assignment, {**desk.truth, **wrong}), desk.key, questions)
    assert factor.codes == ("K7",)


def test_one_wrong_velocity_is_no_common_factor(kit, desk):
    questions = {question.id: question for question in desk.assignment.questions}
    submission = kit.submission_of(desk.assignment, {**desk.truth, "v_b2": 2 * desk.truth["v_b2"]})
    assert find_factors(submission, desk.key, questions) == ()


# ---------------------------------------------------------------- words


def test_every_hint_belongs_to_a_known_mistake():
    assert set(HINTS) <= set(every_mistake()) | set(KINEMATIC)
    assert set(KINEMATIC) <= set(HINTS)


@pytest.mark.parametrize("code", [*every_mistake(), *KINEMATIC])
def test_every_mistake_has_words(code):
    assert about(code)
    assert hint_for((code,)).endswith((".", "?"))


def test_a_group_is_worded_as_a_list_to_check():
    assert hint_for(("E1", "E2")).startswith("Your numbers fit more than one slip; check each: inverted")

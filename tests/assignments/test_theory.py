"""What a textbook makes of an impact that is promised, and of what a solver estimates."""

from __future__ import annotations

import math

import numpy as np
import pytest

from assignments.fairness import allowance, blurred_track, solve
from assignments.film import foresee
from assignments.key import answer_key, true_value
from assignments.load import assignment_ids, load_assignment
from assignments.mistakes import STANDARD_GRAVITY
from assignments.textbook import textbook, textbook_of
from assignments.theory import promised
from assignments.variants import draw_variant
from vml_course.model.solution import Estimate
from vml_course.synth.scene import scene_class

SECRET = bytes(range(32))


def test_a_promised_impact_is_at_time_zero_with_its_law() -> None:
    met, law = promised("soccer_kick", {}), scene_class("soccer_kick")().law()
    assert (met.impact.time_s, met.impact.frame_before, met.impact.unknowns) == (0.0, 0, {})
    assert met.impact.arm_m == law.arm_m > 0
    assert np.array_equal(met.impact.normal, law.normal)


def test_written_rates_make_up_speeds_on_the_arm_that_is_given() -> None:
    rates = {"omega1": 20.0, "omega2": 10.0, "u1": 0.0, "u2": 12.0}
    (way,) = textbook_of("soccer_kick").complete(rates, {"L": 0.5})
    assert way == {**rates, "v1": 10.0, "v2": 5.0}


# ---------------------------------------------------------------- what a solver estimates, by question


def test_a_number_that_the_solver_calls_otherwise_is_kept_under_its_question() -> None:
    estimates = {"mu": Estimate(0.5, 0.01), "omega2": Estimate(-4.0, 0.1), "v1": Estimate(9.0, 0.2)}
    slowing = textbook("hammer-block").solved(estimates, ["a_b"], {})["a_b"]
    assert (slowing.value, slowing.sd) == (0.5 * STANDARD_GRAVITY, 0.01 * STANDARD_GRAVITY)
    speed = textbook("fixed-pivot").solved(estimates, ["v_c2"], {"a": 0.5, "L": 0.8})["v_c2"]
    assert (speed.value, speed.sd) == (-2.0, 0.05)
    assert textbook("ballistic-pendulum").solved(estimates, ["v_b1"], {})["v_b1"] == Estimate(9.0, 0.2)


def test_a_reversed_sign_leaves_a_standard_deviation_positive() -> None:
    found = textbook("free-rod").solved({"v_b1": Estimate(2.0, 0.1), "omega2": Estimate(3.0, 0.2)}, ["v_b1"], {})
    assert found == {"v_b1": Estimate(-2.0, 0.1), "omega2": Estimate(3.0, 0.2)}


SPIN = {"v_t2": Estimate(2.0, 0.03), "omega2": Estimate(5.0, 1.0)}


def test_a_conclusion_that_is_asked_follows_by_its_formula() -> None:
    """s2 = v_t2 + R omega2."""
    found = textbook("spin-bounce").solved(SPIN, ["v_t2", "omega2", "s2"], {"R": 0.12})
    assert found["s2"].value == pytest.approx(2.6)
    assert found["s2"].sd == pytest.approx(math.hypot(0.03, 0.12))


def test_where_a_number_is_too_vague_it_is_not_known_how_vague_the_conclusion_is() -> None:
    """mu = |v_t2 - v_t1| / (v_b2 - v_b1); with v_b2 off by its sd, nothing was thrown up."""
    sharp = {"v_t1": Estimate(1.0, 0.0), "v_t2": Estimate(0.0, 0.1), "v_b1": Estimate(-1.0, 0.0)}
    found = textbook("spin-bounce").solved({**sharp, "v_b2": Estimate(-2.0, 1.0)}, [*sharp, "v_b2", "mu"], {})["mu"]
    assert found.value == -1.0
    assert math.isnan(found.sd)


@pytest.mark.parametrize(
    ("asked", "given"),
    [(["v_t2", "omega2"], {"R": 0.12}), (["s2", "v_t2"], {"R": 0.12}), (["s2", "omega2", "v_t2"], {})],
)
def test_what_is_not_asked_or_cannot_be_worked_out_is_left_out(asked, given) -> None:
    assert textbook("spin-bounce").solved(SPIN, asked, given) == SPIN


def test_what_the_solver_names_is_not_worked_out_again() -> None:
    known = {**SPIN, "s2": Estimate(7.0, 0.5)}
    assert textbook("spin-bounce").solved(known, ["v_t2", "omega2", "s2"], {"R": 0.12}) == known


@pytest.mark.parametrize("name", assignment_ids())
def test_the_key_knows_how_sharply_every_answer_can_be_measured(name: str) -> None:
    assignment = load_assignment(name)
    variant = draw_variant(assignment, SECRET, "s1")
    truth = foresee(variant)
    found = solve(blurred_track(truth, assignment.points), truth, assignment, variant)
    key = answer_key(assignment, variant, truth, found, "0" * 64)
    for question in assignment.questions:
        if question.id in {"px_per_m", "fps"}:
            continue
        off = key.measured[question.id] - true_value(question.id, truth)
        sd = key.expected_sd[question.id]
        assert abs(off) <= 5 * sd + 1e-9, question.id
        assert 3 * sd <= allowance(question, true_value(question.id, truth)), question.id

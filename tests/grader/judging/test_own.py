"""The numbers that a student worked with: ways to read them, how exact they are, what is made from them."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import pytest

from grader.own import OwnNumbers, field_ids, own_numbers, true_numbers


def own(half_units=None, **written):
    return OwnNumbers(written, lambda values: SimpleNamespace(**values), half_units or {})


def ways(bench, **answers):
    asked = bench.asked(next(iter(answers), "e"), answers)
    return own_numbers(asked.submission, asked.key, asked.questions)


# ---------------------------------------------------------------- ways to read them


def test_numbers_are_read_as_they_stand_then_with_v_as_omega_l_either_way(kick):
    first, by_rate, by_speed = ways(kick, omega1=30.0, v_f1=8.0)
    assert (first.numbers.v1, first.numbers.omega1) == (8.0, 30.0)
    assert (by_rate.numbers.v1, by_rate.numbers.omega1) == (15.0, 30.0)
    assert (by_speed.numbers.v1, by_speed.numbers.omega1) == (8.0, 16.0)
    assert {n.m for n in (first.numbers, by_rate.numbers, by_speed.numbers)} == {0.35}
    assert (first.numbers.S, first.numbers.L, first.numbers.D) == (500.0, 0.5, 0.22)


def test_missing_numbers_leave_fewer_ways_or_none(kick):
    assert len(ways(kick, omega1="")) == 1
    assert len(ways(kick, v_f1="")) == 1
    assert ways(kick, v_b2="") == ()
    assert ways(kick, v_b2="fast") == ()


def test_what_is_not_asked_rests(hammer):
    (first, *_) = ways(hammer, v_b2=3.0)
    assert (first.numbers.u1, first.numbers.u2, first.numbers.a) == (0.0, 3.0, 4.0)


def test_a_conclusion_that_others_build_on_is_one_of_the_numbers(pucks):
    (way,) = ways(pucks, phi=0.5)
    assert way.numbers.own_phi == 0.5
    assert math.isnan(ways(pucks, phi="")[0].numbers.own_phi)
    assert way.made_from(lambda n: n.e_by_own_phi) == {
        "a1x",
        "a2x",
        "a2y",
        "b2x",
        "b2y",
        "own_phi",
        "a1y",
        "b1x",
        "b1y",
    }


def test_each_field_has_its_question(kick, pucks):
    questions = {question.id: question for question in kick.assignment.questions}
    expected = {"omega1": "omega1", "omega2": "omega2", "v1": "v_f1", "v2": "v_f2", "u1": "v_b1", "u2": "v_b2"}
    assert field_ids(kick.key, questions) == expected
    assert field_ids(kick.key, {"v_b2": questions["v_b2"]}) == {"u2": "v_b2"}
    asked = {question.id: question for question in pucks.assignment.questions}
    assert field_ids(pucks.key, asked)["own_phi"] == "phi"
    assert "own_phi" not in field_ids(pucks.key, {"v_b2x": asked["v_b2x"]})


def test_the_truth_is_a_record_of_the_same_kind(kick, hammer):
    assert true_numbers(kick.key).e == pytest.approx(kick.truth["e"])
    assert true_numbers(kick.key).S == 500.0
    assert true_numbers(hammer.key).u1 == 0.0


def test_the_scale_of_a_key_without_one_is_that_of_its_answer(kick):
    bench = kick.with_key(values={"px_per_m": 440.0})
    truth = {name: value for name, value in bench.key.truth.items() if name != "px_per_m"}
    for values, scale in ((bench.key.values, 440.0), ({"v_f1": 1.0}, math.nan)):
        key = type(bench.key)(**{**vars(bench.key), "truth": truth, "values": values})
        assert str(true_numbers(key).S) == str(scale)


# ---------------------------------------------------------------- how exact they are


def test_rounding_adds_up_in_squares_and_at_worst_as_it_is():
    numbers = own({"v1": 0.3, "u2": 0.4, "v2": 0.0}, v1=100.0, u2=100.0, v2=1.0)
    assert numbers.rounding(lambda n: n.v1 + n.u2) == pytest.approx(0.5)
    assert numbers.worst_rounding(lambda n: n.v1 + n.u2) == pytest.approx(0.7)
    assert numbers.worst_rounding(lambda n: n.v1 - n.u2 + 1000) == pytest.approx(0.7)
    assert numbers.rounding(lambda n: n.v2) == 0.0


def test_rounding_never_excuses_more_than_five_percent():
    numbers = own({"v1": 30.0}, v1=-100.0)
    assert numbers.rounding(lambda n: n.v1) == numbers.worst_rounding(lambda n: n.v1) == pytest.approx(5.0)


def test_what_cannot_be_worked_out_moves_nothing():
    numbers = own({"v1": 1.0, "u2": 0.25}, v1=-1.0, u2=100.0)
    assert numbers.worst_rounding(lambda n: n.u2 + 1 / n.v1) == 0.25


def test_a_spread_is_that_of_the_written_numbers():
    numbers = own(v1=10.0, u2=10.0)
    assert numbers.spread(lambda n: n.v1 * n.u2, {"v1": 0.3, "u2": 0.4, "omega1": 5.0}) == pytest.approx(5.0)
    assert numbers.spread(lambda n: n.v1, {}) == 0.0


def test_rounding_goes_the_way_that_was_gone(kick):
    """e by v = omega L moves with the digits of omega, not with those of the speeds."""
    answers = {"omega1": "20.0 rad/s", "omega2": "16.0 rad/s", "v_f1": "10 m/s", "v_f2": "8 m/s"}
    first, by_rate, _ = ways(kick, **answers)
    assert by_rate.numbers.v1 == 10.0
    assert first.worst_rounding(lambda n: n.v1) == pytest.approx(0.5)
    assert by_rate.worst_rounding(lambda n: n.v1) == pytest.approx(0.025)
    assert first.half_units["omega1"] == 0.05


# ---------------------------------------------------------------- what is made from them


def test_a_formula_is_made_from_the_fields_that_move_it():
    numbers = own(v1=10.0, v2=5.0, u1=0.0, u2=9.0, omega1=20.0)
    assert numbers.made_from(lambda n: (n.u2 - n.v2) / (n.v1 - n.u1)) == {"v1", "v2", "u1", "u2"}
    assert numbers.made_from(lambda n: n.omega1) == {"omega1"}
    assert numbers.made_from(lambda n: 1.0) == frozenset()


def test_a_number_that_spoils_a_formula_is_one_of_its_sources():
    assert own(v1=0.0).made_from(lambda n: math.sqrt(-n.v1)) == {"v1"}


def test_another_arm_leaves_the_velocities_and_their_digits(kick):
    (first, *_) = ways(kick, v_b2="9.7 m/s")
    moved = first.with_arm(2.0)
    assert moved.numbers == type(first.numbers)(**{**vars(first.numbers), "L": 2.0})
    assert moved.half_units == first.half_units
    assert first.numbers.L == 0.5


def test_pixels_a_metre_are_those_of_the_rendering_where_the_key_knows_it(kick):
    assert true_numbers(kick.with_key(truth={"px_per_m": 400.0}, values={"px_per_m": 401.0}).key).S == 400.0
    asked_only = replace(kick.key, truth={}, values={**kick.truth, "px_per_m": 401.0})
    assert true_numbers(asked_only).S == 401.0

"""A number that follows from others: the formula by the own numbers, the value by the truth, an error once."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grader.concluding import follows_from
from grader.model import Factor, Outcome
from grader.own import OwnNumbers
from grader.stated import Stated
from grader.tracked import FromTable

VELOCITIES = ("v_f1", "v_f2", "v_b1", "v_b2")
RATES = ("omega1", "omega2")


def told(findings):
    return {aspect: (finding.outcome.value, finding.points) for aspect, finding in findings.items()}


def off(bench, **factors):
    return {name: bench.truth[name] * factor for name, factor in factors.items()}


def e_of(bench, answers):
    v = {**bench.truth, **answers}
    return (v["v_b2"] - v["v_f2"]) / (v["v_f1"] - v["v_b1"])


# ---------------------------------------------------------------- shares


def test_a_right_conclusion_earns_formula_value_and_unit(kick):
    assert told(kick.judge("e")) == {"formula": ("right", 3.0), "value": ("right", 3.0)}
    findings = kick.judge("I")
    assert told(findings) == {
        "unit": ("right", pytest.approx(0.6)),
        "formula": ("right", 3.0),
        "value": ("right", pytest.approx(2.4)),
    }
    assert list(findings) == ["unit", "formula", "value"]
    assert {finding.question_id for finding in findings.values()} == {"I"}


def test_a_wrong_conclusion_earns_nothing_and_says_where_to_look(kick):
    findings = kick.judge("e", {"e": 0.2})
    assert told(findings) == {"formula": ("wrong", 0.0), "value": ("wrong", 0.0)}
    assert findings["formula"].out_of == findings["value"].out_of == 3.0
    assert "does not follow from the numbers that you wrote (within 0.5 %" in findings["formula"].message
    assert "look for the error in what you did with it" in findings["value"].message
    assert findings["formula"].numbers == {"value": 0.2, "from_own": pytest.approx(kick.truth["e"])}


@pytest.mark.parametrize(("text", "outcome", "points"), [("", "wrong", 0.0), ("about half", "unsure", 6.0)])
def test_what_says_no_number_is_judged_as_a_whole(kick, text, outcome, points):
    (finding,) = kick.judge("e", {"e": text}).values()
    assert (finding.aspect, finding.outcome, finding.points, finding.out_of) == ("value", outcome, points, 6.0)


# ---------------------------------------------------------------- the formula


def test_a_right_value_from_other_numbers_is_for_a_person(kick):
    findings = kick.judge("e", off(kick, v_b2=1.1))
    assert told(findings)["formula"] == ("unsure", 3.0)
    assert "right, but it does not follow from the numbers that you wrote" in findings["formula"].message
    assert "a person will look" in findings["formula"].message


def test_a_right_value_from_nothing_is_for_a_person(kick):
    findings = kick.judge("e", dict.fromkeys((*VELOCITIES, *RATES), ""))
    assert told(findings)["formula"] == ("unsure", 3.0)
    assert "follow from are missing; a person" in findings["formula"].message
    assert findings["formula"].numbers.keys() == {"value"}


def test_a_wrong_value_from_nothing_is_wrong(kick):
    findings = kick.judge("e", {**dict.fromkeys((*VELOCITIES, *RATES), ""), "e": 0.2})
    assert told(findings) == {"formula": ("wrong", 0.0), "value": ("wrong", 0.0)}
    assert "are missing, so the formula cannot be judged" in findings["formula"].message


def test_right_to_the_edge_of_the_tolerance_without_a_formula_is_unsure_beyond_it_wrong(kick):
    bench = kick.with_question("e", tolerance=0.5).with_key(values={"e": 0.5})
    nothing = dict.fromkeys((*VELOCITIES, *RATES), "")
    assert bench.judge("e", {**nothing, "e": 0.75})["formula"].outcome is Outcome.UNSURE
    assert bench.judge("e", {**nothing, "e": 0.7501})["formula"].outcome is Outcome.WRONG


@pytest.mark.parametrize("gone", [VELOCITIES[:2], RATES])
def test_speed_and_rate_stand_for_one_another(kick, gone):
    answers = dict.fromkeys(gone, "")
    assert kick.judge("e", answers)["formula"].outcome is Outcome.RIGHT
    assert kick.judge("I", answers)["formula"].outcome is Outcome.RIGHT


@given(st.floats(0.2, 5), st.floats(0.2, 5), st.floats(0.2, 5))
@settings(max_examples=40, deadline=None)
def test_what_follows_from_any_numbers_has_the_formulas_points(kick, v_f1, v_f2, v_b2):
    answers = off(kick, v_f1=v_f1, v_f2=v_f2, v_b2=v_b2)
    finding = kick.judge("e", {**answers, "e": e_of(kick, answers)}, factors=())["formula"]
    assert (finding.outcome, finding.points) == (Outcome.RIGHT, 3.0)


def own(value, half_unit=0.0):
    return OwnNumbers({"x": value}, lambda values: values["x"], {"x": half_unit})


@pytest.mark.parametrize(
    ("value", "half_unit", "own_half_unit", "follows"),
    [
        (1000.0, 0.0, 0.0, True),
        (1005.0, 0.0, 0.0, True),
        (995.0, 0.0, 0.0, True),
        (1005.01, 0.0, 0.0, False),
        (1010.0, 10.0, 0.0, True),
        (1010.1, 10.0, 0.0, False),
        (1020.0, 10.0, 10.0, True),
        (1020.1, 10.0, 10.0, False),
        (1060.0, 10.0, 500.0, True),
        (1060.1, 10.0, 500.0, False),
    ],
)
def test_half_a_percent_or_the_printed_digits_are_allowed(value, half_unit, own_half_unit, follows):
    """Rounding of the own numbers never allows more than 5 %."""
    stated = Stated(value, half_unit, str(value), unit_given=True)
    assert follows_from(stated, own(1000.0, own_half_unit), lambda x: x) is follows
    mirrored = Stated(-value, half_unit, str(value), unit_given=True)
    assert follows_from(mirrored, own(-1000.0, own_half_unit), lambda x: x) is follows


def test_nothing_follows_from_what_cannot_be_worked_out():
    assert not follows_from(Stated(1.0, 1.0, "1", unit_given=True), own(0.0), lambda x: 1 / x)


# ---------------------------------------------------------------- an error costs once


def carried_e(bench, answers, **asked):
    return bench.judge("e", {**answers, "e": e_of(bench, answers)}, factors=(), **asked)


def test_an_error_that_was_counted_costs_nothing_again(kick):
    findings = carried_e(kick, off(kick, v_b2=1.1), charged=frozenset({"v_b2"}))
    assert told(findings) == {"formula": ("right", 3.0), "value": ("right", 3.0)}
    assert findings["value"].carried
    assert "their error is counted where it arose" in findings["value"].message


def test_an_error_that_was_carried_there_costs_nothing_either(kick):
    assert carried_e(kick, off(kick, v_b2=1.1), carried=frozenset({"v_b2"}))["value"].carried


def test_an_error_of_a_common_factor_costs_nothing_again(kick):
    answers = off(kick, v_b2=1.1)
    factor = Factor(("K5",), 1.1, ("v_b2",))
    finding = kick.judge("e", {**answers, "e": e_of(kick, answers)}, factors=(factor,))["value"]
    assert finding.carried


@pytest.mark.parametrize("charged", [(), ("omega1",), ("I",), ("fps",)])
def test_an_error_elsewhere_excuses_nothing(kick, charged):
    finding = carried_e(kick, off(kick, v_b2=1.1), charged=frozenset(charged))["value"]
    assert (finding.outcome, finding.points, finding.carried) == (Outcome.WRONG, 0.0, False)


def test_a_half_right_value_is_carried_too(kick):
    """v_b2 is off by 1.5 %, by which e leaves its tolerance."""
    finding = carried_e(kick, off(kick, v_b2=1.015), charged=frozenset({"v_b2"}))["value"]
    assert (finding.outcome, finding.carried) == (Outcome.RIGHT, True)
    assert carried_e(kick, off(kick, v_b2=1.015))["value"].outcome is Outcome.PARTIAL


def test_a_right_value_is_right_by_itself(kick):
    assert not kick.judge("e", charged=frozenset(VELOCITIES))["value"].carried


def test_a_carried_value_names_no_mistake_and_keeps_its_numbers(kick):
    answers = off(kick, v_f2=3.0)
    finding = carried_e(kick, answers, charged=frozenset({"v_f2"}))["value"]
    assert finding.mistake == ""
    assert {"value", "truth", "tolerance"} <= finding.numbers.keys()


def test_an_error_is_carried_by_the_way_that_was_gone(kick):
    """e was worked out with v = omega L: a wrong omega, paid there, costs nothing here; a wrong v_f does not count."""
    omega1 = kick.truth["omega1"] * 1.1
    e = (kick.truth["v_b2"] - kick.truth["v_f2"]) / (omega1 * 0.5)
    answers = {"omega1": omega1, "e": e}
    assert kick.judge("e", answers, factors=(), charged=frozenset({"omega1"}))["value"].carried
    by_speed = {**answers, "v_f1": kick.truth["v_f1"] * 0.7}
    assert not kick.judge("e", by_speed, factors=(), charged=frozenset({"v_f1"}))["value"].carried


def test_an_inertia_by_energy_carries_an_error_of_the_angle(pendulum):
    """Another right formula, another number behind it."""
    t, given_ = {**pendulum.truth, "theta_max": 1.05 * pendulum.truth["theta_max"]}, pendulum.key.given
    lever = given_["M"] * given_["c"] + given_["m"] * given_["d"]
    rise = lever * given_["g"] * (1 - math.cos(t["theta_max"]))
    inertia = 2 * rise / t["omega2"] ** 2 - given_["m"] * given_["d"] ** 2
    answers = {"theta_max": t["theta_max"], "I": inertia}
    findings = pendulum.judge("I", answers, charged=frozenset({"theta_max"}))
    assert findings["formula"].outcome is Outcome.RIGHT
    assert findings["value"].carried


def test_an_e_along_the_own_wrong_direction_is_carried(pucks):
    """phi was taken from y; e was then rightly worked out along it: the direction costs, e does not."""
    phi = 0.5
    t = pucks.truth
    c, s = math.cos(phi), math.sin(phi)
    e = ((t["v_b2x"] - t["v_a2x"]) * c + (t["v_b2y"] - t["v_a2y"]) * s) / (t["v_a1x"] * c)
    findings = pucks.judge("e", {"phi": phi, "e": e}, charged=frozenset({"phi"}))
    assert told(findings) == {"formula": ("right", 2.5), "value": ("right", 2.5)}
    assert findings["value"].carried
    assert pucks.judge("e")["formula"].outcome is Outcome.RIGHT


def test_a_direction_below_the_axis_is_carried_as_one_above(pucks):
    """y was taken downwards, which cost where it arose; phi is negative then, and follows."""
    down = {name: -pucks.truth[name] for name in ("v_a2y", "v_b2y", "phi")}
    finding = pucks.judge("phi", down, charged=frozenset({"v_a2y", "v_b2y"}))["value"]
    assert (finding.carried, finding.mistake) == (True, "")


def test_a_slip_to_the_left_is_carried_as_one_to_the_right(bounce):
    answers = {"omega2": -40.0, "s2": bounce.truth["v_t2"] - 0.12 * 40}
    assert answers["s2"] < 0
    assert bounce.judge("s2", answers, charged=frozenset({"omega2"}))["value"].carried


# ---------------------------------------------------------------- what is too easy is not followed


def test_numbers_that_are_no_impact_are_not_followed(kick):
    """All velocities are one: e of any value follows, and is not paid for twice."""
    answers = {"v_f1": 1.0, "v_f2": 0.5, "v_b2": 5.0}
    findings = carried_e(kick, answers, charged=frozenset(VELOCITIES))
    assert told(findings) == {"formula": ("right", 3.0), "value": ("wrong", 0.0)}
    assert "It follows from your numbers, but they describe no possible impact" in findings["value"].message
    assert "so it counts here too" in findings["value"].message


def test_a_size_below_zero_is_no_possible_one(kick):
    """The leg is faster after: I would be negative."""
    answers = {"omega1": kick.truth["omega2"], "omega2": kick.truth["omega1"]}
    finding = kick.judge("I", {**answers, "I": -kick.truth["I"] * 1.2}, factors=(), charged=frozenset(RATES))["value"]
    assert finding.outcome is Outcome.WRONG
    inertia = 0.35 * 0.5 * kick.truth["v_b2"] / (answers["omega1"] - answers["omega2"])
    finding = kick.judge("I", {**answers, "I": inertia}, factors=(), charged=frozenset(RATES))["value"]
    assert not finding.carried
    assert finding.points < finding.out_of


def test_a_bare_zero_opens_no_door(kick):
    """e = (v_b2 - 0) / v_f1 is easier; numbers and e are possible, and yet nothing is carried."""
    slow = kick.with_key(values={"v_f1": 10.0, "v_f2": 5.0, "v_b1": 0.0, "v_b2": 9.0, "e": 0.4})
    answers = {"v_f2": 0.0}
    finding = carried_e(slow, answers, charged=frozenset({"v_f2"}))["value"]
    assert (finding.outcome, finding.points) == (Outcome.WRONG, 0.0)
    assert "a 0 for v_f2 makes it easy, so it counts here too" in finding.message
    near = carried_e(slow, {"v_f2": 0.1}, charged=frozenset({"v_f2"}))["value"]
    assert near.carried


def test_a_zero_that_is_nearly_true_is_one(kick):
    """The ball rolled at 0.2 m/s; its tolerance is 0.1 m/s."""
    rolling = kick.with_key(values={"v_b1": 0.2})
    answers = {"v_b1": 0.0, "v_b2": kick.truth["v_b2"] * 1.1}
    assert carried_e(rolling, answers, charged=frozenset({"v_b2"}))["value"].carried
    faster = kick.with_key(values={"v_b1": 0.201})
    assert not carried_e(faster, answers, charged=frozenset({"v_b2"}))["value"].carried


def test_what_is_not_followed_has_no_use_of_clicks(kick):
    """Half of the points for clicks need a formula and a possible impact."""
    clicked = kick.with_table(fit=replace(kick.table.fit, rms_px=1.4))
    omega2 = kick.truth["omega2"] * 1.018
    inertia = 0.35 * 0.5 * kick.truth["v_b2"] / (kick.truth["omega1"] - omega2)
    answers = {"omega2": omega2, "I": inertia, "v_f2": omega2 * 0.5}
    assert kick.judge("I", answers)["value"].outcome is Outcome.WRONG
    finding = clicked.judge("I", answers)["value"]
    assert (finding.outcome, finding.points) == (Outcome.PARTIAL, 0.5 * finding.out_of)
    assert "As near as points clicked by hand allow" in finding.message
    assert clicked.judge("I", {"I": inertia})["value"].outcome is Outcome.WRONG
    unmoved = off(kick, omega1=1.0, v_f1=1.0)
    unmoved |= {"omega2": 0.995 * unmoved["omega1"], "v_f2": 0.995 * unmoved["v_f1"]}
    inertia = 0.35 * 0.5 * kick.truth["v_b2"] / (unmoved["omega1"] - unmoved["omega2"])
    findings = clicked.judge("I", {**unmoved, "I": inertia})
    assert findings["formula"].outcome is Outcome.RIGHT
    assert findings["value"].outcome is Outcome.WRONG


# ---------------------------------------------------------------- one arm used throughout


def with_arm(kick, ratio):
    v1, v2 = kick.truth["v_f1"] * ratio, kick.truth["v_f2"] * ratio
    return {"v_f1": v1, "v_f2": v2, "e": (kick.truth["v_b2"] - v2) / v1, "I": kick.truth["I"] * ratio}


@pytest.mark.parametrize("question", ["e", "I"])
@pytest.mark.parametrize("ratio", [0.25, 2.0])
def test_another_arm_used_throughout_is_followed_even_to_an_impossible_e(kick, question, ratio):
    findings = kick.judge(question, with_arm(kick, ratio))
    assert findings["formula"].outcome is Outcome.RIGHT
    assert findings["value"].carried


def test_another_arm_is_followed_for_bodies_that_moved_only(kick):
    still = {**dict.fromkeys(RATES, 20.0), "v_f1": 5.0, "v_f2": 5.0, "I": 3.0}
    arm = Factor(("K12",), 0.5, ("v_f1", "v_f2"))
    findings = kick.judge("e", {**still, "e": (kick.truth["v_b2"] - 5.0) / 5.0}, factors=(arm,))
    assert findings["formula"].outcome is Outcome.RIGHT
    assert "no possible impact" in findings["value"].message


# ---------------------------------------------------------------- numbers that only a person can read


@pytest.mark.parametrize("unread", ["about 10", "9..1"])
def test_a_conclusion_from_a_number_that_nobody_could_read_stays_open(kick, unread):
    findings = kick.judge("e", {"v_b2": unread, "e": -kick.truth["e"]}, factors=())
    assert told(findings) == {"formula": ("unsure", 3.0), "value": ("unsure", 3.0)}
    assert "from v_b2, which could not be read; a person will look" in findings["formula"].message
    assert "before a person has read them" in findings["value"].message
    assert findings["value"].mistake == ""


def test_several_unread_numbers_are_named(kick):
    findings = kick.judge("I", {"omega1": "fast", "omega2": "slow", "I": 0.1}, factors=())
    assert "from ω₁, ω₂, which" in findings["formula"].message


def test_a_right_value_needs_no_reading(kick):
    findings = kick.judge("e", {"v_b2": "about 10"}, factors=())
    assert told(findings) == {"formula": ("unsure", 3.0), "value": ("right", 3.0)}


def test_blank_numbers_leave_nothing_open(kick):
    assert kick.judge("e", {"v_b2": "", "e": 0.3}, factors=())["value"].outcome is Outcome.WRONG


def test_numbers_that_e_does_not_need_leave_nothing_open(kick):
    assert kick.judge("e", {"omega1": "fast", "e": 0.3}, factors=())["value"].outcome is Outcome.WRONG


# ---------------------------------------------------------------- the table behind it


def test_a_value_without_a_table_is_for_a_person(kick):
    bench = replace(kick, table=FromTable())
    finding = bench.judge("e")["value"]
    assert (finding.outcome, finding.points) == (Outcome.UNSURE, 3.0)
    assert "no tracking table" in finding.message

"""A measured number: tolerance and its words, partial credit, unit, sign, clicks, remarks."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grader.judging import Tolerance, judge_measured, judge_value, tolerance_of, truth_of
from grader.model import Outcome
from grader.stated import Stated
from grader.tracked import FromTable
from vml_course.errors import InputError
from vml_course.model.units import UNITS


@pytest.fixture(scope="module")
def plain(kick):
    """v_b2 is 4 m/s, tolerance 1 m/s, worth 10 points; no table widens it. All exact in binary."""
    bench = kick.with_question("v_b2", tolerance=0.25, points=10.0).with_key(values={"v_b2": 4.0})
    return replace(bench, table=FromTable())


def of_v_b2(bench, answer, unit="m/s", **changes):
    return bench.judge("v_b2", {"v_b2": answer}, {"v_b2": unit}, factors=(), **changes)


# ---------------------------------------------------------------- how much is earned


@pytest.mark.parametrize(
    ("value", "outcome", "points", "words"),
    [
        (4.0, "right", 9.0, "Right: within 25 % of the true value"),
        (5.0, "right", 9.0, "Right: within 25 %"),
        (3.0, "right", 9.0, "Right: within 25 %"),
        (5.000001, "partial", 4.5, "Close, but not within 25 %, which earns full points"),
        (2.999999, "partial", 4.5, "Close, but not within 25 %"),
        (6.0, "partial", 4.5, "Close, but not within 25 %"),
        (2.0, "partial", 4.5, "Close, but not within 25 %"),
        (6.000001, "wrong", 0.0, "Not right: full points are given within 25 %"),
        (1.999999, "wrong", 0.0, "Not right: full points are given within 25 %"),
        (-4.0, "partial", 4.5, "the sign is not"),
        (-5.0, "partial", 4.5, "the sign is not"),
        (-3.0, "partial", 4.5, "the sign is not"),
        (-5.000001, "wrong", 0.0, "Not right"),
        (-2.999999, "wrong", 0.0, "Not right"),
        (0.0, "wrong", 0.0, "Not right"),
    ],
)
def test_a_value_earns_by_its_distance(plain, value, outcome, points, words):
    finding = of_v_b2(plain, value)["value"]
    assert (finding.outcome, finding.points, finding.out_of) == (outcome, points, 9.0)
    assert words in finding.message
    assert finding.mistake == ("K6" if "sign" in words else "")
    assert not finding.carried


def test_a_finding_keeps_the_facts_behind_it(plain):
    finding = of_v_b2(plain, 5.5)["value"]
    assert (finding.question_id, finding.aspect) == ("v_b2", "value")
    assert finding.numbers == {"value": 5.5, "truth": 4.0, "tolerance": 1.0}


@given(st.floats(0, 20), st.floats(0, 20))
@settings(max_examples=40, deadline=None)
def test_what_is_nearer_never_earns_less(plain, one, other):
    near, far = sorted((one, other), key=lambda value: abs(value - 4.0))
    assert of_v_b2(plain, near)["value"].points >= of_v_b2(plain, far)["value"].points


@given(st.floats(-20, 20))
@settings(max_examples=40, deadline=None)
def test_signs_mirror(plain, value):
    """Where the truth is negative, all is judged the same the other way round."""
    mirrored = plain.with_key(values={"v_b2": -4.0})
    here, there = of_v_b2(plain, value)["value"], of_v_b2(mirrored, -value)["value"]
    assert (here.outcome, here.points, here.message) == (there.outcome, there.points, there.message)


@given(st.floats(0.1, 20), st.sampled_from(sorted(UNITS["velocity"])))
@settings(max_examples=40, deadline=None)
def test_the_unit_never_changes_a_mark(plain, value, unit):
    """But for the dust of converting, kept away from the edges."""
    if min(abs(abs(value - 4.0) - edge) for edge in (1.0, 2.0)) < 1e-6:
        return
    converted = value / UNITS["velocity"][unit]
    here, there = of_v_b2(plain, value), of_v_b2(plain, converted, unit)
    assert {a: (f.outcome, f.points) for a, f in here.items()} == {a: (f.outcome, f.points) for a, f in there.items()}


# ---------------------------------------------------------------- the unit


@pytest.mark.parametrize(
    ("unit", "outcome", "points", "words"),
    [
        ("m/s", "right", 1.0, "fits"),
        ("", "wrong", 0.0, "read in m/s"),
        ("px/s", "wrong", 0.0, "pixels; m/s was asked"),
    ],
)
def test_the_unit_is_a_tenth_of_the_points(plain, unit, outcome, points, words):
    finding = of_v_b2(plain, 4.0, unit)["unit"]
    assert (finding.question_id, finding.aspect) == ("v_b2", "unit")
    assert (finding.outcome, finding.points, finding.out_of) == (outcome, points, 1.0)
    assert words in finding.message


def test_a_right_number_with_pixels_for_its_unit_pays_for_the_unit_alone(plain):
    findings = of_v_b2(plain, 4.0, "px/s")
    assert findings["value"].points == 9.0
    assert findings["unit"].points == 0.0


@pytest.mark.parametrize(("text", "outcome", "points"), [("", "wrong", 0.0), ("fast", "unsure", 10.0)])
def test_what_says_no_number_is_judged_as_a_whole(plain, text, outcome, points):
    (finding,) = of_v_b2(plain, text).values()
    assert (finding.question_id, finding.aspect) == ("v_b2", "value")
    assert (finding.outcome, finding.points, finding.out_of) == (outcome, points, 10.0)
    assert finding.message.startswith("Nothing is written" if not text else "Expected")


# ---------------------------------------------------------------- the tolerance


@pytest.mark.parametrize(
    ("floor", "sd", "half_width", "words"),
    [
        (0.0, 0.0, 1.0, "within 25 %"),
        (3.0, 0.0, 3.0, "within 25 % or 3 m/s"),
        (0.5, 0.0, 1.0, "within 25 % or 0.5 m/s"),
        (0.0, 1 / 3, 1.0, "within 25 %"),
        (0.0, 0.5, 1.5, "within 1.5 m/s"),
        (2.0, 0.5, 2.0, "within 25 % or 2 m/s"),
        (0.0, math.nan, 1.0, "within 25 %"),
        (0.0, math.inf, 1.0, "within 25 %"),
    ],
)
def test_the_largest_tolerance_holds_and_is_told(plain, floor, sd, half_width, words):
    bench = plain.with_question("v_b2", floor=floor).with_key(expected_sd={"v_b2": sd})
    assert tolerance_of(bench.asked("v_b2")) == Tolerance(half_width, words)


def test_an_sd_that_nobody_knows_allows_nothing(plain):
    bench = plain.with_question("v_b2", tolerance=0.125).with_key(expected_sd={"v_b2": math.nan})
    assert tolerance_of(bench.asked("v_b2")).half_width == 0.5


@pytest.mark.parametrize(
    ("sd", "words"),
    [(0.25, "within 19 %"), (0.28, "within 0.84 m/s"), (4 / 15, "within 0.8 m/s"), (0.1, "within 7.5 %")],
)
def test_a_tolerance_of_the_video_is_told_as_a_share_where_it_is_a_small_one(plain, sd, words):
    bench = plain.with_question("v_b2", tolerance=0.01).with_key(expected_sd={"v_b2": sd})
    assert tolerance_of(bench.asked("v_b2")) == Tolerance(3 * sd, words)


def test_a_tolerance_without_a_unit_ends_without_one(kick):
    bench = kick.with_key(expected_sd={"e": 0.1})
    assert tolerance_of(bench.asked("e")).words == "within 0.3"


@given(st.floats(0.001, 1000), st.floats(0, 1))
@settings(max_examples=40, deadline=None)
def test_the_words_of_a_floor_give_no_truth_away(kick, truth, floor):
    """Telling a floor as a share would: whoever knows it could work out the truth."""
    bench = kick.with_question("v_b1", floor=floor).with_key(values={"v_b1": truth})
    other = bench.with_key(values={"v_b1": 2 * truth})
    assert tolerance_of(bench.asked("v_b1", factors=())).words == tolerance_of(other.asked("v_b1", factors=())).words


@pytest.mark.parametrize("truth", [math.nan, math.inf])
def test_a_truth_that_nobody_knows_is_no_students_fault(plain, truth):
    asked = plain.with_key(values={"v_b2": truth}).asked("v_b2", {"v_b2": 4.0}, factors=())
    with pytest.raises(InputError, match=f"answer key: expected a true value of v_b2, got {truth}"):
        truth_of(asked)
    with pytest.raises(InputError, match="v_b2"):
        judge_measured(replace(asked, key=replace(asked.key, values={})))


# ---------------------------------------------------------------- clicks, digits, a stated uncertainty


def test_a_value_as_near_as_clicks_allow_is_half_right(kick):
    clicked = kick.with_table(fit=replace(kick.table.fit, rms_px=1.4))
    off = {"omega1": kick.truth["omega1"] * 1.045}
    finding = clicked.judge("omega1", off)["value"]
    assert (finding.outcome, finding.points) == (Outcome.PARTIAL, 0.5 * finding.out_of)
    assert "As near as points clicked by hand allow, but not within 2 %" in finding.message
    assert kick.judge("omega1", off)["value"].outcome is Outcome.WRONG


@pytest.mark.parametrize(("value", "points"), [(7.0, 4.5), (1.0, 4.5), (7.000001, 0.0), (0.999999, 0.0)])
def test_clicks_reach_as_far_as_they_may_leave_a_value_off(plain, value, points):
    stated = Stated(value, 0.0, str(value), unit_given=True)
    finding = judge_value(plain.asked("v_b2", factors=()), stated, 9.0, spread=3.0)
    assert finding.points == points
    assert ("As near as points clicked by hand allow" in finding.message) == (points > 0)


def test_remarks_follow_the_verdict(plain):
    finding = of_v_b2(plain, "4.5 ± 0.1 m/s")["value"]
    assert finding.message.startswith("Right: within 25 % of the true value. Your ± is too small")
    assert finding.numbers["uncertainty"] == 0.1
    assert finding.numbers["z"] == pytest.approx(5.0)
    assert finding.numbers.keys() == {"value", "truth", "tolerance", "uncertainty", "z"}
    assert finding.outcome is Outcome.RIGHT


def test_an_uncertainty_of_zero_has_no_z_score(plain):
    assert of_v_b2(plain, "4.5 ± 0 m/s")["value"].numbers.keys() == {"value", "truth", "tolerance"}


# ---------------------------------------------------------------- a slip that explains a wrong value


@pytest.mark.parametrize(("value", "code"), [(4.0, ""), (5.5, "K99"), (9.0, "K99"), (-4.0, "K6")])
def test_an_explanation_is_asked_for_where_a_value_is_not_right_and_not_yet_explained(plain, value, code):
    asked = plain.asked("v_b2", {"v_b2": value}, factors=())
    _, finding = judge_measured(asked, lambda about, stated: "K99" if (about, stated.value) == (asked, value) else "?")
    assert finding.mistake == code

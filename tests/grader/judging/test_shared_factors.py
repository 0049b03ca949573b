"""A factor that many numbers share: counted once, at its source or at the first number that carries it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.model import Factor, Outcome
from grader.tracked import FromTable

VELOCITIES = ("v_f1", "v_f2", "v_b2")
RATES = ("omega1", "omega2")


@pytest.fixture(scope="module")
def bench(kick):
    """No table: nothing but the factor speaks for a value."""
    return replace(kick, table=FromTable())


def judged(bench, question, factor, *, times=None, charged=(), factors=None):
    """Judge the true value times `times` (the factor itself)."""
    value = bench.truth[question] * (factor.value if times is None else times)
    asked = {"factors": (factor,) if factors is None else factors, "charged": frozenset(charged)}
    return bench.value(question, value, **asked)


def of(*codes, value=3.0, ids=VELOCITIES):
    return Factor(codes, value, ids)


def test_the_first_number_that_carries_a_factor_pays_and_the_others_are_carried(bench):
    first, other = judged(bench, "v_f1", of("K5")), judged(bench, "v_b2", of("K5"))
    assert (first.outcome, first.points, first.mistake, first.carried) == (Outcome.WRONG, 0.0, "K5", False)
    assert "one and the same factor; it is counted here, once" in first.message
    assert (other.outcome, other.points, other.mistake, other.carried) == (Outcome.RIGHT, other.out_of, "K5", True)
    assert "counted only once" in other.message


def test_a_factor_with_several_names_is_given_none(bench):
    assert judged(bench, "v_b2", of("K5", "K7")).mistake == ""


LENGTHS = ["K3", "K3b", "K3c", "K4", "K4b", "K5", "K5b", "K7"]
TIMES = ["K2", "K2b", "K8"]


@pytest.mark.parametrize("code", LENGTHS + TIMES)
@pytest.mark.parametrize("source", ["px_per_m", "fps", "v_b1"])
def test_a_wrong_source_has_paid_for_the_first_number_too(bench, code, source):
    """The scale for slips of length, the frame rate for slips of time."""
    finding = judged(bench, "v_f1", of(code), charged={source})
    is_paid = source == ("px_per_m" if code in LENGTHS else "fps")
    assert finding.carried == is_paid
    assert (finding.outcome is Outcome.RIGHT) == is_paid


def test_a_scale_pays_for_no_angular_velocity(bench):
    """Degrees and a scale have nothing in common."""
    assert judged(bench, "omega1", of("K5", ids=RATES), charged={"px_per_m"}).outcome is Outcome.WRONG


def test_a_factor_of_both_kinds_belongs_to_the_first(bench):
    both = of("K5", ids=("omega1", "v_f1"))
    assert judged(bench, "omega1", both, charged={"px_per_m"}).outcome is Outcome.WRONG


def test_a_clock_that_spoils_velocities_and_rates_is_paid_once(bench):
    """Both kinds are off by the same rate of playback; the first velocity pays for the rates, too."""
    clocks = of("K2"), of("K2", ids=RATES)
    assert judged(bench, "v_f1", clocks[0], factors=clocks).outcome is Outcome.WRONG
    assert judged(bench, "omega1", clocks[1], factors=clocks).carried
    assert judged(bench, "omega2", clocks[1], factors=clocks).carried


def test_slips_of_different_kinds_are_paid_apart(bench):
    """Feet in the velocities, degrees in the rates."""
    slips = of("K3"), of("K9", ids=RATES)
    assert judged(bench, "omega1", slips[1], factors=slips).outcome is Outcome.WRONG
    same_code = of("K5"), of("K5", ids=RATES)
    assert judged(bench, "omega1", same_code[1], factors=same_code).outcome is Outcome.WRONG


@pytest.mark.parametrize("codes", [("K1",), ("K1b",), ("K1c",), ("K1", "K1b", "K1c")])
@pytest.mark.parametrize("charged", [(), ("px_per_m",)])
def test_pixels_are_a_step_left_out_half_of_the_points(bench, codes, charged):
    finding = judged(bench, "v_b2", of(*codes, value=500.0), charged=charged)
    assert (finding.outcome, finding.points) == (Outcome.PARTIAL, 0.5 * finding.out_of)
    assert (finding.carried, finding.mistake) == (False, codes[0] if len(codes) == 1 else "")
    assert "still in pixels" in finding.message


@pytest.mark.parametrize(
    ("share", "is_found"), [(1.0, True), (1.039, True), (0.961, True), (1.041, False), (0.959, False)]
)
def test_a_number_carries_a_factor_within_two_tolerances(bench, share, is_found):
    """The tolerance of a speed is 2 %."""
    finding = judged(bench, "v_b2", of("K5"), times=3.0 * share)
    assert finding.carried == is_found


def test_a_number_at_exactly_two_tolerances_still_carries_it(bench):
    exact = bench.with_question("v_b2", tolerance=0.25).with_key(values={"v_b2": 4.0})
    assert judged(exact, "v_b2", of("K5", value=4.0), times=6.0).carried  # 24 / 4 = 6 m/s


def test_a_number_that_does_not_carry_the_factor_is_not_excused(bench):
    assert judged(bench, "v_b2", of("K5", ids=("v_f1", "v_f2"))).outcome is Outcome.WRONG


def test_of_several_factors_the_one_that_a_number_carries_counts(bench):
    factors = of("K3", ids=("v_f1", "v_f2")), of("K5", ids=("v_f1", "v_b2"))
    assert judged(bench, "v_b2", factors[1], factors=factors).mistake == "K5"


def test_a_factor_never_costs_a_value_what_it_earns_by_itself(bench):
    """Within two tolerances of the truth half is earned, whatever the others are off by."""
    wide = bench.with_question("v_f1", tolerance=0.3)
    assert judged(wide, "v_f1", of("K5", value=1.5)).outcome is Outcome.PARTIAL


def test_reversed_signs_cost_half_of_the_first_number_as_one_alone_does(bench):
    assert judged(bench, "v_f1", of("K6", value=-1.0)).points == pytest.approx(0.45)
    assert judged(bench, "v_f2", of("K6", value=-1.0)).carried


# ---------------------------------------------------------------- an acceleration


@pytest.mark.parametrize(
    ("codes", "times", "is_found"),
    [
        (("K7",), 3.0, True),
        (("K7",), 9.0, False),
        (("K2",), 9.0, True),
        (("K2",), 3.0, False),
        (("K7", "K8"), 3.0, True),
        (("K7", "K8"), 9.0, True),
        (("K6",), 3.0, False),
        (("K12",), 3.0, False),
    ],
)
def test_an_acceleration_takes_the_slips_of_the_velocities_over(hammer, codes, times, is_found):
    """Lengths once, times squared; what the velocities have paid for costs nothing again."""
    bench = replace(hammer, table=FromTable())
    finding = judged(bench, "a_b", of(*codes, ids=("v_f1", "v_f2", "v_b2")), times=times)
    assert finding.carried == is_found
    assert (finding.outcome is Outcome.RIGHT) == is_found


def test_an_acceleration_takes_nothing_over_from_angular_velocities(hammer):
    bench = replace(hammer, table=FromTable())
    assert judged(bench, "a_b", of("K5", ids=RATES)).outcome is Outcome.WRONG


def test_velocities_take_no_slip_over_that_they_do_not_carry(hammer):
    bench = replace(hammer, table=FromTable())
    assert judged(bench, "v_b2", of("K5", ids=("v_f1", "v_f2"))).outcome is Outcome.WRONG


def test_an_acceleration_that_is_right_but_for_the_scale_spoils_no_friction(hammer):
    """Deceleration and friction follow from a scale of 450 px/m for 500: paid at the scale, once."""
    wrong = {name: hammer.truth[name] * 500 / 450 for name in (*VELOCITIES, "a_b", "mu")}
    asked = {"charged": frozenset({"px_per_m"})}
    answers = {**wrong, "px_per_m": 450.0}
    assert hammer.judge("a_b", answers, **asked)["value"].carried
    finding = hammer.judge("mu", answers, **asked, carried=frozenset({"a_b"}))["value"]
    assert finding.carried

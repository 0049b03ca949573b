"""What a table says of an answer: whether it supports it, how sharp clicks are; what digits and ± say of themselves."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.clicks import spread_of_concluded, spread_of_measured
from grader.model import Asked, Finding, Outcome
from grader.own import own_numbers
from grader.remarks import remarks_on_number, significant_digits, z_score
from grader.stated import Stated
from grader.support import supported
from grader.tracked import FromTable
from grader.trajectory import TrajectoryFit

SCALE, FPS = 500.0, 480.0
E_SD, HALF_WIDTH = 0.01, 0.014


@pytest.fixture
def asked(kit, assignment):
    """Ask for one answer of a kick, beside a table."""
    numbers = kit.impact()
    questions = {question.id: question for question in assignment.questions}

    def asked(question="e", rms_px=1.0, rows=slice(None), points=kit.POINTS, **table):
        xy_m = kit.trajectory_m(numbers)[rows]
        frame = np.arange(60.0)[rows]
        fit = TrajectoryFit(points, frame, frame / FPS, rms_px, 1.0, 0.0, False, xy_m, xy_m)
        known = {"fit": fit, "values": {"e": numbers.e}, "sds": {"e": E_SD}, **table}
        submission = kit.submission_of(assignment, kit.true_values(numbers))
        key = kit.key_of(numbers)
        return Asked(submission, key, questions[question], questions=questions, table=FromTable(**known))

    return asked


def found(outcome=Outcome.RIGHT, value=0.7, **changes) -> Finding:
    return Finding("e", "value", outcome, 2.0, 3.0, "Said.", {"value": value}, **changes)


# ---------------------------------------------------------------- support


def test_a_right_value_that_its_table_gives_stays_right(asked):
    held = supported(asked(), found(), HALF_WIDTH)
    assert held == replace(found(), numbers={"value": 0.7, "from_table": pytest.approx(0.7)})


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"fit": None, "values": {}}, "there is no tracking table"),
        ({"rms_px": 4.1}, "does not follow your video"),
        ({"rows": slice(26, 60)}, "does not show the impact"),
        ({"rows": slice(0, 33)}, "does not show the impact"),
        ({"values": {"e": 0.775}}, "gives another one"),
        ({"values": {"e": 0.625}}, "gives another one"),
    ],
)
def test_a_right_value_without_support_keeps_its_points_and_reaches_a_person(asked, table, words):
    held = supported(asked(**table), found(), HALF_WIDTH)
    assert (held.outcome, held.points, held.out_of) == (Outcome.UNSURE, 2.0, 3.0)
    assert words in held.message
    assert held.message.endswith("a person will look at it.")


@pytest.mark.parametrize(
    "table",
    [
        {"rms_px": 4.0},
        {"rows": slice(24, 60)},
        {"rows": slice(0, 34)},
        {"values": {"e": 0.773}},
        {"values": {}},
        {"sds": {}},
    ],
)
def test_a_table_just_good_enough_supports(asked, table):
    assert supported(asked(**table), found(), HALF_WIDTH).outcome is Outcome.RIGHT


def test_the_spread_of_the_reference_widens_what_a_table_supports(asked):
    near = {"values": {"e": 0.71}}
    assert supported(asked(**near, sds={}), found(value=0.725), HALF_WIDTH).outcome is Outcome.UNSURE
    assert supported(asked(**near, sds={"e": 0.001}), found(value=0.725), HALF_WIDTH).outcome is Outcome.RIGHT


def test_a_right_value_that_carries_an_error_on_is_not_held_against_the_table(asked):
    carried = found(carried=True)
    assert supported(asked(values={"e": 0.2}), carried, HALF_WIDTH).outcome is Outcome.RIGHT
    assert supported(asked(fit=None, values={}), carried, HALF_WIDTH) == carried


@pytest.mark.parametrize(
    ("in_table", "words"),
    [
        (0.7, "in what you did with it"),
        (0.713, "in what you did with it"),
        (0.715, "at the tracking first"),
        (0.685, "at the tracking first"),
    ],
)
@pytest.mark.parametrize("outcome", [Outcome.WRONG, Outcome.PARTIAL])
def test_an_error_is_looked_for_in_tracking_or_after_it(asked, outcome, in_table, words):
    told = supported(asked(values={"e": in_table}), found(outcome, 0.2), HALF_WIDTH)
    assert told.message.startswith("Said. ")
    assert words in told.message
    assert (told.outcome, told.points, told.numbers["from_table"]) == (outcome, 2.0, in_table)


def test_without_a_value_of_the_table_or_of_the_cell_nothing_is_added(asked):
    assert supported(asked(values={}), found(Outcome.WRONG, 0.2), HALF_WIDTH) == found(Outcome.WRONG, 0.2)
    assert supported(asked(), found(Outcome.UNSURE, 0.2), HALF_WIDTH).message == "Said."


# ---------------------------------------------------------------- clicks

LINE_FRAMES = 9  # whole frames in half of the 40 ms that the reference fits


def slope_sd_px_s(frames: int, noise_px: float) -> float:
    """Standard deviation of the slope of a straight line, from its normal equations."""
    t = np.arange(frames) / FPS
    return noise_px / math.sqrt(((t - t.mean()) ** 2).sum())


@pytest.mark.parametrize("rms_px", [0.4, 1.0, 1.7])
def test_a_speed_is_as_sharp_as_a_line_through_the_clicks(asked, rms_px):
    """A speed may come from two points: its noise is that of one coordinate, twice in square."""
    spread = spread_of_measured(asked("v_b2", rms_px=rms_px))
    assert spread == pytest.approx(4 * slope_sd_px_s(LINE_FRAMES, rms_px) / SCALE)


def test_a_rate_is_as_sharp_as_the_line_of_a_direction_of_its_length(asked):
    assert spread_of_measured(asked("omega1")) == pytest.approx(spread_of_measured(asked("v_b2")) / 0.5)
    assert spread_of_measured(asked("omega1", points=("foot", "knot", "ball"))) == 0.0
    assert spread_of_measured(asked("omega1", points=("foot", "knee"))) == spread_of_measured(asked("omega1"))
    lost = asked("omega1")
    lost.table.fit.own_m[:20, 0] = np.nan
    assert spread_of_measured(lost) == pytest.approx(spread_of_measured(asked("omega1")))


def test_coarse_points_or_none_widen_nothing(asked):
    assert spread_of_measured(asked("v_b2", rms_px=1.71)) == 0.0
    assert spread_of_measured(asked("v_b2", fit=None)) == 0.0
    assert spread_of_measured(asked("px_per_m")) == 0.0
    assert spread_of_measured(asked("e")) == 0.0


@pytest.mark.parametrize(("window_s", "frames"), [(0.04, 9), (0.06, 14), (0.2, 19), (0.01, 6), (0.025, 6)])
def test_a_line_is_half_as_long_as_the_reference_and_40_ms_at_most(asked, window_s, frames):
    spread = spread_of_measured(asked("v_b2", window_s=window_s))
    assert spread == pytest.approx(4 * slope_sd_px_s(frames, 1.0) / SCALE)


@pytest.mark.parametrize(("rows", "after"), [(slice(None), 31), (slice(0, 33), 6)])
def test_an_acceleration_is_as_sharp_as_a_parabola_through_what_follows_the_impact(asked, rows, after):
    plain = asked("v_b2", rows=rows)
    about = replace(plain, question=replace(plain.question, dimension="acceleration"))
    t = np.arange(after) / FPS
    design = np.stack([np.ones(after), t, t**2], axis=1)
    exact = 2 * math.sqrt(np.linalg.inv(design.T @ design)[2, 2]) / math.sqrt(2) / SCALE
    assert spread_of_measured(about) == pytest.approx(
        4 * exact, rel=0.12
    )  # of many frames; few are a little less sharp


def test_a_conclusion_is_as_sharp_as_the_speeds_that_it_comes_from(asked):
    about = asked("e")
    (way, *_) = own_numbers(about.submission, about.key, about.questions)
    n, speed = way.numbers, spread_of_measured(asked("v_b2")) / 4
    spread = spread_of_concluded(about, way, lambda n: n.u2)
    assert spread == pytest.approx(4 * speed)
    both = spread_of_concluded(about, way, lambda n: n.u2 - n.v2)
    assert both == pytest.approx(4 * speed * math.sqrt(2))
    assert spread_of_concluded(about, way, lambda n: n.m) == 0.0
    assert n.m == 0.35


# ---------------------------------------------------------------- remarks


def remarks(asked, sd=0.002, half_width=0.014, **stated):
    about = asked("e")
    key = replace(about.key, expected_sd={"e": sd} if sd else {})
    given_ = {"value": 0.7, "half_unit": 0.0005, "text": "0.700", "unit_given": True, **stated}
    return list(remarks_on_number(Stated(**given_), about.question, key, half_width))


def test_digits_that_fit_bring_no_remark(asked):
    assert remarks(asked) == []
    assert remarks(asked, half_unit=0.0) == []
    assert remarks(asked, sd=0.0, half_unit=5e-9) == []


def test_too_few_digits_and_too_many_bring_one(asked):
    assert remarks(asked, half_unit=0.014) == []
    (coarse,) = remarks(asked, half_unit=0.0141)
    assert "too coarsely" in coarse
    assert remarks(asked, half_unit=2e-5) == []
    (fine,) = remarks(asked, half_unit=1.9e-5)
    assert "3 significant digits" in fine


@pytest.mark.parametrize(
    ("off", "uncertainty", "words"),
    [
        (0.0, 0.004, "fits"),
        (0.0119, 0.004, "fits"),
        (-0.0121, 0.004, "too small"),
        (0.0121, 0.004, "too small"),
        (0.0, 0.0699, "fits"),
        (0.0, 0.0701, "far wider"),
    ],
)
def test_a_stated_uncertainty_is_held_against_the_truth(asked, off, uncertainty, words):
    (said,) = remarks(asked, value=0.7 + off, uncertainty=uncertainty)
    assert words in said


def test_both_are_said_where_both_are_so(asked):
    assert len(remarks(asked, half_unit=0.05, uncertainty=0.004)) == 2


@given(st.floats(0.1, 10.0), st.floats(-5.0, 5.0), st.floats(0.001, 1.0))
def test_a_z_score_counts_the_stated_uncertainties_to_the_truth(truth, off, uncertainty):
    stated = Stated(truth + off, 0.0, "", unit_given=True, uncertainty=uncertainty)
    assert z_score(stated, truth) == pytest.approx(off / uncertainty, abs=1e-9)
    assert math.isnan(z_score(replace(stated, uncertainty=None), truth))


@pytest.mark.parametrize(
    ("value", "sd", "digits"),
    [
        (0.7333, 0.002, 3),
        (-0.7333, 0.02, 2),
        (24.0, 30.0, 1),
        (123.4, 0.1, 4),
        (0.0, 0.1, 1),
        (25.0, 0.0, 1),
        (25.0, 1.0, 2),
        (1.0, 0.5, 2),
    ],
)
def test_the_last_digit_is_of_the_size_of_the_uncertainty(value, sd, digits):
    assert significant_digits(value, sd) == digits

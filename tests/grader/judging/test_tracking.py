"""The tracking table: laid over the truth, each fault named, none that noise could feign."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grader.checks.tracking import tracking
from grader.flags import FOR_STUDENT
from grader.grade import TRACKING
from grader.model import Outcome
from grader.read.flags import Flag
from grader.smoothed import smoothing_of
from grader.tracked import OUR_FAILURE, FromTable
from grader.trajectory import TrajectoryFit, fit_trajectory

FAULTS = {"swapped": (), "y_down": False, "x_left": False, "scale_ratio": 1.0, "lag_frames": 0.0}


def judged(bench, points=10.0, columns=None, flags=(), **changes):
    """Judge a table whose fit has these faults."""
    fit = replace(bench.table.fit, **{**FAULTS, "rms_px": 0.5, **changes})
    submission = replace(bench.submission(), tracking=columns or {}, flags=flags)
    asked = bench.with_table(fit=fit).asked("e")
    (finding,) = tracking(replace(asked, question=replace(TRACKING, points=points), submission=submission))
    return finding


# ---------------------------------------------------------------- how near it is


@pytest.mark.parametrize(
    ("rms_px", "outcome", "points", "words"),
    [
        (0.0, "right", 10.0, "lie 0 px (root mean square) from the true ones."),
        (1.0, "right", 10.0, "lie 1 px (root mean square) from the true ones."),
        (1.01, "partial", 5.0, "lie 1 px (root mean square) from the true ones. A careful hand stays within 1 px."),
        (4.0, "partial", 5.0, "lie 4 px (root mean square) from the true ones. A careful hand stays within 1 px."),
        (4.01, "wrong", 0.0, "lie 4 px (root mean square) from the true ones. A careful hand stays within 1 px."),
    ],
)
def test_a_table_earns_by_its_distance_in_pixels(kick, rms_px, outcome, points, words):
    finding = judged(kick, rms_px=rms_px)
    assert (finding.question_id, finding.aspect, finding.mistake) == ("tracking", "table", "")
    assert (finding.outcome, finding.points, finding.out_of) == (outcome, points, 10.0)
    assert finding.message == f"Your points {words}"
    assert finding.numbers == {"rms_px": rms_px, "scale_ratio": 1.0, "lag_frames": 0.0}


@pytest.mark.parametrize(
    ("fault", "code", "words"),
    [
        ({"swapped": ("foot", "ball")}, "K13", "columns of foot and ball look exchanged"),
        ({"y_down": True}, "K10", "y axis points down in your table; it should point up"),
        ({"x_left": True}, "K15", "x axis points to the left in your table; it should point to the right"),
        ({"scale_ratio": 500.0}, "K1", "check the calibration"),
        ({"scale_ratio": 250000.0}, "K1b", "check the calibration"),
        ({"scale_ratio": 3.28}, "K3", "lengths are not the true ones"),
        ({"scale_ratio": 39.4}, "K3b", "calibration"),
        ({"scale_ratio": 100.0}, "K4", "calibration"),
        ({"scale_ratio": 1000.0}, "K4b", "calibration"),
        ({"scale_ratio": 2.0}, "K5", "calibration"),
        ({"scale_ratio": 0.5}, "K5b", "calibration"),
        ({"scale_ratio": 1.021}, "K7", "calibration"),
        ({"scale_ratio": 0.979}, "K7", "calibration"),
        ({"lag_frames": 0.35}, "K11", "It is 0.3 frames late"),
        ({"lag_frames": 2.0}, "K11", "It is 2.0 frames late"),
        ({"lag_frames": -2.0}, "K11", "It is 2.0 frames early"),
    ],
)
def test_each_fault_is_named_and_costs_half(kick, fault, code, words):
    finding = judged(kick, **fault)
    assert (finding.outcome, finding.points, finding.mistake) == (Outcome.PARTIAL, 5.0, code)
    assert words in finding.message


@pytest.mark.parametrize(
    ("code", "ratio"),
    [
        ("K1", 500.0),
        ("K1b", 250000.0),
        ("K3", 3.28084),
        ("K3b", 39.3701),
        ("K4", 100.0),
        ("K4b", 1000.0),
        ("K5", 2.0),
        ("K5b", 0.5),
    ],
)
@pytest.mark.parametrize(("off", "is_named"), [(1.01999, True), (0.98001, True), (1.02001, False), (0.97999, False)])
def test_a_scale_has_a_name_within_two_percent(kick, code, ratio, off, is_named):
    assert judged(kick, scale_ratio=ratio * off).mistake == (code if is_named else "K7")


@pytest.mark.parametrize("fault", [{"scale_ratio": 1.0199}, {"scale_ratio": 0.9801}, {"lag_frames": 0.3}])
def test_what_is_nearly_right_is_no_fault(kick, fault):
    assert judged(kick, **fault).outcome is Outcome.RIGHT


def test_of_several_faults_each_has_its_sentence_and_none_the_mistake(kick):
    finding = judged(kick, y_down=True, lag_frames=2.0)
    assert (
        "put right. The y axis points down in your table; it should point up. It is 2.0 frames late." in finding.message
    )
    assert finding.mistake == ""


def test_a_table_that_fits_nowhere_is_told_no_faults_of_the_fit(kick):
    finding = judged(kick, rms_px=4.01, y_down=True, lag_frames=12.0, scale_ratio=2.0, swapped=("foot", "ball"))
    assert finding.message.endswith("A careful hand stays within 1 px.")
    assert finding.mistake == ""
    assert judged(kick, rms_px=4.0, y_down=True).mistake == "K10"


# ---------------------------------------------------------------- its clock


def clock(rate, frames=30, start=0):
    frame = np.arange(start, start + frames, dtype=float)
    return {"frame": frame, "t_s": frame / rate}


@pytest.mark.parametrize(
    ("rate", "code", "words"),
    [
        (480.0, "", ""),
        (489.0, "", ""),
        (471.0, "", ""),
        (490.0, "K2", "run at 490 frames a second"),
        (470.0, "K2", "run at 470 frames a second; the recording has another rate"),
        (30.0, "K2", "run at 30 frames a second"),
        (1.0, "K2b", "frame numbers; time is frame number divided by frame rate"),
        (1.019, "K2b", "frame numbers"),
        (0.981, "K2b", "frame numbers"),
        (1.03, "K2", "run at 1.03 frames"),
    ],
)
def test_times_are_held_against_the_frame_numbers(kick, rate, code, words):
    finding = judged(kick, columns=clock(rate))
    assert finding.mistake == code
    assert words in finding.message


def test_gaps_and_rows_out_of_order_do_not_spoil_the_clock(kick):
    columns = clock(30.0)
    columns["t_s"][5], columns["frame"][9] = np.nan, np.nan
    columns["frame"][20:22] = columns["frame"][21:19:-1]
    columns["t_s"][20:22] = columns["t_s"][21:19:-1]
    assert judged(kick, columns=columns).mistake == "K2"


@pytest.mark.parametrize(
    "columns",
    [
        {"frame": np.arange(30.0)},
        {"t_s": np.arange(30.0)},
        {"frame": np.arange(30.0), "t_s": np.full(30, np.nan)},
        {"frame": np.zeros(30), "t_s": np.arange(30.0)},
        {"frame": np.arange(30.0), "t_s": np.zeros(30)},
    ],
)
def test_a_table_without_two_clocks_is_not_blamed(kick, columns):
    assert judged(kick, columns=columns).outcome is Outcome.RIGHT


def test_a_wrong_clock_is_told_of_a_hopeless_table_too(kick):
    assert judged(kick, rms_px=9.0, columns=clock(30.0)).mistake == "K2"


# ---------------------------------------------------------------- its columns and cells


def columns_of(*points, unit="m"):
    return {f"{point}_{axis}_{unit}": np.zeros(30) for point in points for axis in "xy"}


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        (
            columns_of("foot", "knee", "globe"),
            "called globe; the assignment's are ball. Call the columns ball_x_m, ball",
        ),
        (
            columns_of("foot", "globe", "leg"),
            "called globe, leg; the assignment's are knee, ball. Call the columns knee_x",
        ),
        (columns_of(*"gfedcba"), "called a, b, c, d, e; the assignment's are foot, knee, ball."),
        (columns_of("foot", "globe") | {"knee_x_m": np.zeros(30)}, "called globe; the assignment's are knee, ball."),
        (columns_of("foot", "knee", "ball", unit="px"), "has foot, knee, ball in pixels only"),
        (columns_of("foot", "knee") | columns_of("ball", unit="px"), "has ball in pixels only"),
    ],
)
def test_columns_that_are_called_otherwise_are_told_and_left_to_a_person(kick, columns, words):
    finding = judged(kick, columns=columns)
    assert (finding.outcome, finding.points, finding.out_of) == (Outcome.UNSURE, 10.0, 10.0)
    assert words in finding.message
    assert finding.message.startswith("Your points lie 0.5 px (root mean square) from the true ones. The table has ")
    missing = replace(kick.submission(), tracking=columns)
    assert words in without(kick, FromTable(), 10.0, submission=missing).message


def test_a_point_more_than_asked_for_is_no_fault(kick):
    finding = judged(kick, columns=columns_of("foot", "knee", "ball", "hip"))
    assert (finding.outcome, finding.message.count(".")) == (Outcome.RIGHT, 2)


def test_what_its_cells_hold_is_told_where_a_table_is_not_right(kick):
    flags = (Flag.MACROS, Flag.TEXT_IN_TRACKING, Flag.UNNAMED_POINTS)
    text = FOR_STUDENT[Flag.TEXT_IN_TRACKING]
    assert text not in judged(kick, flags=flags).message
    told = judged(kick, rms_px=3.0, flags=flags).message
    assert told.endswith(f"stays within 1 px. {text}")
    assert FOR_STUDENT[Flag.MACROS] not in told
    missing = without(kick, FromTable(), 0.0, submission=replace(kick.submission(), flags=flags))
    assert missing.message.endswith(f"says how to paste yours. {text}")


# ---------------------------------------------------------------- without a table


def without(bench, table, points, **changes):
    asked = replace(bench.asked("e"), question=replace(TRACKING, points=points), table=table, **changes)
    (finding,) = tracking(asked)
    return finding


def test_without_a_table_points_are_left_to_a_person(kick):
    finding = without(kick, FromTable(), 10.0)
    assert (finding.outcome, finding.points, finding.out_of) == (Outcome.UNSURE, 10.0, 10.0)
    assert (finding.question_id, finding.aspect) == ("tracking", "table")
    assert "no tracking table with 10 rows or more of your video" in finding.message
    assert without(kick, FromTable(), 0.0).outcome is Outcome.PARTIAL


def test_our_failure_is_not_called_a_missing_table(kick):
    finding = without(kick, FromTable(why_not=OUR_FAILURE), 0.0)
    assert (finding.question_id, finding.aspect, finding.outcome) == ("tracking", "table", Outcome.UNSURE)
    assert "grader could not work with your tracking table; a person will" in finding.message
    finding = without(kick, FromTable(why_not=OUR_FAILURE), 10.0)
    assert (finding.points, finding.out_of) == (10.0, 10.0)
    fitted = FromTable(kick.table.fit, why_not=OUR_FAILURE)
    assert without(kick, fitted, 10.0).outcome is Outcome.RIGHT


# ---------------------------------------------------------------- the fit


@pytest.fixture(scope="module")
def lay(kit, kick):
    """Lay changed true positions over the truth."""

    def fit(change=lambda xy: xy, shift=0.0, rows=slice(None), **options) -> TrajectoryFit | None:
        table = kit.table_of(change(kit.trajectory_m(kit.impact())))
        table["frame"] = table["frame"] + shift
        return fit_trajectory({name: column[rows] for name, column in table.items()}, kick.key, **options)

    return fit


def test_a_true_table_has_no_fault(lay, kit):
    fit = lay()
    assert fit.rms_px == pytest.approx(0, abs=1e-9)
    assert fit.scale_ratio == pytest.approx(1)
    assert (fit.lag_frames, fit.lag_s, fit.y_down, fit.x_left, fit.swapped) == (0.0, 0.0, False, False, ())
    assert fit.points == kit.POINTS
    assert fit.own_m == pytest.approx(fit.true_m)
    assert fit.time_s == pytest.approx(np.arange(60) / 480)


@given(
    st.floats(0.01, 1000), st.sampled_from([1, -1]), st.sampled_from([1, -1]), st.floats(-50, 50), st.floats(-50, 50)
)
@settings(max_examples=25, deadline=None)
def test_scale_shift_and_axes_are_found_whatever_they_are(lay, scale, right, up, x, y):
    fit = lay(lambda xy: xy * np.array([right, up]) * scale + np.array([x, y]))
    assert fit.scale_ratio == pytest.approx(scale, rel=1e-6)
    assert (fit.x_left, fit.y_down) == (right < 0, up < 0)
    assert fit.rms_px == pytest.approx(0, abs=1e-6)
    assert fit.own_m == pytest.approx(fit.true_m, abs=1e-8)


@pytest.mark.parametrize("lag", [-12.0, -3.0, -0.6, 0.4, 1.5, 12.0])
def test_a_delay_is_found_to_a_twentieth_of_a_frame(lay, lag):
    fit = lay(shift=lag)
    assert fit.lag_frames == pytest.approx(lag, abs=0.026)
    assert fit.lag_s == pytest.approx(lag / 480, abs=1e-4)
    assert fit.clip_frame == pytest.approx(np.arange(60), abs=0.026)
    assert fit.clip_time_s == pytest.approx(np.arange(60) / 480, abs=1e-4)
    assert fit.rms_px < 0.2


@pytest.mark.parametrize("lag", [400.0, 40.0, 20.0, -24.0, -58.0])
def test_a_count_from_elsewhere_is_found_where_it_is_looked_for(lay, lag):
    fit = lay(shift=lag, is_far_tried=True)
    assert fit.lag_frames == pytest.approx(lag, abs=0.026)
    assert fit.rms_px < 0.2
    assert fit.swapped == ()
    near = lay(shift=lag)
    assert near is None or near.rms_px > 4


def test_a_part_of_the_film_counted_from_elsewhere_is_found(lay):
    fit = lay(shift=400.0, rows=slice(15, 45), is_far_tried=True)
    assert fit.lag_frames == pytest.approx(400.0, abs=0.026)


@pytest.mark.parametrize(("first", "is_found"), [(39, True), (41, False)])
def test_half_of_a_table_must_lie_within_the_clip(kit, kick, first, is_found):
    """Of 40 rows 21 do, or 19."""
    table = kit.table_of(kit.trajectory_m(kit.impact(), frames=90))
    table = {name: column[first : first + 40] for name, column in table.items()}
    fit = fit_trajectory({**table, "frame": table["frame"] + 400}, kick.key, is_far_tried=True)
    assert (fit is not None and fit.rms_px < 1e-6 and fit.lag_frames == pytest.approx(400.0)) == is_found


def test_a_clip_that_is_itself_counted_from_elsewhere_is_reached(kit, kick):
    key = replace(kick.key, frame=np.arange(60) + 300)
    fit = fit_trajectory(kit.table_of(kit.trajectory_m(kit.impact())), key, is_far_tried=True)
    assert fit.lag_frames == pytest.approx(-300, abs=0.026)


def test_a_table_of_which_hardly_a_row_lies_in_the_clip_fits_nothing(kit, kick):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    table["frame"] = 1000 + 50 * table["frame"]
    assert fit_trajectory(table, kick.key, is_far_tried=True) is None


def test_a_table_of_something_else_keeps_the_nearest_delay(lay):
    near, far = lay(lambda xy: xy[::-1]), lay(lambda xy: xy[::-1], is_far_tried=True)
    assert (near.rms_px, near.lag_frames) == (far.rms_px, far.lag_frames)
    assert near.rms_px > 50


def test_a_known_delay_is_not_searched_again(lay):
    fit = lay(shift=3.0, lag_frames=2.0)
    assert fit.lag_frames == 2.0
    assert fit.rms_px > 1


@pytest.mark.parametrize("rows", [slice(0, 25), slice(30, 60), slice(10, 25), slice(None)])
@pytest.mark.parametrize("seed", range(3))
def test_noise_feigns_no_delay(lay, rows, seed):
    """A table of one side of the impact fits with many delays."""
    rng = np.random.default_rng(seed)
    fit = lay(lambda xy: xy + rng.normal(0, 1 / 500, xy.shape), rows=rows)
    assert fit.lag_frames == 0.0


def test_two_points_exchanged_are_put_right(lay):
    fit = lay(lambda xy: xy[:, [2, 1, 0]])
    assert fit.swapped == ("foot", "ball")
    assert fit.own_m == pytest.approx(fit.true_m, abs=1e-9)


def test_what_is_merely_coarse_is_not_said_to_be_exchanged(lay):
    rng = np.random.default_rng(1)
    fit = lay(lambda xy: xy + rng.normal(0, 0.1, xy.shape))
    assert fit.swapped == ()


def test_rows_in_any_order_are_sorted(lay, kit, kick):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    order = np.random.default_rng(0).permutation(60)
    fit = fit_trajectory({name: column[order] for name, column in table.items()}, kick.key)
    assert fit.rms_px == pytest.approx(0, abs=1e-9)
    assert fit.frame == pytest.approx(np.arange(60))


def test_time_stands_for_frames_where_these_are_missing(kit, kick):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    del table["frame"]
    assert fit_trajectory(table, kick.key).rms_px == pytest.approx(0, abs=1e-9)
    del table["t_s"]
    assert fit_trajectory(table, kick.key) is None


def test_points_of_which_a_column_is_missing_are_left_out(kit, kick):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    del table["knee_y_m"]
    fit = fit_trajectory(table, kick.key)
    assert fit.points == ("foot", "ball")
    assert fit.own_m.shape == (60, 2, 2)


@pytest.mark.parametrize(("rows", "is_enough"), [(9, False), (10, True)])
def test_ten_rows_are_enough_whatever_the_number_of_points(lay, rows, is_enough):
    assert (lay(rows=slice(20, 20 + rows)) is not None) == is_enough


def test_rows_of_which_a_point_is_missing_still_count_for_the_others(kit, kick):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    table["ball_x_m"] = np.where(np.arange(60) < 50, np.nan, table["ball_x_m"])
    table["foot_y_m"] = np.where(np.arange(60) > 20, np.nan, table["foot_y_m"])
    fit = fit_trajectory(table, kick.key)
    assert fit.rms_px == pytest.approx(0, abs=1e-9)
    assert np.isnan(fit.own_m[:50, 2]).all(axis=1).sum() == 50 or np.isnan(fit.own_m[:50, 2, 0]).all()


@pytest.mark.parametrize("wild", [np.nan, np.inf, 1e8, -1e8])
def test_wild_frame_numbers_are_left_out(kit, kick, wild):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    table["frame"] = np.where(np.arange(60) == 7, wild, table["frame"])
    fit = fit_trajectory(table, kick.key)
    assert fit.frame.size == 59
    assert fit.rms_px == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("wild", [2e9, -2e9, np.inf])
def test_wild_positions_are_left_out_with_their_row(kit, kick, wild):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    table["ball_x_m"] = np.where(np.arange(60) == 7, wild, table["ball_x_m"])
    fit = fit_trajectory(table, kick.key)
    assert fit.frame.size == 59
    assert fit.rms_px == pytest.approx(0, abs=1e-9)


def test_a_table_in_which_nothing_moves_fits_nothing(kit, kick):
    table = kit.table_of(np.ones((60, 3, 2)))
    assert fit_trajectory(table, kick.key, is_far_tried=True) is None


def test_the_distance_is_that_of_points_in_pixels(lay):
    rng = np.random.default_rng(3)
    assert lay(lambda xy: xy + rng.normal(0, 0.8 / 500, xy.shape)).rms_px == pytest.approx(0.8 * 2**0.5, rel=0.1)


# ---------------------------------------------------------------- smoothed across the impact


@pytest.mark.parametrize("width", [3, 5, 7, 9, 13, 17, 21])
def test_smoothing_is_found_with_its_width(lay, kick, smoothed, width):
    fit = lay(lambda xy: smoothed(xy, width))
    assert abs(smoothing_of(fit, kick.key) - width) <= 4
    assert smoothing_of(fit, kick.key) > 0


def test_a_late_table_is_smoothed_about_its_own_impact(lay, kick, smoothed):
    assert smoothing_of(lay(lambda xy: smoothed(xy, 7), shift=400.0, is_far_tried=True), kick.key) > 0


@pytest.mark.parametrize("lag", [-6.0, 6.0])
def test_a_table_that_reaches_out_of_the_clip_is_looked_at_within_it(lay, kick, smoothed, lag):
    fit = lay(lambda xy: smoothed(xy, 7), shift=lag)
    rolled = replace(fit, lag_frames=0.0, frame=fit.clip_frame)  # six rows at an end have no truth beside them
    beyond = np.arange(60) < 6 if lag > 0 else np.arange(60) > 53
    rolled = replace(rolled, true_m=np.where(beyond[:, None, None], np.nan, rolled.true_m))
    assert smoothing_of(rolled, kick.key) > 0


def test_where_nothing_is_seen_or_turns_nothing_is_smoothed(lay, kick):
    fit = lay()
    assert smoothing_of(replace(fit, own_m=np.full_like(fit.own_m, np.nan)), kick.key) == 0
    assert smoothing_of(replace(fit, own_m=fit.true_m), kick.key) == 0
    straight = np.tile(np.arange(60.0)[:, None, None] / 100, (1, 3, 2))
    steady = replace(fit, true_m=straight, own_m=straight + np.random.default_rng(0).normal(0, 0.01, straight.shape))
    assert smoothing_of(steady, kick.key) == 0


def test_smoothing_is_not_asked_of_a_table_away_from_the_impact(lay, kick, smoothed):
    assert smoothing_of(lay(lambda xy: smoothed(xy, 7), rows=slice(44, 60)), kick.key) == 0
    few = lay(lambda xy: smoothed(xy, 7), rows=slice(0, 28))
    assert smoothing_of(few, kick.key) == 0


def test_a_key_that_knows_no_frame_of_the_impact_says_nothing(lay, kick, smoothed):
    truth = {name: value for name, value in kick.key.truth.items() if name != "frame_before"}
    assert smoothing_of(lay(lambda xy: smoothed(xy, 7)), replace(kick.key, truth=truth)) == 0


def test_a_true_table_and_a_noisy_one_are_not_smoothed(lay, kick):
    assert smoothing_of(lay(), kick.key) == 0
    rng = np.random.default_rng(5)
    assert smoothing_of(lay(lambda xy: xy + rng.normal(0, 1 / 500, xy.shape)), kick.key) == 0


def test_a_smoothed_table_is_named_beside_its_distance(kit, kick, smoothed):
    table = kit.table_of(smoothed(kit.trajectory_m(kit.impact()), 5))
    fit = fit_trajectory(table, kick.key)
    asked = replace(kick.with_table(fit=fit).asked("e"), question=replace(TRACKING, points=10.0))
    (finding,) = tracking(asked)
    assert finding.mistake == "K14"
    assert "rounded off at the impact" in finding.message
    assert "Fit each side by itself" in finding.message

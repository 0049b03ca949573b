"""Full credit for a conclusion needs a table that it could come from; errors of tracking and later ones differ."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grader.grade import grade
from grader.model import Answer, Kind, Outcome
from grader.reference import from_table
from grader.remarks import significant_digits


def value_finding(result, question, aspect="value"):
    return next(f for f in result.of(question) if f.aspect == aspect)


def clicked(desk, kit, noise_px=1.0, seed=0):
    """A table of points clicked by hand."""
    xy = kit.trajectory_m(desk.numbers)
    return kit.table_of(xy + noise_px / kit.SCALE * np.random.default_rng(seed).standard_normal(xy.shape))


def test_a_right_value_with_its_table_is_right(desk):
    finding = value_finding(desk.grade(), "e")
    assert finding.outcome is Outcome.RIGHT
    assert finding.numbers["from_table"] == pytest.approx(desk.numbers.e, rel=2e-3)


@pytest.mark.parametrize("question", ["e", "I"])
def test_a_right_value_without_a_table_keeps_its_points_and_reaches_a_person(desk, question):
    result = desk.grade(tracking={})
    finding = value_finding(result, question)
    assert (finding.outcome, finding.points) == (Outcome.UNSURE, finding.out_of)
    assert "no tracking table" in finding.message
    assert (result.points, result.status, result.is_provisional) == (20.0, "review", True)


def test_a_table_of_another_impact_supports_nothing(desk, kit):
    other = kit.impact(e=0.5, inertia=0.5)
    finding = value_finding(desk.grade(tracking=kit.table_of(kit.trajectory_m(other))), "e")
    assert finding.outcome is Outcome.UNSURE
    assert "does not follow your video" in finding.message


def test_a_table_that_gives_another_value_supports_nothing(desk, kit):
    """It follows the video within some pixels, and yet its ball leaves more slowly."""
    xy = kit.trajectory_m(desk.numbers)
    after = np.arange(len(xy)) > 28
    xy[after, 2, 0] -= 0.08 * (xy[after, 2, 0] - 1.0)
    finding = value_finding(desk.grade(tracking=kit.table_of(xy[:40])), "e")
    assert finding.outcome is Outcome.UNSURE


def test_a_table_in_which_nothing_happens_supports_nothing(desk, kit):
    table = kit.table_of(kit.trajectory_m(desk.numbers)[:20])
    finding = value_finding(desk.grade(tracking=table), "e")
    assert finding.outcome is Outcome.UNSURE
    assert "does not show the impact" in finding.message


@pytest.mark.parametrize("change", [lambda xy: xy * 500, lambda xy: xy * [1, -1], lambda xy: xy * [-1, 1]])
def test_a_slip_of_scale_or_axis_does_not_take_support_away(desk, kit, change):
    result = desk.grade(tracking=kit.table_of(change(kit.trajectory_m(desk.numbers))))
    assert value_finding(result, "e").outcome is Outcome.RIGHT


def test_an_error_after_tracking_is_told_from_one_in_tracking(desk, kit):
    wrong = {"e": 0.2}
    assert "error in what you did with it" in value_finding(desk.grade(wrong), "e").message
    xy = kit.trajectory_m(desk.numbers)
    xy[29:, 2, 0] -= 0.05 * (xy[29:, 2, 0] - 1.0)
    assert "look at the tracking first" in value_finding(desk.grade(wrong, tracking=kit.table_of(xy)), "e").message


def far_inertia(desk):
    """Rates within their tolerances of which I is a small difference: it follows, and is far off."""
    omega2 = float(f"{desk.numbers.omega2 * 1.018:.4g}")
    inertia = desk.numbers.gain / (desk.truth["omega1"] - omega2)
    return {"omega2": omega2, "v_f2": float(f"{omega2 * 0.5:.4g}"), "I": float(f"{inertia:.4g}")}


def test_values_as_near_as_clicks_allow_are_half_right(desk, kit):
    off = {"omega1": desk.numbers.omega1 * 1.045}
    assert value_finding(desk.grade(off, tracking=clicked(desk, kit)), "omega1").outcome is Outcome.PARTIAL
    assert value_finding(desk.grade(off), "omega1").outcome is Outcome.WRONG
    assert value_finding(desk.grade(far_inertia(desk), tracking=clicked(desk, kit)), "I").outcome is Outcome.PARTIAL
    assert value_finding(desk.grade(far_inertia(desk)), "I").outcome is Outcome.WRONG


def test_a_wrong_formula_is_no_matter_of_clicks(desk, kit):
    finding = value_finding(desk.grade({"I": desk.numbers.I * 1.11}, tracking=clicked(desk, kit)), "I")
    assert finding.outcome is Outcome.WRONG


def test_a_coarse_table_widens_nothing(desk, kit):
    table = clicked(desk, kit, noise_px=3.0)
    assert value_finding(desk.grade(far_inertia(desk), tracking=table), "I").outcome is Outcome.WRONG


def test_a_failure_of_the_solver_never_costs_points(desk, monkeypatch):
    def broken(_):
        raise ZeroDivisionError

    monkeypatch.setattr("grader.reference.impact_model", broken)
    result = desk.grade()
    assert (result.points, result.status) == (20.0, "review")


def test_a_table_with_rows_twice_and_rows_outside_the_clip_is_solved(desk, kit):
    xy = kit.trajectory_m(desk.numbers)
    table = kit.table_of(np.concatenate([xy, xy]))
    found = from_table({**table, "frame": np.tile(np.arange(60.0), 2)}, desk.key, desk.assignment)
    assert found.values["e"] == pytest.approx(desk.numbers.e, rel=5e-3)
    assert from_table({}, desk.key, desk.assignment).why_not == "there is no tracking table"


# ---------------------------------------------------------------- each fault of a table by its name


def told(desk, kit, table):
    (finding,) = desk.grade(tracking=table).of("tracking")
    return finding


def test_exchanged_points_are_named(desk, kit):
    xy = kit.trajectory_m(desk.numbers)[:, [2, 1, 0]]
    finding = told(desk, kit, kit.table_of(xy))
    assert finding.mistake == "K13"
    assert "foot and ball look exchanged" in finding.message


@pytest.mark.parametrize("width", [3, 5, 9])
@pytest.mark.parametrize("noise_px", [0.0, 0.5])
def test_smoothing_across_the_impact_is_named(desk, kit, width, noise_px):
    rng = np.random.default_rng(width)
    xy = kit.trajectory_m(desk.numbers)
    xy += noise_px / kit.SCALE * rng.standard_normal(xy.shape)
    half = width // 2
    padded = np.pad(xy, ((half, half), (0, 0), (0, 0)), mode="edge")
    smooth = np.stack([padded[k : k + len(xy)] for k in range(width)]).mean(axis=0)
    assert told(desk, kit, kit.table_of(smooth)).mistake == "K14"


@pytest.mark.parametrize("seed", range(20))
def test_noise_is_not_taken_for_smoothing(desk, kit, seed):
    assert told(desk, kit, clicked(desk, kit, seed=seed)).mistake == ""


def test_a_mirrored_picture_is_named(desk, kit):
    assert told(desk, kit, kit.table_of(kit.trajectory_m(desk.numbers) * [-1, 1])).mistake == "K15"


@pytest.mark.parametrize(("rate", "code"), [(30.0, "K2"), (1.0, "K2b"), (480.0, "")])
def test_a_clock_of_another_rate_is_named(desk, kit, rate, code):
    table = {**desk.table, "t_s": np.arange(60) / rate}
    assert told(desk, kit, table).mistake == code


# ---------------------------------------------------------------- digits and stated uncertainty


@pytest.fixture
def typed(desk, kit):
    """What is found when e is typed as a text."""

    def find(text, sd=0.002):
        return _typed(desk, kit, text, sd)

    return find


def _typed(desk, kit, text, sd):
    answer = Answer(Kind.TEXT, None, text, "", "Answers!C6", "name")
    submission = kit.submission_of(desk.assignment, desk.truth, tracking=desk.table)
    key = replace(desk.key, expected_sd={"e": sd})
    submission = replace(submission, answers={**submission.answers, "e": answer})
    return value_finding(grade(submission, key, desk.assignment), "e")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("0.701 ± 0.004", "fits the true value"),
        ("0.705 ± 0.001", "too small"),
        ("0.701 ± 0.4", "far wider"),
        ("0.70123", "3 significant digits"),
        ("0.7", "too coarsely"),
    ],
)
def test_digits_and_uncertainty_bring_a_remark_and_cost_nothing(typed, text, words):
    finding = typed(text)
    assert words in finding.message
    assert (finding.outcome, finding.points) == (Outcome.RIGHT, finding.out_of)


def test_the_z_score_of_a_stated_uncertainty_is_kept(typed):
    assert typed("0.708 ± 0.004").numbers["z"] == pytest.approx(2.0)
    assert "z" not in typed("0.701").numbers


def test_digits_follow_the_uncertainty():
    assert significant_digits(0.0, 0.1) == 1
    assert significant_digits(25.0, 0.0) == 1
    assert significant_digits(-0.7333, 0.02) == 2

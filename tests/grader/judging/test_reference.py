"""What the reference method makes of a table, and whether that supports what a student concluded."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest

from assignments.textbook import textbook_of
from grader import reference
from grader.clicks import spread_of_concluded, spread_of_measured
from grader.model import Finding, Outcome
from grader.own import own_numbers
from grader.reference import from_table
from grader.support import supported
from grader.tracked import OUR_FAILURE
from vml_course.errors import InputError
from vml_course.model.solution import Estimate


@pytest.fixture(scope="module")
def solve(kit, kick):
    """Solve changed true positions."""

    def solved(change=lambda xy: xy, shift=0.0, key=kick.key):
        table = kit.table_of(change(kit.trajectory_m(kit.impact())))
        table["frame"] = table["frame"] + shift
        return from_table(table, key, kick.assignment)

    return solved


# ---------------------------------------------------------------- the table solved


def test_a_true_table_gives_true_values(solve, kick):
    found = solve()
    asked = {"omega1", "omega2", "v_f1", "v_f2", "v_b1", "v_b2", "e", "I"}
    assert found.values.keys() == found.sds.keys() == asked
    for name in asked:
        assert found.values[name] == pytest.approx(kick.truth[name], rel=5e-3, abs=0.02), name
        assert 0 <= found.sds[name] < 0.02
    assert (found.is_corrected, found.why_not, found.fit.rms_px < 0.1) == (False, "", True)
    assert found.is_near


@pytest.mark.parametrize(
    "change", [lambda xy: xy * 500, lambda xy: xy * 1.05, lambda xy: xy * [1, -1], lambda xy: xy * [-1, 1]]
)
def test_a_slip_of_scale_or_axis_is_put_right_first(solve, kick, change):
    found = solve(change)
    assert found.is_corrected
    assert found.values["v_b2"] == pytest.approx(kick.truth["v_b2"], rel=5e-3)


def test_a_scale_that_is_merely_inexact_is_left(solve, kick):
    found = solve(lambda xy: xy * 1.015)
    assert not found.is_corrected
    assert found.values["v_b2"] == pytest.approx(1.015 * kick.truth["v_b2"], rel=5e-3)


@pytest.mark.parametrize("shift", [0.0, 5.0, 400.0, -24.0])
def test_where_frames_are_counted_from_changes_nothing(solve, kick, shift):
    found = solve(shift=shift)
    assert found.values["e"] == pytest.approx(kick.truth["e"], rel=5e-3)
    assert found.rows(0.06) == (29, 31)


def test_rows_that_are_there_twice_count_once(kit, kick):
    table = kit.table_of(kit.trajectory_m(kit.impact()))
    twice = {name: np.concatenate([column, column]) for name, column in table.items()}
    assert from_table(twice, kick.key, kick.assignment).values["e"] == pytest.approx(kick.truth["e"], rel=5e-3)


def test_rows_outside_of_the_clip_and_rows_that_are_there_twice_are_left_out(kit, kick, monkeypatch):
    model = SimpleNamespace(given=(), optional=(), solve=Mock(return_value=Mock(estimates={})))
    monkeypatch.setattr(reference, "impact_model", lambda _: model)
    table = kit.table_of(kit.trajectory_m(kit.impact(), frames=80, at_s=0.06 + 5 / 480))
    table = {name: np.concatenate([column, column]) for name, column in table.items()}
    from_table({**table, "frame": table["frame"] - 5}, kick.key, kick.assignment)
    (motion, *_), _ = model.solve.call_args
    assert motion.frame.tolist() == list(range(60))
    assert motion.time_s == pytest.approx(np.arange(60) / 480)


def test_numbers_without_a_value_raise_no_alarm(kit, kick, monkeypatch):
    def solve(*_):
        return Mock(estimates={"e": Estimate(float(np.float64(1.0) / np.float64(0.0)), 0.0)})

    monkeypatch.setattr(reference, "impact_model", lambda _: SimpleNamespace(given=(), optional=(), solve=solve))
    assert from_table(kit.table_of(kit.trajectory_m(kit.impact())), kick.key, kick.assignment).values["e"] == math.inf


def test_the_window_of_the_assignment_is_the_one_that_is_fitted(kit, kick):
    narrow = replace(kick.assignment, solve={**kick.assignment.solve, "window_s": 0.03})
    assert from_table(kit.table_of(kit.trajectory_m(kit.impact())), kick.key, narrow).window_s == 0.03


def test_a_row_at_the_very_impact_is_after_it(kick):
    fit = kick.table.fit
    assert kick.table.rows(float(fit.time_s[29])) == (29, 31)
    assert kick.table.rows(float(fit.time_s[29]) + 1e-9) == (30, 30)


def test_what_the_solver_does_not_name_follows_by_its_formula(bounce, kit, monkeypatch):
    """s2 = v_t2 + R omega2; what nobody asked is left out."""
    sds = {"v_t2": 0.03, "omega2": 1.0, "e": 0.02, "J": 5.0}
    estimates = {name: Estimate(2.0, sd) for name, sd in sds.items()}
    model = SimpleNamespace(given=("m",), optional=("R", "D"), solve=Mock(return_value=Mock(estimates=estimates)))
    monkeypatch.setattr(reference, "impact_model", lambda _: model)
    found = from_table(kit.table_of(kit.trajectory_m(kit.impact())), bounce.key, bounce.assignment)
    assert found.values == {"v_t2": 2.0, "omega2": 2.0, "e": 2.0, "s2": pytest.approx(2.0 + 0.12 * 2.0)}
    assert found.sds == {"v_t2": 0.03, "omega2": 1.0, "e": 0.02, "s2": pytest.approx(math.hypot(0.03, 0.12))}
    motion, given, options = model.solve.call_args.args
    assert given == {"m": 0.6, "R": 0.12}
    assert found.window_s == options.window_s
    assert (options.striker, options.struck, options.flight) == ("rim", "ball", "always")
    assert motion.sigma_m.shape == (60, 3)
    assert np.isnan(motion.sigma_m).all()


def test_the_solver_is_told_what_scene_and_assignment_declare(kick, kit, monkeypatch):
    model = SimpleNamespace(given=("m", "L"), optional=("D",), solve=Mock(return_value=Mock(estimates={})))
    monkeypatch.setattr(reference, "impact_model", lambda name: model if name == "fixed-pivot" else None)
    from_table(kit.table_of(kit.trajectory_m(kit.impact())), kick.key, kick.assignment)
    motion, given, options = model.solve.call_args.args
    assert given == {"m": 0.35, "L": 0.5, "D": 0.22}
    assert options.drive == kick.assignment.solve["drive"] == "none"
    assert motion.points == kit.POINTS


def test_an_estimate_is_kept_in_the_textbooks_sign(bench_of, kit, monkeypatch):
    solved = {item.id: item.factor({}) for item in textbook_of("struck_rod").measured}
    assert -1.0 in solved.values()
    rod = bench_of("struck-rod", {}, **dict.fromkeys(("u1", "u2", "g2", "omega2"), 1.0))
    model = SimpleNamespace(given=(), optional=(), solve=Mock())
    model.solve.return_value.estimates = {name: Estimate(2.0, 0.1) for name in solved}
    monkeypatch.setattr(reference, "impact_model", lambda _: model)
    found = from_table(kit.table_of(kit.trajectory_m(kit.impact())), rod.key, rod.assignment)
    assert {name: found.values[name] for name in solved} == {name: 2.0 * sign for name, sign in solved.items()}


def test_no_table_gives_nothing(kick):
    found = from_table({}, kick.key, kick.assignment)
    assert (found.fit, found.values, found.why_not) == (None, {}, "there is no tracking table")
    assert not found.is_near
    assert found.rows(0.06) == (0, 0)


def test_what_the_solver_refuses_is_said_in_its_words(solve, monkeypatch):
    class Refuses:
        given = optional = ()

        def solve(self, *_):
            raise InputError("table", "an impact", "none")

    monkeypatch.setattr(reference, "impact_model", lambda _: Refuses())
    found = solve()
    assert (found.fit is not None, found.values) == (True, {})
    assert found.why_not == "table: expected an impact, got none."


@pytest.mark.parametrize(("broken", "keeps_fit"), [("impact_model", True), ("fit_trajectory", False)])
def test_our_own_failure_never_raises(solve, monkeypatch, broken, keeps_fit):
    def fails(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr(reference, broken, fails)
    found = solve()
    assert (found.why_not, found.values) == (OUR_FAILURE, {})
    assert (found.fit is not None) == keeps_fit


def test_a_refusal_while_fitting_is_our_failure(solve, monkeypatch):
    def refuses(*_, **__):
        raise InputError("table", "rows", "none")

    monkeypatch.setattr(reference, "fit_trajectory", refuses)
    assert solve().why_not == OUR_FAILURE


# ---------------------------------------------------------------- a conclusion held against it


def right(bench, question="e", **changes):
    truth = bench.truth[question]
    finding = Finding(question, "value", Outcome.RIGHT, 3.0, 3.0, "Right.", {"value": truth, "truth": truth})
    return replace(finding, **changes)


def held(bench, finding, half_width=0.01):
    return supported(bench.asked(finding.question_id), finding, half_width)


def test_a_right_value_that_its_table_gives_stays_right(kick):
    finding = held(kick, right(kick))
    assert (finding.outcome, finding.points, finding.message) == (Outcome.RIGHT, 3.0, "Right.")
    assert finding.numbers["from_table"] == kick.truth["e"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"fit": None, "values": {}}, "there is no tracking table that it could come from"),
        ({"fit": None, "values": {}, "why_not": OUR_FAILURE}, OUR_FAILURE),
        ({"values": {}, "why_not": OUR_FAILURE}, OUR_FAILURE),
        ({"rms_px": 4.01}, "your tracking table does not follow your video"),
        ({"before": 4}, "your tracking table does not show the impact"),
        ({"after": 4}, "your tracking table does not show the impact"),
        ({"gap": 27}, "your tracking table does not show the impact"),
        ({"values": {"e": 0.72}}, "your tracking table gives another one"),
        ({"values": {"e": 0.68}}, "your tracking table gives another one"),
    ],
)
def test_a_right_value_that_its_table_does_not_support_reaches_a_person(kick, change, words):
    finding = held(with_table(kick, **change), right(kick))
    assert (finding.outcome, finding.points) == (Outcome.UNSURE, 3.0)
    assert finding.message == f"The value is right, but {words}; a person will look at it."


def test_a_table_that_could_not_be_laid_over_the_truth_cannot_be_compared(kick):
    asked = with_table(kick, fit=None, values={}).asked("e")
    asked = replace(asked, submission=replace(asked.submission, tracking={"t_s": np.arange(9.0)}))
    message = supported(asked, right(kick), 0.01).message
    assert message.startswith("The value is right, but your tracking table cannot be compared with your video;")


def with_table(kick, rms_px=0.5, before=29, after=31, gap=0, **changes):
    """A table with so many rows before and after the impact, in the last `gap` of which the ball is missing."""
    fit = kick.table.fit
    rows = slice(29 - before, 29 + after)
    own_m = fit.own_m[rows].copy()
    own_m[len(own_m) - gap :, 2, 1] = np.nan
    fit = replace(fit, rms_px=rms_px, own_m=own_m, time_s=fit.time_s[rows])
    return kick.with_table(**{"fit": fit, **changes})


@pytest.mark.parametrize(
    "change",
    [
        {"rms_px": 4.0},
        {"before": 5, "after": 5},
        {"gap": 26},
        {"values": {"e": 0.7099}},
        {"values": {"e": 0.76}, "sds": {"e": 0.01}},
        {"values": {}, "why_not": "table: expected an impact, got none."},
    ],
)
def test_a_table_that_comes_near_supports_a_right_value(kick, change):
    assert held(with_table(kick, **change), right(kick)).outcome is Outcome.RIGHT


def test_the_tables_own_scatter_widens_to_six_sd_and_no_more(kick):
    exact = kick.with_key(values={"e": 0.5}).with_table(values={"e": 1.0}, sds={"e": 0.0625})
    assert held(exact, right(exact), 0.125).outcome is Outcome.RIGHT
    assert held(exact, right(exact), 0.1249).outcome is Outcome.UNSURE


def test_what_is_carried_needs_no_support_of_its_own(kick):
    finding = held(kick.with_table(fit=None), right(kick, carried=True))
    assert finding.outcome is Outcome.RIGHT


def test_a_wrong_value_is_told_where_to_look(kick):
    wrong = right(kick, outcome=Outcome.WRONG, points=0.0, message="Not right.")
    assert held(kick, wrong).message.startswith("Not right. Your tracking table is good enough")
    off = kick.with_table(values={"e": 0.8})
    assert held(off, wrong).message.startswith("Not right. The reference method finds no right value")
    assert held(off, replace(wrong, outcome=Outcome.PARTIAL)).message.endswith("look at the tracking first.")
    edge = kick.with_key(values={"e": 0.5}).with_table(values={"e": 0.75})
    assert "good enough" in held(edge, replace(wrong), 0.25).message
    assert held(kick.with_table(values={}), wrong) == wrong
    unsure = replace(wrong, outcome=Outcome.UNSURE)
    assert held(kick, unsure).message == "Not right."


# ---------------------------------------------------------------- what clicks allow


def spread(bench, question, rms_px=1.0, **changes):
    fit = replace(bench.table.fit, rms_px=rms_px)
    return spread_of_measured(bench.with_table(fit=fit, **changes).asked(question, factors=()))


def test_a_speed_by_a_line_is_as_sharp_as_its_points_and_its_length(kick):
    """19 frames in 40 ms: sd of a slope is noise fps sqrt(12 / (n (n^2 - 1))), twice in squares, 4 sd."""
    frames = 9  # whole ones in half of 40 ms
    noise_m = 1.0 / math.sqrt(2) / 500
    slope = math.sqrt(2) * noise_m * 480 * math.sqrt(12 / (frames * (frames**2 - 1)))
    assert spread(kick, "v_b2") == pytest.approx(4 * slope)
    assert spread(kick, "v_b2", rms_px=0.5) == pytest.approx(2 * slope)
    assert spread(kick, "omega1") == pytest.approx(4 * slope / 0.5, rel=1e-6)


def test_the_longest_line_is_forty_milliseconds_the_shortest_six_frames(kick):
    assert spread(kick, "v_b2", window_s=0.08) == spread(kick, "v_b2", window_s=0.2)
    assert spread(kick, "v_b2", window_s=0.08) < spread(kick, "v_b2", window_s=0.06)
    assert spread(kick, "v_b2", window_s=0.001) == spread(kick, "v_b2", window_s=12 / 480)
    assert spread(kick, "v_b2", window_s=0.001) > spread(kick, "v_b2", window_s=14 / 480)


def test_an_acceleration_is_that_of_a_parabola_through_all_after(hammer):
    noise_m = 1.0 / math.sqrt(2) / 500
    expected = 4 * noise_m * 480**2 * math.sqrt(720 / 31**5)
    assert spread(hammer, "a_b") == pytest.approx(expected)
    short = replace(hammer.table.fit, own_m=np.full_like(hammer.table.fit.own_m, np.nan))
    few = replace(hammer, table=replace(hammer.table, fit=replace(short, rms_px=1.0))).asked("a_b", factors=())
    assert spread_of_measured(few) == pytest.approx(4 * noise_m * 480**2 * math.sqrt(720 / 6**5))


def test_coarse_points_and_other_quantities_are_given_nothing(kick, pendulum):
    assert spread(kick, "v_b2", rms_px=1.7) > 0
    assert spread(kick, "v_b2", rms_px=1.71) == 0
    assert spread(kick, "px_per_m") == 0
    assert spread(pendulum, "theta_max") == 0
    assert spread_of_measured(kick.with_table(fit=None).asked("v_b2", factors=())) == 0


def test_a_rate_needs_the_two_marks_of_its_direction(kick, pucks):
    fit = kick.table.fit
    one = replace(fit, rms_px=1.0, points=("foot", "ball"), own_m=fit.own_m[:, [0, 2]])
    assert spread_of_measured(kick.with_table(fit=one).asked("omega1", factors=())) == 0
    assert spread_of_measured(kick.with_table(fit=one).asked("v_b2", factors=())) > 0
    leg = replace(fit, rms_px=1.0, points=("foot", "knee"), own_m=fit.own_m[:, :2])
    assert spread_of_measured(kick.with_table(fit=leg).asked("omega1", factors=())) == spread(kick, "omega1")


def test_a_conclusion_takes_the_spreads_of_its_numbers(kick):
    asked = kick.with_table(fit=replace(kick.table.fit, rms_px=1.0)).asked("e", factors=())
    (way, *_) = own_numbers(asked.submission, asked.key, asked.questions)
    assert spread_of_concluded(asked, way, lambda n: n.u2) == pytest.approx(spread(kick, "v_b2"))
    both = spread_of_concluded(asked, way, lambda n: n.u2 - n.v1)
    assert both == pytest.approx(math.hypot(spread(kick, "v_b2"), spread(kick, "v_f1")))
    fewer = replace(asked, questions={"v_b2": asked.questions["v_b2"]})
    assert spread_of_concluded(fewer, way, lambda n: n.v1) == 0

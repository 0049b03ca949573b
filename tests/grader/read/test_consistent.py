"""Where a workbook begins to disagree with itself: just within a tolerance nothing is said, just beyond it is."""

from __future__ import annotations

from dataclasses import replace

import corpus
import numpy as np
import pytest

from grader.consistent import USUAL, remarks_on
from grader.read import ReadRequest, read_workbook

N = 12


@pytest.fixture
def said(assignment, kit):
    def ask(values, table=None, **given):
        labels = {g.id: g.label for g in assignment.givens}
        grid = [[labels[name], name, number] for name, number in given.items()]
        book = read_workbook(ReadRequest("w", corpus.Dialect().write({"Instructions": grid or [["x"]]})))
        return list(remarks_on(book, kit.submission_of(assignment, values, tracking=table), assignment))

    return ask


def table(rows=N, **columns):
    t = np.arange(rows) / 480
    usual = {"frame": np.arange(rows) * 1.0, "t_s": t}
    for point in ("foot", "knee", "ball"):
        usual |= {f"{point}_x_m": t, f"{point}_y_m": 0 * t}
    return {**usual, **{name: np.asarray(column) for name, column in columns.items()}}


def test_nothing_is_said_of_nothing(said):
    assert said({}) == []
    assert said({}, table()) == []


@pytest.mark.parametrize(
    ("question", "dimension"), [("e", "e"), ("v_b2", "velocity"), ("omega2", "angular_velocity"), ("px_per_m", "scale")]
)
def test_what_is_usual_ends_at_its_edges(said, question, dimension):
    low, high = USUAL[dimension]
    assert said({question: low}) == said({question: high}) == []
    for value in (low - 0.01 * abs(high), high * 1.01):
        assert len(said({question: value})) == 1
        assert "is unusual: check sign and unit." in said({question: value})[0]


def test_what_is_unusual_is_told_with_its_unit(said):
    assert said({"e": 1.3}) == ["e = 1.3 is unusual: check sign and unit."]
    assert said({"v_b2": -12345.0})[0].startswith("v_b2 = -1.234e+04 m/s is")


def test_of_a_quantity_without_usual_sizes_none_is_unusual(assignment, kit):
    energy = replace(assignment.question("e"), id="lost", dimension="energy", unit="J")
    other = replace(assignment, questions=(energy,))
    book = read_workbook(ReadRequest("w", corpus.Dialect().write({"Instructions": [["x"]]})))
    for value in (-1e9, 1e9):
        assert list(remarks_on(book, kit.submission_of(other, {"lost": value}), other)) == []


def test_numbers_written_as_text_are_named(said):
    assert said({"e": "0.7", "fps": 480.0}) == ["Numbers written as text, which were understood: e."]
    assert said({"e": "0.7", "fps": "480"}) == ["Numbers written as text, which were understood: f, e."]


def test_what_is_written_in_pixels_is_compared_with_nothing(said):
    assert said({"v_b2": "9000 px/s"}) == []


def test_ten_rows_are_enough(said):
    assert said({}, table(10)) == []
    assert said({}, table(9)) == ["The table has 9 rows; 10 are the least to compare."]


def test_a_clock_is_enough(said):
    for name in ("frame", "t_s"):
        assert said({}, {k: v for k, v in table().items() if k != name}) == []


def test_without_a_clock_this_is_said_and_no_rate(said):
    without = {k: v for k, v in table().items() if k not in {"frame", "t_s"}}
    assert said({"fps": 300.0}, without) == ["The table has neither frame numbers nor times."]
    assert said({"fps": 300.0}, {**without, "t_s": table()["t_s"]}) == []
    assert said({"fps": 300.0}, {**without, "frame": table()["frame"]}) == []


def test_a_clock_that_stands_or_goes_back_is_named_with_its_first_row(said):
    t = table()["t_s"].copy()
    t[5] = t[4]
    assert said({}, table(t_s=t)) == ["The times of the table do not rise in 1 places, first after row 5."]
    frames = np.arange(N) * 1.0
    frames[[4, 8]] = 0, 1
    remark = "The frame numbers of the table do not rise in 2 places, first after row 4."
    assert remark in said({}, table(frame=frames))


def test_gaps_in_a_clock_are_no_steps_back(said):
    t = table()["t_s"].copy()
    t[3] = np.nan
    assert said({"fps": 480.0}, table(t_s=t)) == []


@pytest.mark.parametrize(("fps", "count"), [(480 * 0.991, 0), (480 * 1.0099, 0), (480 * 0.988, 1), (480 * 1.012, 1)])
def test_a_rate_may_be_one_percent_apart(said, fps, count):
    remarks = said({"fps": fps}, table())
    assert len(remarks) == count
    assert all(f"480 frames a second, but you wrote {fps:.4g}." in remark for remark in remarks)


def test_a_rate_is_the_middle_one_of_the_steps_that_go_on(said):
    frames = np.array([0, 1, 2, 2, 3, 9, 10, 11, 12, 13, 14, 15.0])
    t = np.arange(N) / 480
    t[7] = t[6]
    assert not any("frames a second" in remark for remark in said({"fps": 480.0}, table(frame=frames, t_s=t)))
    assert not any("frames a second" in remark for remark in said({"fps": 300.0}, table(frame=[3.0] * N)))


@pytest.mark.parametrize(("scale", "count"), [(500 * 0.982, 0), (500 * 1.019, 0), (500 * 0.975, 1), (500 * 1.025, 1)])
def test_a_scale_may_be_two_percent_apart(said, scale, count):
    x = np.linspace(0, 2, N)
    remarks = said({"px_per_m": scale}, table(ball_x_m=x, ball_x_px=500 * x + 20))
    assert len(remarks) == count
    assert all(f"500 pixels in a metre, but you wrote {scale:.4g}." in remark for remark in remarks)


def test_without_a_written_scale_none_is_compared(said):
    x = np.linspace(0, 1, N)
    assert said({}, table(ball_x_m=x, ball_x_px=500 * x)) == []


def test_a_scale_is_told_once_and_only_of_what_moves(said):
    x = np.linspace(0, 1, N)
    both = table(ball_x_m=x, ball_x_px=500 * x, foot_x_m=x, foot_x_px=500 * x)
    assert len(said({"px_per_m": 400.0}, both)) == 1
    assert said({"px_per_m": 400.0}, table(ball_x_m=x / 500, ball_x_px=x)) == []  # a pixel in all
    assert len(said({"px_per_m": 400.0}, table(ball_x_m=x / 300, ball_x_px=1.5 * x))) == 1
    assert said({"px_per_m": 400.0}, table(ball_x_m=0 * x, ball_x_px=500 * x)) == []
    gaps = np.where(np.arange(N) % 2, x, np.nan)
    assert len(said({"px_per_m": 400.0}, table(ball_x_m=gaps, ball_x_px=500 * x))) == 1
    late = table(knee_x_m=np.full(N, np.nan), knee_x_px=x, ball_x_m=x, ball_x_px=500 * x)
    assert len(said({"px_per_m": 400.0}, late)) == 1


@pytest.mark.parametrize(("speed", "count"), [(10.9, 0), (9.0, 0), (9.1, 0), (11.3, 1), (8.8, 1), (-10.0, 0)])
def test_an_arm_may_be_ten_percent_apart(said, speed, count):
    for turn, name in (("omega1", "v_f1"), ("omega2", "v_f2")):
        remarks = said({turn: 20.0, name: speed}, L=0.5)
        assert len(remarks) == count
        assert all("times L: check both, and their units." in remark for remark in remarks)


def test_an_arm_needs_all_three(said):
    assert said({"omega1": 20.0, "v_f1": 99.0}) == said({"omega1": 20.0}, L=0.5) == said({"v_f1": 99.0}, L=0.5) == []


def turning(rate: float, rows: int = N) -> dict:
    return turned(np.pi - 0.05 + rate * np.arange(rows) / 480)  # across the jump of the angle


def turned(angle) -> dict:
    rows, x, y = len(angle), 2 + 0.5 * np.cos(angle), 3 + 0.5 * np.sin(angle)
    return table(rows, foot_x_m=x, foot_y_m=y, knee_x_m=np.full(rows, 2.0), knee_y_m=np.full(rows, 3.0))


@pytest.mark.parametrize(("rate", "sense"), [(20.0, "counter-clockwise"), (-20.0, "clockwise")])
def test_the_sense_of_turning_is_compared_with_the_sign(said, rate, sense):
    assert said({"omega1": rate}, turning(rate)) == []
    remark = said({"omega1": -rate}, turning(rate))
    assert len(remark) == 1
    assert f"foot turns {sense} about knee; the sign of ω" in remark[0]


def test_a_small_turn_or_few_rows_say_nothing_of_the_sense(said):
    assert said({"omega1": -20.0}, turning(4.3)) == []  # 0.1 rad in all
    assert len(said({"omega1": -20.0}, turning(4.5))) == 1
    assert not any("turns" in remark for remark in said({"omega1": -20.0}, turning(20.0, 9)))
    assert any("turns" in remark for remark in said({"omega1": -20.0}, turning(20.0, 10)))


@pytest.mark.parametrize("second", [-0.2, 0.9])
def test_the_sense_is_that_of_the_whole_turn(said, second):
    for sense, sign in (("counter-clockwise", 1), ("clockwise", -1)):
        there = turned(sign * np.array([0, second, *np.linspace(0, 0.4, N - 4), -0.1, 0.5]))
        assert said({"omega1": 0.5 * sign}, there) == []
        assert f"foot turns {sense} about knee" in said({"omega1": -0.5 * sign}, there)[0]


def test_a_sense_needs_a_sign_and_both_points_alone(said):
    there = turning(-20.0)
    assert said({}, there) == []
    alone = {name: column for name, column in there.items() if name.startswith(("foot", "knee"))}
    assert any("foot turns clockwise" in remark for remark in said({"omega1": 20.0}, alone))


def test_a_tenth_of_a_radian_is_no_turn(said):
    angle, still = np.linspace(0, 0.1, N), np.zeros(N)
    there = table(foot_x_m=1 + still, foot_y_m=np.tan(angle), knee_x_m=still, knee_y_m=still)
    assert np.arctan2(there["foot_y_m"], there["foot_x_m"])[-1] == 0.1
    assert said({"omega1": -20.0}, there) == []


def test_a_missing_point_is_named_with_its_column(said):
    lacking = {k: v for k, v in table().items() if "ball" not in k and "knee" not in k}
    remark = "The table has no positions in metres called knee, ball. Name columns knee_x_m."
    assert said({}, lacking) == [remark]
    other = {**lacking, "b_x_m": lacking["foot_x_m"], "a_x_m": lacking["foot_x_m"]}
    asked = said({}, other)[0]
    assert "called knee, ball; which of them is a, b? Name columns knee_x_m." in asked

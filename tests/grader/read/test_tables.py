"""Tracking tables of other programs, and of people in a hurry."""

from __future__ import annotations

import corpus
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.read import ReadRequest, read_workbook
from grader.read.headings import Heading, match_points, read_heading
from grader.read.table import read_table

POINTS = ("foot", "knee", "ball")
N = 15


def table(grid, points=POINTS, sheet="Tracking", **others):
    data = corpus.Dialect().write({**others, sheet: grid})
    return read_table(read_workbook(ReadRequest("w.xlsx", data)), points)


def line(*columns):
    """Rows of numbers: each column rises by its own step."""
    return [[step * i for step in columns] for i in range(N)]


def test_the_classic_laboratory_puts_everything_on_one_sheet():
    header = ["frame", "t", "x_ball", "y_ball", "x_foot", "y_foot", "x_knee", "y_knee", "angle_leg", "length_leg"]
    header += [None, "ratio (m/px)", 0.002]
    found = table([header, *line(1, 0.002, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 1.0, 0.0)], sheet="Data")
    assert set(found.columns) == {"frame", "t_s", *(f"{p}_{a}_m" for p in POINTS for a in "xy")}
    assert found.columns["foot_y_m"][3] == pytest.approx(0.12)
    assert (found.flags, found.unnamed, found.where) == (frozenset(), (), "Data")


TRACKER = [["#multi:"], ["", "#ball", None, None, "#foot", None, None, "#mass_C"], ["t", *["x", "y", "step"] * 3]]


def test_masses_of_tracker_are_mapped_by_their_names_and_asked_about_otherwise():
    found = table([*TRACKER, *line(0.1, 1, 2, 3, 4, 5, 6, 7, 8, 9)])
    positions = {f"{p}_{a}_m" for p in ("ball", "foot", "mass_c") for a in "xy"}
    assert set(found.columns) == {"t_s", "step"} | positions
    assert found.columns["foot_x_m"][1] == 4
    assert "unnamed-points" in found.flags
    assert found.unnamed == ("mass_c",)


@pytest.mark.parametrize("delimiter", ["\t", ",", ";"])
def test_text_of_tracker_that_stayed_in_one_column_is_cut(delimiter):
    lines = ["mass A" + delimiter * 2, delimiter.join("txy")]
    lines += [delimiter.join(f"{value:.3E}" for value in row) for row in line(0.1, 1, 2)]
    found = table([[text] for text in lines], points=("ball",))
    assert found.columns["ball_x_m"].tolist() == list(range(N))
    assert found.columns["t_s"][2] == 0.2


def test_semicolons_go_with_decimal_commas():
    lines = ["t;xball;yball", *(f"0,{i:03};1,2{i:02};-{i},5" for i in range(N)), "the end"]
    found = table([[text] for text in lines], points=("ball",))
    assert found.columns["ball_x_m"][3] == 1.203
    assert found.columns["ball_y_m"][3] == -3.5


def test_a_comma_is_not_guessed_where_nothing_tells():
    rows = [[i, i, "1,234", "2,345"] for i in range(N)]
    found = table([["frame", "t_s", "ball_x_m", "ball_y_m"], *rows, [N, N, 1.0, 1.0]])
    assert found.columns["frame"].tolist() == [N]
    assert found.flags == {"text-in-tracking"}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("frame", Heading("frame")),
        ("Frame #", Heading("frame")),
        ("t", Heading("t")),
        ("t/s", Heading("t", unit="s")),
        ("Time [ms]", Heading("t", unit="ms")),
        ("time (seconds)", Heading("t", unit="s")),
        ("t_m", None),
        ("step", Heading("step")),
        ("ball_x_m", Heading("x", "ball", "m")),
        ("Ball x (cm)", Heading("x", "ball", "cm")),
        ("left foot y [px]", Heading("y", "left_foot", "px")),
        ("x_ball", Heading("x", "ball")),
        ("xball", Heading("x", "ball")),
        ("x", Heading("x")),
        ("y (ft)", Heading("y", "", "ft")),
        ("pos_x_ball", Heading("x", "ball")),
        ("x position ball", Heading("x", "ball")),
        ("pixelx", Heading("x", "", "px")),  # codespell:ignore
        ("pixel_y", Heading("y", "", "px")),
        ("ball_x_s", None),
        ("position", None),
        ("v_x", None),
        ("a_y", None),
        ("vx", None),
        ("ball_vx_m_s", None),
        ("foot_sigma_m", None),
        ("leg_angle_deg", None),
        ("note", None),
        ("", None),
    ],
)
def test_headings_are_known_by_their_words(text, expected):
    assert read_heading(text) == expected


def test_units_of_headings_are_brought_to_si():
    found = table([["t (ms)", "ball x (cm)", "ball y (cm)"], *line(10, 100, 200)], points=("ball",))
    assert found.columns["t_s"][1] == pytest.approx(0.01)
    assert found.columns["ball_y_m"][1] == pytest.approx(2.0)


def test_pixels_stay_pixels():
    found = table([["frame", "ball_x_px", "ball_y_px"], *line(1, 3, 4)])
    assert set(found.columns) == {"frame", "ball_x_px", "ball_y_px"}


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["mass_a"], {}),
        (["Foot", "KNEE", "ball"], {"Foot": "foot", "KNEE": "knee", "ball": "ball"}),
        (["ball_1", "ball_2"], {"ball_1": "ball"}),
        (["knee_foot"], {}),
    ],
)
def test_points_are_matched_by_name_only(names, expected):
    assert match_points(names, POINTS) == expected


def test_an_empty_tracking_sheet_does_not_hide_the_table_beside_it():
    header = ["frame", "t_s", "ball_x_m", "ball_y_m"]
    found = table([header], **{"my data": [header, *line(1, 0.1, 2, 3)]})
    assert found.where == "my data"
    assert found.columns["ball_x_m"][1] == 2


def test_columns_that_contradict_each_other_are_flagged():
    header = ["t", "x_ball", "y_ball", "t"]
    assert table([header, *line(1, 2, 3, 1)]).flags == frozenset()
    assert table([header, *line(1, 2, 3, 4)]).flags == {"columns-twice"}
    twice = table([["t", "ball_x_m", "ball_y_m", "ball_x_cm", "ball_y_cm"], *line(1, 2, 3, 200, 300)])
    assert twice.flags == frozenset()


def test_what_stands_in_the_place_of_numbers_is_flagged():
    rows = line(1, 0.1, 2, 3)
    rows[2][2], rows[3][3], rows[4][2] = "lost", ("NA()", "#N/A"), True
    found = table([["frame", "t_s", "ball_x_m", "ball_y_m"], *rows])
    assert found.flags == {"text-in-tracking"}
    assert np.isnan([found.columns["ball_x_m"][2], found.columns["ball_y_m"][3], found.columns["ball_x_m"][4]]).all()


def test_x_without_y_is_no_position():
    assert table([["frame", "t_s", "ball_x_m", "note"], *line(1, 1, 1, 1)]).columns == {}


def test_positions_that_are_no_numbers_are_no_table():
    assert table([["frame", "ball_x_m", "ball_y_m"], [1, "a", "b"], [2, None, None]]).columns == {}


@given(st.text(max_size=60))
def test_any_text_has_a_heading_or_none(text):
    heading = read_heading(text)
    assert heading is None or (heading.role in {"frame", "step", "t", "x", "y"} and heading.factor > 0)

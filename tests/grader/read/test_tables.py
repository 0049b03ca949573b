"""Tracking tables of other programs, and of people in a hurry."""

from __future__ import annotations

from dataclasses import replace

import corpus
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.kind import Kind
from grader.read import BookCell, ReadRequest, read_workbook
from grader.read.headings import Heading, match_points, read_heading, read_headings
from grader.read.table import other_points, read_table

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


def test_numbers_and_notes_beside_a_pasted_text_stay_what_they_are():
    """A spreadsheet may have taken one line of a text for a number."""
    texts = [["xball;yball;t", "a;b"], *([f"{i},5;2,5;{i}", "note; of it"] for i in range(N)), [0.25]]
    found = table(texts, points=("ball",))
    assert found.columns["ball_x_m"].tolist() == [*(i + 0.5 for i in range(N)), 0.25]
    assert np.isnan(found.columns["ball_y_m"][-1])
    assert found.where == "Tracking"


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
        ("Frame no.", Heading("frame")),
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
        ("xball left", None),
        ("left foot y (pixels)", Heading("y", "left_foot", "px")),
        ("x", Heading("x")),
        ("y (ft)", Heading("y", "", "ft")),
        ("pos_x_ball", Heading("x", "ball")),
        ("x position ball", Heading("x", "ball")),
        ("pixelx", Heading("x", "", "px")),  # codespell:ignore
        ("pixel_y", Heading("y", "", "px")),
        ("ball_x_s", None),
        ("position", None),
        ("mass_a_x_m", Heading("x", "mass_a", "m")),
        ("x Point P (cm)", Heading("x", "point_p", "cm")),
        ("ball_a_x", None),
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


def test_a_point_of_two_words_is_matched_whatever_its_case():
    assert match_points(["Left_Foot", "knee"], ["LEFT_foot", "Knee"]) == {"Left_Foot": "LEFT_foot", "knee": "Knee"}


def test_a_point_too_many_does_no_harm():
    header = ["frame", "ball_x_m", "ball_y_m", "mass_c_x_m", "mass_c_y_m"]
    found = table([header, *line(1, 2, 3, 4, 5)], points=("ball",))
    assert (found.flags, found.unnamed) == (frozenset(), ())
    assert found.columns["mass_c_x_m"][1] == 4


def test_points_of_others_are_listed_in_order():
    columns = ["frame", "t_s", "ball_x_m", "mass_b_x_px", "mass_a_x_m", "mass_a_y_m"]
    assert other_points(columns, ["ball"]) == ["mass_a", "mass_b"]


@pytest.mark.parametrize(
    ("above", "point"),
    [
        ([], "point"),
        ([None, "Left foot"], "left_foot"),
        ([None, "--"], "point"),
        ([None, "n" * 41], "n" * 40),
        ([None, None, None, "right of them"], "point"),
    ],
)
def test_columns_without_a_name_have_the_one_above_them(above, point):
    found = table([above, ["t", "x", "y"], *line(1, 2, 3)], points=())
    assert set(found.columns) == {"t_s", f"{point}_x_m", f"{point}_y_m"}


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
    for difference, flags in ((5e-7, set()), (5e-6, {"columns-twice"})):
        assert table([header, *line(1, 2, 3, 1 + difference)]).flags == flags


def test_what_stands_in_the_place_of_numbers_is_flagged():
    rows = line(1, 0.1, 2, 3)
    rows[2][2], rows[3][3], rows[4][2] = "lost", ("NA()", "#N/A"), True
    found = table([["frame", "t_s", "ball_x_m", "ball_y_m"], *rows])
    assert found.flags == {"text-in-tracking"}
    assert np.isnan([found.columns["ball_x_m"][2], found.columns["ball_y_m"][3], found.columns["ball_x_m"][4]]).all()


@pytest.mark.parametrize(
    ("cell", "flag"),
    [
        ((("NA()"), "#N/A"), "text-in-tracking"),
        ("lost", "text-in-tracking"),
        (True, "text-in-tracking"),
        ("", None),
        (" ", None),
        (None, None),
    ],
)
def test_what_a_cell_holds_instead_of_a_number_is_told_apart(cell, flag):
    rows = line(1, 0.1, 2, 3)
    rows[3][2] = cell
    found = table([["frame", "t_s", "ball_x_m", "ball_y_m"], *rows])
    assert found.flags == ({flag} if flag else frozenset())
    assert np.isnan(found.columns["ball_x_m"][3])
    assert found.columns["frame"].size == N  # the row is kept: its y is there


@pytest.mark.parametrize(
    ("kind", "value", "flag"),
    [
        ("e", "#N/A", "errors-in-tracking"),
        ("d", "2026-05-01", "dates-in-tracking"),
        ("b", "1", "text-in-tracking"),
    ],
)
def test_errors_and_dates_have_flags_of_their_own(kind, value, flag):
    data = corpus.Dialect().write({"Tracking": [["frame", "t_s", "ball_x_m", "ball_y_m"], *line(1, 0.1, 2, 3)]})
    markup = corpus.members(data)["xl/worksheets/sheet1.xml"].decode()
    changed = markup.replace('<c r="C4" t="n"><v>4</v>', f'<c r="C4" t="{kind}"><v>{value}</v>')
    assert changed != markup
    book = read_workbook(ReadRequest("w", corpus.with_parts(data, **{"xl/worksheets/sheet1.xml": changed.encode()})))
    assert read_table(book, POINTS).flags == {flag}


def test_formulas_that_were_never_worked_out_have_a_flag_of_their_own():
    data = corpus.Dialect().write({"Tracking": [["frame", "t_s", "ball_x_m", "ball_y_m"], *line(1, 0.1, 2, 3)]})
    markup = corpus.members(data)["xl/worksheets/sheet1.xml"].decode()
    changed = markup.replace('<c r="C4" t="n"><v>4</v>', '<c r="C4"><f>A1</f>')
    book = read_workbook(ReadRequest("w", corpus.with_parts(data, **{"xl/worksheets/sheet1.xml": changed.encode()})))
    assert read_table(book, POINTS).flags == {"uncached-in-tracking"}


@pytest.mark.parametrize(("is_visible", "flags"), [(True, {"dates-in-tracking"}), (False, frozenset())])
def test_a_number_shown_as_a_date_is_none_and_a_hidden_sheet_no_table(is_visible, flags):
    data = corpus.Dialect().write({"Tracking": [["frame", "ball_x_m", "ball_y_m"], *line(1, 2, 3)]})
    book = read_workbook(ReadRequest("w", data))
    cells = {**book.sheets[0].cells, (3, 2): BookCell(Kind.DATE, 45413.0, "2024-05-01")}
    found = read_table(replace(book, sheets=(replace(book.sheets[0], cells=cells, is_visible=is_visible),)))
    assert (bool(found.columns), found.flags) == (is_visible, flags)


def test_rows_without_any_position_are_left_out():
    rows = line(1, 0.1, 2, 3)
    rows[2][2:] = [None, None]
    rows[5][2] = None
    found = table([["frame", "t_s", "ball_x_m", "ball_y_m"], *rows])
    assert found.columns["frame"].tolist() == [i for i in range(N) if i != 2]


def test_headings_are_looked_for_in_the_first_two_hundred_rows():
    grid = [["note"] for _ in range(199)]
    header = ["frame", "ball_x_m", "ball_y_m"]
    assert table([*grid, header, *line(1, 2, 3)]).columns
    assert not table([*grid, ["note"], header, *line(1, 2, 3)]).columns


def test_three_headings_are_the_least_and_the_row_with_most_counts():
    assert not table([["ball_x_m", "ball_y_m"], *line(1, 2)]).columns
    found = table([["t", "x_ball", "y_ball"], ["frame", "t", "x_ball", "y_ball"], *line(1, 2, 3, 4)])
    assert found.columns["ball_y_m"][1] == 4
    again = table([["t", "x_ball", "y_ball"], ["t", "x_foot", "y_foot"], *line(1, 2, 3)])
    assert set(again.columns) == {"t_s", "ball_x_m", "ball_y_m"}  # of two alike the upper one


def test_our_sheet_comes_first_then_the_classic_one_then_any():
    def grid(step):
        return [["frame", "t_s", "ball_x_m", "ball_y_m"], *line(1, 0.1, step, 0)]

    sheets = {"other": grid(1), "Data": grid(2), "TRACKING (2)": grid(3)}
    data = corpus.Dialect().write(sheets)
    assert read_table(read_workbook(ReadRequest("w", data))).columns["ball_x_m"][1] == 3
    del sheets["TRACKING (2)"]
    assert read_table(read_workbook(ReadRequest("w", corpus.Dialect().write(sheets)))).columns["ball_x_m"][1] == 2


def test_without_points_of_an_assignment_names_stay_and_none_is_missed():
    found = table([["frame", "mass_a_x_m", "mass_a_y_m"], *line(1, 2, 3)], points=())
    assert set(found.columns) == {"frame", "mass_a_x_m", "mass_a_y_m"}
    assert (found.flags, found.unnamed) == (frozenset(), ())


def test_the_one_point_of_an_assignment_is_meant_whatever_it_is_called():
    found = table([["frame", "mass_a_x_px", "mass_a_y_px"], *line(1, 2, 3)], points=("ball",))
    assert set(found.columns) == {"frame", "ball_x_px", "ball_y_px"}
    assert found.flags == frozenset()


@pytest.mark.parametrize(
    ("text", "number"), [("1,5", 1.5), ("-0,25", -0.25), ("−3,75", -3.75), ("0,125", 0.125), ("2,1234", 2.1234)]
)
def test_decimal_commas_are_understood_where_one_is_certain(text, number):
    rows = [[i, i, text, "4,5"] for i in range(N)]
    found = table([["frame", "t_s", "ball_x_m", "ball_y_m"], *rows])
    assert found.columns["ball_x_m"].tolist() == [number] * N
    assert found.flags == frozenset()


def test_commas_and_points_in_one_table_are_not_guessed():
    rows = [[i, i, "1,234", "4.5"] for i in range(N)] + [[N, N, "1,5", 1.0]]
    found = table([["frame", "t_s", "ball_x_m", "ball_y_m"], *rows])
    assert np.isnan(found.columns["ball_x_m"][0])
    assert found.flags == {"text-in-tracking"}


def test_a_pair_is_kept_where_nothing_else_stands():
    assert set(read_headings({1: "ball x", 2: "ball y"}, {})) == {1, 2}


def test_one_axis_alone_is_left_out():
    header = ["frame", "ball_x_m", "ball_y_m", "foot_x_m", "knee_y_m"]
    assert set(table([header, *line(1, 2, 3, 4, 5)]).columns) == {"frame", "ball_x_m", "ball_y_m"}


def test_numbers_or_clocks_alone_are_no_table_and_hide_none():
    assert table(line(1, 2, 3)).columns == {}
    pasted = [["t;x;y"], *([f"{i};{i};{i}"] for i in range(N))]
    assert set(table([["frame", "step", "t"], [], *pasted], points=()).columns) == {"t_s", "point_x_m", "point_y_m"}


def test_a_long_heading_is_cut():
    header = ["frame", "x_" + "n" * 79, "y_" + "n" * 79]
    assert set(table([header, *line(1, 2, 3)], points=()).columns) == {"frame", f"{'n' * 78}_x_m", f"{'n' * 78}_y_m"}


def test_x_without_y_is_no_position():
    assert table([["frame", "t_s", "ball_x_m", "note"], *line(1, 1, 1, 1)]).columns == {}


def test_positions_that_are_no_numbers_are_no_table():
    assert table([["frame", "ball_x_m", "ball_y_m"], [1, "a", "b"], [2, None, None]]).columns == {}


@given(st.text(max_size=60))
def test_any_text_has_a_heading_or_none(text):
    heading = read_heading(text)
    assert heading is None or (heading.role in {"frame", "step", "t", "x", "y"} and heading.factor > 0)

import json
from pathlib import Path

import numpy as np
import pytest

from vml_course import cli
from vml_course.errors import InputError, UnitError, UnknownNameError
from vml_course.usecases.solve_table import read_given

GIVEN = ["-g", "m=0.5kg", "-g", "L=0.56 m"]


def _kick_csv(folder: Path, knee: bool = True, unit: str = "m") -> Path:
    """Write a kick with 15 -> 13 m/s and a ball 0 -> 24 m/s, without gravity: exact in closed form."""
    time = np.arange(60) / 480
    s = time - 0.0603
    angle = -np.pi / 2 + np.where(s <= 0, 15, 13) / 0.56 * s
    ball = np.stack([0.1 + 24 * np.clip(s, 0, None), -0.56 + 0 * s], axis=1)
    foot = 0.56 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = {"foot": foot, "knee": 0 * foot, "ball": ball} if knee else {"foot": foot, "ball": ball}
    header = ["frame", "t_s", *(f"{name}_{axis}_{unit}" for name in points for axis in "xy")]
    rows = np.column_stack([np.arange(60) + 400, time, *points.values()])
    path = folder / "kick.csv"
    text = "\n".join(",".join(f"{number:.12g}" for number in row) for row in rows)
    path.write_text(",".join(header) + "\n" + text + "\n", encoding="utf-8")
    return path


def test_json_has_both_methods_with_values_and_units(tmp_path, capsys):
    assert cli.run(["solve", str(_kick_csv(tmp_path)), *GIVEN, "--gravity", "0 m/s^2", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["e"]["value"] == pytest.approx(11 / 15, rel=1e-6)
    assert found["I"]["value"] == pytest.approx(1.8816, rel=1e-5)
    assert found["I"]["sd"] == pytest.approx(0.0094, rel=0.02)
    assert found["I"]["unit"] == "kg m^2"
    assert found["method"] == "joint"
    assert found["frame_before"] == 428
    assert found["lines"]["e"]["value"] == pytest.approx(11 / 15, rel=1e-6)
    assert found["lines"]["correlation_e_I"] is None
    assert found["notes"] == []


def test_the_table_shows_values_with_their_uncertainty(tmp_path, capsys):
    assert cli.run(["solve", str(_kick_csv(tmp_path)), *GIVEN, "--gravity", "0 m/s^2"]) == 0
    shown = capsys.readouterr().out
    assert "0.7333 ± 0.0022" in shown
    assert "1.8816 ± 0.0094" in shown


def test_without_a_knee_the_reference_still_solves_and_says_why_lines_do_not(tmp_path, capsys):
    path = _kick_csv(tmp_path, knee=False)
    assert cli.run(["solve", str(path), *GIVEN, "--gravity", "0 m/s^2"]) == 0
    assert "note: no solution by lines: point: expected one of foot, ball, got 'knee'" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "given m: expected a mass, got nothing. Give it with -g m=0.5kg."),
        (["-g", "m=0.5"], "given m: expected a unit after the number (kg, g, lb), got none."),
        (["-g", "m"], "-g: expected symbol=number unit, such as m=0.5kg, got 'm'."),
        (
            [*GIVEN, "--model", "loose"],
            (
                "model: expected one of ballistic-pendulum, fixed-pivot, free-rod, hammer-block, spin-bounce, "
                "two-pucks, got 'loose'."
            ),
        ),
        ([*GIVEN, "--window", "40"], "--window: expected a unit after the number (s, ms), got none."),
    ],
)
def test_wrong_input_is_one_line_and_exit_code_2(tmp_path, capsys, arguments, line):
    assert cli.run(["solve", str(_kick_csv(tmp_path)), *arguments]) == 2
    assert capsys.readouterr().err == line + "\n"


def test_pixels_without_a_scale_are_refused(tmp_path, capsys):
    assert cli.run(["solve", str(_kick_csv(tmp_path, unit="px")), *GIVEN]) == 2
    assert "pixels only" in capsys.readouterr().err


def test_given_numbers_bring_their_uncertainty():
    given, given_sd = read_given(["m=500 g ± 2 %", "L = 56cm"])
    assert given == {"m": pytest.approx(0.5), "L": pytest.approx(0.56)}
    assert given_sd == {"m": pytest.approx(0.01)}


@pytest.mark.parametrize(("text", "error"), [("m:0.5kg", InputError), ("x=1m", UnknownNameError), ("L=2kg", UnitError)])
def test_given_numbers_that_make_no_sense_are_refused(text, error):
    with pytest.raises(error):
        read_given([text])


@pytest.mark.parametrize("ending", ["svg", "png"])
def test_a_plot_is_written_beside_the_numbers(tmp_path, capsys, ending):
    plot = tmp_path / f"kick.{ending}"
    assert cli.run(["solve", str(_kick_csv(tmp_path)), *GIVEN, "--gravity", "0 m/s^2", "--plot", str(plot)]) == 0
    assert "0.7333" in capsys.readouterr().out
    if ending == "svg":
        shown = plot.read_text("utf-8")
        for words in ("e = 0.7333", "ball, along the blow", "angle of foot about the pivot", "residual", "impact"):
            assert words in shown
    else:
        assert plot.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--plot", "kick.pdf"], "ends in .svg or .png"),
        (["--plot", "kick.svg", "--method", "lines"], "a joint solution"),
    ],
)
def test_a_plot_that_cannot_be_is_refused_and_nothing_is_left(tmp_path, capsys, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    table = _kick_csv(tmp_path)
    assert cli.run(["solve", str(table), *GIVEN, "--gravity", "0 m/s^2", *arguments]) == 2
    assert words in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [table]


def test_lines_are_for_pivoted_bodies_only(tmp_path, capsys):
    table = _kick_csv(tmp_path)
    given = ["-g", "m=0.5kg", "--striker", "foot", "--struck", "ball", "--gravity", "0 m/s^2", "--flight", "never"]
    assert cli.run(["solve", str(table), *given, "--model", "two-pucks", "--method", "lines"]) == 2
    assert "lines being for fixed-pivot and hammer-block" in capsys.readouterr().err


def test_another_model_shows_its_own_symbols(tmp_path, capsys):
    time = np.arange(60) / 480
    s = (time - 0.0603)[:, None]
    a = [0.1, 0.2] + np.where(s <= 0, [2.0, 0.5], [0.4, 0.5]) * s  # equal pucks along x, e = 0.6
    b = [0.2, 0.2] + np.where(s <= 0, [0.0, 0.0], [1.6, 0.0]) * s
    rows = np.column_stack([np.arange(60), time, a, b])
    header = "frame,t_s,one_x_m,one_y_m,two_x_m,two_y_m\n"
    table = tmp_path / "pucks.csv"
    table.write_text(header + "\n".join(",".join(f"{x:.12g}" for x in row) for row in rows) + "\n", encoding="utf-8")
    arguments = [
        "--model",
        "two-pucks",
        "-g",
        "m=0.2 kg",
        "--striker",
        "one",
        "--struck",
        "two",
        "--gravity",
        "0 m/s^2",
    ]
    assert cli.run(["solve", str(table), *arguments, "--flight", "never", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["e"]["value"] == pytest.approx(0.6, rel=1e-6)
    assert found["M"]["value"] == pytest.approx(0.2, rel=1e-6)
    assert "lines" not in found


def test_a_picture_that_is_shown_twice_is_told(tmp_path, capsys):
    table = _kick_csv(tmp_path)
    rows = table.read_text("utf-8").splitlines()
    old, new = rows[11].split(","), rows[12].split(",")
    rows[12] = ",".join([*new[:2], *old[2:]])
    table.write_text("\n".join(rows) + "\n", encoding="utf-8")
    cli.run(["solve", str(table), *GIVEN, "--gravity", "0 m/s^2"])
    assert "note: frames 411 show the picture before once more" in capsys.readouterr().out


@pytest.mark.parametrize("ending", ["svg", "png"])
def test_a_free_body_diagram_is_written_with_the_numbers_on_it(tmp_path, capsys, ending):
    path = tmp_path / f"forces.{ending}"
    more = ["--gravity", "0", "--diagram", str(path), "--contact", "10ms", "-g", "M=4kg", "-g", "c=0.25m"]
    assert cli.run(["solve", str(_kick_csv(tmp_path)), *GIVEN, *more]) == 0
    assert "0.7333" in capsys.readouterr().out
    if ending == "svg":
        shown = path.read_text("utf-8")
        for words in ("impulse J", "mean force", "pin reaction R", "J = 12 N s", "1200"):
            assert words in shown
    else:
        assert path.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ["--model", "spin-bounce"],
            "--diagram: expected an impact of two bodies (fixed-pivot, hammer-block, free-rod",
        ),
        (["--method", "lines"], "--diagram: expected a joint solution"),
        (["--contact", "3 s"], "contact time"),
        (["--contact", "3"], "--contact: expected a unit"),
    ],
)
def test_a_diagram_that_cannot_be_is_refused_and_nothing_is_left(tmp_path, capsys, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    table = _kick_csv(tmp_path)
    more = ["--gravity", "0", "--diagram", "forces.svg", *arguments]
    assert cli.run(["solve", str(table), *GIVEN, *more]) == 2
    assert words in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [table]


def test_a_model_knows_the_usual_names_and_view_of_its_scene(tmp_path, capsys):
    time = np.arange(60) / 480
    s = (time - 0.0603)[:, None]
    a = [0.1, 0.2] + np.where(s <= 0, [2.0, 0.5], [0.4, 0.5]) * s
    b = [0.2, 0.2] + np.where(s <= 0, [0.0, 0.0], [1.6, 0.0]) * s
    rows = np.column_stack([np.arange(60), time, a, b])
    header = "frame,t_s,puck_a_x_m,puck_a_y_m,puck_b_x_m,puck_b_y_m\n"
    table = tmp_path / "pucks.csv"
    table.write_text(header + "\n".join(",".join(f"{x:.12g}" for x in row) for row in rows) + "\n", encoding="utf-8")
    more = ["--json", "--diagram", str(tmp_path / "forces.svg")]
    assert cli.run(["solve", str(table), "--model", "two-pucks", "-g", "m=0.2 kg", *more]) == 0
    assert (tmp_path / "forces.svg").read_text("utf-8").count(">J = 0.32 N s<") == 2
    found = json.loads(capsys.readouterr().out)
    assert found["e"]["value"] == pytest.approx(0.6, rel=1e-6)
    assert found["v_a1"]["unit"] == "m/s"

"""The main path at the prompt: render, track from the file, solve; held against the truth that was rendered."""

import csv
import json

import numpy as np
import pytest

from vml_course.cli import run

TRACKING_PX = 0.05  # RMS of the distance from the truth, every point, before and after the impact
E_SHARE, I_SHARE = 0.01, 0.03
STUDENT_E_SHARE, STUDENT_I_SHARE = 0.02, 0.05
POINTS = ("foot", "knee", "shin", "ball")


def columns_of(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    return {
        name: np.array([float(row[name] or "nan") for row in rows if "status" not in name])
        for name in rows[0]
        if "status" not in name
    }


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kick")
    assert run(["render", "soccer_kick", "-o", str(folder)]) == 0
    truth, known = columns_of(folder / "truth.csv"), json.loads((folder / "truth.json").read_text("utf-8"))
    seeds = [f"{p}={truth[f'{p}_x_px'][0]:.2f},{truth[f'{p}_y_px'][0]:.2f}" for p in POINTS]
    camera, marks = known["camera"], known["marks_m"]
    bar = [
        (camera["origin_x_px"] + x * camera["px_per_m"], camera["origin_y_px"] - y * camera["px_per_m"])
        for x, y in (marks["bar_left"], marks["bar_right"])
    ]
    scale = ",".join(f"{value:.2f}" for end in bar for value in end) + "=1 m"
    options = [option for seed in seeds for option in ("-p", seed)]
    outputs = [option for kind in ("csv", "xlsx", "mat") for option in ("-o", str(folder / f"track.{kind}"))]
    video = str(folder / "video.mp4")
    assert run(["track", video, *options, "--scale", scale, "--vector", "leg=knee:foot", *outputs]) == 0
    return folder, truth, known


@pytest.mark.parametrize("point", POINTS)
def test_every_point_is_tracked_to_the_truth_before_and_after_the_impact(measured, point):
    folder, truth, known = measured
    found, before = columns_of(folder / "track.csv"), known["impact"]["frame_before"] + 1
    away = np.hypot(*(found[f"{point}_{axis}_px"] - truth[f"{point}_{axis}_px"] for axis in "xy"))
    for side in (away[:before], away[before:]):
        assert np.sqrt(np.mean(side**2)) <= TRACKING_PX


@pytest.mark.parametrize("kind", ["csv", "xlsx", "mat"])
@pytest.mark.parametrize("drive", ["free", "none"])
def test_e_and_i_come_back_from_every_kind_of_table(measured, capsys, kind, drive):
    folder, _, known = measured
    true = {symbol: real["from_states"] for symbol, real in known["impact"]["unknowns"].items()}
    table, given = str(folder / f"track.{kind}"), ["-g", "m=0.5kg", "-g", "L=0.56m"]
    capsys.readouterr()
    assert run(["solve", table, "--model", "fixed-pivot", *given, "--drive", drive, "--json"]) == 0
    solved = json.loads(capsys.readouterr().out)
    assert solved["e"]["value"] == pytest.approx(true["e"], rel=E_SHARE)
    assert solved["I"]["value"] == pytest.approx(true["I"], rel=I_SHARE)
    assert solved["I"]["unit"] == "kg m^2"
    assert solved["lines"]["e"]["value"] == pytest.approx(true["e"], rel=STUDENT_E_SHARE)
    assert solved["lines"]["I"]["value"] == pytest.approx(true["I"], rel=STUDENT_I_SHARE)


def test_the_leg_vector_keeps_its_length(measured):
    folder, _, _ = measured
    assert np.abs(columns_of(folder / "track.csv")["leg_dlength_pct"]).max() < 0.1


def test_the_track_table_begins_with_frame_step_and_time(measured):
    folder, _, _ = measured
    assert (folder / "track.csv").read_text("utf-8-sig").startswith("frame,step,t_s")


def test_truth_columns_are_those_that_were_promised(measured):
    _, truth, _ = measured
    of_point = ("x_px", "y_px", "x_m", "y_m")
    assert list(truth) == ["frame", "t_s", *(f"{p}_{c}" for p in POINTS for c in of_point), "leg_angle_deg"]

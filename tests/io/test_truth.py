"""Truth files keep every digit, or say what is wrong with them."""

import json
from dataclasses import fields

import numpy as np
import pytest

from vml_course.errors import FileMissingError, TableError
from vml_course.io.truth import read_truth_csv, read_truth_json, write_truth_csv, write_truth_json
from vml_course.model.camera import Camera
from vml_course.model.truth import Check, ImpactTruth, Truth


@pytest.fixture
def truth():
    frames = 3
    numbers = {item.name: 0.1 * k for k, item in enumerate(fields(ImpactTruth), start=1)}
    pairs = ("contact_m", "normal", "struck_before_m_s", "struck_after_m_s")
    impact = ImpactTruth(**numbers | {name: np.array([1 / 3, 2 / 3]) for name in pairs} | {"frame_before": 1})
    return Truth(
        scene="soccer_kick",
        parameters={"restitution": 11 / 15},
        camera=Camera(fps=240),
        time_s=np.arange(frames) / 240,
        bodies=("leg", "ball"),
        pose=np.arange(frames * 6).reshape(frames, 2, 3) / 7,
        points=("foot", "ball"),
        xy_m=np.arange(frames * 4).reshape(frames, 2, 2) / 9,
        leg_angle_rad=np.array([-2.0, -1.5, -1.0]),
        marks_m={"bar_left": (-0.25, -0.82)},
        impact=impact,
        checks=(Check("impulse", 1e-9, 1e-3),),
        versions={"pymunk": "7"},
        model="fixed-pivot",
        given={"m": 0.5},
        seed=3,
    )


def test_json_gives_back_every_digit(tmp_path, truth):
    write_truth_json(tmp_path / "truth.json", truth)
    back = read_truth_json(tmp_path / "truth.json")
    for name in ("scene", "parameters", "camera", "bodies", "points", "marks_m", "checks", "given", "seed", "versions"):
        assert getattr(back, name) == getattr(truth, name)
    for name in ("time_s", "pose", "xy_m", "leg_angle_rad", "xy_px"):
        assert np.array_equal(getattr(back, name), getattr(truth, name))
    for item in fields(ImpactTruth):
        assert np.array_equal(getattr(back.impact, item.name), getattr(truth.impact, item.name))


def test_csv_has_exactly_the_columns_that_are_documented(tmp_path, truth):
    write_truth_csv(tmp_path / "truth.csv", truth)
    header = (tmp_path / "truth.csv").read_text().splitlines()[0]
    assert header == (
        "frame,t_s,foot_x_px,foot_y_px,foot_x_m,foot_y_m,ball_x_px,ball_y_px,ball_x_m,ball_y_m,leg_angle_deg"
    )


def test_csv_gives_back_the_numbers(tmp_path, truth):
    write_truth_csv(tmp_path / "truth.csv", truth)
    table = read_truth_csv(tmp_path / "truth.csv")
    assert table["frame"].tolist() == [0, 1, 2]
    assert table["ball_x_px"] == pytest.approx(truth.xy_px[:, 1, 0], rel=1e-8)
    assert table["ball_y_m"] == pytest.approx(truth.xy_m[:, 1, 1], rel=1e-8)
    assert table["leg_angle_deg"] == pytest.approx(truth.leg_angle_deg, rel=1e-8)


def test_nothing_but_the_file_is_left_in_the_folder(tmp_path, truth):
    write_truth_json(tmp_path / "truth.json", truth)
    write_truth_csv(tmp_path / "truth.csv", truth)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["truth.csv", "truth.json"]


@pytest.mark.parametrize("read", [read_truth_json, read_truth_csv])
def test_a_missing_file_is_told(tmp_path, read):
    with pytest.raises(FileMissingError, match="nowhere"):
        read(tmp_path / "nowhere")


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", json.dumps({"format": "vml-truth 99"})])
def test_a_file_that_is_no_truth_is_told(tmp_path, text):
    (tmp_path / "truth.json").write_text(text)
    with pytest.raises(TableError, match=r"truth\.json: expected a truth file"):
        read_truth_json(tmp_path / "truth.json")


@pytest.mark.parametrize("text", ["", "a,b\n1,2\n", "frame,t_s\n0,soon\n", "frame,t_s\n0\n"])
def test_a_table_that_is_no_truth_is_told(tmp_path, text):
    (tmp_path / "truth.csv").write_text(text)
    with pytest.raises(TableError, match=r"truth\.csv: expected"):
        read_truth_csv(tmp_path / "truth.csv")

"""Truth files keep every digit, or say what is wrong with them."""

import json
from dataclasses import fields, replace

import numpy as np
import pytest

from vml_course.errors import FileMissingError, InputError, TableError, UnknownNameError
from vml_course.io.truth import read_truth_csv, read_truth_json, write_truth_csv, write_truth_json
from vml_course.model.camera import Camera
from vml_course.model.strained import StrainTruth
from vml_course.model.truth import Check, ImpactTruth, Realised, Truth


@pytest.fixture
def truth():
    frames = 3
    impact = ImpactTruth(
        time_s=0.1,
        frame_before=1,
        contact_m=np.array([1 / 3, 2 / 3]),
        normal=np.array([0.6, 0.8]),
        arm_m=0.7,
        impulse_xy_N_s=np.array([1 / 7, 2 / 7]),
        before=np.arange(6).reshape(2, 3) / 11,
        after=np.arange(6).reshape(2, 3) / 13,
        mass=np.array([[0.0, 0.0, 1.8816], [0.5, 0.5, 0.004]]),
        striker=0,
        struck=1,
        unknowns={"e": Realised(11 / 15, 0.7333, 0.73), "I": Realised(1.8816, 1.88, 1.9)},
    )
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
        declared={"striker": "foot", "gravity_m_s2": 0.0},
    )


def test_json_gives_back_every_digit(tmp_path, truth):
    write_truth_json(tmp_path / "truth.json", truth)
    back = read_truth_json(tmp_path / "truth.json")
    for name in (
        "scene",
        "parameters",
        "camera",
        "bodies",
        "points",
        "marks_m",
        "checks",
        "given",
        "declared",
        "versions",
    ):
        assert getattr(back, name) == getattr(truth, name)
    for name in ("time_s", "pose", "xy_m", "leg_angle_rad", "xy_px"):
        assert np.array_equal(getattr(back, name), getattr(truth, name))
    for item in fields(ImpactTruth):
        assert np.array_equal(getattr(back.impact, item.name), getattr(truth.impact, item.name))


def test_a_strained_body_is_read_back_with_every_digit(tmp_path, truth):
    gradient = np.arange(24).reshape(3, 2, 2, 2) / 700
    strained = replace(truth, impact=None, strain=StrainTruth(np.array([0, 0.5, 1]), gradient, {"nu": 1 / 3}))
    write_truth_json(tmp_path / "truth.json", strained)
    back = read_truth_json(tmp_path / "truth.json")
    assert back.impact is None
    assert back.strain.unknown("nu") == 1 / 3
    for name in ("load", "gradient", "green_strain"):
        assert np.array_equal(getattr(back.strain, name), getattr(strained.strain, name))
    with pytest.raises(UnknownNameError, match="unknown: expected one of nu, got 'e'"):
        back.strain.unknown("e")
    with pytest.raises(InputError, match=r"soccer_kick: expected a scene with an impact, got one without\."):
        _ = back.met


def test_a_truth_from_before_there_were_strains_is_still_read(tmp_path, truth):
    write_truth_json(tmp_path / "truth.json", truth)
    document = json.loads((tmp_path / "truth.json").read_text())
    assert document.pop("strain") is None
    (tmp_path / "truth.json").write_text(json.dumps(document))
    assert read_truth_json(tmp_path / "truth.json").met.unknowns == truth.met.unknowns


def test_a_scene_whose_bodies_do_not_turn_has_no_angle(tmp_path, truth):
    flat = replace(truth, leg_angle_rad=np.zeros(0))
    write_truth_json(tmp_path / "truth.json", flat)
    write_truth_csv(tmp_path / "truth.csv", flat)
    assert read_truth_json(tmp_path / "truth.json").leg_angle_rad.shape == (0,)
    assert list(read_truth_csv(tmp_path / "truth.csv"))[-1] == "ball_y_m"


def test_the_pinned_names_are_read_from_states_and_unknowns(truth):
    impact = truth.impact
    assert (impact.restitution, impact.inertia_kg_m2, impact.struck_mass_kg) == (11 / 15, 1.8816, 0.5)
    assert (impact.omega_before_rad_s, impact.omega_after_rad_s) == (2 / 11, 2 / 13)
    assert impact.impulse_N_s == pytest.approx(0.6 / 7 + 1.6 / 7)
    assert impact.impulse_tangent_N_s == pytest.approx(1.2 / 7 - 0.8 / 7)
    with pytest.raises(UnknownNameError, match="unknown: expected one of I, e, got 'mu'"):
        impact.unknown("mu")


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

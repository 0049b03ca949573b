"""`vml render` at the prompt."""

import json

import pytest

from vml_course.cli import run
from vml_course.model.quantity import quantities_of
from vml_course.synth.scene import scene_class, scene_names

SMALL = [
    part
    for text in ("fps=240", "width_px=640", "height_px=360", "px_per_m=250", "origin_x_px=210", "origin_y_px=100")
    for part in ("--set", text)
]


def test_it_writes_three_files_and_says_so(tmp_path, capsys):
    assert run(["render", "soccer_kick", *SMALL, "--set", "e=11/15", "-o", str(tmp_path / "kick")]) == 0
    said = capsys.readouterr().out
    for name in ("video.mp4", "truth.json", "truth.csv"):
        assert (tmp_path / "kick" / name).stat().st_size > 0
        assert name in said
    assert "e = 0.7333" in said


def test_json_is_all_that_goes_to_standard_output(tmp_path, capsys):
    assert run(["render", "soccer_kick", *SMALL, "--format", "avi", "--json", "-o", str(tmp_path)]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["video"].endswith("video.avi")
    assert facts["I"] == pytest.approx(1.8816)


def test_a_strained_body_is_told_by_its_strain(tmp_path, capsys):
    small = ["width_px=768", "height_px=320", "px_per_m=3000", "origin_x_px=384", "origin_y_px=130", "eps=0.03"]
    arguments = ["render", "tensile_strip", *(part for text in small for part in ("--set", text)), "-o", str(tmp_path)]
    assert run(arguments) == 0
    assert "eps = 0.03, nu = 0.38, strain of the marks up to 3.05 %, full load from frame 30" in capsys.readouterr().out
    assert run([*arguments, "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["nu"], facts["full_load_frame"]) == (0.38, 30)
    assert "impact_time_s" not in facts


def test_parameters_are_listed_with_unit_range_and_meaning(capsys):
    assert run(["render", "soccer_kick", "--parameters"]) == 0
    said = capsys.readouterr().out
    for word in ("omega_before_rad_s", "omega1", "3 to 60 rad/s", "noise_grey", "format"):
        assert word in said


def test_help_lists_the_scenes_and_an_example(capsys):
    assert run(["render", "--help"]) == 0
    said = capsys.readouterr().out
    assert "A leg that swings about the knee kicks a football" in said
    assert "vml render soccer_kick --set" in said


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["render", "socer", "-o", "x"], "scene: expected one of"),
        (["render", "soccer_kick"], "--out: expected a folder"),
        (["render", "soccer_kick", "--set", "e=2", "-o", "x"], "restitution (e): expected 0.05 to 1, got 2."),
        (["render", "soccer_kick", "--set", "q=2", "-o", "x"], "--set q: expected one of"),
        (["render", "soccer_kick", "--set", "px_per_m=900", "-o", "x"], "soccer_kick: expected an honest impact"),
        (["render", "tensile_strip", "--set", "shutter=0.5", "-o", "x"], "shutter: expected 0 in tensile_strip"),
        (["render", "plate_with_hole", "--set", "S=1e9", "-o", "x"], "stress_Pa (S): expected 2e+06 to 4e+07 Pa"),
        (["render", "hammer_block", "--set", "m=-1", "-o", "x"], "block_mass_kg (m): expected 0.3 to 5 kg, got -1 kg."),
        (["render", "bat_and_ball", "--set", "v=40", "-o", "x"], "ball outside the picture, px is"),
        (["render", "two_pucks", "--set", "v=0.3", "--set", "normal_deg=60", "--set", "drift_m_s=1", "-o", "x"], "hit"),
    ],
)
def test_a_mistake_is_one_line_and_exit_code_2(arguments, words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    said = capsys.readouterr().err.strip()
    assert words in said
    assert "\n" not in said
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", scene_names())
def test_every_scene_refuses_in_one_line_and_leaves_no_folder(name, capsys, tmp_path):
    mass = next((item for item in quantities_of(scene_class(name)).values() if item.unit == "kg"), None)
    wrong = [
        ("origin_x_px=-3900", "outside the picture, px is "),
        ("width_px=641", "width_px: expected an even number of pixels"),
        ("background=beach", "background: expected one of "),
        *(
            [(f"{mass.name}=-1", f"{mass.name} ({mass.symbol}): expected {mass.range_text}, got -1 kg.")]
            if mass
            else []
        ),
        *([("e=1.01", "restitution (e): expected 0.05 to 1, got 1.01.")] if "e" in scene_class(name).unknowns else []),
    ]
    for text, words in wrong:
        assert run(["render", name, "--set", text, "-o", str(tmp_path / "deep" / "clip")]) == 2
        said = capsys.readouterr().err.strip()
        assert words in said
        assert "\n" not in said
        assert not list(tmp_path.iterdir())

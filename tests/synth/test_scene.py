"""The registry of scenes and what `--set` understands."""

import pkgutil
import subprocess
import sys
from dataclasses import fields

import pytest

from vml_course.errors import InputError, NumberError, OutOfRangeError, UnknownNameError
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.model.quantity import quantities_of
from vml_course.synth import looks
from vml_course.synth.scene import scene_class, scene_names
from vml_course.synth.settings import make_settings, read_settings, settable
from vml_course.synth.simulate import simulate

MARKS = ("striker", "struck", "knee", "striker_mark", "struck_mark")


@pytest.mark.parametrize("name", scene_names())
def test_every_scene_is_honest_with_its_defaults(name):
    kind = scene_class(name)
    truth = simulate(kind(), kind.default_camera, seed=0)
    assert truth.scene == name == kind.name
    assert set(getattr(kind, "vector", None) or ()) <= set(truth.points)
    assert set((truth.impact or truth.strain).unknowns) <= set(kind.unknowns)
    assert set(truth.declared) <= {item.name for item in fields(ImpactOptions)} | set(MARKS)
    assert {str(value) for word, value in truth.declared.items() if word in MARKS} <= set(truth.points)
    assert all(item.about for item in quantities_of(kind).values())


def test_every_scene_has_a_file_that_draws_it_and_nothing_else_is_drawn():
    assert tuple(sorted(item.name for item in pkgutil.iter_modules(looks.__path__))) == scene_names()


def test_an_unknown_scene_is_told_with_those_that_exist():
    with pytest.raises(UnknownNameError, match=r"scene: expected one of .*soccer_kick.*, got 'socer'"):
        scene_class("socer")


def test_a_file_dropped_into_the_folder_is_a_scene(tmp_path):
    """Tried in a process of its own, with a second folder on the package's path."""
    (tmp_path / "toe_poke.py").write_text(
        "from dataclasses import dataclass\n"
        "from typing import ClassVar\n"
        "from vml_course.synth.scenes.soccer_kick import SoccerKick\n"
        "@dataclass(frozen=True)\n"
        "class ToePoke(SoccerKick):\n"
        "    name: ClassVar[str] = 'toe_poke'\n"
        "    title: ClassVar[str] = 'A poke with the toe'\n"
    )
    assert "A poke with the toe" in _vml_with(tmp_path, "render", "--help")
    _vml_with(tmp_path, "render", "toe_poke", "-o", str(tmp_path / "film"), "--set", "fps=120")  # drawn as a kick is
    assert (tmp_path / "film" / "video.mp4").is_file()


def test_a_scenes_own_file_may_draw_it_too(tmp_path):
    (tmp_path / "dark_poke.py").write_text(
        "from dataclasses import dataclass\n"
        "from typing import ClassVar\n"
        "from vml_course.synth.looks import soccer_kick\n"
        "from vml_course.synth.scenes.soccer_kick import SoccerKick\n"
        "@dataclass(frozen=True)\n"
        "class DarkPoke(SoccerKick):\n"
        "    name: ClassVar[str] = 'dark_poke'\n"
        "    title: ClassVar[str] = 'A poke in the dark'\n"
        "def look(scene, camera, seed):\n"
        "    print('drawn by its own file')\n"
        "    return soccer_kick.look(scene, camera, seed)\n"
    )
    film = ["render", "dark_poke", "-o", str(tmp_path / "film"), "--set", "fps=120"]
    assert "drawn by its own file" in _vml_with(tmp_path, *film)


def _vml_with(folder, *words: str) -> str:
    """Run `vml` with the scenes of another folder beside its own."""
    code = (
        f"import vml_course.synth.scenes as s; s.__path__.append({str(folder)!r})\n"
        f"from vml_course.cli import main; main({list(words)!r})"
    )
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_values_are_set_by_name_or_symbol_on_scene_camera_and_recording():
    made = read_settings("soccer_kick", ["e=11/15", "ball_mass_kg=0.45", "fps=240", "crf=20", "format=avi"])
    assert made.scene.restitution == 11 / 15
    assert made.scene.ball_mass_kg == 0.45
    assert made.camera.fps == 240
    assert (made.recording.crf, made.recording.format) == (20, "avi")


def test_a_variants_mapping_makes_the_same_settings():
    assert make_settings("soccer_kick", {"e": 0.5, "fps": 240}) == read_settings("soccer_kick", ["e=0.5", "fps=240"])


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ("zeta=1", UnknownNameError, "zeta: expected one of .*restitution"),
        ("e", InputError, "--set: expected NAME=VALUE"),
        ("e=fast", NumberError, "e: expected"),
        ("e=1/0", NumberError, "e: expected"),
        ("e=1.5", OutOfRangeError, r"restitution \(e\): expected 0.05 to 1, got 1.5"),
        ("m=0", OutOfRangeError, r"ball_mass_kg \(m\): expected 0.05 to 2 kg"),
        ("format=gif", UnknownNameError, "format: expected one of mp4, avi"),
        ("width_px=641", InputError, "width_px: expected an even number"),
    ],
)
def test_what_cannot_be_set_is_told_in_one_line(text, error, words):
    with pytest.raises(error, match=words) as caught:
        read_settings("soccer_kick", [text])
    assert "\n" not in str(caught.value)


def test_a_name_and_its_symbol_may_not_both_be_set():
    with pytest.raises(InputError, match="one value"):
        read_settings("soccer_kick", ["e=0.5", "restitution=0.6"])


def test_what_can_be_set_has_units_ranges_and_meanings():
    known = settable("soccer_kick")
    assert known["inertia_kg_m2"].symbol == "I"
    assert known["inertia_kg_m2"].unit == "kg m^2"
    assert all(item.about and item.low <= item.default <= item.high for item in known.values())

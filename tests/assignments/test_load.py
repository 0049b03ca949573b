"""An assignment's file: what is right loads, what is wrong is named with its key."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from assignments.errors import AssignmentFileError
from assignments.load import FILE, assignment_ids, catalogue, load_assignment, load_folder
from vml_course.errors import UnknownNameError

Edit = Callable[[str, str], Path]


@pytest.fixture
def edited(tmp_path: Path) -> Edit:
    """Return a copy of the kick with one passage replaced."""

    def edit(old: str, new: str) -> Path:
        folder = tmp_path / "my-kick"
        shutil.copytree(catalogue() / "soccer-kick", folder)
        text = (folder / FILE).read_text(encoding="utf-8")
        assert old in text
        (folder / FILE).write_text(text.replace(old, new, 1), encoding="utf-8")
        return folder

    return edit


@pytest.mark.parametrize("assignment_id", assignment_ids())
def test_every_assignment_of_the_catalogue_loads_and_gives_20_points(assignment_id: str) -> None:
    assignment = load_assignment(assignment_id)
    assert assignment.id == assignment_id
    assert assignment.total_points == 20


def test_the_kick_asks_for_the_fixed_set_of_answers() -> None:
    ids = {question.id for question in load_assignment("soccer-kick").questions}
    assert ids == {"px_per_m", "fps", "v_f1", "v_f2", "v_b1", "v_b2", "omega1", "omega2", "e", "I"}


def test_conclusions_are_worth_12_of_20_points() -> None:
    groups = load_assignment("soccer-kick").question_groups()
    assert sum(question.points for question in groups["conclusion"]) == 12


def test_an_instructors_own_copy_loads_from_any_folder(edited: Edit) -> None:
    assert load_folder(edited('title = "A soccer kick"', 'title = "My kick"')).title == "My kick"


def test_a_plain_knee_is_an_option_of_an_assignment(edited: Edit) -> None:
    assert load_folder(edited("[solve]", '[words]\nknee = "plain"\n[solve]')).words == {"knee": "plain"}


def test_an_unknown_assignment_is_answered_with_those_there_are() -> None:
    with pytest.raises(UnknownNameError, match=r"one of soccer-kick, .*two-pucks, got 'penalty'"):
        load_assignment("penalty")


MISTAKES = [
    ("low = 0.35", 'low = "a third"', r"draw\.restitution\.low: expected a valid number, got 'a third'"),
    ("low = 0.35", "low = 0.01", r"draw\.restitution\.low: expected 0\.05 to 1, got 0\.01"),
    ("low = 0.35", "low = 0.95", r"draw\.restitution\.high: expected more than low \(0\.95\), got 0\.9"),
    ("step = 0.005", "step = 0.6", r"draw\.restitution\.step: expected at most the range \(0\.55\), got 0\.6"),
    ("step = 0.005", "stop = 0.005", r"draw\.restitution\.stop: expected no such key"),
    ("step = 0.005", "", r"draw\.restitution\.step: expected a value, got none"),
    ("[draw.restitution]", "[draw.bounciness]", r"draw: expected one of .*restitution.*, got 'bounciness'"),
    (
        'scene = "soccer_kick"',
        'scene = "tensile_strip"',
        r"scene: expected one of .*soccer_kick.*, got 'tensile_strip'",
    ),
    ('scene = "soccer_kick"', 'scene = "tennis"', r"scene: expected one of .*soccer_kick.*, got 'tennis'"),
    ('model = "fixed-pivot"', 'model = "free"', r"model: expected one of .*fixed-pivot.*, got 'free'"),
    ('handout = "handout.html.j2"', 'handout = "no.j2"', r"handout: expected a file in my-kick/, got 'no\.j2'"),
    ('dimension = "scale"', 'dimension = "zoom"', r"question\.px_per_m\.dimension: expected one of .*, got 'zoom'"),
    ('unit = "px/m"', 'unit = "m/px"', r"question\.px_per_m\.unit: expected 'px/m', the SI unit of scale, got 'm/px'"),
    ('id = "px_per_m"', 'id = "fps"', r"question: expected each name once, got 'fps' 2 times"),
    ('id = "px_per_m"', 'id = "zoom"', r"question\.id: expected one of .*, got 'zoom'"),
    ('id = "px_per_m"', 'id = "a cell"', r"question\.a cell\.id: expected pattern"),
    ("points = 1.5", "points = -1", r"question\.v_b2\.points: expected greater than or equal to 0, got -1"),
    ('needs = ["v_f1",', 'needs = ["v1",', r"question\.e\.needs: expected one of .*, got 'v1'"),
    ('group = "calibration"', 'group = "fun"', r"question\.px_per_m\.group: expected 'calibration', .* got 'fun'"),
    (
        'formula = "rate_of_speed"',
        'formula = "magic"',
        r"derive\.omega_before_rad_s\.formula: expected one of .* 'magic'",
    ),
    ('v = "foot_speed_m_s"', 'w = "foot_speed_m_s"', r"derive\.omega_before_rad_s\.inputs: expected the letters v, a"),
    ('v = "foot_speed_m_s"', 'v = "speed"', r"derive\.omega_before_rad_s\.inputs: expected one of .*, got 'speed'"),
    ("inertia_kg_m2 = [0.10, 3.0]", "inertia_kg_m2 = [3, 0.1]", r"limits\.inertia_kg_m2: expected \[low, high\]"),
    ('given = "bar"', 'given = "rod"', r"stick\.given: expected one of m, L, D, bar, fps, got 'rod'"),
    ("value = 1.0", 'value = 1.0\nparameter = "leg_length_m"', r"given\.bar: expected either a parameter or a value"),
    ('parameter = "camera.fps"', 'parameter = "fps"', r"given\.parameter: expected one of .*, got 'fps'"),
    ('unit = "kg"', 'unit = "stone"', r"given\.m\.unit: expected one of .*, got 'stone'"),
    ("crf = 18", "crf = 99", r"recording: expected settings that can be used, got crf: expected 0 to 51, got 99"),
    ("crf = 18", "bitrate = 18", r"recording: expected one of format, codec, crf, noise_grey, .*got 'bitrate'"),
    ("[solve]", '[words]\nknee = "sore"\n[solve]', r"words\.knee: expected one of marked, plain, got 'sore'"),
    ("[solve]", '[words]\nelbow = "plain"\n[solve]', r"words: expected one of texture, .*knee, .*got 'elbow'"),
    (
        'drive = "none"',
        'drive = "some"',
        r"solve: expected settings .*, got drive: expected one of free, none, got 'some'",
    ),
    ('"E1", "E2"', '"E1", "E99"', r"separate\.mistakes: expected one of .*, got 'E99'"),
    ("normal_tilt_deg = 0.0", "restitution = 0.5", r"parameter: expected each name once, got 'restitution' 2 times"),
    ("normal_tilt_deg = 0.0", "normal_tilt_deg = 30.0", r"fixed\.normal_tilt_deg: expected -5 to 5 deg, got 30"),
    ("format = 1 ", "format = 2 ", r"format: expected 1, got 2"),
    ("title = ", "title : ", r"file: expected TOML in UTF-8, got .*line 6"),
]


@pytest.mark.parametrize(("old", "new", "message"), MISTAKES)
def test_a_mistake_is_named_with_file_key_expectation_and_finding(
    edited: Edit, old: str, new: str, message: str
) -> None:
    with pytest.raises(AssignmentFileError, match=rf"my-kick/assignment\.toml, .*{message}"):
        load_folder(edited(old, new))


def test_all_mistakes_are_named_at_once(edited: Edit) -> None:
    folder = edited("crf = 18", "crf = 99")
    text = (folder / FILE).read_text(encoding="utf-8").replace('given = "bar"', 'given = "rod"')
    (folder / FILE).write_text(text, encoding="utf-8")
    with pytest.raises(AssignmentFileError) as caught:
        load_folder(folder)
    assert {mistake.name for mistake in caught.value.mistakes} == {"recording", "stick.given"}


def test_a_folder_without_its_file_is_said_so(tmp_path: Path) -> None:
    with pytest.raises(AssignmentFileError, match=r"expected a file named assignment\.toml, got none"):
        load_folder(tmp_path)

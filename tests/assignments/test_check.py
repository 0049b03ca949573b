"""Mistakes in an assignment's file are named with the line on which they stand."""

from __future__ import annotations

import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assignments.check import check_file
from assignments.load import FILE, assignment_ids, catalogue
from assignments.locate import line_of
from vml_course.errors import FileMissingError

TEXT = """\
# a comment
format = 1
title = "x"          # low = 3

[draw.mass]
low = 1
high = 2

[draw."camera.px_per_m"]
low = 400

[separate]
mistakes = [
    "E1", "E2",
    "E99",
]

[[question]]
id = "e"
points = 6

[[question]]
label = "I = 3"
id = "I"
points = 7
[question.more]
low = 5
"""


@pytest.mark.parametrize(
    ("key", "got", "line"),
    [
        ("format", "2", 2),
        ("draw.mass", "", 5),
        ("draw.mass.low", "", 6),
        ("draw.mass.step", "none", 5),  # missing: where its table begins
        ("draw.camera.px_per_m.low", "", 10),
        ("separate.mistakes", "'E99'", 15),
        ("separate.mistakes", "'E98'", 13),
        ("question.e.points", "", 20),
        ("question.I.points", "", 25),
        ("question.id", "'I'", 24),
        ("question.I.tolerance", "none", 22),
        ("question", "", 18),
        ("limits.mass", "", 1),  # nothing of it is there
        ("file", "Expected '=' after a key (at line 6, column 7)", 6),
    ],
)
def test_a_key_is_found_on_its_line(key: str, got: str, line: int) -> None:
    assert line_of(TEXT, key, got) == line


@given(st.text(max_size=200), st.text(max_size=20), st.text(max_size=20))
def test_any_text_has_a_line_to_point_at(text: str, key: str, got: str) -> None:
    assert line_of(text, key, got) >= 1


@pytest.mark.parametrize("name", assignment_ids())
def test_every_key_of_the_catalogue_is_found_where_its_value_stands(name: str) -> None:
    text = (catalogue() / name / FILE).read_text(encoding="utf-8")
    lines, content = text.splitlines(), tomllib.loads(text)
    for question in content["question"]:
        for key, value in question.items():
            line = lines[line_of(text, f"question.{question['id']}.{key}") - 1]
            assert line.startswith(f"{key} = ")
            assert str(value) in line or isinstance(value, list)
    for draw, table in content["draw"].items():
        for key in table:
            assert lines[line_of(text, f"draw.{draw}.{key}") - 1].startswith(f"{key} = ")


@pytest.fixture
def spoilt(tmp_path: Path) -> Callable[..., Path]:
    def spoil(*changes: tuple[str, str]) -> Path:
        folder = tmp_path / "my-kick"
        shutil.copytree(catalogue() / "soccer-kick", folder)
        text = (folder / FILE).read_text(encoding="utf-8")
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        (folder / FILE).write_text(text, encoding="utf-8")
        return folder

    return spoil


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('scene = "soccer_kick"', 'scene = "golf"', "one of ballistic_pendulum"),
        ('model = "fixed-pivot"', 'model = "two-pucks"', "'fixed-pivot', that of the scene soccer_kick"),
        ("low = 0.35", 'low = "low"', "a valid number"),
        ("avoid = [[0.42, 0.48]]", "avoid = [0.42, 0.48]", "a valid"),
        ('"E1", "E2"', '"E1", "E99"', "one of E1"),
        ("points = 1.5", "point = 1.5", "no such key"),
        ('check = "velocity"', 'check = "speed"', "one of acceleration"),
        ('id = "v_f2"', 'id = "v_g2"', "one of px_per_m"),
        ("crf = 18", "crf = 99", "settings that can be used"),
        ('parameter = "leg_length_m"', 'parameter = "leg_m"', "one of "),
        ("omega_before_rad_s = [9.0, 30.0]", "omega_before_rad_s = [30.0, 9.0]", "[low, high] with low below high"),
        ('handout = "handout.html.j2"', 'handout = "handout.j2"', "a file in my-kick/"),
    ],
)
def test_a_mistake_stands_on_the_line_that_was_changed(
    spoilt: Callable[..., Path], old: str, new: str, expected: str
) -> None:
    folder = spoilt((old, new))
    text = (folder / FILE).read_text(encoding="utf-8")
    line = text[: text.index(new)].count("\n") + 1
    found = check_file(folder).mistakes
    assert any(m.line == line and m.expected.startswith(expected) for m in found), found


def test_all_mistakes_are_told_from_top_to_bottom(spoilt: Callable[..., Path]) -> None:
    folder = spoilt(("low = 0.35", "low = 9"), ('"E1", "E2"', '"E1", "E99"'), ('unit = "kg"', 'unit = "stone"'))
    lines = [mistake.line for mistake in check_file(folder / FILE).mistakes]
    assert len(lines) >= 3
    assert lines == sorted(lines)


def test_a_conclusion_needs_the_numbers_that_it_follows_from(spoilt: Callable[..., Path]) -> None:
    folder = spoilt(('needs = ["v_f1", "v_f2", "v_b1", "v_b2"]', "needs = []"))
    text = (folder / FILE).read_text(encoding="utf-8")
    start = text.index('[[question]]\nid = "v_b2"')
    (folder / FILE).write_text(
        text[:start] + text[text.index('[[question]]\nid = "e"') :].replace(', "v_b2"]', "]"), encoding="utf-8"
    )
    (found,) = check_file(folder).mistakes
    assert found.expected.startswith("questions from which the conclusions follow, of omega2, v_f2")


def test_a_body_that_moves_must_be_asked_for(tmp_path: Path) -> None:
    folder = tmp_path / "my-bat"
    shutil.copytree(catalogue() / "bat-and-ball", folder)
    text = (folder / FILE).read_text(encoding="utf-8")
    start, end = text.index('[[question]]\nid = "v_b1"'), text.index('[[question]]\nid = "v_b2"')
    text = text[:start] + text[end:].replace('"v_b1", ', "")
    (folder / FILE).write_text(text, encoding="utf-8")
    (found,) = check_file(folder).mistakes
    assert found.expected == "a question v_b1: the body is not at rest"


def test_the_mark_of_a_door_is_not_the_point_that_is_hit(tmp_path: Path) -> None:
    folder = tmp_path / "my-door"
    shutil.copytree(catalogue() / "swinging-door", folder)
    text = (folder / FILE).read_text(encoding="utf-8").replace('"v_c2"', '"v_f2"')
    (folder / FILE).write_text(text, encoding="utf-8")
    (found,) = check_file(folder).mistakes
    assert (found.key, found.expected) == ("question.v_f2", "v_c2, that of the point that is hit")


def test_a_given_number_that_the_answers_need_must_be_told(tmp_path: Path) -> None:
    folder = tmp_path / "my-rod"
    shutil.copytree(catalogue() / "struck-rod", folder)
    text = (folder / FILE).read_text(encoding="utf-8").replace('id = "b"\n', 'id = "offset"\n')
    (folder / FILE).write_text(text, encoding="utf-8")
    assert any(m.expected == "one with the id 'b', from which the answers follow" for m in check_file(folder).mistakes)


@pytest.mark.parametrize("name", assignment_ids())
def test_the_catalogue_is_right(name: str) -> None:
    assert check_file(catalogue() / name).mistakes == ()


def test_what_is_no_assignment_is_said_so(tmp_path: Path) -> None:
    with pytest.raises(FileMissingError, match=r"expected a folder with an assignment\.toml"):
        check_file(tmp_path)


def test_bytes_that_are_no_text_are_a_mistake_of_the_file(tmp_path: Path) -> None:
    folder = tmp_path / "odd"
    folder.mkdir()
    (folder / FILE).write_bytes(b"\xff\xfe")
    (found,) = check_file(folder).mistakes
    assert (found.line, found.key, found.expected) == (1, "file", "TOML in UTF-8")


@pytest.mark.parametrize(
    ("old", "new", "at", "words"),
    [
        ("{% endblock %}", "{% endblok %}", "{% endblok %}", "Encountered unknown tag 'endblok'"),
        ("{{ video }}", "{{ vidio }}", "", "'vidio' is undefined"),
    ],
)
def test_a_handout_that_cannot_be_written_is_a_mistake(tmp_path: Path, old: str, new: str, at: str, words: str) -> None:
    folder = tmp_path / "my-kick"
    shutil.copytree(catalogue() / "soccer-kick", folder)
    file = folder / "handout.html.j2"
    file.write_text(file.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    (found,) = check_file(folder).mistakes
    assert (found.file, words in found.got) == (str(file), True)
    text = file.read_text(encoding="utf-8")
    assert found.line == text[: text.index(at)].count("\n") + 1  # the first where Jinja does not say

"""A course folder: made once, its secret kept."""

from __future__ import annotations

import csv
import json
import os
import stat
from pathlib import Path

import pytest

from assignments.course import SECRET_FILE, new_course, open_course
from assignments.errors import CourseError
from vml_course.cli import run

posix = pytest.mark.skipif(os.name != "posix", reason="modes of files are POSIX's")


def test_a_new_course_can_be_opened_again(tmp_path: Path) -> None:
    made = new_course(tmp_path / "a" / "dynamics", 'Dynamics "II": Schlag & Stoß')
    assert open_course(made.folder) == made
    assert made.title == 'Dynamics "II": Schlag & Stoß'


def test_the_title_is_the_folders_name_when_none_is_given(tmp_path: Path) -> None:
    assert new_course(tmp_path / "dynamics").title == "dynamics"


def test_every_course_has_a_secret_of_32_bytes_of_its_own(tmp_path: Path) -> None:
    one, other = new_course(tmp_path / "one"), new_course(tmp_path / "other")
    assert len(one.secret) == len(other.secret) == 32
    assert one.secret != other.secret


def test_a_course_that_is_printed_keeps_its_secret(tmp_path: Path) -> None:
    course = new_course(tmp_path / "c")
    assert "secret" not in repr(course)
    assert course.secret.hex() not in repr(course)


@posix
def test_the_secret_is_readable_by_its_owner_only(tmp_path: Path) -> None:
    course = new_course(tmp_path / "c")
    assert stat.S_IMODE((course.folder / SECRET_FILE).stat().st_mode) == 0o600


@posix
@pytest.mark.parametrize("mode", [0o640, 0o604, 0o660])
def test_a_course_whose_secret_is_open_is_not_run(tmp_path: Path, mode: int) -> None:
    course = new_course(tmp_path / "c")
    (course.folder / SECRET_FILE).chmod(mode)
    with pytest.raises(CourseError, match=rf"expected a file that only you can read, got mode {mode:o}.*chmod 600"):
        open_course(course.folder)


def test_version_control_never_sees_secret_grades_handouts_and_names(tmp_path: Path) -> None:
    ignored = (new_course(tmp_path / "c").folder / ".gitignore").read_text(encoding="utf-8").splitlines()
    assert {"/.secret", "/gradebook*", "/handouts/", "/.making-*/", "/roster.csv"} <= set(ignored)


def test_what_is_in_the_folder_already_stays(tmp_path: Path) -> None:
    (tmp_path / ".gitignore").write_text("*.bak\n", encoding="utf-8")
    (tmp_path / "roster.csv").write_text("name,email\nMe,me@example.org\n", encoding="utf-8")
    new_course(tmp_path, "Here")
    assert (tmp_path / ".gitignore").read_text(encoding="utf-8").startswith("*.bak\n# Never")
    assert "Me,me@example.org" in (tmp_path / "roster.csv").read_text(encoding="utf-8")


def test_a_second_course_in_the_same_folder_is_refused_and_the_secret_stays(tmp_path: Path) -> None:
    course = new_course(tmp_path / "c")
    with pytest.raises(CourseError, match=r"a folder without a course, got course\.toml in it"):
        new_course(tmp_path / "c")
    assert open_course(course.folder).secret == course.secret


@pytest.mark.parametrize("place", ["grades.csv", "grades.csv/deeper"])
def test_a_file_where_the_folder_should_be_is_called_one_and_stays(tmp_path: Path, capsys, place: str) -> None:
    (tmp_path / "grades.csv").write_text("name\n", encoding="utf-8")
    assert run(["course", "new", str(tmp_path / place)]) == 2
    wanted = "expected a folder, or a name that is still free, got a file. Choose another name."
    assert capsys.readouterr().err == f"{tmp_path / 'grades.csv'}: {wanted}\n"
    assert (tmp_path / "grades.csv").read_text(encoding="utf-8") == "name\n"


def test_the_roster_starts_with_three_students(tmp_path: Path) -> None:
    with new_course(tmp_path / "c").roster.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [list(row) for row in rows] == [["name", "email"]] * 3


@pytest.mark.parametrize("title", ["two\nlines", "x" * 201])
def test_a_title_is_one_line(tmp_path: Path, title: str) -> None:
    with pytest.raises(CourseError, match="title: expected one line"):
        new_course(tmp_path / "c", title)


@pytest.mark.parametrize(
    ("file", "text", "message"),
    [
        ("course.toml", None, "expected a course folder with course.toml, got none. Make one with: vml course new"),
        ("course.toml", "title = ", "expected TOML in UTF-8"),
        ("course.toml", "title = 3\n", "title: expected a valid string, got 3"),
        (".secret", None, "expected the course's secret, got No such file"),
        (".secret", "abc\n", "expected 64 hexadecimal digits, got 3 other characters"),
    ],
)
def test_a_broken_course_is_said_so_in_one_line(tmp_path: Path, file: str, text: str | None, message: str) -> None:
    path = new_course(tmp_path / "c").folder / file
    if text is None:
        path.unlink()
    else:
        path.write_text(text, encoding="utf-8")
    with pytest.raises(CourseError) as caught:
        open_course(tmp_path / "c")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_command_says_what_comes_next(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["course", "new", str(tmp_path / "c"), "--title", "Dynamics"]) == 0
    said = capsys.readouterr().out
    assert 'Made the course "Dynamics"' in said
    assert "vml handout soccer-kick --course" in said
    assert open_course(tmp_path / "c").secret.hex() not in said


def test_the_command_gives_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["course", "new", str(tmp_path / "c"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said == {"folder": str(tmp_path / "c"), "title": "c", "roster": str(tmp_path / "c" / "roster.csv")}


def test_the_command_refuses_a_second_course_with_code_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(["course", "new", str(tmp_path / "c")])
    assert run(["course", "new", str(tmp_path / "c")]) == 2
    assert capsys.readouterr().err.count("\n") == 1

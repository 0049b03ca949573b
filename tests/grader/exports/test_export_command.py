"""`vml export`: from a graded and released course to a platform's file."""

from __future__ import annotations

import csv
import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from assignments.course import Course, new_course, open_course
from grader.autograder.wheels import NEEDED
from grader.exporting import Wish, export_grades
from grader.exports import exports
from grader.grade import grade
from grader.gradebook import Gradebook
from grader.releasing import release_grades
from grader.roster import Enrolled
from vml_course.cli import run
from vml_course.errors import InputError, TableError, UnknownNameError

CLASS = (("Jane Doe", "jane@x.edu", {"login": "jdoe"}), ("Jürg Müller", "juerg@x.edu", {}), ("Nora New", "n@x.edu", {}))
HEAD = "Student,ID,SIS Login ID,Section,Soccer kick (4711)\n    Points Possible,,,,20\n"


@pytest.fixture
def course(tmp_path: Path, kit, desk_of_grading) -> Course:
    """Two of three graded; nothing released yet."""
    made = new_course(tmp_path / "course", "Dynamics")
    with Gradebook.open(made) as book:
        arrivals = book.take_in([Enrolled(name, email, ids) for name, email, ids in CLASS])
        for i, arrival in enumerate(arrivals[:2]):
            mark(book, kit, desk_of_grading, i, arrival.student.pid, {} if i == 0 else {"e": 0.05})
    return made


@pytest.fixture
def desk_of_grading(assignment, tmp_path, empty_bytes, good_bytes, kit):
    numbers = kit.impact()
    return kit.Desk(assignment, numbers, kit.key_of(numbers), tmp_path, empty_bytes, good_bytes)


def mark(book, kit, desk, i: int, pid: str, changes: dict) -> None:
    code = f"CODE{i}"
    key = kit.key_of(desk.numbers, code=code, student=pid)
    book.keep_key(kit.variant_of("signed", code, pid), key)
    table = kit.table_of(kit.trajectory_m(desk.numbers))  # without one a person has to look
    submission = kit.submission_of(desk.assignment, {**desk.truth, **changes}, tracking=table)
    submission = kit.replace(submission, code=code, content_sha256=f"{i}{changes}", file_sha256="0" * 64)
    book.record_run(submission, grade(submission, key, desk.assignment))


def canvas_file(folder: Path, *rows: str) -> Path:
    path = folder / "Grades-DYN.csv"
    path.write_bytes((HEAD + "".join(f"{row}\n" for row in rows)).encode())
    return path


def test_nothing_leaves_before_a_release(course, tmp_path, capfd) -> None:
    template = canvas_file(tmp_path, '"Doe, Jane",,jdoe,A,')
    for to in ("canvas", "canvas-feedback", "csv", "moodle", "moodle-feedback", "blackboard"):
        code = run(["export", "soccer-kick", "--to", to, "--course", str(course.folder), "--template", str(template)])
        assert code == 2
        assert "vml release soccer-kick" in capfd.readouterr().err
    assert not list((course.folder / "exports").glob("*"))


def test_what_was_released_is_filled_and_said(course, tmp_path, capfd) -> None:
    release_grades(course, "soccer-kick", who="test")
    template = canvas_file(
        tmp_path, '"Doe, Jane",,jdoe,A,', '"Müller, Jürg",,jm,A,3', '"New, Nora",,nn,A,', '"X, Y",,xy,A,1'
    )
    before = template.read_bytes()
    code = run(["export", "soccer-kick", "--to", "canvas", "--course", str(course.folder), "--template", str(template)])
    said = capfd.readouterr().out
    assert code == 1  # one is nobody of this course
    assert template.read_bytes() == before
    written = course.folder / "exports" / "soccer-kick-canvas.csv"
    rows = written.read_text(encoding="utf-8").splitlines()
    points = {row["Student"]: row["Soccer kick (4711)"] for row in csv.DictReader(rows)}
    assert points["Doe, Jane"] == "20"
    assert 3 < float(points["Müller, Jürg"]) < 20
    assert (points["New, Nora"], points["X, Y"]) == ("", "1")
    assert "2 filled, 1 no grade, 1 skipped" in said
    assert "was 3" in said
    assert "Gradebook > Import" in said


def test_the_newest_release_counts_not_the_newest_grade(course, tmp_path, kit, desk_of_grading, capfd) -> None:
    release_grades(course, "soccer-kick", who="test")
    with Gradebook.open(course) as book:
        pid = next(student.pid for student in book.students() if student.name == "Jane Doe")
        mark(book, kit, desk_of_grading, 0, pid, {"e": 0.01, "I": 9.0})
    template = canvas_file(tmp_path, '"Doe, Jane",,jdoe,A,')
    out = tmp_path / "filled.csv"
    arguments = ["export", "soccer-kick", "--to", "canvas", "--course", str(course.folder), "-o", str(out)]
    run([*arguments, "--template", str(template)])
    assert out.read_text(encoding="utf-8").endswith("jdoe,A,20\n")
    assert "1 grades have changed since the release" in capfd.readouterr().out
    release_grades(course, "soccer-kick", who="test")
    run([*arguments, "--template", str(template)])
    assert not out.read_text(encoding="utf-8").endswith("jdoe,A,20\n")


def test_points_that_are_not_final_leave_with_a_word_until_they_are_settled_and_released(
    course, tmp_path, kit, desk_of_grading, capfd
) -> None:
    with Gradebook.open(course) as book:
        pid = next(student.pid for student in book.students() if student.name == "Jane Doe")
        mark(book, kit, desk_of_grading, 0, pid, {"e": "about 0.6"})
    template = canvas_file(tmp_path, '"Doe, Jane",,jdoe,A,')
    place, out = ["--course", str(course.folder)], tmp_path / "filled.csv"
    arguments = ["export", "soccer-kick", "--to", "canvas", *place, "-o", str(out), "--template", str(template)]
    release_grades(course, "soccer-kick", who="test")
    assert run(arguments) == 1
    said = capfd.readouterr().out
    assert "open: up to 20 of 20, a person has to look" in said
    assert "1 with open points" in said
    assert "vml gradebook set PID soccer-kick QUESTION POINTS; then vml release soccer-kick" in said
    assert run(["gradebook", "set", pid, "soccer-kick", "e", "2", "--reason", "read", *place]) == 0
    capfd.readouterr()
    run(arguments)
    said = capfd.readouterr().out
    assert "open:" not in said
    assert "open points" not in said
    assert "1 grades have changed since the release" in said
    release_grades(course, "soccer-kick", who="test")
    run(arguments)
    said = capfd.readouterr().out
    assert "open:" not in said
    assert "open points" not in said
    assert "have changed" not in said


def test_a_template_is_never_written_over(course, tmp_path) -> None:
    release_grades(course, "soccer-kick", who="test")
    template = canvas_file(tmp_path, '"Doe, Jane",,jdoe,A,')
    before = template.read_bytes()
    with pytest.raises(InputError, match="name of its own"):
        export_grades(course, "soccer-kick", "canvas", Wish(template, template))
    assert template.read_bytes() == before


def test_a_failed_export_leaves_the_older_file_and_nothing_else(course, tmp_path) -> None:
    release_grades(course, "soccer-kick", who="test")
    folder = tmp_path / "out"
    folder.mkdir()
    older = folder / "filled.csv"
    older.write_text("older", encoding="utf-8")
    template = tmp_path / "other.csv"
    template.write_text("name,email\nJane,jane@x.edu\n", encoding="utf-8")
    with pytest.raises(TableError):
        export_grades(course, "soccer-kick", "canvas", Wish(template, older))
    assert [path.name for path in folder.iterdir()] == ["filled.csv"]
    assert older.read_text(encoding="utf-8") == "older"


def test_a_template_of_many_megabytes_is_not_read(course, tmp_path) -> None:
    with (tmp_path / "big.csv").open("wb") as file:
        file.truncate(60_000_000)
    with pytest.raises(InputError, match="a file of 60 MB"):
        export_grades(course, "soccer-kick", "canvas", Wish(tmp_path / "big.csv"))


@pytest.mark.skipif(os.name != "posix", reason="modes are POSIX's")
def test_what_holds_names_and_grades_is_for_its_owner_alone(course) -> None:
    release_grades(course, "soccer-kick", who="test")
    done = export_grades(course, "soccer-kick", "csv")
    assert stat.S_IMODE(done.file.stat().st_mode) == 0o600


def test_the_result_is_there_for_programs(course, capfd) -> None:
    release_grades(course, "soccer-kick", who="test")
    assert run(["export", "soccer-kick", "--to", "csv", "--course", str(course.folder), "--json"]) == 0
    done = json.loads(capfd.readouterr().out)
    assert [line["status"] for line in done["lines"]] == ["filled", "filled", "no grade"]


def test_platforms_are_found_by_name(course) -> None:
    assert set(exports()) == {
        "blackboard",
        "canvas",
        "canvas-feedback",
        "csv",
        "gradescope",
        "moodle",
        "moodle-feedback",
    }
    with pytest.raises(UnknownNameError, match="moodle-feedback"):
        export_grades(course, "soccer-kick", "blackbord")
    release_grades(course, "soccer-kick", who="test")
    with pytest.raises(InputError, match="--template: expected the CSV that the gradebook of Canvas exports"):
        export_grades(course, "soccer-kick", "canvas")
    with pytest.raises(InputError, match="--template: expected none for csv"):
        export_grades(course, "soccer-kick", "csv", Wish(course.roster))


def test_the_help_names_every_platform_and_imports_none_of_them(capfd) -> None:
    assert run(["export", "--help"]) == 0
    said = " ".join(capfd.readouterr().out.replace("│", " ").split())
    assert f"One of {', '.join(exports())}." in said
    asked = "import sys, grader.export_commands; print([m for m in sys.modules if 'grader.' in m and 'export' in m])"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "['grader.exports', 'grader.export_commands']"


def test_the_autograder_needs_no_release_and_gives_nothing_away_in_the_shell(course, tmp_path, capfd) -> None:
    for name in NEEDED:
        (tmp_path / f"{name.replace('-', '_')}-1.0-py3-none-any.whl").write_bytes(b"wheel")
    out = tmp_path / "autograder.zip"
    arguments = ["export", "soccer-kick", "--to", "gradescope", "--course", str(course.folder), "-o", str(out)]
    code = run([*arguments, "--wheels", str(tmp_path)])
    said = "".join(capfd.readouterr())
    assert code == 1  # Nora has no variant
    assert "has no variant" in said
    assert "CODE0" not in said
    assert "autograder points" in said
    assert "{points}" not in said
    assert open_course(course.folder).secret.hex() not in said
    assert stat.S_IMODE(out.stat().st_mode) & 0o077 == 0


def test_wheels_that_cannot_be_fetched_are_one_clear_line_and_leave_nothing(
    course, tmp_path, capfd, monkeypatch
) -> None:
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    out = tmp_path / "out" / "autograder.zip"
    out.parent.mkdir()
    code = run(["export", "soccer-kick", "--to", "gradescope", "--course", str(course.folder), "-o", str(out)])
    said = capfd.readouterr().err
    assert code == 2
    assert said.count("\n") == 1
    assert "--wheels DIR" in said
    assert not list(out.parent.iterdir())

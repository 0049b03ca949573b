"""Names in course.toml that nothing answers to, at the prompt."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from assignments.course import new_course
from assignments.load import assignment_folder
from grader.gradebook import Gradebook
from vml_course.cli import run

MISSPELT = """
[assignment.soccerkick]
due = 2027-04-26T23:59:00

[[extension]]
student = "k3m9x2ab"
assignment = "two-puks"
hours = 48
reason = "ill, no two-puks"
"""


@pytest.fixture(params=["folder", "store"])
def place(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("VML_HOME", str(tmp_path / "home"))
    return str(tmp_path / "c") if request.param == "folder" else f"memory://{tmp_path.name}/c"


@pytest.mark.parametrize(
    "command",
    [
        ["handout", "soccer-kick"],
        ["handout", "soccer-kick", "--plan"],
        ["collect", "soccer-kick", "x.zip"],
        ["grade"],
        ["gradebook", "show"],
        ["release", "soccer-kick"],
        ["export", "soccer-kick", "--to", "csv"],
    ],
)
def test_no_command_goes_on_when_a_due_date_is_of_no_assignment(place, command, capsys) -> None:
    course = new_course(place, "c")
    course.shelf.write("course.toml", f'title = "c"\n{MISSPELT}'.encode())
    assert run([*command, "--course", place]) == 2
    said = capsys.readouterr().err
    terms = "course.toml, line 3, [assignment.soccerkick]: expected an assignment that there is (nearest: soccer-kick)"
    assert f"{terms}, got 'soccerkick'. And line 8, [[extension]] assignment: " in said
    assert "(nearest: two-pucks), got 'two-puks'." in said
    assert str(course.assignments) in said
    assert len(said.splitlines()) == 1
    assert not (course.folder / "gradebook.db").exists()


def test_terms_of_an_assignment_of_the_courses_own_are_terms(place, capsys) -> None:
    course = new_course(place, "c")
    course.shelf.write("course.toml", b'title = "c"\n[assignment.own-kick]\ndue = 2027-04-26T23:59:00\n')
    assert run(["gradebook", "show", "--course", place]) == 2
    (course.assignments / "own-kick").mkdir(parents=True)
    (course.assignments / "own-kick" / "assignment.toml").write_text("")  # only listed: what it says is not read
    assert run(["gradebook", "show", "--course", place]) == 0


def test_an_assignment_that_is_being_handed_out_from_elsewhere_may_have_its_terms_before(tmp_path, capsys) -> None:
    course = new_course(tmp_path / "c")
    course.shelf.write("course.toml", b'title = "c"\n[assignment.own-kick]\ndue = 2027-04-26T23:59:00\n')
    shutil.copytree(assignment_folder("soccer-kick"), tmp_path / "own-kick")
    words = ["--dry-run", "--course", str(tmp_path / "c")]
    assert run(["handout", str(tmp_path / "own-kick"), *words]) == 0
    assert run(["handout", "soccer-kick", *words]) == 2
    assert "got 'own-kick'" in capsys.readouterr().err


def test_an_extension_of_nobody_is_said_and_the_command_goes_on(place, capsys) -> None:
    course = new_course(place, "c")
    with Gradebook.open(course) as book:
        pid = book.students_from_roster(course.roster)[0].pid
    given = "".join(f'[[extension]]\nstudent = "{one}"\nhours = 1\nreason = "ill"\n' for one in (pid, f"{pid}x"))
    course.shelf.write("course.toml", f'title = "c"\n{given}'.encode())
    assert run(["gradebook", "show", "--json", "--course", place]) == 0
    said = capsys.readouterr()
    line = f"course.toml, line 7, [[extension]] student: expected a pseudonym of the class list (nearest: {pid})"
    assert said.err == f"{line}, got '{pid}x'. It extends nothing so far. See: vml roster list.\n"
    assert json.loads(said.out) == []


def test_an_extension_before_there_is_a_class_list_makes_no_gradebook(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    course.shelf.write("course.toml", b'title = "c"\n[[extension]]\nstudent = "ab"\nhours = 1\nreason = "ill"\n')
    assert run(["handout", "soccer-kick", "--dry-run", "--course", str(tmp_path / "c")]) == 0
    assert "(none yet), got 'ab'." in capsys.readouterr().err
    assert not (tmp_path / "c" / "gradebook.db").exists()

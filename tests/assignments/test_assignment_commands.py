"""The commands about assignments: what they print, as text and as JSON, and their exit codes."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from assignments.load import assignment_ids, catalogue, load_assignment
from vml_course.cli import run


def test_the_list_has_every_assignment(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["assignment", "list"]) == 0
    said = capsys.readouterr().out
    assert all(name in said for name in assignment_ids())
    assert run(["assignment", "list", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["id"] for row in rows] == list(assignment_ids())
    assert rows[0] == {
        "id": "soccer-kick",
        "title": "A soccer kick",
        "scene": "soccer_kick",
        "finds": "e, I",
        "points": "20",
    }


def test_a_course_lists_its_own_assignments_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(catalogue() / "two-pucks", tmp_path / "assignments" / "my-pucks")
    assert run(["assignment", "list", "--course", str(tmp_path), "--json"]) == 0
    assert [row["id"] for row in json.loads(capsys.readouterr().out)] == [*assignment_ids(), "my-pucks"]


@pytest.mark.parametrize("name", assignment_ids())
def test_an_assignment_is_shown_with_all_that_it_says(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["assignment", "show", name, "--mistakes"]) == 0
    said = capsys.readouterr().out
    assignment = load_assignment(name)
    assert all(goal in said for goal in assignment.goals)
    assert all(draw.parameter in said for draw in assignment.draws)
    assert all(code in said for code in assignment.separation.mistakes)
    assert said.rstrip().endswith(assignment.folder)
    assert run(["assignment", "show", name, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert (content["id"], content["total_points"]) == (name, 20)
    assert set(assignment.separation.mistakes) <= set(content["mistakes"])


def test_an_unknown_assignment_is_answered_with_those_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["assignment", "show", "golf"]) == 2
    assert "expected one of soccer-kick," in capsys.readouterr().err


def test_a_right_file_ends_well(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["assignment", "check", str(catalogue() / "two-pucks")]) == 0
    assert "can be handed out" in capsys.readouterr().out


def test_mistakes_are_told_as_editors_read_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(catalogue() / "two-pucks", folder)
    file = folder / "assignment.toml"
    file.write_text(
        file.read_text(encoding="utf-8").replace("tolerance = 0.01\n", "tolerance = -1\n"), encoding="utf-8"
    )
    line = file.read_text(encoding="utf-8").splitlines().index("tolerance = -1") + 1
    assert run(["assignment", "check", str(folder)]) == 2
    said = capsys.readouterr().out.splitlines()
    assert said == [f"{file}:{line}: question.px_per_m.tolerance: expected greater than 0, got -1.", "1 mistake"]
    assert run(["assignment", "check", str(file), "--json"]) == 2
    (told,) = json.loads(capsys.readouterr().out)
    assert (told["file"], told["line"], told["key"]) == (str(file), line, "question.px_per_m.tolerance")
    assert (told["expected"], told["got"]) == ("greater than 0", "-1")

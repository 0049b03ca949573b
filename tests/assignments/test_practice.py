"""Practice: a variant that everybody may see through, without a course."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import assignments.practice
from assignments.load import load_assignment
from assignments.practice import make_practice
from assignments.release import Order, Release, make
from vml_course.cli import run
from vml_course.errors import FileFormatError, OutOfRangeError

KICK = load_assignment("soccer-kick")


@pytest.fixture(scope="module")
def practised(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_practice(KICK, tmp_path_factory.mktemp("at home") / "practice").folder


def test_practice_is_a_students_folder_with_truth_and_solution(practised: Path) -> None:
    assert sorted(path.name for path in practised.iterdir()) == [
        "handout.html",
        "solution.txt",
        "truth.csv",
        "truth.json",
        "video.mp4",
        "workbook.xlsx",
    ]
    assert not list(practised.parent.glob(".making-*"))


def test_the_solution_tells_what_is_true_measured_and_accepted(practised: Path) -> None:
    text = (practised / "solution.txt").read_text(encoding="utf-8")
    truth = json.loads((practised / "truth.json").read_text(encoding="utf-8"))
    assert text.startswith(KICK.title)
    for question in KICK.questions:
        assert question.label in text
    line = next(line for line in text.splitlines() if line.startswith("Coefficient of restitution"))
    true = float(line.split(" e ")[1].split()[0])
    assert f'"restitution": {true:g}' in json.dumps(truth) or true == pytest.approx(
        truth["parameters"]["restitution"], rel=1e-4
    )
    assert " ± " in line
    assert f"{true * 0.98:.5g} to {true * 1.02:.5g}" in line


def test_practice_takes_nothing_from_a_course_and_a_seed_is_a_variant(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Order] = []

    def noted(order: Order, folder: Path) -> Release:
        asked.append(order)
        raise OutOfRangeError("stop", 0, 1, "", 2)

    monkeypatch.setattr(assignments.practice, "make", noted)
    for seed in (1, 2, 1):
        with pytest.raises(OutOfRangeError):
            make_practice(KICK, tmp_path / "p", seed)
        assert not (tmp_path / "p").exists()
    assert asked[0] == asked[2]
    assert asked[0].secret != asked[1].secret
    assert make is not noted


def test_a_folder_that_holds_something_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine.txt").touch()
    with pytest.raises(FileFormatError, match="a new or empty folder"):
        make_practice(KICK, tmp_path)
    assert run(["handout", "soccer-kick", "--practice"]) == 2
    assert "--practice: expected where to put it" in capsys.readouterr().err
    assert run(["handout", "soccer-kick", "--practice", "-o", str(tmp_path / "n"), "--seed", "-1"]) == 2
    assert run(["handout", "soccer-kick"]) == 2
    assert "--course: expected the course folder" in capsys.readouterr().err

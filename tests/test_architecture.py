"""The architecture is a test: break it on purpose and see that the build says so."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("vml_course", "assignments", "grader")

SABOTAGE = {
    "the core opens a database": ("vml_course/kinetics/sabotage.py", "import sqlite3\n"),
    "synth looks into track": ("vml_course/synth/sabotage.py", "import vml_course.track\n"),
    "io looks into kinetics": ("vml_course/io/sabotage.py", "import vml_course.kinetics\n"),
    "track looks up to the use cases": ("vml_course/track/sabotage.py", "def f():\n    import vml_course.usecases\n"),
    "a scene knows another scene": (
        "vml_course/synth/scenes/sabotage.py",
        "import vml_course.synth.scenes.soccer_kick\n",
    ),
    "an export knows another one": ("grader/exports/sabotage.py", "import grader.exports.canvas\n"),
    "assignments know the grader": ("assignments/sabotage.py", "import grader\n"),
    "a stray file in the hall": ("vml_course/utils.py", ""),
    "the model knows scipy": ("vml_course/model/sabotage.py", "import scipy\n"),
}


def lint_imports(folder: Path) -> subprocess.CompletedProcess[str]:
    command = [str(Path(sys.executable).with_name("lint-imports")), "--no-cache"]
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture
def copy(tmp_path):
    for package in PACKAGES:
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return tmp_path


def test_the_house_as_it_stands_keeps_its_contracts(copy):
    result = lint_imports(copy)
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize(("path", "source"), SABOTAGE.values(), ids=SABOTAGE.keys())
def test_a_broken_contract_fails_the_build(copy, path, source):
    (copy / path).write_text(f'"""Sabotage."""\n{source}', encoding="utf-8")
    result = lint_imports(copy)
    assert result.returncode != 0, result.stdout


def test_every_room_says_why_it_is_as_it_is():
    rooms = [
        *PACKAGES,
        *(f"vml_course/{room}" for room in ("synth", "track", "kinetics", "io", "correlate", "chart", "model")),
    ]
    assert [room for room in rooms if not (ROOT / room / "README.md").is_file()] == []


def test_no_file_is_longer_than_one_sitting():
    lines = {p: len(p.read_text("utf-8").splitlines()) for package in PACKAGES for p in (ROOT / package).rglob("*.py")}
    assert {str(path): count for path, count in lines.items() if count > 400} == {}

"""The README's way to an assignment of one's own, followed word by word: copy, edit, check, preview, hand out."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

import assignments
from assignments.derive import FORMULAS, arguments_of
from assignments.load import load_assignment
from assignments.schema import AssignmentFile, QuestionTable
from vml_course.cli import run

README = (Path(assignments.__file__).parent / "README.md").read_text(encoding="utf-8")
SECTION = README.split("## Your own assignment, without Python")[1].split("### What the file says")[0]


def blocks(kind: str) -> list[str]:
    found = re.findall(rf"^ *```{kind}\n(.*?)^ *```", SECTION, re.DOTALL | re.MULTILINE)
    return [re.sub(r"^ {3}", "", block, flags=re.MULTILINE).strip() for block in found]


def edited(text: str, snippet: str) -> str:
    """Put a snippet in place of the table or line that begins like it."""
    first = snippet.splitlines()[0]
    if first.startswith("["):
        start = text.index(first)
        end = text.index("\n\n", start)
        return text[:start] + snippet + text[end:]
    key = first.partition(" =")[0]
    return re.sub(rf"^{key} = .*$", snippet, text, count=1, flags=re.MULTILINE)


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_newcomer_gets_from_the_readme_to_a_handout(desk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    make, check, preview, hand_out = blocks("sh")
    for line in make.splitlines():
        assert run(line.split()[1:]) == 0, line
    said = capsys.readouterr().out
    folder = Path(said.strip().splitlines()[-1].partition("Its folder: ")[2])
    own = desk / re.search(r"here to `(.*?)`", SECTION)[1]
    shutil.copytree(folder, own)

    file = own / "assignment.toml"
    text = file.read_text(encoding="utf-8")
    for snippet in blocks("toml"):
        text = edited(text, snippet)
        assert snippet in text
    file.write_text(text, encoding="utf-8")

    assert run(check.split()[1:]) == 0
    assert "can be handed out" in capsys.readouterr().out
    assert run(preview.split()[1:]) == 0
    made = {path.name for path in (desk / "preview").iterdir()}
    assert made == {"video.mp4", "workbook.xlsx", "handout.html", "solution.html"}
    assert "Two heavy pucks" in (desk / "preview" / "handout.html").read_text(encoding="utf-8")

    (desk / "dynamics" / "roster.csv").write_text("name,email\nAna Example,ana@example.org\n", encoding="utf-8")
    assert run(hand_out.split()[1:]) == 0
    (student,) = (
        path for path in (desk / "dynamics" / "handouts" / own.name).iterdir() if path.is_dir() and path.name != "zips"
    )
    assert {path.name for path in student.iterdir()} == {"video.mp4", "workbook.xlsx", "handout.html"}


def test_an_own_assignment_comes_before_the_catalogue_s(desk: Path) -> None:
    own = desk / "assignments" / "two-pucks"
    shutil.copytree(load_assignment("two-pucks").folder, own)
    file = own / "assignment.toml"
    file.write_text(file.read_text(encoding="utf-8").replace("Two pucks meet obliquely", "My pucks"), encoding="utf-8")
    assert load_assignment("two-pucks", desk / "assignments").title == "My pucks"
    assert load_assignment(str(own)).title == "My pucks"
    assert load_assignment("two-pucks").title == "Two pucks meet obliquely"


def test_the_readme_names_every_formula_and_every_key_of_the_file() -> None:
    for name in FORMULAS:
        assert f"| `{name}` | {', '.join(arguments_of(name))} |" in README
    for key in (*AssignmentFile.model_fields, *QuestionTable.model_fields):
        assert re.search(rf"\b{key}\b", README.split("### What the file says")[1]), key

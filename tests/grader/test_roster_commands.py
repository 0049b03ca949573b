"""`vml roster`: what its commands do with a class list, and what they say of it."""

from __future__ import annotations

from pathlib import Path

from assignments.course import new_course
from grader.gradebook import Gradebook
from grader.rostering import roster_of
from vml_course.cli import run

CLASS = "name,email\nJane Doe,jane@x.org\nSøren Ærø,soeren@x.org\n"


def _import(course, text: str, *options: str) -> int:
    file = course.folder / "class.csv"
    file.write_text(text, encoding="utf-8")
    return run(["roster", "import", str(file), "--course", str(course.folder), *options])


def test_the_sample_list_is_put_away_once_a_class_is_taken_in_and_that_is_said(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    assert _import(course, CLASS, "--dry-run") == 0
    assert "The sample list in roster.csv would be put away." in capsys.readouterr().out
    assert course.roster.is_file()
    assert _import(course, CLASS) == 0
    assert "The sample list in roster.csv was put away." in capsys.readouterr().out
    assert not course.roster.exists()
    assert [s.name for s in roster_of(course)] == ["Jane Doe", "Søren Ærø"]
    assert _import(course, CLASS) == 0
    assert "roster.csv" not in capsys.readouterr().out


def test_a_list_of_ones_own_stays_beside_one_that_is_taken_in_and_that_is_said(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    course.roster.write_text("name,email\nAnn,ann@x.org\n", encoding="utf-8")
    assert _import(course, CLASS) == 0
    said = capsys.readouterr().out
    assert "In the course as well: 1 student of roster.csv. To leave somebody out: vml roster drop PID." in said
    assert len(roster_of(course)) == 3


def test_a_list_of_ones_own_that_holds_nobody_is_no_hindrance(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    course.roster.write_text("name,email\n", encoding="utf-8")
    assert _import(course, CLASS) == 0
    assert "roster.csv" not in capsys.readouterr().out


def test_the_courses_own_list_is_taken_in_without_a_word_about_another(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    assert run(["roster", "import", str(course.roster), "--course", str(course.folder)]) == 0
    assert "roster.csv" not in capsys.readouterr().out
    assert course.roster.is_file()


def test_a_list_of_one_late_student_does_not_list_everybody_else(tmp_path: Path, capsys) -> None:
    course, file = str(tmp_path / "c"), tmp_path / "list.csv"
    new_course(Path(course)).roster.unlink()
    file.write_text("name,email\n" + "".join(f"S{i},s{i}@x.org\n" for i in range(4)), encoding="utf-8")
    assert run(["roster", "import", str(file), "--course", course]) == 0
    file.write_text("name,email\nLate,late@x.org\n", encoding="utf-8")
    capsys.readouterr()
    assert run(["roster", "import", str(file), "--course", course]) == 0
    said = capsys.readouterr().out
    assert "1 new, 0 known, 0 linked, 4 not listed." in said
    assert "s0@x.org" not in said


def test_dropped_students_are_marked_where_grades_are_shown(tmp_path: Path, capsys) -> None:
    course = new_course(tmp_path / "c")
    with Gradebook.open(course) as book:
        pid = book.students_from_roster(course.roster)[1].pid
    assert run(["roster", "drop", pid, "--course", str(course.folder)]) == 0
    capsys.readouterr()
    assert run(["gradebook", "show", "--course", str(course.folder)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.endswith("dropped") for line in lines if line.startswith(pid)] == [True]
    assert sum(line.endswith("dropped") for line in lines) == 1


def test_the_commands_take_in_show_drop_and_forget(tmp_path: Path, capsys) -> None:
    course, file = str(tmp_path / "c"), tmp_path / "class.csv"
    new_course(Path(course)).roster.unlink()
    file.write_text(CLASS, encoding="utf-8")
    assert run(["roster", "import", str(file), "--course", course, "--dry-run"]) == 0
    assert "Nothing was changed" in capsys.readouterr().out
    assert run(["roster", "import", str(file), "--course", course]) == 0
    assert "2 new, 0 known, 0 linked, 0 not listed." in capsys.readouterr().out
    assert run(["roster", "list", "--course", course]) == 0
    said = capsys.readouterr().out
    pid = said.split()[0]
    assert "Søren Ærø" in said
    assert run(["roster", "drop", pid, "--course", course]) == 0
    assert run(["roster", "purge", "--course", course, "--dropped-only", "--yes"]) == 0
    capsys.readouterr()
    assert run(["roster", "list", "--course", course]) == 0
    said = capsys.readouterr().out
    assert "Doe" not in said
    assert "dropped" in said
    assert run(["roster", "import", str(tmp_path / "none.csv"), "--course", course]) == 2

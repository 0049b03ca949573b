"""A course from key to feedback: gradebook, batch grading, pages, commands."""

from __future__ import annotations

import json
import os
import re
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from assignments.course import Course, new_course
from assignments.load import load_assignment
from assignments.variants import signature_of
from assignments.workbook import fill_workbook, write_workbook
from grader.errors import NoKeyError, UnknownVariantError
from grader.form import check_workbook
from grader.gradebook import Gradebook, Student
from grader.grading import Wanted, grade_files
from grader.model import Outcome
from vml_course.cli import run
from vml_course.errors import FileMissingError

TOTAL = load_assignment("soccer-kick").total_points
FOR_E = load_assignment("soccer-kick").question("e").points


@dataclass
class Class:
    """A course with three students who have variants."""

    course: Course
    kit: object
    assignment: object
    students: tuple[Student, ...]

    def variant(self, i: int):
        code = f"CODE{i}"
        signature = signature_of(self.course.secret, "soccer-kick", code)
        return self.kit.variant_of(signature, code, self.students[i].pid)

    def numbers(self, i: int):
        return self.kit.impact(e=0.6 + 0.1 * i)

    def key(self, i: int):
        return self.kit.key_of(self.numbers(i), code=f"CODE{i}", student=self.students[i].pid)

    def workbook(self, i: int, name: str = "", **changes) -> Path:
        folder = self.course.folder / "returned"
        folder.mkdir(exist_ok=True)
        empty, filled = folder / ".empty.xlsx", folder / (name or f"from {i}.xlsx")
        write_workbook(empty, self.assignment, self.variant(i), {g.id: 1.0 for g in self.assignment.givens})
        numbers = self.numbers(i)
        answers = {**self.kit.rounded(self.kit.true_values(numbers)), **changes}
        units = {q.id: q.unit for q in self.assignment.questions if q.unit}
        fill_workbook(empty, filled, answers, units, self.kit.table_of(self.kit.trajectory_m(numbers)))
        return filled


@pytest.fixture
def room(tmp_path, kit, assignment) -> Class:
    course = new_course(tmp_path / "course", "Dynamics")
    with Gradebook.open(course) as book:
        made = Class(course, kit, assignment, book.students_from_roster(course.roster))
        for i in range(3):
            book.keep_key(made.variant(i), made.key(i))
    return made


# ---------------------------------------------------------------- gradebook


def test_students_get_random_pseudonyms_once(room):
    with Gradebook.open(room.course) as book:
        again = book.students_from_roster(room.course.roster)
    assert again == room.students
    assert [student.name for student in again] == ["Ana Example", "Ben Example", "Chi Example"]
    assert len({student.pid for student in again}) == 3
    assert all(re.fullmatch("[2-9a-z]{8}", student.pid) for student in again)


def test_names_stand_in_one_table_only(room):
    grade_files(room.course, [room.workbook(0)])
    with sqlite3.connect(room.course.folder / "gradebook.db") as connection:
        for line in connection.iterdump():
            if "Ana" in line:
                assert line.startswith('INSERT INTO "student_identity"')
    connection.close()


def test_a_key_comes_back_as_it_was_kept(room):
    with Gradebook.open(room.course) as book:
        for key in (book.key_for_code("CODE1"), book.key_of("soccer-kick", room.students[1].pid)):
            assert key.values == room.key(1).values
            np.testing.assert_array_equal(key.xy_px, room.key(1).xy_px)
        book.keep_key(room.variant(1), room.key(1))
        assert book.has_key("soccer-kick", room.students[1].pid)
        assert not book.has_key("soccer-kick", "nobody")


def test_unknown_codes_and_students_are_told(room):
    with Gradebook.open(room.course) as book:
        with pytest.raises(UnknownVariantError, match="a variant code of this course"):
            book.key_for_code("OTHER")
        with pytest.raises(NoKeyError, match="Hand it out first"):
            book.key_of("soccer-kick", "nobody")


def test_runs_are_added_and_the_newest_counts(room):
    first, second = room.workbook(0, "a.xlsx", e=0.1), room.workbook(0, "b.xlsx")
    grade_files(room.course, [first])
    (again,) = grade_files(room.course, [first])
    (better,) = grade_files(room.course, [second])
    assert (again.attempt, better.attempt) == (1, 2)
    with Gradebook.open(room.course) as book:
        (row,) = book.rows()
        assert (row.points, row.attempt, row.student.name) == (TOTAL, 2, "Ana Example")
        assert book.rows("another") == ()
        assert book.is_whole()
    with sqlite3.connect(room.course.folder / "gradebook.db") as connection:
        assert connection.execute("select count(*) from grade_run").fetchone() == (3,)
        assert connection.execute("select count(*) from submission").fetchone() == (2,)
    connection.close()


def test_an_old_file_graded_again_stays_old(room):
    first, second = room.workbook(0, "z.xlsx", e=0.1), room.workbook(0, "a.xlsx")
    grade_files(room.course, [first])
    grade_files(room.course, [second])
    (again,) = grade_files(room.course, [first])
    with Gradebook.open(room.course) as book:
        (row,) = book.rows()
    assert (again.attempt, row.attempt, row.points, row.attempts) == (1, 2, TOTAL, 2)
    assert "attempt 2" in Path(again.feedback).read_text(encoding="utf-8")


def test_files_of_one_student_are_taken_in_the_order_of_their_change(room):
    newest, oldest = room.workbook(0, "a.xlsx"), room.workbook(0, "z.xlsx", e=0.1)
    os.utime(oldest, (1e9, 1e9))
    graded = grade_files(room.course, [newest, oldest])
    assert [(item.file.name, item.attempt) for item in graded] == [("a.xlsx", 2), ("z.xlsx", 1)]
    assert all("2 files of this student came together" in item.message for item in graded)
    page = (room.course.folder / "feedback" / "soccer-kick" / "class.html").read_text(encoding="utf-8")
    assert "2 attempts; number 2 counts" in page
    assert "No grade yet (2): Ben Example, Chi Example" in page


def test_a_person_settles_a_review(room, capsys):
    grade_files(room.course, [room.workbook(0, e="about 0.6")])
    course, pid = ["--course", str(room.course.folder)], room.students[0].pid
    assert run(["gradebook", "show", *course]) == 0
    assert f"up to {TOTAL:g}" in capsys.readouterr().out
    call = ["gradebook", "set", pid, "soccer-kick", "e"]
    assert run([*call, "4.5", "--reason", "0.6 was meant", *course]) == 0
    with Gradebook.open(room.course) as book:
        (row,) = book.rows()
        assert book.is_whole()
    assert (row.points, row.status, row.reasons, row.outcomes["e"]) == (TOTAL - 1.5, "ok", (), Outcome.PARTIAL)
    assert "0.6 was meant" in (room.course.folder / "feedback/soccer-kick/class.html").read_text(encoding="utf-8")
    assert run([*call[:-1], "total", "3", "--reason", "copied", *course]) == 0
    with Gradebook.open(room.course) as book:
        assert book.rows()[0].points == 3.0
    grade_files(room.course, [room.workbook(0, "new.xlsx")])
    with Gradebook.open(room.course) as book:
        assert book.rows()[0].points == TOTAL  # a newer attempt is judged anew


@pytest.mark.parametrize(
    ("who", "question", "points", "reason"),
    [("nobody", "e", "1", "x"), ("", "speed", "1", "x"), ("", "e", "99", "x"), ("", "e", "1", " ")],
)
def test_what_cannot_be_set_is_one_line(room, capsys, who, question, points, reason):
    grade_files(room.course, [room.workbook(0)])
    call = ["gradebook", "set", who or room.students[0].pid, "soccer-kick", question, points, "--reason", reason]
    assert run([*call, "--course", str(room.course.folder)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_points_below_zero_are_refused_as_a_number(room, capsys):
    grade_files(room.course, [room.workbook(0)])
    call = ["gradebook", "set", room.students[0].pid, "soccer-kick", "e", "-1", "--reason", "x"]
    assert run([*call, "--course", str(room.course.folder)]) == 2
    assert "points: expected 0 to " in capsys.readouterr().err


@pytest.mark.skipif(os.name != "posix", reason="modes of files")
def test_the_gradebook_is_its_owners_alone(room):
    file = room.course.folder / "gradebook.db"
    assert file.stat().st_mode & 0o777 == 0o600
    file.chmod(0o644)
    with Gradebook.open(room.course):
        assert file.stat().st_mode & 0o777 == 0o600


def test_a_changed_event_shows(room):
    with sqlite3.connect(room.course.folder / "gradebook.db") as connection:
        connection.execute("update event set data_json = '{}' where id = 4")
    connection.close()
    with Gradebook.open(room.course) as book:
        assert not book.is_whole()


def test_two_graders_at_once_lose_nothing(room):
    files = [room.workbook(i) for i in range(3)]
    with ThreadPoolExecutor(4) as pool:
        batches = list(pool.map(lambda _: grade_files(room.course, files), range(4)))
    assert all(item.status == "ok" for batch in batches for item in batch)
    with Gradebook.open(room.course) as book:
        assert [row.attempt for row in book.rows()] == [1, 1, 1]
        assert book.is_whole()


def test_a_batch_is_graded_recorded_and_explained(room):
    room.workbook(0)
    room.workbook(1, e=float(f"{1 / room.numbers(1).e:.4g}"))
    (room.course.folder / "returned" / "notes.xlsx").write_bytes(b"%PDF-1.4")
    told = []
    graded = grade_files(room.course, [room.course.folder / "returned"], progress=lambda *done: told.append(done))
    assert [(item.file.name, item.status, item.points) for item in graded] == [
        ("from 0.xlsx", "ok", TOTAL),
        ("from 1.xlsx", "ok", TOTAL - FOR_E),
        ("notes.xlsx", "unreadable", 0.0),
    ]
    assert told == [(1, 3), (2, 3), (3, 3)]
    assert "PDF" in graded[2].message
    page = Path(graded[1].feedback).read_text(encoding="utf-8")
    assert "<b>e</b>: Your e looks turned over" in page
    assert "Ben" not in page
    overview = (room.course.folder / "feedback" / "soccer-kick" / "class.html").read_text(encoding="utf-8")
    assert "Ben Example" in overview
    assert "PDF" in overview


def test_received_bytes_are_kept_as_they_came(room):
    file = room.workbook(0)
    grade_files(room.course, [file, file])
    kept = [path for path in (room.course.folder / "inbox").rglob("*") if path.is_file()]
    assert [path.read_bytes() for path in kept] == [file.read_bytes()]


@pytest.mark.parametrize("name", ["missing.xlsx", "."])
def test_what_cannot_be_read_is_a_status(room, name):
    """One missing file beside a good one is a status; nothing at all is a mistake of the call."""
    empty = room.course.folder / "nothing"
    empty.mkdir()
    missing = empty if name == "." else room.course.folder / name
    with pytest.raises(FileMissingError, match="expected"):
        grade_files(room.course, [missing])
    graded = grade_files(room.course, [room.workbook(0), missing])
    if name != ".":
        assert (graded[1].status, graded[1].needs_attention) == ("unreadable", True)


def test_another_courses_workbook_is_not_graded(room, tmp_path):
    other = Class(new_course(tmp_path / "other"), room.kit, room.assignment, room.students)
    (item,) = grade_files(room.course, [other.workbook(0)])
    assert item.status == "unreadable"
    assert "a variant code of this course" in item.message


def test_a_hidden_truth_stays_hidden(room):
    (item,) = grade_files(room.course, [room.workbook(0, v_b2=1.0, px_per_m=7.0)], Wanted(show_truth=False))
    page = Path(item.feedback).read_text(encoding="utf-8")
    assert "True value" not in page
    assert "<svg" not in page
    assert f"{room.numbers(0).u2:.4g}" not in page


def test_the_truth_is_hidden_unless_it_is_asked_for(room, capsys):
    file, course = str(room.workbook(0)), ["--course", str(room.course.folder)]
    page = room.course.folder / "feedback" / "soccer-kick" / f"{room.students[0].pid}.html"
    assert run(["grade", file, *course]) == 0
    assert "True value" not in page.read_text(encoding="utf-8")
    assert run(["grade", file, *course, "--show-truth"]) == 0
    assert "True value" in page.read_text(encoding="utf-8")
    assert "from 0.xlsx" in capsys.readouterr().out


def test_stopping_a_long_run_says_how_to_go_on(room, monkeypatch, capsys):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("grader.handing_out.hand_out_to", stopped)
    assert run(["handout", "soccer-kick", "--course", str(room.course.folder)]) == 130
    assert "run the same command again to continue" in capsys.readouterr().err


def test_a_unit_that_was_not_chosen_is_said(room, capsys):
    file = room.workbook(0)
    fill_workbook(file, file, {}, {"v_b2": ""})
    assert run(["check", str(file)]) == 1
    shown = capsys.readouterr().out
    assert "choose one in column D" in shown
    assert "variant code" in shown


# ---------------------------------------------------------------- check and hand out


def test_a_check_sees_form_only(room):
    result = check_workbook(room.workbook(0, e=99.0))
    assert result.is_complete
    assert result.tracking_rows == 60
    result = check_workbook(room.workbook(0, "b.xlsx", v_b2="", px_per_m="1,234", omega1="17 s", I="1,234"))
    answers = {answer.question_id: answer for answer in result.answers}
    unread = {q: a.status for q, a in answers.items() if a.status != "read"}
    assert unread == {"v_b2": "empty", "px_per_m": "unclear", "omega1": "unclear"}
    assert answers["I"].says == "1,234, read as 1.234 kg m^2"
    assert not result.is_complete


# ---------------------------------------------------------------- commands


@pytest.mark.parametrize("command", [["grade"], ["handout"], ["check"], ["gradebook", "show"]])
def test_every_command_has_help_with_an_example(capsys, command):
    assert run([*command, "--help"]) == 0
    assert f"vml {' '.join(command)}" in " ".join(capsys.readouterr().out.split())


def test_grade_prints_json_and_ends_with_one_when_someone_should_look(room, capsys):
    good, bad = room.workbook(0), room.course.folder / "x.xlsx"
    bad.write_bytes(b"")
    course = ["--course", str(room.course.folder)]
    assert run(["grade", str(good), *course, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["points"] == TOTAL
    assert run(["grade", str(good), str(bad), *course]) == 1
    shown = capsys.readouterr().out
    assert "empty file" in shown
    assert "Class page:" in shown


def test_the_gradebook_is_shown(room, capsys):
    grade_files(room.course, [room.workbook(0)])
    assert run(["gradebook", "show", "--course", str(room.course.folder)]) == 0
    shown = capsys.readouterr().out
    assert f"{TOTAL:g} / {TOTAL:g}" in shown
    assert shown.count("nothing graded yet") == 2
    assert run(["gradebook", "show", "--course", str(room.course.folder), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["student"]["name"] == "Ana Example"


def test_check_says_whether_a_workbook_is_complete(room, capsys):
    assert run(["check", str(room.workbook(0))]) == 0
    assert "Complete" in capsys.readouterr().out
    assert run(["check", str(room.workbook(0, e="")), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["is_complete"] is False


@pytest.mark.parametrize(
    "arguments", [["check", "no.xlsx"], ["grade", "x", "--course", "no"], ["gradebook", "show", "--course", "no"]]
)
def test_mistakes_are_one_line(arguments, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1


# ---------------------------------------------------------------- comparing a class


def test_a_class_is_compared_and_no_grade_changes(room, capsys):
    """The third student hands in the table of the first one."""
    files = [room.workbook(i) for i in range(2)]
    copied = room.kit.table_of(np.round(room.kit.trajectory_m(room.numbers(0)), 6))
    empty, third = room.course.folder / "empty.xlsx", room.course.folder / "third.xlsx"
    write_workbook(empty, room.assignment, room.variant(2), {g.id: 1.0 for g in room.assignment.givens})
    fill_workbook(empty, third, room.kit.rounded(room.kit.true_values(room.numbers(2))), {}, copied)
    grade_files(room.course, [*files, third])
    with Gradebook.open(room.course) as book:
        before = book.rows()
    assert run(["integrity", "soccer-kick", "--course", str(room.course.folder)]) == 0
    said = capsys.readouterr().out
    (line,) = (line for line in said.splitlines() if "other-video" in line)
    assert line.split()[:2] == [room.students[2].pid, room.students[0].pid]
    assert line.endswith("in at most 3.0% of honest classes")
    assert "3 workbooks compared" in said
    assert "not a verdict" in said
    assert run(["integrity", "soccer-kick", "--course", str(room.course.folder), "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["new"] == 0
    assert again["evidence"]
    with Gradebook.open(room.course) as book:
        assert book.rows() == before


def test_comparing_an_unknown_assignment_is_one_line(room, capsys):
    assert run(["integrity", "soccer-kik", "--course", str(room.course.folder)]) == 2
    assert "soccer-kick" in capsys.readouterr().err

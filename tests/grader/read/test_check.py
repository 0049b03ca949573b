"""What `vml check` tells a student: form, and whether the workbook agrees with itself. Never the truth."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from assignments.model import NOBODY
from assignments.workbook import fill_workbook, write_workbook
from grader.consistent import _OF_FLAGS, remarks_on
from grader.form import check_workbook
from grader.read import ReadRequest, find_submission, read_workbook
from grader.read.book import Book
from grader.template import template_cells
from vml_course.cli import run

GIVEN = {"m": 0.35, "L": 0.5, "D": 0.22}


def remarks(desk, changes=None, units=None, tracking=None, flags=(), given=GIVEN):
    book = read_workbook(ReadRequest("w.xlsx", desk.workbook(changes, units).read_bytes()))
    submission = find_submission(book, desk.assignment.questions, template_cells(desk.assignment))
    table = submission.tracking if tracking is None else tracking(dict(submission.tracking))
    submission = replace(submission, tracking=table, flags=flags)
    labels = {g.label: given.get(g.id) for g in desk.assignment.givens}
    patched = replace_numbers(book, labels)
    return list(remarks_on(patched, submission, desk.assignment))


def replace_numbers(book: Book, numbers) -> Book:
    """The book with other given numbers."""
    sheet = book.sheets[0]
    cells = dict(sheet.cells)
    for (row, column), cell in sheet.cells.items():
        if numbers.get(cell.text) is not None:
            cells[row, column + 2] = cells[row, column + 2]._replace(number=numbers[cell.text])
    return replace(book, sheets=(replace(sheet, cells=cells), *book.sheets[1:]))


def test_a_good_workbook_has_no_remark(desk):
    assert remarks(desk) == []


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"e": 1.4}, "e = 1.4 is unusual: check sign and unit."),
        ({"e": -0.7}, "e = -0.7 is unusual"),
        ({"I": -1.0}, "I = -1 kg m^2 is unusual"),
        ({"v_b2": 9000.0}, "v_b2 = 9000 m/s is unusual"),
        ({"fps": 30.0}, "The table runs at 480 frames a second, but you wrote 30."),
        ({"v_f1": 99.0}, "v_f1 is not ω_1 times L"),
        ({"omega1": -20.0}, "foot turns counter-clockwise about knee; the sign of ω_1 says otherwise."),
        ({"e": "0,7"}, "Numbers written as text, which were understood: e."),
    ],
)
def test_numbers_that_disagree_are_named(desk, changes, words):
    assert any(words in remark for remark in remarks(desk, changes))


def test_a_missing_number_is_compared_with_nothing(desk):
    assert remarks(desk, {"v_f1": ""}) == []


def column(name, make):
    return lambda table: {**table, name: make(table)}


@pytest.mark.parametrize(
    ("tracking", "words"),
    [
        (lambda t: {k: v for k, v in t.items() if "knee" not in k}, "no positions in metres called knee. Name columns"),
        (
            lambda t: {k.replace("knee", "mass_a"): v for k, v in t.items()},
            "called knee; which of them is mass_a? Name columns knee_x_m.",
        ),
        (lambda t: {k: v[:5] for k, v in t.items()}, "5 rows; 10 are the least"),
        (lambda t: {k: v for k, v in t.items() if k not in {"frame", "t_s"}}, "neither frame numbers nor times"),
        (
            column("t_s", lambda t: t["t_s"][::-1]),
            "The times of the table do not rise in 59 places, first after row 1.",
        ),
        (column("frame", lambda t: np.r_[0, 0, t["frame"][2:]]), "frame numbers of the table do not rise in 1 places"),
        (column("ball_x_px", lambda t: 300 * t["ball_x_m"]), "The table has 300 pixels in a metre, but you wrote 500."),
        (
            lambda t: {k: -v if "_y_" in k else v for k, v in t.items()},
            "foot turns clockwise about knee; the sign of ω_1",
        ),
    ],
)
def test_a_table_that_disagrees_is_named(desk, tracking, words):
    assert any(words in remark for remark in remarks(desk, tracking=tracking))


@pytest.mark.parametrize(
    "tracking",
    [
        lambda t: {},
        column("ball_x_px", lambda t: 500 * t["ball_x_m"]),
        column("knee_x_px", lambda t: np.full_like(t["frame"], np.nan)),
        column("t_s", lambda t: np.full_like(t["frame"], np.nan)),
        lambda t: {**t, "foot_x_m": t["knee_x_m"], "foot_y_m": t["knee_y_m"] + 1},
    ],
)
def test_a_table_that_says_nothing_against_it_has_no_remark(desk, tracking):
    assert remarks(desk, tracking=tracking) == []


def test_without_a_written_scale_none_is_compared(desk):
    assert remarks(desk, {"px_per_m": ""}, tracking=column("ball_x_px", lambda t: 300 * t["ball_x_m"])) == []


@pytest.mark.parametrize("flag", _OF_FLAGS)
def test_every_flag_is_said(desk, flag):
    assert remarks(desk, flags=(flag, "unknown")) == [_OF_FLAGS[flag]]


def test_the_answers_are_looked_at_for_form(desk):
    changes = {"e": "", "v_f1": "1,234 km/h", "I": "?", "v_b2": 9000.0, "v_f2": "450 px/s"}
    result = check_workbook(desk.workbook(changes, {"omega1": ""}))
    status = {answer.question_id: answer.status for answer in result.answers}
    assert (status["e"], status["I"], status["omega1"], status["v_f2"]) == ("empty", "unclear", "no unit", "no unit")
    assert status["v_b2"] == "read"
    assert not result.is_complete
    assert result.tracking_rows == 60
    assert any("v_b2 = 9000" in remark for remark in result.remarks)


def test_an_older_version_is_pointed_out(desk, monkeypatch):
    monkeypatch.setattr("grader.form.load_assignment", lambda _: replace(desk.assignment, version="2026b"))
    result = check_workbook(desk.workbook())
    assert "of version 1 of the assignment; this program knows version 2026b" in result.remarks[0]


def test_the_command_prints_it(desk, capsys):
    path = str(desk.workbook({"e": 1.4}))
    assert run(["check", path]) == 0
    assert "! e = 1.4 is unusual" in capsys.readouterr().out
    assert run(["check", path, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["is_complete"] is True


def test_a_practice_workbook_is_said_to_be_nobodys(desk, tmp_path, kit, capsys):
    empty, filled = tmp_path / "empty.xlsx", tmp_path / "filled.xlsx"
    write_workbook(empty, desk.assignment, kit.variant_of(student=NOBODY), {g.id: 1.0 for g in desk.assignment.givens})
    numbers = kit.impact()
    units = {q.id: q.unit for q in desk.assignment.questions if q.unit}
    fill_workbook(empty, filled, kit.rounded(kit.true_values(numbers)), units, kit.table_of(kit.trajectory_m(numbers)))
    assert run(["check", str(filled)]) == 0
    assert "it is a practice workbook, which nobody can hand in" in capsys.readouterr().out


def test_numbers_written_as_text_are_told_in_one_line(desk):
    (said,) = remarks(desk, {"e": "0,7", "I": "0,9"})
    assert said == "Numbers written as text, which were understood: e, I."


def test_nothing_of_the_truth_is_said(desk):
    """The same remarks for every variant: nothing but the workbook is asked."""
    text = " ".join(remarks(desk, {"e": 0.5, "I": 2.0}))
    assert text == ""

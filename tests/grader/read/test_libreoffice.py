"""A workbook that LibreOffice saved says what it said before; the file is genuine, see data/README.md."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from grader.kind import Kind
from grader.read import Book, ReadRequest, read_workbook
from grader.read.locate import claims_of, find_submission
from grader.stated import Stated, state

FILE = Path(__file__).parent / "data" / "libreoffice.xlsx"
TYPED = ("px_per_m", "fps", "omega1", "v_f1", "v_f2", "v_b2", "I")


@pytest.fixture(scope="module")
def book() -> Book:
    return read_workbook(ReadRequest(FILE.name, FILE.read_bytes()))


@pytest.fixture
def saved(book, desk):
    return find_submission(book, desk.assignment.questions, {}, desk.assignment.points)


def test_it_is_known_by_its_code(book):
    assert (claims_of(book).assignment_id, claims_of(book).code, claims_of(book).version) == (
        "soccer-kick",
        "CODE1",
        "1",
    )
    assert [sheet.name for sheet in book.sheets if not sheet.is_visible] == ["_meta"]


def test_answers_are_found_by_name_with_their_units(saved, desk):
    for name in TYPED:
        answer = saved.answer(name)
        assert (answer.kind, answer.found_by) == (Kind.NUMBER, "name")
        stated = state(answer, desk.assignment.question(name))
        assert isinstance(stated, Stated)
        assert stated.value == pytest.approx(desk.truth[name], rel=1e-12)
        assert stated.unit_given
    assert saved.flags == ()


def test_a_formula_is_read_as_libreoffice_worked_it_out(saved, desk):
    t, day = desk.truth, 46143.0  # the date in the cell of v_b1 counts as a number of days
    assert saved.answer("e").number == pytest.approx((t["v_b2"] - t["v_f2"]) / (t["v_f1"] - day), rel=1e-12)


def test_commas_and_dates_stay_what_they_were(saved):
    assert (saved.answer("omega2").kind, saved.answer("omega2").text) == (Kind.TEXT, "16,99")
    assert (saved.answer("v_b1").kind, saved.answer("v_b1").text) == (Kind.DATE, "2026-05-01")


def test_cells_of_every_kind_are_told_apart(book):
    own = next(sheet for sheet in book.sheets if sheet.name == "My work's")
    expected = {
        (1, 1): (Kind.ERROR, "#DIV/0!"),
        (2, 1): (Kind.TEXT, "xb"),
        (4, 3): (Kind.TEXT, "x"),
        (1, 4): (Kind.TEXT, "  spaced\nline  "),
        (2, 4): (Kind.BOOL, "TRUE"),
        (3, 4): (Kind.ERROR, "#N/A"),
    }
    assert {place: (own.at(place).kind, own.at(place).text) for place in expected} == expected


def test_the_general_format_is_no_format(book):
    answers = next(sheet for sheet in book.sheets if sheet.name == "Answers")
    assert {answers.at((row, 3)).format for row in (6, 7, 9, 12, 14)} == {""}


def test_the_table_keeps_fifteen_digits(saved, desk):
    assert list(saved.tracking) == list(desk.table)
    for name, column in desk.table.items():
        np.testing.assert_allclose(saved.tracking[name], column, rtol=1e-14, atol=1e-15)


def test_saving_it_there_says_nothing_new(saved, desk):
    """The same content again is the same attempt: opening and saving a file must not use one up."""
    before = desk.read(desk.workbook().read_bytes())
    answers = {**before.answers, "e": saved.answer("e"), "omega2": saved.answer("omega2"), "v_b1": saved.answer("v_b1")}
    assert before.content_sha256 != saved.content_sha256
    again = find_submission(book_with(desk, answers), desk.assignment.questions, {}, desk.assignment.points)
    assert again.content_sha256 == saved.content_sha256


def book_with(desk, answers) -> Book:
    """The workbook that was filled here, with these answers in its cells."""
    book = read_workbook(ReadRequest("w.xlsx", desk.workbook().read_bytes()))
    ((index, sheet),) = [(i, sheet) for i, sheet in enumerate(book.sheets) if sheet.name == "Answers"]
    cells = dict(sheet.cells)
    for row in range(1, 40):
        name = next((q.id for q in desk.assignment.questions if sheet.at((row, 1)).text == q.label), "")
        if name in {"e", "omega2", "v_b1"}:
            answer = answers[name]
            cells[row, 3] = cells[row, 3]._replace(kind=answer.kind, number=answer.number, written=answer.text)
    return replace(book, sheets=(*book.sheets[:index], replace(sheet, cells=cells), *book.sheets[index + 1 :]))

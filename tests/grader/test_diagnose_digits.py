"""How the digits of an answer, and those of all cells, decide what fits it."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assignments.model import Question
from grader.diagnose import Candidate, _sharper, diagnose_answer, matching, usual_digits
from grader.model import Answer, Kind, Submission
from grader.stated import Stated

NUMBER = Question("e", "e", "e", "number", "", 1.0, "", 0.02, "conclusion")


def test_codes_that_fit_to_the_digits_go_before_those_within_half_a_percent() -> None:
    stated = Stated(1.0, 0.0, "1", unit_given=True)
    exact, near, far = Candidate("A", 1.0004), Candidate("B", 1.004), Candidate("C", 1.006)
    assert matching(stated, (near, exact)) == ("A",)
    assert matching(stated, iter((far, near))) == ("B",)
    assert matching(stated, (far,)) == ()
    assert matching(stated, (Candidate("D", 0.0), Candidate("E", math.inf), Candidate("F", math.nan))) == ()
    assert matching(Stated(-1.0, 0.0, "-1", unit_given=True), (Candidate("G", -1.0004),)) == ("G",)


def test_what_is_off_by_the_whole_half_unit_still_fits() -> None:
    assert matching(Stated(0.75, 0.125, "", unit_given=True), (Candidate("A", 0.875),)) == ("A",)
    assert matching(Stated(0.75, 0.125, "", unit_given=True), (Candidate("A", 0.876),)) == ()


@settings(deadline=None)
@given(st.floats(0.0, 0.1), st.floats(0.0, 0.1), st.floats(-0.3, 0.3))
def test_rounding_of_the_answer_and_of_what_it_comes_from_are_both_allowed(
    half: float, rounding: float, off: float
) -> None:
    fits = matching(Stated(1.0 + off, half, "", unit_given=True), (Candidate("A", 1.0, rounding),)) == ("A",)
    if abs(abs(off) - max(half + rounding, 0.005)) > 1e-9:
        assert fits == (abs(off) < max(half + rounding, 0.005))


@pytest.mark.parametrize(
    ("texts", "digits"),
    [
        (("12.4", "0.7", "3.05"), 3),
        (("12.4", "0.700", "3.05"), 3),
        (("1.234", "2.345", "0.0678", "9"), 4),
        (("12.4", "0.7"), 0),
        (("12.4", "0.7", "3.0512345"), 0),
        (("-12.4", "5", "-312"), 3),
    ],
)
def test_the_usual_number_of_digits_is_that_of_most_cells(texts, digits: int) -> None:
    cells = {
        name: Answer(Kind.NUMBER, float(text), text, "", "", "name") for name, text in zip("abcd", texts, strict=False)
    }
    asked = {name: replace(NUMBER, id=name) for name in cells}
    assert usual_digits(Submission("w.xlsx", "a", "", cells, {}), asked) == digits


def test_where_it_is_not_known_how_many_digits_are_usual_a_cell_is_taken_as_it_stands() -> None:
    assert _sharper(0.02, 0.5, 0) == 0.5
    assert _sharper(0.02, 0.5, 1) == pytest.approx(0.005)
    assert _sharper(0.0, 0.5, 4) == 0.5
    assert _sharper(12.0, 0.5, 4) == pytest.approx(0.005)
    assert _sharper(12.345, 0.0005, 3) == 0.0005


def test_a_student_who_writes_one_digit_is_told_no_mistake(kit, desk):
    """0.6 is within its rounding of half of what the catalogue holds."""
    questions = {question.id: question for question in desk.assignment.questions}
    written = {"v_f1": 9.0, "v_f2": 7.0, "v_b1": 0.0, "v_b2": 8.0}
    for value in (0.3, 0.5, 0.6, 0.8, 2.0):  # 0.1 would follow
        submission = kit.submission_of(desk.assignment, {**written, "e": value})
        assert diagnose_answer("e", submission, desk.key, questions) is None

"""A cell as a quantity: its value, how exactly it was written, or why it says nothing and who is to look."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assignments.model import Question
from grader.model import Answer, Kind, Outcome
from grader.read.locate import SEVERAL
from grader.stated import Stated, Unstated, state

SPEED = Question("v", "Speed", "v", "velocity", "m/s", 1.0, "velocity", 0.02, "measurement")
RATIO = Question("e", "Ratio", "e", "number", "", 1.0, "conclusion", 0.02, "conclusion")
SCALE = Question("s", "Scale", "S", "scale", "px/m", 1.0, "scale", 0.01, "calibration")


def typed(text, question=SPEED, unit="", read_as=""):
    return state(Answer(Kind.TEXT, None, text, unit, "Answers!C7", "name", read_as), question)


def number(text, question=SPEED, unit="m/s"):
    return state(Answer(Kind.NUMBER, float(text), text, unit, "Answers!C7", "name"), question)


# ---------------------------------------------------------------- the value


def test_a_number_has_the_unit_of_its_unit_cell():
    assert number("12.5") == Stated(12.5, 0.05, "12.5 m/s", unit_given=True)
    assert number("36", unit="km/h") == Stated(pytest.approx(10.0), pytest.approx(0.5 / 3.6), "36 km/h", True)


def test_a_number_without_a_unit_is_read_in_the_one_that_was_asked():
    assert number("12.5", unit="") == Stated(12.5, 0.05, "12.5", unit_given=False)
    assert number("0.73", RATIO, "") == Stated(0.73, 0.005, "0.73", unit_given=True)


def test_a_unit_behind_a_typed_number_wins_over_the_unit_cell():
    assert typed("12.5 cm/s", unit="km/h").value == pytest.approx(0.125)
    assert typed("12.5", unit="cm/s") == Stated(pytest.approx(0.125), pytest.approx(0.0005), "12.5 cm/s", True)
    assert typed("12.5 cm/s", unit="km/h").text == "12.5 cm/s"


def test_what_was_meant_by_a_comma_is_what_is_read_and_shown():
    stated = typed("9,703", unit="m/s", read_as="9.703")
    assert (stated.value, stated.text, stated.half_unit) == (9.703, "9.703 m/s", 0.0005)
    assert typed("9,703 m/s", read_as="9.703 m/s").text == "9.703 m/s"


def test_a_stated_uncertainty_is_in_the_same_unit():
    assert typed("(12.5 ± 0.5) cm/s").uncertainty == pytest.approx(0.005)
    assert typed("12.5", unit="m/s").uncertainty is None


@pytest.mark.parametrize(
    "read",
    [lambda: typed("740 px/s"), lambda: number("740", unit="px/s"), lambda: typed("740", unit="px/s")],
)
def test_pixels_say_so(read):
    stated = read()
    assert (stated.value, stated.half_unit, stated.unit_given, stated.in_pixels) == (740.0, 0.0, True, True)
    assert stated.text == "740 px/s"
    assert not number("740").in_pixels


# ---------------------------------------------------------------- how exactly it was written


@pytest.mark.parametrize(
    ("text", "half_unit"),
    [
        ("24", 0.5),
        ("24.", 0.5),
        ("24.0", 0.05),
        ("24,0", 0.05),
        ("-24.00", 0.005),
        ("−24.00", 0.005),
        ("– 24.00", 0.005),
        ("+24.00", 0.005),
        ("0.024", 0.0005),
        (".5", 0.05),
        ("2.4e1", 0.5),
        ("2.4e-3", 5e-5),
        ("2.4E+3", 50.0),
        ("1 234", 0.5),
        ("1 234,5", 0.05),
        ("1 234.5", 0.05),
        ("1.234,5", 0.05),
        ("1,234.5", 0.05),
        ("\u200b24.0", 0.05),
        ("２４.0", 0.05),
        ("24.0 ± 0.5 m/s", 0.05),
        ("(24.0 ± 0.5) m/s", 0.05),
        ("24.0 km/h", 0.05 / 3.6),
        ("24.0 m/s", 0.05),
        ("0", 0.0),
        ("0.00", 0.0),
        ("24.1234", 0.0),
        ("24.123", 0.0005),
        ("0.0123456", 0.0),
        ("0.012345", 5e-7),
        ("2.4·10^1", 0.0),
        ("2.4 × 10¹", 0.0),
        ("2.4x10^1", 0.0),
        ("1e-290", 5e-291),
        ("1e-299", 5e-300),
        ("1.0e-299", 0.0),
        ("1e299", 5e298),
        ("1e300", 0.0),
    ],
)
def test_half_of_the_last_written_digit(text, half_unit):
    assert typed(text).half_unit == pytest.approx(half_unit, rel=1e-9, abs=0)


def test_a_unit_that_begins_with_a_digit_is_no_digit():
    rate = replace(SPEED, dimension="angular_velocity", unit="rad/s")
    assert typed("20.5 1/s", rate).half_unit == 0.05


def test_a_percentage_is_written_to_its_own_digits():
    assert typed("73 %", RATIO).half_unit == pytest.approx(0.005)
    assert typed("73 %", RATIO).value == pytest.approx(0.73)


def test_a_scale_turned_over_is_not_said_to_be_rounded():
    assert typed("2 mm/px", SCALE) == Stated(500.0, 0.0, "2 mm/px", unit_given=True)


@given(st.integers(1, 99999), st.integers(0, 6))
def test_the_truth_lies_within_half_a_digit_of_what_was_rounded(digits, decimals):
    value = digits / 10**decimals
    stated = typed(f"{value:.{decimals}f}")
    assert abs(stated.value - value) <= stated.half_unit
    assert stated.half_unit == pytest.approx(0.5 * 10**-decimals)


# ---------------------------------------------------------------- what says no quantity


def cell(kind, text="", number=None, found_by="name"):
    return state(Answer(kind, number, text, "m/s", "Answers!C7", found_by), SPEED)


@pytest.mark.parametrize(
    ("read", "outcome", "words"),
    [
        (lambda: cell(Kind.BLANK), "wrong", ["Nothing is written here"]),
        (lambda: cell(Kind.BOOL, "TRUE"), "wrong", ["TRUE or FALSE", "not a number"]),
        (lambda: cell(Kind.ERROR, "#DIV/0!"), "wrong", ["#DIV/0!", "Check the cells that it uses"]),
        (lambda: cell(Kind.UNCACHED), "unsure", ["never worked out", "Open the workbook", "save", "hand in again"]),
        (
            lambda: cell(Kind.DATE, "2026-03-04", 46085.0),
            "unsure",
            ["2026-03-04 and holds the number 46085:", "format"],
        ),
        (
            lambda: cell(Kind.DATE, "2026-03-04"),
            "unsure",
            ["a date, 2026-03-04: the spreadsheet", "A person will look"],
        ),
        (lambda: cell(Kind.TEXT, "1; 2", found_by=SEVERAL), "unsure", ["Answers!C7", "1; 2", "Keep one", "A person"]),
        (lambda: typed("1,234", unit="m/s"), "unsure", ["'1,234' can be read in two ways", "Write 1.234 or 1234"]),
        (lambda: typed("fast"), "unsure", ["Expected a number", "'fast'", "A person will look"]),
        (lambda: typed("12 parsec"), "unsure", ["Expected a unit of velocity", "'parsec'", "A person will look"]),
        (lambda: number("12", unit="parsec"), "unsure", ["Expected a unit of velocity", "'parsec'"]),
        (lambda: typed("740 px/s ± 3 m/s"), "unsure", ["Expected", "A person will look"]),
    ],
)
def test_why_a_cell_says_nothing(read, outcome, words):
    unstated = read()
    assert isinstance(unstated, Unstated)
    assert unstated.outcome is Outcome(outcome)
    for word in words:
        assert word in unstated.reason

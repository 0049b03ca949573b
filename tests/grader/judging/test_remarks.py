"""What is said of digits and of a stated uncertainty."""

from __future__ import annotations

import math

import pytest

from grader.judging import judge_value
from grader.remarks import remarks_on_number, significant_digits, z_score
from grader.stated import Stated


def remarks(kick, value, half_unit=0.0, uncertainty=None, sd=0.002, half_width=0.014):
    key = kick.with_key(values={"e": 0.75}, expected_sd={"e": sd}).key
    stated = Stated(value, half_unit, "", unit_given=True, uncertainty=uncertainty)
    return " ".join(remarks_on_number(stated, kick.question("e"), key, half_width))


@pytest.mark.parametrize(
    ("half_unit", "words"),
    [
        (0.05, "too coarsely"),
        (0.015, "one digit more"),
        (0.014, ""),
        (0.0005, ""),
        (2e-5, ""),
        (1.9e-5, "3 sign"),
        (0, ""),
    ],
)
def test_digits_are_remarked_where_they_are_too_few_or_say_too_much(kick, half_unit, words):
    said = remarks(kick, 0.75, half_unit)
    assert words in said
    assert bool(said) == bool(words)


def test_digits_of_a_frame_rate_are_not_talked_of(kick):
    """480 frames a second are 480, though the last digit is coarser than a tolerance of 0.1 %."""
    stated = Stated(480.0, 0.5, "", unit_given=True)
    assert list(remarks_on_number(stated, kick.question("fps"), kick.key, 0.48)) == []


def test_without_a_known_sd_no_digit_is_too_much(kick):
    assert remarks(kick, 0.75, 1e-12, sd=0.0) == ""
    stated = Stated(0.75, 1e-12, "", unit_given=True)
    assert list(remarks_on_number(stated, kick.question("e"), kick.key, 0.014)) == []


@pytest.mark.parametrize(
    ("value", "uncertainty", "words"),
    [
        (0.75, 0.01, "Your ± fits the true value."),
        (1.5, 0.25, "Your ± fits the true value."),
        (0.0, 0.25, "Your ± fits the true value."),
        (1.5001, 0.25, "too small"),
        (-0.0001, 0.25, "too small"),
        (0.75, 0.25 * 5, "Your ± fits the true value."),
        (0.75, 0.2501 * 5, "far wider"),
        (0.75, 0.0, ""),
        (0.75, None, ""),
    ],
)
def test_an_uncertainty_is_held_against_the_truth(kick, value, uncertainty, words):
    said = remarks(kick, value, uncertainty=uncertainty, half_width=0.25)
    assert words in said
    assert bool(said) == bool(words)


def test_a_z_score_counts_own_uncertainties():
    assert z_score(Stated(0.5, 0.0, "", unit_given=True, uncertainty=0.25), 1.0) == -2.0
    assert math.isnan(z_score(Stated(0.5, 0.0, "", unit_given=True), 1.0))


def test_a_value_deserves_digits_down_to_its_sd():
    assert significant_digits(0.0, 0.1) == significant_digits(25.0, 0.0) == significant_digits(25.0, -1.0) == 1
    assert significant_digits(-0.7333, 0.02) == 2
    assert significant_digits(100.0, 1.0) == 3
    assert significant_digits(24.0, 3000.0) == 1


def test_digits_of_a_value_of_another_size_are_not_talked_of(kick):
    coarse = Stated(0.7, 0.05, "", unit_given=True)
    assert "rounded too coarsely" in " ".join(remarks_on_number(coarse, kick.question("e"), kick.key, 0.014))
    assert list(remarks_on_number(coarse, kick.question("e"), kick.key, 0.014, is_near=False)) == []


@pytest.mark.parametrize(
    ("value", "half_width", "is_told"),
    [
        (4.0, 0.25, True),
        (-4.0, 0.25, True),
        (6.0, 0.25, True),  # half as much again
        (6.5, 0.25, False),
        (2.0, 0.25, True),
        (1.5, 0.25, False),
        (12.0, 4.0, True),  # within twice a wide tolerance
        (12.5, 4.0, False),
    ],
)
def test_only_of_a_value_of_the_size_asked_for_the_digits_are_talked_of(kick, value, half_width, is_told):
    bench = kick.with_question("v_b2", tolerance=0.0, floor=half_width).with_key(values={"v_b2": 4.0})
    stated = Stated(value, 2 * half_width, "", unit_given=True)
    message = judge_value(bench.asked("v_b2"), stated, 1.0, 0.0).message
    assert ("rounded too coarsely" in message) is is_told

"""Of several mistakes that fit, those stay that the digits do not speak against."""

from __future__ import annotations

from dataclasses import asdict, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assignments.mistakes import ImpactNumbers
from assignments.textbook import textbook, textbook_names
from grader import weighing
from grader.own import OwnNumbers
from grader.stated import Stated
from grader.weighing import Cell, likely

WRITTEN = ImpactNumbers(v1=10.0, v2=8.0, u1=0.0, u2=15.0, omega1=20.0, omega2=16.0, m=0.5, L=0.5)
HALF = {"v1": 0.05, "v2": 0.05, "u2": 0.05}


def cell(value: float, half_unit: float) -> Stated:
    return Stated(value, half_unit, str(value), unit_given=True)


def way(numbers: ImpactNumbers = WRITTEN, half_units=HALF) -> OwnNumbers:
    return OwnNumbers(asdict(numbers), lambda values: ImpactNumbers(**values), half_units)


def of_v1(factor: float, shift: float = 0.0):
    return lambda n: factor * n.v1 + shift


def test_what_gives_the_very_digits_is_likelier_than_what_only_comes_near() -> None:
    mistakes = {"near": of_v1(1, 1.2e-4), "there": of_v1(1)}
    assert likely(cell(10.0, 1e-4), mistakes, way(), ()) == ("there",)


def test_two_that_give_the_same_digits_are_a_group_in_their_order() -> None:
    mistakes = {"B": of_v1(1, 0.0004), "A": of_v1(1, -0.0004)}
    assert likely(cell(10.0, 0.001), mistakes, way(), ()) == ("B", "A")


def test_a_single_mistake_is_weighed_against_nothing() -> None:
    assert likely(cell(99.0, 0.1), {"only": of_v1(1)}, way(), ()) == ("only",)


def test_an_answer_with_all_digits_tells_exact_numbers_apart() -> None:
    mistakes = {"there": of_v1(1), "near": of_v1(1.0001)}
    assert likely(cell(10.00001, 0.0), mistakes, way(half_units={}), ()) == ("there",)
    assert likely(cell(-10.00001, 0.0), {c: of_v1(-f) for c, f in (("there", 1), ("near", 1.0001))}, way(), ()) == (
        "there",
    )


def test_what_no_mistake_gives_to_the_digits_stays_a_group() -> None:
    mistakes = {"A": of_v1(1, 3.0), "B": of_v1(1, -3.0)}
    assert likely(cell(10.0, 0.001), mistakes, way(), ()) == ("A", "B")


def test_numbers_before_rounding_count_as_well() -> None:
    mistakes = {"typed": of_v1(1), "before": of_v1(1, 0.04), "never": of_v1(1, 0.2)}
    assert likely(cell(10.0, 0.02), mistakes, way(), ()) == ("typed", "before")


def test_another_answer_tells_that_numbers_were_used_as_written() -> None:
    """Both may come from what was rounded; only with the numbers as written does the other answer follow."""
    mistakes = {"typed": of_v1(1), "before": of_v1(1, 0.04)}
    other = Cell(cell(18.0, 1e-4), (lambda n: n.v1 + n.v2,))
    assert likely(cell(10.0, 0.02), mistakes, way(), (other,)) == ("typed",)
    as_loose = Cell(cell(18.0, 1.0), (lambda n: n.v1 + n.v2,))
    assert likely(cell(10.0, 0.02), mistakes, way(), (as_loose,)) == ("typed", "before")


def test_another_answer_tells_where_in_the_last_digit_the_numbers_lie() -> None:
    mistakes = {"low": of_v1(1, 0.04), "high": of_v1(1, -0.04)}
    high = Cell(cell(10.04, 0.01), (of_v1(1),))
    assert likely(cell(10.0, 0.01), mistakes, way(), (high,)) == ("high",)
    assert likely(cell(10.0, 0.01), mistakes, way(), ()) == ("low", "high")


def test_another_answer_counts_if_one_of_its_right_ways_leads_to_it() -> None:
    mistakes = {"low": of_v1(1, 0.04), "high": of_v1(1, -0.04)}
    high = Cell(cell(10.04, 0.01), (lambda n: n.m, of_v1(1)))
    assert likely(cell(10.0, 0.01), mistakes, way(), (high,)) == ("high",)


def test_another_answer_that_is_wrong_itself_is_no_evidence() -> None:
    mistakes = {"near": of_v1(1, 1.2e-4), "there": of_v1(1)}
    wrong = Cell(cell(77.0, 0.1), (of_v1(1),))
    assert likely(cell(10.0, 1e-4), mistakes, way(), (wrong,)) == ("there",)


@settings(deadline=None, max_examples=20)
@given(st.floats(-0.99, 0.99))
def test_a_mistake_made_before_rounding_always_stays(part: float) -> None:
    exact = replace(WRITTEN, v1=WRITTEN.v1 + 0.05 * part)
    mistakes = {"made": lambda n: n.v1 * n.v2, "rival": lambda n: n.v1 * n.v2 + 0.3}
    assert "made" in likely(cell(round(exact.v1 * exact.v2, 1), 0.05), mistakes, way(), ())


def test_draws_fill_the_last_digits_evenly_and_leave_the_rest() -> None:
    draws = list(weighing._before_rounding(way()))
    for name, half in HALF.items():
        parts = sorted((getattr(n, name) - getattr(WRITTEN, name)) / half for n in draws)
        assert parts == pytest.approx([-1 + (2 * k + 1) / len(draws) for k in range(len(draws))], abs=0.03)
    assert {(n.omega1, n.m, n.u1) for n in draws} == {(20.0, 0.5, 0.0)}
    assert len({round(n.v1 - n.v2, 9) for n in draws}) > len(draws) / 2  # each by itself


def test_no_textbook_measures_more_numbers_than_are_drawn() -> None:
    assert max(len({item.field for item in textbook(name).measured}) for name in textbook_names()) <= len(
        weighing._ROOTS
    )

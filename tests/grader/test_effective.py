"""Which attempt counts and what lateness takes off."""

from __future__ import annotations

import datetime as dt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assignments.terms import Late, Terms
from grader.effective import Attempt, Effective, effective

DUE = dt.datetime(2026, 5, 1, tzinfo=dt.UTC)
HOUR = dt.timedelta(hours=1)
TENTH_AN_HOUR = Late("linear", share=0.1, per_hours=1)


def _attempts(*what: tuple[float, float]) -> list[Attempt]:
    """Attempts in order: hours after the due date, points."""
    return [Attempt(number, DUE + hours * HOUR, points) for number, (hours, points) in enumerate(what, start=1)]


THREE = _attempts((-3, 4.0), (-2, 9.0), (-1, 6.0))


@pytest.mark.parametrize(
    ("counts", "attempt", "points"), [("newest", 3, 6.0), ("best", 2, 9.0), ("first", 1, 4.0), ("mean", 3, 19 / 3)]
)
def test_the_attempt_that_the_terms_name_counts(counts, attempt, points) -> None:
    result = effective(THREE, Terms(counts=counts))
    assert (result.attempt, result.ignored) == (attempt, ())
    assert result.points == result.earned == pytest.approx(points, abs=1e-6)


def test_the_best_is_the_best_after_lateness() -> None:
    attempts = _attempts((-1, 8.0), (2.5, 10.0))
    terms = Terms(due=DUE, counts="best", late=TENTH_AN_HOUR)
    assert effective(attempts, terms) == Effective(1, 8.0, 0.0, 8.0)


def test_of_equally_good_attempts_the_earliest_counts() -> None:
    assert effective(_attempts((-2, 8.0), (-1, 8.0)), Terms(counts="best")).attempt == 1


def test_lateness_takes_its_share_of_what_was_earned() -> None:
    result = effective(_attempts((1.5, 10.0)), Terms(due=DUE, late=TENTH_AN_HOUR))
    assert result == Effective(1, 10.0, 0.2, 8.0)


def test_a_small_grade_loses_the_same_share() -> None:
    assert effective(_attempts((0.5, 0.5)), Terms(due=DUE, late=TENTH_AN_HOUR)) == Effective(1, 0.5, 0.1, 0.45)


def test_the_mean_is_of_what_is_left_of_each() -> None:
    result = effective(_attempts((-1, 10.0), (1, 10.0)), Terms(due=DUE, counts="mean", late=TENTH_AN_HOUR))
    assert (result.earned, result.points) == (10.0, 9.5)
    assert result.late_share == pytest.approx(0.05)


def test_attempts_beyond_the_limit_do_not_count() -> None:
    result = effective(THREE, Terms(attempts=2))
    assert (result.attempt, result.points, result.ignored) == (2, 9.0, (3,))
    assert effective(THREE, Terms(attempts=3)).ignored == ()


def test_what_came_after_the_last_moment_does_not_count_and_uses_no_attempt() -> None:
    attempts = _attempts((-1, 5.0), (3, 9.0))
    terms = Terms(due=DUE, closes=DUE + 2 * HOUR, attempts=1)
    assert effective(attempts, terms) == Effective(1, 5.0, 0.0, 5.0, (2,))


def test_who_handed_in_after_the_last_moment_only_has_no_points() -> None:
    result = effective(_attempts((3, 9.0)), Terms(due=DUE, closes=DUE + HOUR))
    assert result == Effective(1, 9.0, 1.0, 0.0, (1,))


def test_no_points_lose_no_share() -> None:
    assert effective(_attempts((1, 0.0)), Terms(due=DUE, late=TENTH_AN_HOUR)) == Effective(1, 0.0, 0.0, 0.0)


@given(
    st.lists(st.tuples(st.floats(-100, 100), st.floats(0, 20)), min_size=1, max_size=6),
    st.sampled_from(["newest", "best", "first", "mean"]),
    st.integers(0, 4),
    st.floats(0, 1),
)
def test_nothing_earns_more_than_its_best_attempt_or_less_than_nothing(what, counts, limit, share) -> None:
    terms = Terms(due=DUE, counts=counts, attempts=limit, late=Late("linear", share=share, per_hours=5))
    result = effective(_attempts(*what), terms)
    assert 0.0 <= result.points <= max(points for _, points in what) + 1e-6
    assert len(result.ignored) == (max(len(what) - limit, 0) if limit else 0)


@given(st.lists(st.tuples(st.floats(-100, 100), st.floats(0, 20)), min_size=1, max_size=6), st.randoms())
def test_the_order_in_which_attempts_are_looked_up_does_not_matter(what, random) -> None:
    attempts = _attempts(*what)
    shuffled = random.sample(attempts, len(attempts))
    terms = Terms(due=DUE, counts="best", attempts=3, late=TENTH_AN_HOUR)
    assert effective(shuffled, terms) == effective(attempts, terms)

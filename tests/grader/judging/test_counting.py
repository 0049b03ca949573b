"""How attempts, lateness and the due date are told to a student."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from assignments.terms import Late, Terms
from grader.counting import standing


def row(attempts=1, **changes):
    facts = {"attempts": attempts, "attempt": 1, "late_share": 0.0, "earned": 10.0, "points": 10.0, "ignored": ()}
    return SimpleNamespace(**{**facts, **changes})


def terms(attempts=0, counts="newest"):
    return Terms(attempts=attempts, counts=counts)


def words(*args, due="", closes="", is_over=False):
    return " ".join(standing(*args, due, closes, is_over=is_over).sentences)


@pytest.mark.parametrize(
    ("used", "allowed", "is_over", "said", "may"),
    [
        (1, 3, False, "1 of 3 attempts used, 2 attempts left. The newest attempt counts.", True),
        (2, 3, False, "2 of 3 attempts used, 1 attempt left. The newest attempt counts.", True),
        (3, 3, False, "3 of 3 attempts used, no attempt is left. The newest attempt counts.", False),
        (4, 3, False, "4 of 3 attempts used, no attempt is left. The newest attempt counts.", False),
        (1, 1, False, "1 of 1 attempt used, no attempt is left.", False),
        (1, 0, False, "You may hand in again as often as you like. The newest attempt counts.", True),
        (2, 0, False, "You may hand in again as often as you like. The newest attempt counts.", True),
        (1, 3, True, "1 attempt handed in; the time is over.", False),
        (2, 3, True, "2 attempts handed in; the time is over. The newest attempt counts.", False),
        (1, 0, True, "1 attempt handed in; the time is over.", False),
    ],
)
def test_what_may_still_be_handed_in(used, allowed, is_over, said, may):
    found = standing(row(used), terms(allowed), "", is_over=is_over)
    assert found.sentences == (said,)
    assert found.may_hand_in is may


@pytest.mark.parametrize(
    ("counts", "said"), [("newest", "newest"), ("best", "best"), ("first", "first"), ("mean", "mean of all attempts")]
)
def test_which_attempt_counts(counts, said):
    assert words(row(2), terms(counts=counts)).endswith(f"The {said}{'' if 'all' in said else ' attempt'} counts.")


def test_without_a_row_one_attempt_is_known():
    assert standing(None, terms(2), "", is_over=False).sentences == (
        "1 of 2 attempts used, 1 attempt left. The newest attempt counts.",
    )


def test_the_due_date_comes_first():
    assert words(row(), terms(), due="Friday 12:00").startswith("Due: Friday 12:00. You may")


def test_what_lateness_takes_off_is_told():
    late = row(late_share=0.25, earned=10.0, points=7.5)
    assert "Handed in late: 25 % of the 10 points earned, 2.5, are taken off." in words(late, terms())
    assert "Handed in late: 25 % in the mean of the 10 points" in words(late, terms(counts="mean"))
    assert "late" not in words(row(), terms())


def test_what_came_after_everything_counts_nothing():
    gone = row(2, attempt=2, late_share=1.0, ignored=(2,), points=0.0)
    said = words(gone, terms())
    assert "after the last moment or after the last attempt, so it counts nothing" in said
    assert "taken off" not in said
    assert "100 %" in words(row(2, attempt=1, late_share=1.0, ignored=(2,), points=0.0), terms())
    assert "99 %" in words(row(2, attempt=2, late_share=0.99, ignored=(2,), points=0.1), terms())


def test_attempts_that_do_not_count_are_named():
    assert words(row(3, ignored=(3,)), terms()).endswith(
        "Attempt 3 came too late, or was one too many: it does not count."
    )
    said = words(row(3, ignored=(2, 3)), terms())
    assert said.endswith("Attempts 2, 3 came too late, or were too many: they do not count.")


LATE = Late("fixed", share=0.1)
COSTS = "Late work loses 10 % of its points."


def test_what_lateness_will_cost_is_told_while_a_due_date_can_be_missed():
    allowed = replace(terms(), late=LATE)
    assert words(row(), allowed, due="Friday").startswith(f"Due: Friday. {COSTS} You may")
    assert words(row(), allowed, due="Friday", is_over=True).startswith("Due: Friday. 1 attempt handed in")
    assert COSTS not in words(row(), allowed)


def test_the_last_moment_is_told_until_it_has_passed():
    closes = "Nothing counts that comes after Sunday."
    assert words(row(), terms(), due="Friday", closes=closes).startswith(f"Due: Friday. {closes} You may")
    assert words(row(), terms(), closes=closes).startswith(f"{closes} You may")
    assert closes not in words(row(), terms(), closes=closes, is_over=True)

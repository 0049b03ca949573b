"""Due dates, lateness, extensions: the arithmetic that decides about points."""

from __future__ import annotations

import datetime as dt
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assignments.terms import Calendar, Extension, Late, Terms, TrueValues
from assignments.terms_words import late_text, terms_text

HOUR = 3600.0
DUE = dt.datetime(2026, 5, 1, 22, 0, tzinfo=dt.UTC)

late_rules = st.builds(
    Late,
    rule=st.sampled_from(["none", "fixed", "linear", "steps"]),
    share=st.floats(0, 1),
    per_hours=st.floats(0.1, 200),
    steps=st.lists(st.tuples(st.floats(0, 500), st.floats(0, 1)), max_size=4).map(lambda s: tuple(sorted(s))),
    grace_minutes=st.floats(0, 600),
    cap=st.floats(0, 1),
)


@given(late_rules, st.floats(-1e6, 1e8))
def test_no_rule_takes_off_less_than_nothing_or_more_than_its_cap(late: Late, late_s: float) -> None:
    assert 0.0 <= late.share_off(late_s) <= late.cap


@given(late_rules, st.floats(-1e6, 0))
def test_what_is_in_time_loses_nothing(late: Late, late_s: float) -> None:
    assert late.share_off(late_s) == 0.0


@given(late_rules.filter(lambda late: late.rule != "steps"), st.floats(0, 1e7), st.floats(0, 1e7))
def test_later_never_costs_less(late: Late, one: float, other: float) -> None:
    assert late.share_off(min(one, other)) <= late.share_off(max(one, other))


@pytest.mark.parametrize(
    ("late", "hours", "off"),
    [
        (Late("none"), 1000, 0.0),
        (Late("none", share=0.3), 1000, 0.0),
        (Late("fixed", share=0.3), 1 / 3600, 0.3),
        (Late("fixed", share=0.3), 0, 0.0),
        (Late("fixed", share=0.2), 0.001, 0.2),
        (Late("fixed", share=0.2), 1000, 0.2),
        (Late("linear", share=0.1, per_hours=24), 0.001, 0.1),
        (Late("linear", share=0.1, per_hours=24), 24, 0.1),
        (Late("linear", share=0.1, per_hours=24), 24.001, 0.2),
        (Late("linear", share=0.1, per_hours=24, cap=0.5), 24 * 90, 0.5),
        (Late("steps", steps=((0, 0.1), (24, 0.3))), 0.001, 0.1),
        (Late("steps", steps=((0, 0.1), (24, 0.3))), 24, 0.1),
        (Late("steps", steps=((0, 0.1), (24, 0.3))), 24.001, 0.3),
        (Late("steps", steps=((24, 0.3),)), 1, 0.0),
        (Late("fixed", share=0.2, grace_minutes=15), 0.25, 0.0),
        (Late("fixed", share=0.2, grace_minutes=15), 0.2501, 0.2),
        (Late("linear", share=0.1, per_hours=1, grace_minutes=90), 2, 0.2),
    ],
)
def test_each_rule_takes_off_what_it_says(late: Late, hours: float, off: float) -> None:
    assert late.share_off(hours * HOUR) == pytest.approx(off)


def test_terms_without_dates_are_never_late_closed_or_over() -> None:
    now = dt.datetime(2100, 1, 1, tzinfo=dt.UTC)
    assert (Terms().late_s(now), Terms().is_closed(now), Terms().is_over(now)) == (0.0, False, False)


def test_lateness_counts_from_the_due_moment_in_any_zone() -> None:
    terms = Terms(due=DUE, closes=DUE + dt.timedelta(hours=2))
    berlin = (DUE + dt.timedelta(hours=1)).astimezone(ZoneInfo("Europe/Berlin"))
    assert terms.late_s(berlin) == HOUR
    assert terms.late_s(DUE - dt.timedelta(hours=1)) == 0.0
    assert [terms.is_closed(DUE + dt.timedelta(hours=h)) for h in (2, 2.01)] == [False, True]
    assert [terms.is_over(DUE + dt.timedelta(hours=h)) for h in (2, 2.01)] == [False, True]


def test_without_a_last_moment_it_is_over_when_lateness_takes_everything() -> None:
    """As long as late work earns something, a true value that is shown is an answer."""
    quarters = Late("linear", share=0.25, per_hours=1, grace_minutes=30)
    assert [Terms(due=DUE, late=quarters).is_over(DUE + dt.timedelta(hours=h)) for h in (0, 3, 3.01)] == [
        False,
        False,
        True,
    ]
    for late in (Late(), Late("linear", share=0.25, per_hours=1, cap=0.9), Late("fixed", share=0.5)):
        assert not Terms(due=DUE, late=late).is_over(DUE + dt.timedelta(days=999))
    assert Terms(due=DUE, late=Late("fixed", share=1.0)).is_over(DUE + dt.timedelta(seconds=1))


def test_true_values_are_seen_when_nothing_can_be_handed_in_any_more() -> None:
    terms, later = Terms(due=DUE, closes=DUE, attempts=3), DUE + dt.timedelta(hours=1)
    assert [terms.shows_truth(DUE, attempts) for attempts in (0, 2, 3, 4)] == [False, False, True, True]
    assert terms.shows_truth(later, 0)
    assert not Terms().shows_truth(later, 99)


@pytest.mark.parametrize(("true_values", "shown"), [("never", False), ("always", True)])
def test_true_values_may_be_shown_never_or_always(true_values: TrueValues, shown: bool) -> None:
    terms = Terms(due=DUE, attempts=1, true_values=true_values)
    assert [terms.shows_truth(DUE + dt.timedelta(hours=h), n) for h, n in ((0, 0), (0, 1), (1, 0))] == [shown] * 3


def test_extensions_add_up_for_their_student_and_assignment_only() -> None:
    calendar = Calendar(
        terms={"kick": Terms(due=DUE, closes=DUE, attempts=2), "bat": Terms(due=DUE)},
        extensions=(
            Extension("ann", "ill", "kick", hours=24),
            Extension("ann", "ill again", hours=1, attempts=1),
            Extension("ben", "moved", "kick", attempts=1),
        ),
    )
    ann = calendar.terms_of("kick", "ann")
    assert ann.due == ann.closes == DUE + dt.timedelta(hours=25)
    assert ann.attempts == 3
    assert calendar.terms_of("bat", "ann").due == DUE + dt.timedelta(hours=1)
    assert calendar.terms_of("bat", "ann").attempts == 0  # as many as one likes stays so
    assert calendar.terms_of("kick", "ben") == Terms(due=DUE, closes=DUE, attempts=3)
    assert calendar.terms_of("kick") == Terms(due=DUE, closes=DUE, attempts=2)
    assert calendar.terms_of("rod", "ann") == Terms()


def test_a_due_date_reads_as_students_read_it_in_the_zone_of_the_course() -> None:
    calendar = Calendar("America/New_York", {"kick": Terms(due=DUE), "bat": Terms()})
    assert calendar.due_text("kick") == "Friday 1 May 2026, 18:00 (America/New_York)"
    assert calendar.due_text("bat") == ""


def test_a_students_own_due_date_is_told_with_the_extension() -> None:
    calendar = Calendar("UTC", {"kick": Terms(due=DUE)}, (Extension("ann", "ill", hours=24),))
    assert calendar.due_text("kick", "ann") == "Saturday 2 May 2026, 22:00 (UTC)"
    assert calendar.due_text("kick", "ben") == calendar.due_text("kick") == "Friday 1 May 2026, 22:00 (UTC)"


def test_a_student_is_told_date_lateness_last_moment_and_attempts() -> None:
    late = Late("linear", share=0.1, per_hours=24, cap=0.5)
    terms = Terms(due=DUE, closes=DUE + dt.timedelta(days=7), attempts=3, counts="best", late=late)
    told = terms_text(Calendar("UTC", {"kick": terms}, (Extension("ann", "ill", hours=24),)), "kick", "ann")
    assert told == (
        "Due Saturday 2 May 2026, 22:00 (UTC).",
        "Late work loses 10 % of its points for every 24 h begun, 50 % at most.",
        "Nothing counts that comes after Saturday 9 May 2026, 22:00 (UTC).",
        "3 attempts; the best attempt counts.",
    )


@pytest.mark.parametrize(
    ("late", "words"),
    [
        (Late(), ""),
        (Late("fixed", share=0.25), "Late work loses 25 % of its points."),
        (
            Late("fixed", share=0.2, grace_minutes=10),
            "Late work loses 20 % of its points; up to 10 minutes are let pass.",
        ),
    ],
)
def test_what_lateness_costs_is_said_in_words(late: Late, words: str) -> None:
    assert late_text(late) == words


@pytest.mark.parametrize(("attempts", "said"), [(0, ()), (1, ("One attempt.",))])
def test_how_often_one_may_try_is_said_where_there_is_a_limit(attempts: int, said: tuple[str, ...]) -> None:
    assert terms_text(Calendar("UTC", {"kick": Terms(attempts=attempts)}), "kick") == said

"""When a file counts as handed in: as platform or person say, else to nobody's loss."""

from __future__ import annotations

import datetime as dt

import pytest

from assignments.terms import Late, Terms
from grader.collect import collect
from grader.gradebook import Gradebook
from grader.grading import Wanted, grade_collected, grade_files
from grader.receipts import handed_in_at

SLUG = "soccer-kick"
DUE = dt.datetime(2026, 5, 1, 22, 0, tzinfo=dt.UTC)


def _row(term, i: int):
    with Gradebook.open(term.course) as book:
        return book.row(SLUG, term.pids[i])


@pytest.mark.parametrize(
    ("told", "is_late", "expected"),
    [
        (None, None, DUE),  # the platform does not say: in time
        (None, False, DUE),
        (None, True, DUE + dt.timedelta(minutes=15, seconds=1)),  # late, not said when: nobody pays for collecting late
        (DUE + dt.timedelta(hours=1), None, DUE + dt.timedelta(hours=1)),
        (DUE - dt.timedelta(hours=1), True, DUE - dt.timedelta(hours=1)),
    ],
)
def test_when_something_was_handed_in(told, is_late, expected) -> None:
    moment, terms = DUE + dt.timedelta(hours=5), Terms(due=DUE, late=Late(grace_minutes=15))
    assert handed_in_at(terms, told, is_late=is_late, moment=moment) == expected
    assert handed_in_at(Terms(), None, is_late=is_late, moment=moment) == moment


LATE = """[assignment.soccer-kick]
due = 2026-05-01T22:00:00Z
closes = 2026-05-02T22:00:00Z
late = { rule = "fixed", share = 0.5 }
"""


def test_a_class_that_is_collected_later_is_not_late_but_what_blackboard_dates_is(term) -> None:
    term.say(LATE)
    files = {
        "Lab_nobody_attempt_2026-05-01-23-00-00_lab.xlsx": term.file(0),
        "Lab_nobody_attempt_2026-05-03-00-00-00_lab.xlsx": term.file(1),
        "s_903_5_lab.xlsx": term.file(2),
    }
    collect(term.course, SLUG, term.download(**files))
    graded = grade_collected(term.course, SLUG)
    assert [_row(term, i).late_share for i in range(3)] == [0.5, 1.0, 0.0]
    closed = next(item for item in graded if item.pid == term.pids[1])
    assert "This attempt does not count" in closed.message


def test_a_file_that_nobody_dates_counts_as_in_time_unless_somebody_says(term) -> None:
    term.say(LATE)
    path = term.course.folder / "w.xlsx"
    path.write_bytes(term.file(0))
    grade_files(term.course, [path], Wanted(received=DUE + dt.timedelta(hours=1)))
    assert _row(term, 0).late_share == 0.5
    path.write_bytes(term.file(1))
    grade_files(term.course, [path])
    assert _row(term, 1).late_share == 0.0


def test_a_file_that_is_late_at_an_unknown_time_is_said_to_count_as_just_late(term) -> None:
    """Canvas says LATE and no more: who is collected a week later loses no more than who is collected at once."""
    term.say(LATE.replace('"fixed", share = 0.5', '"linear", share = 0.1, per_hours = 1'))
    names = {"a_LATE_901_1_lab.xlsx": term.file(0), "b_902_2_lab.xlsx": term.file(1)}
    late, in_time = collect(term.course, SLUG, term.download(**names))
    assert (late.status, in_time.message) == ("matched", "")
    assert late.message == "Late; Canvas does not say when: it counts as just late (--received says when)."
    grade_collected(term.course, SLUG)
    assert [_row(term, i).late_share for i in range(2)] == [0.1, 0.0]


def test_a_late_file_of_a_told_time_is_taken_at_its_word(term) -> None:
    term.say(LATE)
    names = {"a_LATE_901_1_lab.xlsx": term.file(0)}
    (late,) = collect(term.course, SLUG, term.download(**names), received=DUE + dt.timedelta(hours=3))
    assert (late.status, late.message) == ("matched", "")
    term.say("")
    (other,) = collect(term.course, SLUG, term.download(**{"b_LATE_902_2_lab.xlsx": term.file(1)}))
    assert other.message == ""  # nothing was due

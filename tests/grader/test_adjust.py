"""What a person decides about an attempt: the arithmetic."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assignments.load import load_assignment
from grader.adjust import TOTAL, Adjustment, Standing, check_adjustment, decided, settle
from grader.advice import next_steps
from grader.model import Diagnosis, Finding, Grade, Outcome
from vml_course.errors import InputError, UnknownNameError

KICK = load_assignment("soccer-kick")
BEFORE = Standing(
    9.0,
    {"e": (6.0, 6.0), "I": (3.0, 6.0)},
    {"e": Outcome.UNSURE, "I": Outcome.PARTIAL},
    ("Unsure about e.", "The workbook carries macros."),
)


def _set(question: str, points: float, reason: str = "seen on paper") -> Adjustment:
    return Adjustment(question, points, reason, "ann", "2026-05-01T10:00:00+00:00")


@pytest.mark.parametrize(
    ("points", "outcome"),
    [(6.0, Outcome.RIGHT), (5.99, Outcome.PARTIAL), (0.01, Outcome.PARTIAL), (0.0, Outcome.WRONG)],
)
def test_a_question_that_was_set_counts_as_set_and_is_unsure_no_more(points: float, outcome: Outcome) -> None:
    after = settle(BEFORE, [_set("e", points)])
    assert after.points == pytest.approx(3.0 + points)
    assert after.worth == {"e": (points, 6.0), "I": (3.0, 6.0)}
    assert after.outcomes == {"e": outcome, "I": Outcome.PARTIAL}
    assert after.reasons == ("The workbook carries macros.",)


def test_another_question_leaves_what_is_unsure_unsure() -> None:
    after = settle(BEFORE, [_set("I", 6.0)])
    assert (after.points, after.outcomes["e"], after.reasons) == (12.0, Outcome.UNSURE, BEFORE.reasons)


def test_the_newest_decision_on_a_question_counts() -> None:
    assert settle(BEFORE, [_set("e", 1.0), _set("e", 4.0)]) == settle(BEFORE, [_set("e", 4.0)])


def test_a_total_settles_the_whole_attempt() -> None:
    after = settle(BEFORE, [_set(TOTAL, 12.5)])
    assert (after.points, after.reasons) == (12.5, ())
    assert after.outcomes == {"e": Outcome.PARTIAL, "I": Outcome.PARTIAL}
    assert after.worth == BEFORE.worth


def test_a_total_leaves_what_was_sure_as_it_was() -> None:
    sure = Standing(9.0, BEFORE.worth, {"e": Outcome.RIGHT, "I": Outcome.WRONG}, ())
    assert settle(sure, [_set(TOTAL, 12.0)]).outcomes == sure.outcomes


def test_a_question_set_after_the_total_changes_it() -> None:
    assert settle(BEFORE, [_set(TOTAL, 12.0), _set("I", 4.0)]).points == 13.0


def test_a_question_that_this_attempt_does_not_have_changes_nothing() -> None:
    assert settle(BEFORE, [_set("omega", 4.0)]) == BEFORE


def test_nothing_decided_changes_nothing() -> None:
    assert settle(BEFORE, []) == BEFORE


@given(st.lists(st.tuples(st.sampled_from(["e", "I"]), st.floats(0, 6)), max_size=6))
def test_points_are_the_sum_of_the_questions(decisions: list[tuple[str, float]]) -> None:
    after = settle(BEFORE, [_set(question, points) for question, points in decisions])
    assert after.points == pytest.approx(sum(points for points, _ in after.worth.values()), abs=1e-5)


def test_a_decision_says_who_when_what_and_why() -> None:
    assert str(_set("e", 4.5)) == "e set to 4.5 by ann on 2026-05-01: seen on paper"


@pytest.mark.parametrize(("question", "points"), [("e", 0.0), ("e", 6.0), (TOTAL, 20.0)])
def test_what_can_be_given_is_accepted(question: str, points: float) -> None:
    check_adjustment(KICK, _set(question, points))


@pytest.mark.parametrize(
    ("question", "points", "reason", "words"),
    [
        ("e", 6.01, "x", "points: expected 0 to 6 for e, got 6.01"),
        ("e", -0.01, "x", "points: expected 0 to 6 for e, got -0.01"),
        (TOTAL, 20.01, "x", "points: expected 0 to 20 for total, got 20.01"),
        ("e", 1.0, " ", "reason: expected why the points are given, got nothing. Say it with --reason."),
        ("e", float("nan"), "x", "points: expected 0 to 6 for e, got nan"),
    ],
)
def test_what_cannot_be_given_is_one_line(question: str, points: float, reason: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        check_adjustment(KICK, _set(question, points, reason))
    assert str(caught.value).rstrip(".") == words.rstrip(".")


def test_an_unknown_question_is_told_with_those_known() -> None:
    with pytest.raises(UnknownNameError, match=r"question: expected one of px_per_m, .*, total, got 'mass'"):
        check_adjustment(KICK, _set("mass", 1.0))


def _found(question: str, aspect: str, points: float, out_of: float) -> Finding:
    return Finding(question, aspect, Outcome.WRONG, points, out_of, "Not the value.", {"value": 1.0}, "swapped")


GRADE = Grade(
    (_found("e", "value", 1.0, 5.0), _found("I", "value", 2.0, 6.0), _found("e", "unit", 1.0, 1.0)),
    points=4.0,
    out_of=12.0,
    status="ok",
    diagnosis=(
        Diagnosis("e", ("inverted",), "Turned over?", "own"),
        Diagnosis("velocities", ("frames",), "Per frame?", "own", ("e", "I")),
    ),
    reasons=("The workbook carries macros.",),
)


@pytest.mark.parametrize(("points", "outcome"), [(6.0, Outcome.RIGHT), (2.4, Outcome.PARTIAL), (0.0, Outcome.WRONG)])
def test_the_page_says_what_a_person_decided_once_and_shares_it_out_among_the_aspects(
    points: float, outcome: Outcome
) -> None:
    told = decided(GRADE, [_set("e", points)])
    value = Finding("e", "value", outcome, points * 5 / 6, 5.0, "A person decided: seen on paper")
    unit = Finding("e", "unit", outcome, points / 6, 1.0, "")
    assert told.findings == (value, GRADE.findings[1], unit)
    assert told.decided == {"e"}


def test_a_decision_about_one_question_says_nothing_of_another() -> None:
    told = decided(GRADE, [_set("I", 6.0)])
    assert [(one.question_id, one.outcome, one.points) for one in told.findings] == [
        ("e", Outcome.WRONG, 1.0),
        ("I", Outcome.RIGHT, 6.0),
        ("e", Outcome.WRONG, 1.0),
    ]


def test_a_decision_about_what_is_worth_nothing_gives_nothing() -> None:
    free = Grade((_found("tracking", "table", 0.0, 0.0),), 0.0, 0.0, "ok")
    (told,) = decided(free, [_set("tracking", 0.0)]).findings
    assert (told.points, told.out_of, told.outcome) == (0.0, 0.0, Outcome.RIGHT)


def test_the_page_says_the_newest_decision() -> None:
    assert decided(GRADE, [_set("e", 1.0), _set("e", 4.0, "read again")]) == decided(
        GRADE, [_set("e", 4.0, "read again")]
    )


def test_hints_go_where_a_person_has_decided_everything_they_are_about() -> None:
    assert [hint.subject for hint in decided(GRADE, [_set("e", 4.0)]).diagnosis] == ["velocities"]
    assert [hint.subject for hint in decided(GRADE, [_set("I", 4.0)]).diagnosis] == ["e", "velocities"]
    assert decided(GRADE, [_set("e", 4.0), _set("I", 4.0)]).diagnosis == ()


@pytest.mark.parametrize("decisions", [[], [_set(TOTAL, 12.0)], [_set("omega", 1.0)]])
def test_findings_stay_where_nobody_decided_about_the_question(decisions: list[Adjustment]) -> None:
    assert decided(GRADE, decisions) == GRADE


def test_the_student_is_told_of_which_symbol_and_why_but_not_by_whom() -> None:
    assert _set("e", 4.5).told("e") == "e set to 4.5 points: seen on paper"


@pytest.mark.parametrize(
    ("points", "words"), [(6.0, "nothing to do"), (3.0, "A person has looked"), (0.0, "A person has")]
)
def test_what_a_person_decided_is_not_to_be_repaired(points: float, words: str) -> None:
    told = decided(replace(GRADE, findings=GRADE.findings[:1], diagnosis=()), [_set("e", points)])
    (step,) = next_steps(told, KICK, may_hand_in=True, show_truth=False)
    assert words in step

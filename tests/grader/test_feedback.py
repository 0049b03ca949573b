"""The student's page: what was written and expected, by question and level, what to do next, what lateness took."""

from __future__ import annotations

import datetime as dt
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from assignments.film import foresee
from assignments.key import answer_key
from assignments.load import assignment_ids, load_assignment
from assignments.terms import Late, Terms
from assignments.variants import draw_variant
from assignments.words import tracking_columns
from grader.advice import next_steps
from grader.counting import standing
from grader.feedback import Report, feedback_page
from grader.frame import ImpactFrame
from grader.grade import grade
from grader.gradebook import Row, Student
from grader.levels import levels_of
from grader.model import Answer, Kind, Submission
from grader.page import points_text
from grader.trajectory import fit_trajectory

FRAME = ImpactFrame(28, 300, 500, 400, 300, "data:image/jpeg;base64,AAAA")
MOST_BYTES = 60_000


def report_of(desk, kit, tracking=None, units=None, **changes) -> Report:
    table = kit.table_of(kit.trajectory_m(desk.numbers)) if tracking is None else tracking
    submission = kit.submission_of(desk.assignment, {**desk.truth, **changes}, units, table)
    return Report(desk.assignment, submission, desk.key, grade(submission, desk.key, desk.assignment))


def row_of(result, **changes) -> Row:
    first = Row(Student("pupil001"), "soccer-kick", 1, result.points, result.out_of, result.status, "")
    return replace(first, earned=result.points, **changes)


def text_of(page: str) -> str:
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", "", page.partition("<body>")[2]))


# ---------------------------------------------------------------- levels


@pytest.mark.parametrize("changes", [{}, {"e": 0.1}, {"v_b2": 1.0, "I": ""}, {"px_per_m": 1.0}])
def test_the_levels_add_up_to_the_points(desk, kit, changes):
    report = report_of(desk, kit, **changes)
    found = [f for level in levels_of(report.grade, report.assignment) for f in level.findings]
    assert sum(f.points for f in found) == pytest.approx(report.grade.points)
    assert sum(f.out_of for f in found) == pytest.approx(report.grade.out_of)


def test_a_wrong_formula_costs_processing_and_no_measurement(desk, kit):
    report = report_of(desk, kit, e=0.1)
    shares = {level.name: level.share for level in levels_of(report.grade, report.assignment)}
    assert shares["Measurement"] == 1.0
    assert shares["Processing"] == pytest.approx(0.5)


# ---------------------------------------------------------------- what was written, what was expected


def test_the_page_says_what_was_written_and_what_was_expected(desk, kit):
    text = text_of(feedback_page(report_of(desk, kit, v_f1="10,5", units={"v_f1": "km/h"})))
    assert "10,5 km/h" in text
    assert f"{desk.truth['v_f1']:g} m/s" in text


def test_nothing_true_is_shown_while_attempts_remain(desk, kit):
    report = replace(report_of(desk, kit, v_b2=1.0, e=0.2), show_truth=False, frame=FRAME)
    page = feedback_page(report)
    assert "True value" not in page
    assert 'class="ring"' not in page
    assert 'class="mine"' in page
    assert f"{desk.truth['v_b2']:.4g}" not in page
    assert "true curves are shown when" in page


def test_a_page_that_never_shows_true_curves_promises_none(desk, kit):
    report = replace(report_of(desk, kit), show_truth=False)
    assert "The true curves are shown when nothing can be handed in" in feedback_page(report)
    page = feedback_page(replace(report, terms=Terms(true_values="never")))
    assert "The true curves are not shown in this course." in page


def test_the_picture_shows_both_points_where_they_are(desk, kit):
    """The table is exact, so that the student's point lies on the true one."""
    page = feedback_page(replace(report_of(desk, kit), frame=FRAME))
    ball = desk.key.xy_px[28, 2] - [300, 500] + 0.5
    at = f'cx="{ball[0]:.1f}" cy="{ball[1]:.1f}"'
    assert f'<circle class="mine" {at}' in page
    assert f'<circle class="ring" {at}' in page


def test_a_table_without_the_frame_shows_the_true_points_alone(desk, kit):
    table = {name: column[:20] for name, column in kit.table_of(kit.trajectory_m(desk.numbers)).items()}
    page = feedback_page(replace(report_of(desk, kit, tracking=table), frame=FRAME))
    assert 'class="mine"' not in page
    assert 'class="ring"' in page
    assert "Your table has no points in this frame." in page


def test_points_outside_of_the_picture_are_in_its_table_only(desk, kit):
    page = feedback_page(replace(report_of(desk, kit), frame=replace(FRAME, left=0, top=0, width=50, height=50)))
    assert 'class="picture"' not in page


@pytest.mark.parametrize("frames", [60, 3000])
def test_a_page_stays_small(desk, kit, frames):
    xy_m = kit.trajectory_m(desk.numbers, frames=frames)
    key = replace(
        desk.key,
        frame=np.arange(frames),
        time_s=np.arange(frames) / kit.FPS,
        xy_px=xy_m * np.array([kit.SCALE, -kit.SCALE]) + np.array([100.0, 400.0]),
    )
    submission = kit.submission_of(desk.assignment, {**desk.truth, "e": 0.1, "v_b2": 1.0}, None, kit.table_of(xy_m))
    frame = replace(FRAME, address="data:image/jpeg;base64," + "A" * 15_000)
    report = Report(desk.assignment, submission, key, grade(submission, key, desk.assignment), frame=frame)
    assert len(feedback_page(report).encode()) <= MOST_BYTES


# ---------------------------------------------------------------- what to do next


@pytest.mark.parametrize(
    ("changes", "units", "expected"),
    [
        ({"v_f1": 5.0}, None, "on each side of the impact, never across it: v<sub>f1</sub>."),
        ({"omega1": "quick"}, None, "Type ω<sub>1</sub> as plain numbers"),
        ({}, {"v_f1": ""}, "Choose the unit in the cell beside v<sub>f1</sub>."),
        ({"I": 55.0}, None, "Work out I again from the numbers that you wrote"),
        ({"px_per_m": 333.0}, None, "Measure the known length again"),
        ({"fps": 100.0}, None, "frame rate of the recording"),
        ({"omega2": 77.0}, None, "angles in radians"),
    ],
)
def test_the_next_step_is_the_one_that_went_wrong(desk, kit, changes, units, expected):
    report = report_of(desk, kit, units=units, **changes)
    steps = next_steps(report.grade, report.assignment, may_hand_in=True, show_truth=False)
    assert any(expected in step for step in steps)
    assert steps[-1] == "Save the workbook and hand it in again."


def test_a_named_mistake_comes_first_and_is_not_told_twice(desk, kit):
    report = report_of(desk, kit, e=1 / desk.numbers.e)
    steps = next_steps(report.grade, report.assignment, may_hand_in=False, show_truth=True)
    assert "Follow the hints" in steps[0]
    assert not any("Work out e again" in step for step in steps)
    assert "Compare" in steps[-1]


def test_right_work_needs_nothing(desk, kit):
    report = report_of(desk, kit)
    assert "nothing to do" in next_steps(report.grade, report.assignment, may_hand_in=True, show_truth=False)[0]


def test_a_missing_table_is_asked_for_and_a_bad_one_is_not(desk, kit):
    missing = report_of(desk, kit, tracking={})
    table = kit.table_of(kit.trajectory_m(desk.numbers) * 2.0)
    bad = report_of(desk, kit, tracking=table)

    def said(report):
        return " ".join(next_steps(report.grade, report.assignment, may_hand_in=False, show_truth=False))

    assert "Paste your measured positions" in said(missing)
    assert "Paste" not in said(bad)


def test_an_empty_workbook_is_told_where_to_type(desk, kit):
    submission = kit.submission_of(desk.assignment, {}, None, {})
    report = Report(desk.assignment, submission, desk.key, grade(submission, desk.key, desk.assignment))
    assert "coloured cells of the sheet Answers" in text_of(feedback_page(report))


# ---------------------------------------------------------------- due date, attempts, lateness

DUE = dt.datetime(2026, 12, 1, 23, 59, tzinfo=dt.UTC)


def test_lateness_is_told_in_points(desk, kit):
    result = report_of(desk, kit).grade
    row = row_of(result, late_share=0.2, attempts=2, attempt=2, ignored=(3,))
    row = replace(row, points=0.8 * row.earned)
    report = replace(
        report_of(desk, kit), row=row, terms=Terms(due=DUE, attempts=3, counts="best"), due="Tuesday", attempt=2
    )
    text = text_of(feedback_page(report))
    assert "Due: Tuesday." in text
    assert "20 % of the 20 points earned, 4, are taken off" in text
    assert f"{points_text(16.0)} of 20 points" in text
    assert "2 of 3 attempts used, 1 attempt left. The best attempt counts." in text
    assert "Attempt 3 came too late, or was one too many: it does not count." in text


@pytest.mark.parametrize(
    ("used", "terms", "is_over", "expected"),
    [
        (1, Terms(), False, ("as often as you like. The newest attempt counts.", True)),
        (2, Terms(attempts=2), False, ("2 of 2 attempts used, no attempt is left. The newest attempt counts.", False)),
        (1, Terms(attempts=1), False, ("1 of 1 attempt used, no attempt is left.", False)),
        (1, Terms(attempts=3), True, ("1 attempt handed in; the time is over.", False)),
        (2, Terms(counts="mean"), True, ("2 attempts handed in; the time is over. The mean of all", False)),
    ],
)
def test_attempts_are_told_in_words(desk, kit, used, terms, is_over, expected):
    row = row_of(report_of(desk, kit).grade, attempts=used)
    found = standing(row, terms, "", is_over=is_over)
    sentence, may = expected
    assert sentence in " ".join(found.sentences)
    assert found.may_hand_in is may


def test_all_attempts_that_do_not_count_are_named(desk, kit):
    found = standing(
        row_of(report_of(desk, kit).grade, attempts=4, ignored=(3, 4)), Terms(attempts=2), "", is_over=True
    )
    assert "Attempts 3, 4 came too late, or were too many: they do not count." in found.sentences


def test_what_came_after_the_last_moment_counts_nothing(desk, kit):
    row = row_of(report_of(desk, kit).grade, late_share=1.0, ignored=(1,))
    found = standing(replace(row, points=0.0), Terms(due=DUE, closes=DUE, late=Late()), "", is_over=True)
    assert any("counts nothing" in sentence for sentence in found.sentences)


# ---------------------------------------------------------------- hostile texts


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=st.text(min_size=1, max_size=40))
def test_no_text_of_a_workbook_becomes_markup(desk, kit, text):
    hostile = f"<img src=x onerror=a>{text}<svg onload=a>"
    page = feedback_page(report_of(desk, kit, v_b1=hostile, e=hostile))
    assert "<img" not in page
    assert "<svg onload" not in page


# ---------------------------------------------------------------- the tracking table


@pytest.mark.parametrize(
    ("table_of", "said"),
    [
        (lambda xy: xy * 2.0, "divided by 2, the error of its scale"),
        (lambda xy: xy * [1, -1], "turned so that y points up"),
        (lambda xy: np.roll(xy, 2, axis=0), "compared 2.0 frames earlier"),
        (lambda xy: np.roll(xy, -2, axis=0), "compared 2.0 frames later"),
    ],
)
def test_what_was_done_to_the_table_is_said(desk, kit, table_of, said):
    xy_m = table_of(kit.trajectory_m(desk.numbers))[3:-3]
    table = {name: column[3:-3] for name, column in kit.table_of(kit.trajectory_m(desk.numbers)).items()}
    for p, point in enumerate(kit.POINTS):
        table |= {f"{point}_x_m": xy_m[:, p, 0], f"{point}_y_m": xy_m[:, p, 1]}
    assert said in text_of(feedback_page(report_of(desk, kit, tracking=table)))


def test_the_known_delay_gives_the_same_curves_as_the_search(desk, kit):
    table = kit.table_of(np.roll(kit.trajectory_m(desk.numbers), 2, axis=0))
    searched = fit_trajectory(table, desk.key)
    known = fit_trajectory(table, desk.key, searched.lag_frames)
    assert known.lag_frames == searched.lag_frames
    np.testing.assert_allclose(known.own_m, searched.own_m, atol=1e-12)


@pytest.mark.parametrize("name", assignment_ids())
def test_every_assignment_has_its_page(name):
    """Also of a scene without a ball, or without a body whose angle is measured."""
    assignment = load_assignment(name)
    variant = draw_variant(assignment, bytes(range(32)), "pupil001")
    key = answer_key(assignment, variant, foresee(variant), None, "0" * 64)
    xy_m = key.xy_px * [1, -1] / key.truth["px_per_m"]
    names = [point for point in assignment.points if point in key.points]
    columns = [key.frame, key.time_s, *(xy_m[:, key.points.index(point), axis] for point in names for axis in (0, 1))]
    table = dict(zip(tracking_columns(names), columns, strict=True))
    answers = {
        q.id: Answer(Kind.NUMBER, key.values[q.id], f"{key.values[q.id]:.6g}", q.unit, "Answers!C7", "name")
        for q in assignment.questions
    }
    submission = Submission("w.xlsx", assignment.id, key.code, answers, table)
    middle = np.nanmean(key.xy_px[int(key.truth["frame_before"])], axis=0)
    frame = replace(FRAME, index=int(key.truth["frame_before"]), left=int(middle[0]) - 200, top=int(middle[1]) - 150)
    page = feedback_page(Report(assignment, submission, key, grade(submission, key, assignment), frame=frame))
    assert page.count("<svg") >= 2
    assert 'class="mine"' in page
    assert len(page.encode()) + 15_000 <= MOST_BYTES

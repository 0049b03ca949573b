"""The instructor's page: how questions and variants did, how exactly the class measured, who needs a look."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assignments.course import new_course
from grader.adjust import Adjustment
from grader.charts import histogram, scatter_chart
from grader.class_page import class_page
from grader.evidence import evidence_in
from grader.grade import grade
from grader.gradebook import Gradebook, Row, Student
from grader.items import Evidence, difficulty_of, evidence_of, items_of, precision_of, tracking_px
from grader.model import Finding, Outcome
from grader.roster import Enrolled

QUESTIONS = ("px_per_m", "fps", "omega1", "omega2", "v_f1", "v_f2", "v_b1", "v_b2", "e", "I")


def row(number: int, share: float = 1.0, **changes) -> Row:
    outcomes = dict.fromkeys(QUESTIONS, Outcome.RIGHT)
    first = Row(
        Student(f"pid{number:02}", f"Name {number}"), "soccer-kick", 1, 20 * share, 20.0, "ok", "", outcomes,
        earned=20 * share,
    )  # fmt: skip
    return replace(first, **changes)


def wrong(question: str, number: int, **changes) -> Row:
    outcomes = dict.fromkeys(QUESTIONS, Outcome.RIGHT) | {question: Outcome.WRONG}
    return row(number, outcomes=outcomes, **changes)


def value(question: str, own: float, truth: float, points: float = 1.0) -> Finding:
    numbers = {"value": own, "truth": truth, "tolerance": 0.1}
    return Finding(question, "value", Outcome.RIGHT, points, 1.0, "", numbers)


# ---------------------------------------------------------------- questions


def test_facility_is_the_mean_part_of_the_points(assignment):
    rows = [row(0), wrong("e", 1), row(2), row(3)]
    evidence = {"pid00": Evidence((value("e", 1, 1, 0.5),))}
    item = next(item for item in items_of(assignment, rows, evidence) if item.question.id == "e")
    assert item.facility == pytest.approx((0.5 + 0 + 1 + 1) / 4)
    assert (item.right, item.answered) == (3, 4)


def test_unsure_answers_are_left_out_until_a_person_has_decided(assignment):
    unsure = row(0, outcomes=dict.fromkeys(QUESTIONS, Outcome.UNSURE))
    item = items_of(assignment, [unsure, row(1)], {})[0]
    assert (item.facility, item.answered) == (1.0, 1)


def test_a_decision_outweighs_the_findings(assignment):
    decided = wrong("e", 0, decisions=(Adjustment("e", 0.0, "copied", "ann", "2026-05-01"),))
    items = items_of(assignment, [decided], {"pid00": Evidence((value("e", 1, 1),))})
    assert next(item.facility for item in items if item.question.id == "e") == 0.0


def test_a_question_that_only_the_best_solve_discriminates(assignment):
    weak = {**dict.fromkeys(("e", "I", "v_f1"), Outcome.WRONG), "v_b1": Outcome.RIGHT}
    strong = {"v_b1": Outcome.WRONG}
    rows = [row(n, outcomes=dict.fromkeys(QUESTIONS, Outcome.RIGHT) | (weak if n % 2 else strong)) for n in range(12)]
    found = {item.question.id: item.discrimination for item in items_of(assignment, rows, {})}
    assert found["e"] > 0.9
    assert found["v_b1"] < -0.9
    assert found["fps"] is None


def test_a_few_students_tell_no_discrimination(assignment):
    rows = [wrong("e", n) if n % 2 else row(n) for n in range(7)]
    assert all(item.discrimination is None for item in items_of(assignment, rows, {}))


# ---------------------------------------------------------------- precision


def test_the_reached_precision_is_that_of_the_students_in_spite_of_slips(assignment):
    rng = np.random.default_rng(3)
    off = rng.normal(0, 0.02, 400)
    off[:20] = 5.0
    evidence = [Evidence((value("v_b2", 10 * (1 + d), 10.0),), {"v_b2": 10.0}, {"v_b2": 0.1}) for d in off]
    (found,) = precision_of(assignment, evidence)
    assert found.is_relative
    assert found.predicted == pytest.approx(0.01)
    assert found.reached == pytest.approx(0.02, rel=0.15)
    assert found.students == 400


def test_a_number_that_is_zero_is_told_in_its_unit(assignment):
    (found,) = precision_of(assignment, [Evidence((value("v_b1", 0.01, 0.0),), {"v_b1": 0.0}, {"v_b1": 0.001})])
    assert not found.is_relative
    assert found.reached == pytest.approx(0.0148, rel=0.01)


def test_evidence_keeps_what_is_needed(desk, kit):
    result = desk.grade(tracking=kit.table_of(kit.trajectory_m(desk.numbers)))
    one = evidence_of(result.findings, replace(desk.key, expected_sd={"e": 0.01}))
    assert precision_of(desk.assignment, [one])[0].question.id == "e"
    assert tracking_px([one])[0] < 0.1


# ---------------------------------------------------------------- difficulty


def evidence_with(sds: list[float]) -> dict[str, Evidence]:
    return {f"pid{n:02}": Evidence((), {"e": 0.5}, {"e": 0.5 * sd}) for n, sd in enumerate(sds)}


def test_an_unfair_class_is_called_so(assignment):
    sds = [0.01 + 0.01 * n for n in range(12)]
    rows = [row(n, 1.0 - 0.06 * n) for n in range(12)]
    found = difficulty_of(assignment, rows, evidence_with(sds))
    assert found.r == pytest.approx(-1.0)
    assert "scored lower" in found.words


def test_chance_is_called_chance(assignment):
    rows = [row(n, 0.5 + 0.4 * (n * 7 % 5) / 5) for n in range(12)]
    assert "chance" in difficulty_of(assignment, rows, evidence_with([0.01 + 0.002 * n for n in range(12)])).words


def test_variants_that_are_all_alike_tell_nothing(assignment):
    rows = [row(n, 1 - n / 20) for n in range(12)]
    assert "too much alike" in difficulty_of(assignment, rows, evidence_with([0.01] * 12)).words


def test_lateness_is_no_fault_of_the_variant(assignment):
    late = row(0, points=5.0, earned=20.0, late_share=0.75)
    assert difficulty_of(assignment, [late], evidence_with([0.02])).score_percent == (100.0,)


@given(st.lists(st.floats(0, 1), max_size=60))
def test_a_histogram_loses_nobody(shares):
    assert sum(bar.count for bar in histogram(shares)) == len(shares)


@given(st.lists(st.tuples(st.floats(0, 50), st.floats(0, 100)), max_size=40))
def test_a_scatter_stays_inside_its_axes(pairs):
    x, y = [a for a, _ in pairs], [b for _, b in pairs]
    chart = scatter_chart(x, y, "x", "y")
    assert len(chart.dots) == len(pairs)
    assert all(chart.left <= a <= chart.right_edge and chart.top <= b <= chart.bottom for a, b in chart.dots)


# ---------------------------------------------------------------- the page


def test_who_needs_a_look_is_named_with_the_reason(assignment):
    rows = [row(0, status="review", reasons=("Unsure about e.",)), row(1, attempt=2, ignored=(2,)), row(2, 0.2)]
    page = class_page(assignment, rows, [("x.pdf", "x.pdf: expected a workbook, got a PDF.")])
    attention = page.partition('id="attention"')[2].partition("</section>")[0]
    assert 'href="pid00.html"><b>Name 0</b></a>: Unsure about e.' in attention
    assert "Name 1</b></a>: No attempt counts" in attention
    assert "<b>x.pdf</b>: expected a workbook" in attention
    assert "Name 2" not in attention
    assert "May need help, below 40 %: <b>Name 2</b> (20 %)" in page


def test_a_class_in_good_order_needs_no_look(assignment):
    assert "Needs a look" not in class_page(assignment, [row(0)])


def test_every_plot_has_its_numbers_in_a_table(assignment):
    rows = [row(n, 1 - n / 20) for n in range(12)]
    page = class_page(assignment, rows, (), (), evidence_with([0.01 + 0.01 * n for n in range(12)]))
    assert page.count("<svg") == page.count("Numbers of this plot") == 2
    assert re.search(r'<th scope="row">Name 11</th><td class="n">12 %</td><td class="n">45 %</td>', page)


def test_without_evidence_precision_and_difficulty_are_left_out(assignment):
    page = class_page(assignment, [row(0)])
    assert "Measured precision" not in page
    assert "Difficulty of the variants" not in page


# ---------------------------------------------------------------- from the gradebook


def test_evidence_comes_back_from_the_gradebook_as_it_went_in(desk, kit, tmp_path):
    key = replace(desk.key, expected_sd={"e": 0.004, "loss": float("nan")})
    submission = kit.submission_of(desk.assignment, {**desk.truth, "e": 0.3}, None, {})
    result = grade(submission, key, desk.assignment)
    with Gradebook.open(new_course(tmp_path / "course", "Dynamics")) as book:
        (first, *_) = book.take_in([Enrolled("Ana", "")])
        own = replace(key, student=first.student.pid)
        book.keep_key(kit.variant_of(student=first.student.pid), own)
        book.record_run(submission, result)
        rows = book.rows("soccer-kick")
        (found,) = evidence_in(book, rows).values()
    assert found.findings == result.findings
    assert found.expected_sd == {"e": 0.004}
    assert found.values == dict(key.values)
    assert "Measured precision" in class_page(desk.assignment, rows, (), (), {first.student.pid: found})

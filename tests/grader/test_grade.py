"""Units, measured values, formulas and final values are judged apart, and an error costs once."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assignments.model import Question
from grader import checks
from grader.checks import check_named, check_names, explanation_of
from grader.grade import grade, in_order
from grader.model import Outcome, overall
from vml_course.errors import UnknownNameError

VELOCITIES = ("v_f1", "v_f2", "v_b1", "v_b2")


def value_finding(result, question, aspect="value"):
    return next(f for f in result.of(question) if f.aspect == aspect)


def test_right_answers_earn_everything(desk, kit):
    result = desk.grade(tracking=kit.table_of(kit.trajectory_m(desk.numbers)))
    assert (result.points, result.out_of, result.status) == (20.0, 20.0, "ok")
    assert result.diagnosis == ()
    assert all(finding.outcome is Outcome.RIGHT for finding in result.findings)


def test_points_add_up_to_what_the_assignment_promises(desk):
    empty = desk.grade(dict.fromkeys(desk.truth, ""))
    assert empty.out_of == desk.assignment.total_points
    assert empty.points == 0.0
    assert desk.grade(dict.fromkeys(desk.truth, "x")).out_of == desk.assignment.total_points


@pytest.mark.parametrize(
    ("off", "outcome", "share"),
    [
        (0.0, "right", 1.0),
        (0.019, "right", 1.0),
        (-0.019, "right", 1.0),
        (0.021, "partial", 0.5),
        (-0.039, "partial", 0.5),
        (0.041, "wrong", 0.0),
        (-1.5, "wrong", 0.0),
    ],
)
def test_a_measured_value_is_judged_by_its_tolerance(desk, off, outcome, share):
    finding = value_finding(desk.grade({"v_b2": desk.numbers.u2 * (1 + off)}), "v_b2")
    assert finding.outcome == outcome
    assert finding.points == pytest.approx(share * 1.35)


def test_the_tolerance_is_never_narrower_than_three_sd(desk, kit):
    key = kit.key_of(desk.numbers, expected_sd={"v_b2": 0.05 * desk.numbers.u2})
    values = {**desk.truth, "v_b2": desk.numbers.u2 * 1.14}
    finding = value_finding(grade(kit.submission_of(desk.assignment, values), key, desk.assignment), "v_b2")
    assert finding.outcome is Outcome.RIGHT
    assert "within 15 %" in finding.message


def test_a_truth_of_zero_has_a_tolerance_in_its_unit(desk):
    assert (
        value_finding(desk.grade({"v_b1": 0.09}), "v_b1").message == "Right: within 2 % or 0.1 m/s of the true value."
    )
    assert value_finding(desk.grade({"v_b1": 0.3}), "v_b1").outcome is Outcome.WRONG


def test_a_missing_unit_costs_a_tenth(desk):
    result = desk.grade(units={**desk.units, "v_b2": ""})
    assert value_finding(result, "v_b2", "unit").outcome is Outcome.WRONG
    assert result.points == pytest.approx(20 - 0.15)


def test_another_unit_is_as_good(desk):
    result = desk.grade({"v_b2": desk.numbers.u2 * 3.6}, units={**desk.units, "v_b2": "km/h"})
    assert result.points == 20.0


def test_a_reversed_sign_is_half_right_and_named(desk):
    finding = value_finding(desk.grade({"v_b2": -desk.numbers.u2}), "v_b2")
    assert (finding.outcome, finding.mistake) == (Outcome.PARTIAL, "K6")


# ---------------------------------------------------------------- follow-through


def test_a_wrong_velocity_costs_only_itself(desk):
    u2 = desk.numbers.u2 * 1.1
    e = (u2 - desk.numbers.v2) / desk.numbers.v1
    inertia = desk.numbers.I * 1.1
    result = desk.grade({"v_b2": float(f"{u2:.4g}"), "e": float(f"{e:.4g}"), "I": float(f"{inertia:.4g}")})
    assert result.points == pytest.approx(20 - 1.35)
    assert value_finding(result, "e").carried
    assert value_finding(result, "I").carried


def test_a_wrong_formula_costs_its_question_and_is_named(desk):
    result = desk.grade({"e": float(f"{1 / desk.numbers.e:.4g}")})
    assert result.points == pytest.approx(14.0)
    assert value_finding(result, "e", "formula").mistake == "E1"
    assert [d.codes for d in result.diagnosis] == [("E1",)]


def test_a_right_formula_with_right_inputs_and_a_far_value_is_not_excused(desk):
    """Each velocity is within tolerance, but I is a small difference: the value is not good enough."""
    omega2 = float(f"{desk.numbers.omega2 * 1.018:.4g}")
    inertia = desk.numbers.gain / (desk.truth["omega1"] - omega2)
    result = desk.grade({"omega2": omega2, "v_f2": float(f"{omega2 * 0.5:.4g}"), "I": float(f"{inertia:.4g}")})
    assert value_finding(result, "omega2").outcome is Outcome.RIGHT
    assert value_finding(result, "I", "formula").outcome is Outcome.RIGHT
    assert value_finding(result, "I").outcome is Outcome.WRONG


def test_uncalibrated_velocities_cost_half_and_are_named(desk):
    """A step was left out: the scale is wrong, the velocities are half right, e and I follow from them."""
    changes = {name: desk.truth[name] * 500 for name in VELOCITIES}
    result = desk.grade({**changes, "px_per_m": 1.0, "I": desk.truth["I"] * 500})
    assert result.points == pytest.approx(20 - 0.9 - 0.45 - 0.45 - 0.675)
    assert [d.codes for d in result.diagnosis] == [("K1",)]
    assert value_finding(result, "v_f1").outcome is Outcome.PARTIAL
    assert value_finding(result, "I").carried


def test_a_scale_that_is_a_little_off_costs_once(desk):
    """Velocities that follow from it are right in themselves."""
    changes = {name: desk.truth[name] * 1.15 for name in VELOCITIES}
    result = desk.grade({**changes, "px_per_m": 500 / 1.15, "I": desk.truth["I"] * 1.15})
    assert result.points == pytest.approx(20 - 0.9)
    assert all(value_finding(result, name).carried for name in ("v_f1", "v_f2", "v_b2", "I"))


def test_a_factor_without_a_wrong_source_is_paid_by_the_first_velocity(desk):
    result = desk.grade({**{name: desk.truth[name] * 3.28084 for name in VELOCITIES}, "I": desk.truth["I"] * 3.28084})
    assert value_finding(result, "v_f1").outcome is Outcome.WRONG
    assert result.points == pytest.approx(20 - 0.9)


def test_a_wrong_frame_rate_is_paid_at_the_frame_rate(desk):
    names = (*VELOCITIES, "omega1", "omega2")
    result = desk.grade({**{name: desk.truth[name] / 16 for name in names}, "fps": 30.0})
    assert result.points == pytest.approx(20 - 0.9)
    assert {d.codes for d in result.diagnosis} == {("K2",)}


def test_pixels_that_say_so_lose_the_unit_and_pay_once(desk):
    changes = {name: desk.truth[name] * 500 for name in VELOCITIES}
    result = desk.grade(changes, units={**desk.units, **dict.fromkeys(VELOCITIES, "px/s")})
    assert value_finding(result, "v_f2", "unit").outcome is Outcome.WRONG
    assert result.diagnosis[0].codes == ("K1",)


@pytest.mark.parametrize(
    "velocities",
    [dict.fromkeys(VELOCITIES, 1.0), {"v_f1": 1.0, "v_f2": 0.0, "v_b1": 0.0, "v_b2": 0.0}],
)
def test_trivial_velocities_do_not_make_the_rest_easy(desk, velocities):
    result = desk.grade({**velocities, "omega1": 2.0, "omega2": 0.0, "e": 0.0, "I": 0.0})
    assert value_finding(result, "e").points == 0
    assert value_finding(result, "I").points == 0


def test_a_right_value_that_follows_from_nothing_is_for_a_person(desk):
    result = desk.grade({**dict.fromkeys((*VELOCITIES, "omega1", "omega2"), "")})
    finding = value_finding(result, "e", "formula")
    assert (finding.outcome, finding.points, result.status) == (Outcome.UNSURE, 3.0, "review")
    assert result.reasons == ("Unsure about e, I.",)


def test_a_wrong_value_without_velocities_earns_nothing(desk):
    result = desk.grade({**dict.fromkeys((*VELOCITIES, "omega1", "omega2"), ""), "e": 0.2})
    assert sum(f.points for f in result.of("e")) == 0


# ---------------------------------------------------------------- unsure is not wrong


def test_an_ambiguous_number_costs_nothing_and_reaches_a_person(desk):
    result = desk.grade({"px_per_m": "1,234.5,6"})
    assert result.points == 20.0
    assert result.status == "review"
    assert result.is_provisional


@pytest.mark.parametrize("text", ["about 0.57", "1e999", "NaN", "?"])
def test_every_text_that_is_no_number_reaches_a_person(desk, text):
    result = desk.grade({"e": text})
    assert (result.points, result.status, result.reasons) == (20.0, "review", ("Unsure about e.",))
    assert result.is_provisional


@pytest.mark.parametrize(
    ("name", "text", "read_as"),
    [
        ("v_b2", "{:.3f}", "."),
        ("px_per_m", "1,234", "1234"),
        ("omega1", "20,000", "20.000"),
        ("v_b1", "1,234", "1.234"),
    ],
)
def test_a_comma_is_read_in_the_one_way_that_is_plausible(desk, name, text, read_as):
    text = text.format(desk.numbers.u2).replace(".", ",")
    result = desk.grade({name: text})
    finding = value_finding(result, name)
    expected = text.replace(",", ".") if read_as == "." else read_as
    assert finding.message.startswith(f"Read as {expected}. ")
    assert finding.outcome is not Outcome.UNSURE


def test_a_comma_with_no_plausible_reading_stays_a_question(desk):
    assert value_finding(desk.grade({"fps": "1,234"}), "fps").message.startswith("Read as 1234")
    assert value_finding(desk.grade({"omega1": "1,234 rpm"}), "omega1").outcome is not Outcome.RIGHT
    assert value_finding(desk.grade({"e": "123,456"}), "e").outcome is Outcome.UNSURE


def test_a_workbook_without_any_answer_is_empty(desk, kit):
    blank = desk.grade(dict.fromkeys(desk.truth, ""))
    assert (blank.status, blank.points) == ("empty", 0.0)
    nothing = type(kit.submission_of(desk.assignment, {}))("w.xlsx", desk.assignment.id, "CODE1", {}, {})
    assert grade(nothing, desk.key, desk.assignment).reasons[0].startswith("No answer cells were found")


# ---------------------------------------------------------------- another arm than L


def with_arm(desk, ratio):
    """Work rightly, but with another length than L."""
    n = desk.numbers
    v1, v2 = n.v1 * ratio, n.v2 * ratio
    values = {"v_f1": v1, "v_f2": v2, "e": (n.u2 - v2) / v1, "I": n.I * ratio}
    return {name: float(f"{value:.4g}") for name, value in values.items()}


@pytest.mark.parametrize(
    ("ratio", "words"),
    [(0.5, "half of L"), (100.0, "L in centimetres"), (0.78, "L − R"), (1.22, "L + R"), (0.9, "m in")],
)
def test_another_arm_used_throughout_costs_once_and_is_named(desk, ratio, words):
    result = desk.grade(with_arm(desk, ratio))
    assert result.points == pytest.approx(20 - 0.9)
    (hint,) = [d for d in result.diagnosis if d.codes == ("K12",)]
    assert words in hint.hint or (words == "m in" and "m instead of L" in hint.hint)
    assert value_finding(result, "e").carried
    assert len(result.diagnosis) == 1


def test_a_formula_on_impossible_numbers_says_that_it_counts_here_too(desk):
    changes = {"v_f1": 1.0, "v_f2": 0.5, "omega1": 2.0, "omega2": 1.0, "v_b2": 5.0, "e": 4.5, "I": 1.0}
    finding = value_finding(desk.grade(changes), "e")
    assert finding.outcome is Outcome.WRONG
    assert "counts here too" in finding.message


def test_one_cause_has_one_hint_that_names_its_cells(desk, kit):
    changes = {name: desk.truth[name] / 2 for name in VELOCITIES}
    table = kit.table_of(kit.trajectory_m(desk.numbers) / 2)
    result = desk.grade({**changes, "px_per_m": 1000.0, "I": desk.truth["I"] / 2}, tracking=table)
    (hint,) = result.diagnosis
    assert {"px_per_m", "v_f1", "v_b2", "tracking"} <= set(hint.ids)
    assert "scale is twice too large" in hint.hint


def test_a_failure_of_ours_costs_nothing(desk, monkeypatch):
    def broken(_):
        raise ZeroDivisionError

    monkeypatch.setattr("grader.grade.check_named", lambda name: broken if name == "scale" else check_named(name))
    result = desk.grade({"px_per_m": 1.0})
    assert (result.points, result.status) == (20.0, "review")


def test_flags_that_matter_bring_a_person(desk, kit):
    submission = kit.submission_of(desk.assignment, desk.truth, tracking=desk.table)
    flagged = type(submission)(**{**vars(submission), "flags": ("macros", "far-cells"), "assignment_id": "other"})
    result = grade(flagged, desk.key, desk.assignment)
    assert result.reasons == ("The workbook says that it belongs to 'other'.", "The workbook carries macros.")


# ---------------------------------------------------------------- tracking


def tracked(desk, kit, change) -> dict:
    return kit.table_of(change(kit.trajectory_m(desk.numbers)))


@pytest.mark.parametrize(
    ("change", "outcome", "mistake"),
    [
        (lambda xy: xy, Outcome.RIGHT, ""),
        (lambda xy: xy + np.array([3.0, -2.0]), Outcome.RIGHT, ""),
        (lambda xy: xy * 500, Outcome.PARTIAL, "K1"),
        (lambda xy: xy * 1.1, Outcome.PARTIAL, "K7"),
        (lambda xy: xy * 2, Outcome.PARTIAL, "K5"),
        (lambda xy: xy * np.array([1, -1]), Outcome.PARTIAL, "K10"),
        (lambda xy: np.concatenate([xy[:1]] * 3 + [xy[:-3]]), Outcome.PARTIAL, "K11"),
        (lambda xy: xy[::-1], Outcome.WRONG, ""),
    ],
)
def test_a_tracking_table_is_laid_over_the_truth(desk, kit, change, outcome, mistake):
    (finding,) = desk.grade(tracking=tracked(desk, kit, change)).of("tracking")
    assert finding.outcome is outcome
    if mistake:
        assert finding.mistake == mistake


def test_noise_of_the_table_is_measured_in_pixels(desk, kit):
    rng = np.random.default_rng(2)
    (finding,) = desk.grade(tracking=tracked(desk, kit, lambda xy: xy + rng.normal(0, 0.5 / 500, xy.shape))).of(
        "tracking"
    )
    assert finding.numbers["rms_px"] == pytest.approx(0.5 * 2**0.5, rel=0.1)


@pytest.mark.parametrize("drop", ["frame", "ball_x_m"])
def test_a_table_may_lack_a_column(desk, kit, drop):
    table = tracked(desk, kit, lambda xy: xy)
    del table[drop]
    (finding,) = desk.grade(tracking=table).of("tracking")
    assert finding.outcome is Outcome.RIGHT


@pytest.mark.parametrize("table", [{}, {"frame": np.arange(5.0), "ball_x_m": np.ones(5), "ball_y_m": np.ones(5)}])
def test_too_small_a_table_costs_nothing(desk, table):
    result = desk.grade(tracking=table)
    assert (result.points, result.status) == (20.0, "review")
    assert "10 rows" in result.of("tracking")[0].message


# ---------------------------------------------------------------- laws


@given(
    st.dictionaries(
        st.sampled_from(["v_f1", "v_b2", "omega1", "e", "I", "fps", "px_per_m"]),
        st.one_of(st.floats(), st.text(max_size=12)),
        max_size=7,
    )
)
@settings(deadline=None, max_examples=150)
def test_any_answers_end_in_a_grade_within_its_bounds(kit, assignment, answers):
    numbers = kit.impact()
    submission = kit.submission_of(assignment, {**kit.rounded(kit.true_values(numbers)), **answers})
    result = grade(submission, kit.key_of(numbers), assignment)
    assert 0 <= result.points <= result.out_of == 20.0
    assert all(0 <= f.points <= f.out_of for f in result.findings)
    assert not any("grader could not" in f.message for f in result.findings)


@given(st.floats(0, 0.2), st.floats(0, 0.2))
@settings(deadline=None, max_examples=60)
def test_a_smaller_error_never_earns_less(kit, assignment, one, other):
    numbers = kit.impact()
    earned = []
    for off in sorted((one, other)):
        values = {**kit.rounded(kit.true_values(numbers)), "v_b2": numbers.u2 * (1 + off), "e": "", "I": ""}
        result = grade(kit.submission_of(assignment, values), kit.key_of(numbers), assignment)
        earned.append(result.points)
    assert earned[0] >= earned[1]


def question(name: str, *needs: str) -> Question:
    return Question(name, name, name, "number", "", 1, "velocity", 0.1, "g", needs)


def test_questions_are_judged_after_what_they_need():
    questions = [
        question("c", "b"),
        question("b", "a"),
        question("a", "elsewhere"),
        question("x", "y"),
        question("y", "x"),
    ]
    assert [q.id for q in in_order(questions)] == ["a", "b", "c", "x", "y"]


@pytest.mark.parametrize(
    ("outcomes", "points", "expected"),
    [
        (["right", "right"], 2, "right"),
        (["right", "wrong"], 1, "partial"),
        (["right", "wrong"], 0.1, "wrong"),
        (["unsure", "wrong"], 1, "unsure"),
        ([], 0, "unsure"),
    ],
)
def test_a_question_ends_as_its_worst_aspect(outcomes, points, expected):
    assert overall(map(Outcome, outcomes), points, 2.0) == expected


# ---------------------------------------------------------------- the registry


def test_every_check_of_the_catalogue_exists_and_explains_itself(assignment):
    assert {question.check for question in assignment.questions} <= set(check_names())
    for name in check_names():
        assert callable(check_named(name))
        assert len(explanation_of(name)) > 40
    assert set(check_names()) == {p.stem for p in map(__import__("pathlib").Path, _files(checks))}


def _files(package):
    folder = __import__("pathlib").Path(package.__file__).parent
    return [p for p in folder.glob("*.py") if p.stem != "__init__"]


def test_an_unknown_check_is_named_with_those_known():
    with pytest.raises(UnknownNameError, match="velocity"):
        check_named("speed")

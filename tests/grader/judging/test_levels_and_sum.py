"""From findings to a grade: the order of judging, what is charged, levels, points, status and reasons."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assignments.model import Question
from grader import checks
from grader import grade as grading
from grader.checks import check_named, check_names, explanation_of
from grader.flags import FOR_PERSON, FOR_PERSON_OF_TABLE
from grader.grade import TRACKING, grade, in_order
from grader.levels import LEVELS, levels_of
from grader.model import Answer, Diagnosis, Finding, Grade, Kind, Outcome, Submission, overall
from grader.read.flags import Flag
from grader.tracked import OUR_FAILURE, FromTable
from vml_course.errors import UnknownNameError


@pytest.fixture
def quick(monkeypatch, kick):
    """Grade answers of the kick with a table that supports the truth, without solving one."""

    def graded(answers=None, assignment=kick.assignment, submission=None, key=kick.key, **table):
        submission = submission or kick.submission(answers)

        def from_table(tracking, *others):
            assert tracking is not None
            assert tracking.keys() == submission.tracking.keys()
            assert others == (key, assignment)
            return FromTable(**{"fit": kick.table.fit, "values": dict(kick.truth), **table})

        monkeypatch.setattr(grading, "from_table", from_table)
        return grade(submission, key, assignment)

    return graded


def by_aspect(result, question):
    return {finding.aspect: finding for finding in result.of(question)}


# ---------------------------------------------------------------- a whole grade


def test_right_answers_earn_all_and_need_nobody(quick):
    result = quick()
    assert (result.points, result.out_of, result.status, result.reasons, result.diagnosis) == (20, 20, "ok", (), ())
    assert not result.is_provisional
    assert [f.question_id for f in result.findings][-1] == "tracking"


def test_findings_stand_in_the_order_of_judging_and_belong_to_all_questions(quick, kick):
    assert {f.question_id for f in quick().findings} == {*(q.id for q in kick.assignment.questions), "tracking"}


def test_a_table_that_is_worth_points_is_judged_once(quick, kick):
    table = replace(TRACKING, points=4.0)
    result = quick(assignment=replace(kick.assignment, questions=(*kick.assignment.questions, table)))
    assert result.out_of == 24.0
    assert [f.aspect for f in result.of("tracking")] == ["table"]
    assert result.of("tracking")[0].points == 4.0


def test_an_error_is_charged_where_it_arose(quick, kick):
    """e and I follow from a wrong v_b2, which alone costs."""
    t = kick.truth
    u2 = 1.1 * t["v_b2"]
    e, inertia = (u2 - t["v_f2"]) / t["v_f1"], 1.1 * t["I"]
    result = quick({"v_b2": u2, "e": e, "I": inertia})
    assert result.points == pytest.approx(20 - 1.35)
    assert by_aspect(result, "e")["value"].carried
    assert by_aspect(result, "I")["value"].carried


def test_a_half_right_number_is_charged_too(quick, kick):
    t = kick.truth
    u2 = 1.03 * t["v_b2"]
    result = quick({"v_b2": u2, "e": (u2 - t["v_f2"]) / t["v_f1"]})
    assert by_aspect(result, "v_b2")["value"].outcome is Outcome.PARTIAL
    assert by_aspect(result, "e")["value"].carried


def test_a_missing_unit_is_no_error_that_is_carried(quick, kick):
    t = kick.truth
    submission = kick.submission({"e": 0.5}, {"v_b2": ""})
    result = quick(submission=submission)
    assert by_aspect(result, "v_b2")["unit"].outcome is Outcome.WRONG
    assert not by_aspect(result, "e")["value"].carried
    assert t["e"] == pytest.approx(0.7)


def test_what_is_carried_is_carried_on(quick, kick):
    """All velocities are off by the scale, which is charged; I follows from them."""
    wrong = {name: 1.15 * kick.truth[name] for name in ("v_f1", "v_f2", "v_b2", "I")}
    result = quick({**wrong, "px_per_m": 500 / 1.15})
    assert result.points == pytest.approx(20 - 0.9)
    assert by_aspect(result, "I")["value"].carried


def test_a_conclusion_is_given_what_was_carried_before_it(quick, kick, monkeypatch):
    seen = []

    def spy(asked):
        seen.append((asked.question.id, asked.charged, asked.carried))
        right = Finding(asked.question.id, "value", Outcome.RIGHT, 1, 1, "", carried=asked.question.id == "v_f1")
        wrong = replace(right, outcome=Outcome.WRONG)
        other = replace(wrong, aspect="unit")
        return (other, wrong if asked.question.id == "fps" else right)

    monkeypatch.setattr(grading, "check_named", lambda _: spy)
    quick()
    order = [name for name, _, _ in seen]
    assert order.index("e") > order.index("v_b2")
    assert seen[order.index("px_per_m")][1:] == (frozenset(), frozenset())
    assert seen[order.index("e")][1:] == ({"fps"}, {"v_f1"})


def test_our_own_failure_costs_nothing_and_reaches_a_person(quick, monkeypatch):
    def fails(_):
        raise ZeroDivisionError

    monkeypatch.setattr(grading, "check_named", lambda name: fails if name == "scale" else check_named(name))
    result = quick({"px_per_m": 1.0})
    (finding,) = result.of("px_per_m")
    assert (finding.aspect, finding.outcome, finding.points, finding.out_of) == ("value", Outcome.UNSURE, 1.0, 1.0)
    assert "grader could not judge this; a person will" in finding.message
    assert (result.points, result.status, result.reasons) == (20, "review", ("Unsure about S.",))


def test_a_truth_that_the_key_does_not_know_costs_nothing(quick, kick):
    result = quick({"v_b1": 3.0}, key=kick.with_key(values={"v_b1": float("nan")}).key)
    assert by_aspect(result, "v_b1")["value"].outcome is Outcome.UNSURE


def test_a_table_that_we_could_not_work_with_is_named_to_a_person(quick):
    result = quick(fit=None, values={}, why_not=OUR_FAILURE)
    assert result.reasons == ("Unsure about e, I, tracking.",)
    assert result.points == 20


def test_of_two_readings_of_a_comma_the_one_near_the_truth_is_meant(quick):
    assert by_aspect(quick({"px_per_m": "1,234"}), "px_per_m")["value"].message.startswith("Read as 1234. ")


def test_another_arm_used_throughout_is_named_with_its_length(quick, kick):
    v1, v2 = 0.9 * kick.truth["v_f1"], 0.9 * kick.truth["v_f2"]
    result = quick({"v_f1": v1, "v_f2": v2, "e": (kick.truth["v_b2"] - v2) / v1, "I": 0.9 * kick.truth["I"]})
    (hint,) = result.diagnosis
    assert hint.codes == ("K12",)
    assert "0.45 m" in hint.hint


def test_how_a_comma_was_read_is_said_once(quick, kick):
    findings = by_aspect(quick({"v_b2": "9,703"}), "v_b2")
    assert findings["value"].message.startswith("Read as 9.703. ")
    assert "Read as" not in findings["unit"].message
    assert "Read as" not in by_aspect(quick({"v_b2": "9.703"}), "v_b2")["value"].message


# ---------------------------------------------------------------- mistakes that are named


def test_a_mistake_that_alone_explains_an_answer_stands_at_its_formula(quick, kick):
    result = quick({"e": 1 / kick.truth["e"]})
    findings = by_aspect(result, "e")
    assert (findings["formula"].mistake, findings["value"].mistake) == ("E1", "")
    assert [d.codes for d in result.diagnosis] == [("E1",)]


def test_a_right_answer_is_not_diagnosed(quick, monkeypatch):
    asked = []
    monkeypatch.setattr(grading, "diagnose_answer", lambda quantity, *_: asked.append(quantity))
    quick()
    assert asked == []
    quick({"I": 5.0})
    assert asked == ["I"]


def test_conclusions_that_are_not_asked_are_not_diagnosed(quick, kick):
    only_e = tuple(q for q in kick.assignment.questions if q.id != "I")
    result = quick({"e": 0.1}, assignment=replace(kick.assignment, questions=only_e))
    assert all("I" not in d.ids for d in result.diagnosis)


def test_several_explanations_are_written_at_no_formula(quick, monkeypatch):
    two = Diagnosis("e", ("E1", "E2"), "hint", "own", ("e",))
    monkeypatch.setattr(grading, "diagnose_answer", lambda quantity, *_: two if quantity == "e" else None)
    result = quick({"e": 0.1, "I": 9.0})
    assert by_aspect(result, "e")["formula"].mistake == ""
    assert two in result.diagnosis


# ---------------------------------------------------------------- status and reasons


def test_a_person_is_told_why_to_look(quick, kick):
    submission = replace(kick.submission({"e": "half", "v_b2": "fast"}), flags=("macros", "far-cells"))
    result = quick(submission=replace(submission, assignment_id="x" * 60))
    assert result.status == "review"
    assert result.reasons[0] == f"The workbook says that it belongs to '{'x' * 40}'."
    assert result.reasons[1] == "The workbook carries macros."
    assert result.reasons[2] == "Unsure about v_b2, e, I."
    assert len(result.reasons) == 3


def test_of_flags_of_a_table_a_person_is_told_only_where_it_is_not_right(quick, kick):
    submission = replace(kick.submission(), flags=(Flag.TEXT_IN_TRACKING, Flag.HIDDEN_SHEET))
    hidden, text = FOR_PERSON[Flag.HIDDEN_SHEET], FOR_PERSON_OF_TABLE[Flag.TEXT_IN_TRACKING]
    assert quick(submission=submission).reasons == (hidden,)
    poor = quick(submission=submission, fit=replace(kick.table.fit, rms_px=3.0))
    assert by_aspect(poor, "tracking")["table"].outcome is Outcome.PARTIAL
    assert poor.reasons == (text, hidden)


def test_a_workbook_without_answers_is_empty_and_says_which_kind(quick, kick):
    blank = quick(dict.fromkeys(kick.truth, ""))
    assert (blank.status, blank.points) == ("empty", 0)
    assert "No answer cells were found" in blank.reasons[0]
    answers = {q.id: Answer(found_by="name", where="Answers!C1") for q in kick.assignment.questions}
    found = quick(submission=replace(kick.submission(), answers=answers))
    assert found.status == "empty"
    assert "No question is answered" in found.reasons[0]
    assert quick(dict.fromkeys(list(kick.truth)[1:], "")).status == "ok"
    other = quick(submission=replace(kick.submission(), answers=answers, flags=("macros",)))
    assert (other.status, other.reasons[1]) == ("empty", "The workbook carries macros.")


def test_dust_of_adding_is_swept_off(quick, kick, monkeypatch):
    def thirds(asked):
        return (Finding(asked.question.id, "value", Outcome.RIGHT, 0.1 + 2e-8, 0.1 + 2e-8, ""),)

    monkeypatch.setattr(grading, "check_named", lambda _: thirds)
    result = quick()
    assert (result.points, result.out_of) == (1.1, 1.1)


# ---------------------------------------------------------------- the order of judging


def question(name, *needs):
    return Question(name, name, name, "number", "", 1, "velocity", 0.1, "g", needs)


def test_questions_follow_what_they_need_keep_their_order_and_break_circles():
    questions = [
        question("c", "b"),
        question("self", "self"),
        question("b", "a"),
        question("a", "elsewhere"),
        question("x", "y"),
        question("y", "x"),
        question("z", "x"),
    ]
    assert [q.id for q in in_order(questions)] == ["self", "a", "b", "c", "x", "y", "z"]
    assert list(in_order([])) == []
    circle = [question("x", "y"), question("after", "y"), question("y", "x")]
    assert [q.id for q in in_order(circle)] == ["x", "y", "after"]


@given(
    st.lists(
        st.tuples(st.integers(0, 7), st.lists(st.integers(0, 7), max_size=3)), max_size=8, unique_by=lambda p: p[0]
    )
)
@settings(max_examples=50, deadline=None)
def test_every_question_is_judged_once(graph):
    questions = [question(str(name), *map(str, needs)) for name, needs in graph]
    assert sorted(q.id for q in in_order(questions)) == sorted(q.id for q in questions)


# ---------------------------------------------------------------- levels


def test_the_three_levels_are_scored_apart(quick, kick):
    result = quick({"v_b2": 1.0, "e": 0.1})
    levels = {level.name: level for level in levels_of(result, kick.assignment)}
    assert list(levels) == ["Measurement", "Processing", "Conclusion"] == list(LEVELS)
    assert {f.question_id for f in levels["Processing"].findings} == {"e", "I"}
    assert {f.aspect for f in levels["Processing"].findings} == {"formula"}
    assert {(f.question_id, f.aspect) for f in levels["Conclusion"].findings} == {
        ("e", "value"),
        ("I", "value"),
        ("I", "unit"),
    }
    assert levels["Measurement"].share == pytest.approx((8 - 1.35) / 8)
    assert all(level.about == LEVELS[level.name] for level in levels.values())


@given(st.dictionaries(st.sampled_from(["v_b2", "omega1", "e", "I", "fps"]), st.floats(-30, 30)))
@settings(max_examples=25, deadline=None)
def test_the_levels_add_up_to_the_total(kick, answers):
    questions = kick.assignment.questions
    findings = [f for q in questions for f in kick.judge(q.id, answers, factors=()).values()]
    result = Grade(tuple(findings), sum(f.points for f in findings), sum(f.out_of for f in findings), "ok")
    levels = levels_of(result, kick.assignment)
    out_of = [sum(f.out_of for f in level.findings) for level in levels]
    assert sum(out_of) == pytest.approx(result.out_of)
    assert sum(level.share * n for level, n in zip(levels, out_of, strict=True)) == pytest.approx(result.points)


def test_a_level_without_points_is_left_out(kick):
    nothing = Finding("tracking", "table", Outcome.PARTIAL, 0, 0, "")
    formula = Finding("e", "formula", Outcome.RIGHT, 1, 2, "")
    (level,) = levels_of(Grade((nothing, formula), 1, 2, "ok"), kick.assignment)
    assert (level.name, level.share) == ("Processing", 0.5)
    assert replace(level, findings=(nothing,)).share == 0.0


def test_a_finding_of_no_question_is_measurement(kick):
    table = Finding("tracking", "table", Outcome.RIGHT, 1, 1, "")
    assert [level.name for level in levels_of(Grade((table,), 1, 1, "ok"), kick.assignment)] == ["Measurement"]


# ---------------------------------------------------------------- words of grading


def test_a_submission_freezes_a_copy_of_its_table():
    column = [1.0, 2.0]
    submission = Submission("w.xlsx", "a", "c", {}, {"frame": column})
    column[0] = 9.0
    assert submission.tracking["frame"].tolist() == [1.0, 2.0]
    assert Submission("w.xlsx", "a", "c", {}, {"frame": [1, 2]}).tracking["frame"].dtype == float
    with pytest.raises(ValueError, match="read-only"):
        submission.tracking["frame"][0] = 1


def test_an_answer_that_was_not_found_is_blank():
    here = Answer(Kind.NUMBER, 1.0, "1")
    submission = Submission("w.xlsx", "a", "c", {"e": here}, {})
    assert submission.answer("e") is here
    assert submission.answer("I") == Answer()
    assert Answer().kind is Kind.BLANK


@pytest.mark.parametrize(
    ("outcomes", "points", "expected"),
    [
        (["right", "right"], 2.0, "right"),
        (["right", "partial"], 2.0, "partial"),
        (["partial", "wrong"], 0.79, "wrong"),
        (["partial", "wrong"], 0.8, "partial"),
        (["wrong", "unsure"], 1.0, "unsure"),
        (["partial", "unsure"], 2.0, "unsure"),
        (["right", "wrong"], 0.0, "wrong"),
        ([], 0.0, "unsure"),
    ],
)
def test_a_question_ends_as_its_worst_aspect_softened_where_much_was_earned(outcomes, points, expected):
    assert overall(map(Outcome, outcomes), points, 2.0) == expected
    assert overall([Outcome.WRONG], 0.0, 0.0) is Outcome.WRONG
    assert overall([Outcome.WRONG], 0.2, 0.5) is Outcome.PARTIAL


def test_points_that_a_person_has_still_to_confirm_are_provisional():
    unsure = Finding("e", "value", Outcome.UNSURE, 1, 1, "")
    assert Grade((unsure,), 1, 1, "review").is_provisional
    assert not Grade((replace(unsure, out_of=0.0),), 1, 1, "review").is_provisional
    assert not Grade((replace(unsure, outcome=Outcome.WRONG),), 1, 1, "review").is_provisional


# ---------------------------------------------------------------- the checks by name


def test_each_check_is_found_by_its_name_and_explains_itself():
    assert set(check_names()) >= {"acceleration", "angle", "conclusion", "rate", "scale", "tracking", "velocity"}
    for name in check_names():
        assert check_named(name).__name__ == name
        text = explanation_of(name)
        assert len(text) > 40
        assert "\n" not in text
        assert "  " not in text
    words = "Compare with the true angle, in radians or degrees as you chose; unit and value are judged apart."
    assert explanation_of("angle") == words
    with pytest.raises(UnknownNameError, match=r"check: .*velocity.*'speed'"):
        check_named("speed")


def test_a_check_without_words_explains_nothing(monkeypatch):
    monkeypatch.setattr(checks, "check_named", lambda _: lambda asked: ())
    assert explanation_of("angle") == ""


@pytest.mark.parametrize(
    ("question", "value", "code"),
    [
        ("px_per_m", 1.0, "K1"),
        ("px_per_m", 0.002, "K1b"),
        ("px_per_m", 0.00209, "K1b"),
        ("px_per_m", 0.00191, "K1b"),
        ("px_per_m", 0.00211, ""),
        ("px_per_m", 0.00189, ""),
        ("px_per_m", 1000.0, "K5"),
        ("px_per_m", 250.0, "K5b"),
        ("px_per_m", 500 / 3.28084, "K3"),
        ("px_per_m", 5.0, "K4"),
        ("px_per_m", 0.5, "K4b"),
        ("px_per_m", 1019.0, "K5"),
        ("px_per_m", 981.0, "K5"),
        ("px_per_m", 1021.0, ""),
        ("px_per_m", 979.0, ""),
        ("px_per_m", 400.0, ""),
        ("fps", 30.0, "K2"),
        ("fps", 29.97, "K2"),
        ("fps", 30.04, "K2"),
        ("fps", 60.0, "K2"),
        ("fps", 23.96, "K2"),
        ("fps", 30.06, ""),
        ("fps", 240.0, ""),
    ],
)
def test_a_wrong_source_is_explained_where_it_has_a_name(kick, question, value, code):
    finding = kick.value(question, value)
    assert (finding.outcome, finding.mistake) == (Outcome.WRONG, code)


@pytest.mark.parametrize("slip", [1.0, 1.019, 0.981])
def test_an_angle_in_degrees_is_named(pendulum, slip):
    degrees = pendulum.truth["theta_max"] * 57.29578 * slip
    assert pendulum.value("theta_max", degrees).mistake == "PA4"
    assert pendulum.judge("theta_max", {"theta_max": degrees}, {"theta_max": "deg"})["value"].mistake == ""
    assert pendulum.value("theta_max", degrees * 1.05).mistake == ""
    assert pendulum.value("theta_max", degrees / 1.05).mistake == ""


def test_an_angle_in_degrees_may_be_off_by_the_whole_tolerance(pendulum):
    """An angle of 0 is held with a tolerance of 30 degrees, to the last digit: 30 written as it is."""
    bench = pendulum.with_question("theta_max", floor=math.radians(30.0)).with_key(values={"theta_max": 0.0})
    for degrees, code in ((30.0, "PA4"), (-30.0, "PA4"), (30.000001, "")):
        assert bench.value("theta_max", degrees, factors=()).mistake == code


@pytest.mark.parametrize("question", ["omega1", "v_b2"])
def test_velocities_and_rates_are_measured_numbers(kick, question):
    assert {aspect: f.outcome.value for aspect, f in kick.judge(question).items()} == {
        "unit": "right",
        "value": "right",
    }


def test_an_acceleration_is_a_measured_number(hammer):
    assert {f.outcome.value for f in hammer.judge("a_b").values()} == {"right"}

"""Hints name the thing, one for each cause; what to do next begins with the earliest step that went wrong."""

from __future__ import annotations

from dataclasses import replace

import pytest

from assignments.names import names_in
from assignments.textbook import every_mistake
from grader.advice import next_steps
from grader.hints import KINEMATIC, SOURCE_HINTS, about, hint_for, one_hint_a_cause, with_marks
from grader.model import Diagnosis, Finding, Grade, Outcome

# Words of which each hint must hold one: what a student is to look at.
NAMED = {
    "K1": "pixels", "K1b": "px/m", "K1c": "frame", "K2": "playback", "K2b": "frame number", "K3": "feet",
    "K3b": "inches", "K3c": "kilometres per hour", "K4": "centimetres", "K4b": "millimetres", "K5": "diameter",
    "K5b": "radius", "K6": "sign", "K7": "scale", "K8": "frame rate", "K9": "degrees", "K9b": "revolutions",
    "K9c": "twice", "K10": "down", "K11": "frame", "K12": "arm", "K13": "exchanged", "K14": "smooth", "K15": "left",
}  # fmt: skip


def told(subject: str, *codes: str, ids=None, basis="truth") -> Diagnosis:
    return Diagnosis(subject, codes, f"hint {' '.join(codes)}", basis, (subject,) if ids is None else ids)


def finding(id_: str, outcome=Outcome.WRONG, aspect="value", mistake="", numbers=None, **changes) -> Finding:
    return Finding(
        id_, aspect, outcome, 0.0, 1.0, "Said.", {"value": 1.0} if numbers is None else numbers, mistake, **changes
    )


@pytest.mark.parametrize("code", KINEMATIC)
def test_a_hint_and_its_short_form_name_the_thing(code):
    assert NAMED[code] in hint_for((code,))
    assert NAMED[code] in about(code) or code in {"K1b", "K14"}


def test_a_mistake_without_a_sentence_is_told_by_its_short_form():
    bare = next(code for code, mistake in every_mistake().items() if not mistake.hint)
    assert hint_for((bare,)) == f"Your value fits this slip: {about(bare)}. Check that step."


def test_a_mistake_with_a_sentence_is_told_by_it():
    assert hint_for(("K3",)) == "These look like feet per second. Use metres."
    assert "looks turned over" in hint_for(("E1",))


def test_names_are_those_of_the_scene():
    names = names_in("bat_and_ball")
    assert "bat" in hint_for(("E4",), names) or "barrel" in hint_for(("E4",), names)
    assert "foot" in hint_for(("E4",))
    assert "foot" not in hint_for(("E4", "E2"), names)
    assert about("E2", names) in hint_for(("E4", "E2"), names)
    assert about("E4", names) in hint_for(("E4", "E2"), names)


def test_a_group_lists_what_to_check():
    assert hint_for(iter(("K3", "K4"))) == "Your numbers fit more than one slip; check each: feet; centimetres."


# ---------------------------------------------------------------- marks


def test_a_finding_with_a_mistake_of_its_own_is_told_first():
    scale = told("velocities", "K3", ids=("v_f1",))
    marked = with_marks([scale], [finding("px_per_m", mistake="K3"), finding("fps")])
    assert [(d.subject, d.codes, d.basis, d.ids) for d in marked] == [
        ("px_per_m", ("K3",), "truth", ("px_per_m",)),
        ("velocities", ("K3",), "truth", ("v_f1",)),
    ]
    assert marked[0].hint == SOURCE_HINTS["K3"]


@pytest.mark.parametrize(
    ("id_", "code", "at_source"), [("fps", "K2", True), ("px_per_m", "K7", False), ("v_b2", "K3", False)]
)
def test_scale_and_rate_have_hints_of_their_own(id_, code, at_source):
    (mark,) = with_marks([], [finding(id_, mistake=code)])
    assert mark.hint == (SOURCE_HINTS[code] if at_source else hint_for((code,)))


def test_a_cell_that_is_explained_gets_no_second_explanation():
    swapped = told("e", "E5", basis="own")
    assert with_marks([swapped], [finding("e", mistake="K6")]) == (swapped,)
    assert len(with_marks([swapped], [finding("v_b2", mistake="K6")])) == 2


# ---------------------------------------------------------------- one hint a cause


def causes(*items: Diagnosis):
    return [(d.subject, d.codes, d.ids) for d in one_hint_a_cause(items)]


def test_a_slip_of_the_scale_is_told_once_wherever_it_shows():
    items = (told("px_per_m", "K3"), told("velocities", "K3", ids=("v_f1", "v_b2")), told("tracking", "K7"))
    assert causes(*items) == [("px_per_m", ("K3",), ("px_per_m", "v_f1", "v_b2", "tracking"))]
    (joined,) = one_hint_a_cause(items)
    assert (joined.hint, joined.basis) == ("hint K3", "truth")


def test_the_same_cell_is_named_once():
    assert causes(told("v_b2", "K3"), told("velocities", "K4", ids=("v_b2", "v_f1"))) == [
        ("v_b2", ("K3",), ("v_b2", "v_f1"))
    ]


def test_a_later_single_code_settles_an_earlier_group():
    assert causes(told("velocities", "K5", "K7"), told("px_per_m", "K5")) == [
        ("velocities", ("K5",), ("velocities", "px_per_m"))
    ]
    assert causes(told("px_per_m", "K5"), told("velocities", "K5", "K7")) == [
        ("px_per_m", ("K5",), ("px_per_m", "velocities"))
    ]


def test_a_slip_of_the_rate_is_one_for_speeds_and_rates():
    items = (told("velocities", "K2", ids=("v_f1",)), told("angular velocities", "K8", ids=("omega1", "omega2")))
    assert causes(*items) == [("velocities", ("K2",), ("v_f1", "omega1", "omega2"))]


@pytest.mark.parametrize("code", ["K1", "K1b", "K3", "K4", "K4b", "K5", "K5b", "K7"])
def test_rates_have_no_scale(code):
    """A factor two of the angular velocities is another slip than a factor two of the speeds."""
    speeds, rates = told("velocities", code, ids=("v_f1",)), told("angular velocities", code, ids=("omega1",))
    assert len(causes(speeds, rates)) == 2
    assert len(causes(speeds, told("tracking", code))) == 1


def test_other_mistakes_are_told_each():
    assert (
        len(causes(told("e", "E1"), told("I", "I1"), told("v_b2", "K6"), told("velocities", "K3"), told("fps", "K2")))
        == 5
    )
    assert causes(told("e", "E1", "E2"), told("e2", "E1", "E2")) == [("e", ("E1", "E2"), ("e", "e2"))]
    assert len(causes(told("velocities", "K3", "K6"), told("px_per_m", "K3"))) == 2
    assert len(causes(told("velocities", "K2", "K5"), told("fps", "K2"))) == 2
    assert one_hint_a_cause([]) == ()


# ---------------------------------------------------------------- what to do next


@pytest.fixture
def steps(assignment):
    def steps(*findings, diagnosis=(), status="ok", may_hand_in=False, show_truth=False):
        grade = Grade(findings, 0.0, 10.0, status, tuple(diagnosis))
        return [str(step) for step in next_steps(grade, assignment, may_hand_in=may_hand_in, show_truth=show_truth)]

    return steps


def test_nothing_is_to_be_done_where_everything_is_right(steps):
    right = finding("e", Outcome.RIGHT)
    (step,) = steps(right, may_hand_in=True, show_truth=True)
    assert "nothing to do" in step
    (step,) = steps(finding("e", Outcome.WRONG, carried=True))
    assert "nothing to do" in step


def test_what_a_person_has_decided_is_nothing_to_do_but_to_read(assignment):
    def step(outcome):
        grade = Grade((finding("e", outcome),), 0.0, 10.0, "ok", decided=frozenset({"e"}))
        return next_steps(grade, assignment, may_hand_in=True, show_truth=True)[0]

    assert step(Outcome.PARTIAL).startswith("A person has looked")
    assert step(Outcome.RIGHT).startswith("Everything that was judged is right")


def test_an_empty_workbook_is_to_be_filled_in_and_nothing_else(steps):
    first, then = steps(finding("e"), status="empty", may_hand_in=True)
    assert "coloured cells" in first
    assert "Answers" in first
    assert "hand it in again" in then


def test_the_last_step_is_to_hand_in_again_or_to_compare(steps):
    wrong = finding("v_b2")
    assert "hand it in again" in steps(wrong, may_hand_in=True, show_truth=True)[-1]
    assert "Compare" in steps(wrong, show_truth=True)[-1]
    assert len(steps(wrong)) == 1


@pytest.mark.parametrize(
    ("id_", "words", "symbol"),
    [
        ("px_per_m", "known length", "s"),
        ("fps", "frame rate of the recording", "f"),
        ("v_b2", "straight line to the positions", "v<sub>b2</sub>"),
        ("omega1", "angles in radians", "ω<sub>1</sub>"),
    ],
)
@pytest.mark.parametrize("outcome", [Outcome.WRONG, Outcome.PARTIAL])
def test_a_number_that_is_measured_wrongly_is_to_be_measured_again(steps, id_, words, symbol, outcome):
    (step,) = steps(finding(id_, outcome))
    assert words in step
    assert symbol in step


def test_numbers_of_a_kind_are_measured_again_together(steps):
    first, second = steps(finding("v_f1"), finding("omega1"), finding("v_b2"))
    assert "ω<sub>1</sub>" in first or "ω<sub>1</sub>" in second
    together = first if "positions" in first else second
    assert "v<sub>f1</sub>, v<sub>b2</sub>" in together


def test_a_dimension_without_advice_is_measured_again(assignment, steps):
    odd = replace(
        assignment,
        questions=tuple(replace(q, dimension="angle") if q.id == "v_b2" else q for q in assignment.questions),
    )
    (step,) = next_steps(Grade((finding("v_b2"),), 0.0, 1.0, "ok"), odd, may_hand_in=False, show_truth=False)
    assert step == "Measure v<sub>b2</sub> again."


def test_what_a_hint_explains_is_not_told_twice(steps):
    hinted = steps(finding("v_b2"), finding("v_f1"), diagnosis=[told("v_b2", "K6")])
    assert "Where to look" in hinted[0]
    assert "v<sub>b2</sub>" in hinted[0]
    assert "v<sub>f1</sub>" not in hinted[0]
    assert "v<sub>f1</sub>" in hinted[1]
    assert "v<sub>b2</sub>" not in hinted[1]
    assert len(hinted) == 2


def test_a_hint_without_cells_of_its_own_is_about_its_subject_or_the_table(steps):
    assert "v<sub>b2</sub>" in steps(finding("v_b2"), diagnosis=[told("v_b2", "K6", ids=())])[0]
    (step,) = steps(finding("e", Outcome.RIGHT), diagnosis=[told("tracking", "K10")])
    assert "Tracking" in step


def test_a_text_is_to_be_typed_as_a_number(steps):
    (step,) = steps(finding("v_b2", Outcome.UNSURE, numbers={}))
    assert "plain numbers" in step
    assert "v<sub>b2</sub>" in step
    assert "nothing to do" in steps(finding("v_b2", Outcome.UNSURE))[0]
    both = steps(finding("v_b2", Outcome.UNSURE, numbers={}), finding("v_b2"))
    assert len(both) == 1


def test_a_missing_unit_is_to_be_chosen(steps):
    (step,) = steps(finding("v_b2", aspect="unit"))
    assert "unit in the cell beside v<sub>b2</sub>" in step


def test_a_formula_is_to_be_worked_out_again_unless_it_is_explained(steps):
    (step,) = steps(finding("e", aspect="formula"), finding("e"))
    assert "Work out e again" in step
    (hinted,) = steps(finding("e", aspect="formula"), diagnosis=[told("e", "E1")])
    assert "Where to look" in hinted


@pytest.mark.parametrize(
    ("outcome", "numbers", "words"),
    [
        (Outcome.WRONG, {}, "Paste your measured positions into the sheet Tracking"),
        (Outcome.UNSURE, {}, "Paste your measured positions"),
        (Outcome.WRONG, {"rms_px": 9.0}, "Repair the tracking table"),
        (Outcome.PARTIAL, {"rms_px": 3.0}, "Repair the tracking table"),
        (Outcome.UNSURE, {"rms_px": 3.0}, "nothing to do"),
        (Outcome.RIGHT, {}, "nothing to do"),
    ],
)
def test_a_table_is_pasted_or_repaired(steps, outcome, numbers, words):
    (step,) = steps(finding("tracking", outcome, "table", numbers=numbers))
    assert words in step


def test_the_earliest_step_comes_first(steps):
    order = steps(
        finding("e", aspect="formula"),
        finding("tracking", aspect="table", numbers={}),
        finding("v_b2"),
        finding("v_f2", aspect="unit"),
        finding("v_f1", Outcome.UNSURE, numbers={}),
        diagnosis=[told("I", "I1")],
        may_hand_in=True,
    )
    starts = ["Follow the hints", "Type", "Choose the unit", "Fit a straight", "Paste", "Work out", "Save the workbook"]
    assert [step.startswith(start) for step, start in zip(order, starts, strict=True)] == [True] * len(starts)

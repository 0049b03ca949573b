"""A mistake planted in true numbers is found by its own entry, in every textbook; the truth is never told a mistake."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from assignments.load import assignment_ids, load_assignment
from assignments.model import AnswerKey, Assignment, Question
from assignments.textbook import textbook_of
from assignments.theory import Textbook, by_code, promised, value_of
from assignments.variants import draw_variant
from grader.diagnose import (
    diagnose_answer,
    diagnose_factors,
    needs_diagnosis,
)
from grader.model import Answer, Factor, Kind, Outcome, Submission

SECRET = bytes(range(32))
SCALE, FPS = 500.0, 480.0


@dataclass(frozen=True, eq=False)
class Desk:
    """An assignment, its textbook, and a key without a film."""

    assignment: Assignment
    book: Textbook
    key: AnswerKey

    @property
    def questions(self) -> dict[str, Question]:
        return {question.id: question for question in self.assignment.questions}

    def submission(self, values) -> Submission:
        answers = {
            name: value
            if isinstance(value, Answer)
            else Answer(Kind.NUMBER, float(value), f"{value:.15g}", self.questions[name].unit, "Answers!C6", "name")
            for name, value in values.items()
            if name in self.questions
        }
        return Submission("w.xlsx", self.assignment.id, "CODE1", answers, {})

    def told(self, quantity: str, changes=None, digits: int = 15):
        values = {**self.key.values, **(changes or {})}
        written = {n: v if isinstance(v, Answer) else float(f"{v:.{digits}g}") for n, v in values.items()}
        return diagnose_answer(quantity, self.submission(written), self.key, self.questions)


@cache
def desk_of(name: str, student: str = "s1") -> Desk:
    assignment = load_assignment(name)
    book = textbook_of(assignment.scene)
    met = promised(assignment.scene, draw_variant(assignment, SECRET, student).parameters)
    numbers = replace(book.numbers_of(met), S=SCALE)
    values = {item.id: item.true(met) for item in book.measured}
    values |= {item.id: value_of(item.formula, numbers) for item in book.concluded}
    asked = {question.id for question in assignment.questions}
    values = {name: value for name, value in values.items() if name in asked}
    nothing = np.zeros(0)
    truth = {"px_per_m": SCALE, "fps": FPS}
    key = AnswerKey(
        assignment.id, student, "CODE1", values, {}, {}, met.given, truth, "0" * 64, {}, (), nothing, nothing,
        np.zeros((0, 0, 2)), {}, assignment.scene,
    )  # fmt: skip
    return Desk(assignment, book, key)


def first_way(desk: Desk, values):
    fields = {item.field: values[item.id] for item in desk.book.measured if item.id in values}
    first = next(iter(desk.book.complete({**desk.book.resting(desk.questions), **fields}, desk.key.given)))
    return desk.book.record(first, desk.key.given, SCALE)


def planted(desk: Desk):
    """Each mistake whose value is clear of the right one, with it."""
    numbers = first_way(desk, desk.key.values)
    for concluded in desk.book.concluded:
        right = value_of(concluded.formula, numbers)
        if concluded.id in desk.questions:
            for mistake in desk.book.mistakes_about(concluded.id, desk.assignment.scene):
                value = mistake.value(numbers)
                if math.isfinite(value) and value != 0 and abs(value / right - 1) > 0.02:
                    yield mistake, value, numbers


@pytest.mark.parametrize("name", assignment_ids())
def test_a_mistake_planted_in_true_numbers_is_told_by_its_own_entry(name: str) -> None:
    desk = desk_of(name)
    cases = list(planted(desk))
    assert len(cases) > 15
    for mistake, value, numbers in cases:
        diagnosis = desk.told(mistake.quantity, {mistake.quantity: value})
        assert diagnosis is not None, mistake.code
        assert mistake.code in diagnosis.codes
        assert (diagnosis.subject, diagnosis.basis, diagnosis.ids) == (mistake.quantity, "own", (mistake.quantity,))
        others = [m for m in desk.book.mistakes_about(mistake.quantity, desk.assignment.scene) if m != mistake]
        is_exact = len(f"{value:.15g}") > 8  # a whole number such as -1 reads as rounded
        if is_exact and all(
            abs(m.value(numbers) / value - 1) > 1e-3 for m in others if math.isfinite(m.value(numbers))
        ):
            assert diagnosis.codes == (mistake.code,)
            assert "{" not in diagnosis.hint


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(assignment_ids()), st.integers(0, 5), st.integers(3, 15))
def test_the_truth_is_never_told_a_mistake(name: str, student: int, digits: int) -> None:
    desk = desk_of(name, f"s{student}")
    for concluded in desk.book.concluded:
        if concluded.id in desk.questions:
            assert desk.told(concluded.id, digits=digits) is None


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(assignment_ids()), st.floats(0.8, 1.25), st.sampled_from([3, 4, 6]))
def test_what_follows_from_wrong_numbers_is_told_no_mistake(name: str, factor: float, digits: int) -> None:
    """A velocity that was measured badly spoils what follows from it, and its formula is right all the same."""
    desk = desk_of(name)
    changed = next(item.id for item in reversed(desk.book.measured) if item.id in desk.key.values)
    values = {
        n: float(f"{v:.{digits}g}") for n, v in {**desk.key.values, changed: factor * desk.key.values[changed]}.items()
    }
    for concluded in desk.book.concluded:
        own = value_of(concluded.formula, first_way(desk, values))
        if concluded.id in desk.questions and math.isfinite(own) and own != 0:
            follows = {**values, concluded.id: own}
            assert diagnose_answer(concluded.id, desk.submission(follows), desk.key, desk.questions) is None


@settings(deadline=None, max_examples=30)
@given(st.floats(0.1, 10.0))
def test_mistakes_are_found_on_the_students_own_numbers_at_any_scale(factor: float) -> None:
    """Speeds that are all off by a factor leave a turned-over e what it is."""
    desk = desk_of("soccer-kick")
    speeds = {name: factor * desk.key.values[name] for name in ("v_f1", "v_f2", "v_b1", "v_b2", "omega1", "omega2")}
    diagnosis = desk.told("e", {**speeds, "e": 1 / desk.key.values["e"]})
    assert diagnosis is not None
    assert diagnosis.codes == ("E1",)


def test_a_speed_may_have_come_from_the_rate_all_the_same() -> None:
    """The speeds that are written explain nothing; omega L, which gives others, turned over does."""
    desk = desk_of("soccer-kick", "s2")
    speeds = {"v_f1": 1.1 * desk.key.values["v_f1"], "v_f2": 1.3 * desk.key.values["v_f2"]}
    diagnosis = desk.told("e", {**speeds, "e": 1 / desk.key.values["e"]})
    assert (diagnosis.codes, diagnosis.basis) == (("E1",), "own")


# ---------------------------------------------------------------- what is not named

NUMBER = Question("e", "e", "e", "number", "", 1.0, "", 0.02, "conclusion")


def test_what_cannot_be_read_is_told_nothing() -> None:
    desk = desk_of("soccer-kick")
    assert desk.told("e", {"e": Answer(Kind.TEXT, None, "about half", "", "Answers!C6", "name")}) is None
    assert desk.told("e", {"e": Answer()}) is None


def test_without_own_numbers_only_what_is_clear_on_the_truth_is_told() -> None:
    desk = desk_of("two-pucks")

    def told(value: float):
        return diagnose_answer("e", desk.submission({"e": value}), desk.key, desk.questions)

    e = desk.key.values["e"]
    found = told(-e)
    assert (found.codes, found.basis) == (("PE9",), "truth")
    assert told(-e * 1.02).codes == ("PE9",)
    assert told(-e * 1.04) is None
    assert told(e) is None
    assert told(e * (1 + 1.9 * desk.questions["e"].tolerance)) is None
    assert told(77.0) is None


def test_a_group_that_is_near_on_the_truth_is_told_as_one() -> None:
    """On the truth 1/e and its neighbours within three times the distance, or 3 %, are all named."""
    desk = desk_of("soccer-kick")
    found = diagnose_answer("e", desk.submission({"e": 1 / desk.key.values["e"]}), desk.key, desk.questions)
    distances = {
        m.code: abs(1 / desk.key.values["e"] / m.value(first_way(desk, desk.key.values)) - 1)
        for m in desk.book.mistakes_about("e", "soccer_kick")
    }
    near = {code for code, distance in distances.items() if distance <= 0.03}
    assert set(found.codes if found else ()) == (near if len(near) <= 3 else set())


def told_of(monkeypatch, formulas, value: float, tolerance: float = 0.02, *, has_own_numbers: bool = False):
    """Diagnose an e of two pucks whose only mistakes have these formulas; codes are named a, b, c, d in their order."""
    desk = desk_of("two-pucks")
    usual = desk.book.mistakes_about("e")[: len(formulas)]
    made = [replace(mistake, formula=formula) for mistake, formula in zip(usual, formulas, strict=True)]
    monkeypatch.setattr("grader.diagnose.textbook_of", lambda _: replace(desk.book, mistakes=by_code(*made)))
    questions = {**desk.questions, "e": replace(desk.questions["e"], tolerance=tolerance)}
    written = {**(desk.key.values if has_own_numbers else {}), "e": value}
    found = diagnose_answer("e", desk.submission(written), desk.key, questions)
    letters = dict(zip((mistake.code for mistake in made), "abcd", strict=False))
    return found and "".join(letters[code] for code in found.codes)


@pytest.mark.parametrize(
    ("offered", "value", "told"),
    [
        ([2.0], 2.0, "a"),
        ([1.0], 1.0, "a"),
        ([2.0], 2.05, "a"),
        ([2.0], 2.07, None),
        ([2.06, 2.0, 2.02], 2.0, "bca"),
        ([2.0, 2.01, 2.02, 2.03], 2.0, None),
        ([2.0 / 1.05, 2.0 / 1.02], 2.0, "ba"),
        ([2.0 / 1.07, 2.0 / 1.02], 2.0, "b"),
        ([2.0 / 1.025, 2.0 / 1.005], 2.0, "ba"),
        ([0.0, math.nan, 2.0], 2.0, "c"),
        ([1.9, math.inf, 2.0], 2.0, "c"),
    ],
)
def test_on_the_truth_all_within_three_times_the_nearest_are_told_unless_too_many_are(
    monkeypatch, offered, value: float, told: str | None
) -> None:
    formulas = [lambda _, number=number: number for number in offered]
    assert told_of(monkeypatch, formulas, value) == told


@pytest.mark.parametrize(("tolerance", "told"), [(0.24, "a"), (0.26, None)])
def test_what_lies_within_twice_the_tolerance_of_the_truth_is_told_nothing(monkeypatch, tolerance, told) -> None:
    e = desk_of("two-pucks").key.values["e"]
    assert told_of(monkeypatch, [lambda _: 1.5 * e], 1.5 * e, tolerance) == told


def test_at_the_edge_of_twice_the_tolerance_nothing_is_told(monkeypatch) -> None:
    """From e to -e are 2 e, with all its digits."""
    e = desk_of("two-pucks").key.values["e"]
    assert told_of(monkeypatch, [lambda _: -e], -e, 1.0) is None
    assert told_of(monkeypatch, [lambda _: -e], -e, 0.999) == "a"


@pytest.mark.parametrize(("count", "told"), [(1, "a"), (3, "abc"), (4, None)])
def test_of_own_numbers_too_no_more_than_three_are_told(monkeypatch, count: int, told: str | None) -> None:
    formulas = [lambda _: 2.125001] * count
    assert told_of(monkeypatch, formulas, 2.125001, has_own_numbers=True) == told


@pytest.mark.parametrize(
    ("name", "quantity", "near", "far"), [("two-pucks", "phi", 1.045, 1.055), ("ballistic-pendulum", "I", 1.075, 1.085)]
)
def test_on_the_truth_each_quantity_has_its_own_reach(monkeypatch, name, quantity, near: float, far: float) -> None:
    desk = desk_of(name)
    made = replace(desk.book.mistakes_about(quantity)[0], formula=lambda _: 99.0)
    monkeypatch.setattr("grader.diagnose.textbook_of", lambda _: replace(desk.book, mistakes=by_code(made)))

    def codes(value: float):
        found = diagnose_answer(quantity, desk.submission({quantity: value}), desk.key, desk.questions)
        return found and found.codes

    assert codes(99.0 * near) == (made.code,)
    assert codes(99.0 * far) is None


KICK = {"v_f1": 10.02, "v_f2": 8.016, "v_b1": 0.0, "v_b2": 15.03, "omega1": 20.04, "omega2": 16.03}


@pytest.mark.parametrize(
    ("speeds", "codes"), [(KICK, ("E19",)), ({**KICK, "omega1": 20.0, "omega2": 16.0, "v_b2": 15.0}, ("E17b", "E19"))]
)
def test_zeros_that_a_spreadsheet_hides_are_believed(speeds, codes) -> None:
    """0.8 of somebody who writes four digits is 0.8000, which only the ratio of the foot's speeds gives."""
    desk = desk_of("soccer-kick")
    found = diagnose_answer("e", desk.submission({**speeds, "e": 0.8}), desk.key, desk.questions)
    assert (found and found.codes) == codes


@pytest.mark.parametrize(("e", "codes"), [(0.836, ("E8",)), (0.4661, ("E20",))])
def test_hidden_zeros_of_the_other_cells_are_believed_as_well(e: float, codes) -> None:
    """8 and 10 m/s of somebody who writes four digits are 8.000 and 10.00: fewer mistakes fit."""
    desk = desk_of("soccer-kick")
    whole = {**KICK, "v_f1": 10.0, "v_f2": 8.0, "I": 1.234, "e": e}
    assert diagnose_answer("e", desk.submission(whole), desk.key, desk.questions).codes == codes


def test_an_answer_with_fewer_digits_than_usual_is_taken_as_it_stands_where_nothing_else_fits() -> None:
    desk = desk_of("soccer-kick")
    found = diagnose_answer("e", desk.submission({**KICK, "e": 1.9}), desk.key, desk.questions)
    assert (found.codes, found.basis) == (("E2", "E24"), "own")


def test_a_hint_has_the_names_of_the_scene_and_the_symbols_of_the_questions() -> None:
    desk = desk_of("hammer-and-block")
    written = desk.submission({**desk.key.values, "e": 1 / desk.key.values["e"]})
    asked = {**desk.questions, "v_f2": replace(desk.questions["v_f2"], symbol="w_2")}
    hint = diagnose_answer("e", written, desk.key, asked).hint
    assert "e = (v_b2 − w₂) / (v_h1 − 0)" in hint
    lost = desk.key.values["v_b2"] / desk.key.values["v_f1"]
    assert (
        "The head still moves"
        in diagnose_answer("e", desk.submission({**desk.key.values, "e": lost}), desk.key, asked).hint
    )


def test_another_right_answer_tells_that_the_numbers_were_used_as_written() -> None:
    """I follows from the very numbers that are written, so the ratio 8.016 / 10.02 is exact and fits alone."""
    desk = desk_of("soccer-kick")
    coarse = {**KICK, "omega1": 20.0, "omega2": 16.0, "v_b2": 15.0, "e": 0.8}

    def codes(values):
        return diagnose_answer("e", desk.submission(values), desk.key, desk.questions).codes

    inertia = desk.key.given["m"] * desk.key.given["L"] * 15.0 / 4.0
    assert codes(coarse) == codes({**coarse, "I": 77.7}) == ("E17b", "E19")
    assert codes({**coarse, "I": inertia}) == ("E19",)


def test_rates_of_nothing_are_no_failure() -> None:
    """The speed that a rate of zero gives is zero, whatever digits the speed's own cell has."""
    desk = desk_of("soccer-kick")
    assert desk.told("e", {"omega1": 0.0, "omega2": 0.0, "e": 77.7}, digits=3) is None


@pytest.mark.parametrize(
    ("outcomes", "needed"),
    [
        ([("formula", Outcome.RIGHT), ("value", Outcome.RIGHT), ("unit", Outcome.WRONG)], False),
        ([("formula", Outcome.WRONG), ("value", Outcome.RIGHT)], False),
        ([("formula", Outcome.RIGHT), ("value", Outcome.UNSURE)], True),
        ([("formula", Outcome.RIGHT), ("value", Outcome.PARTIAL)], True),
        ([("formula", Outcome.UNSURE)], True),
        ([], False),
    ],
)
def test_a_formula_or_a_value_that_is_not_right_asks_for_a_name_unless_the_truth_explains_the_value(
    outcomes, needed: bool
) -> None:
    assert needs_diagnosis(outcomes) is needed


def test_common_factors_are_put_into_words_unless_too_many_fit() -> None:
    desk = desk_of("soccer-kick")
    speeds, rates = Factor(("K3",), 3.28, ("v_f1", "v_b2")), Factor(("K9", "K2"), 57.3, ("omega1", "omega2"))
    many = Factor(("K1", "K2", "K3", "K4"), 9.0, ("v_f1", "v_b2"))
    arm = Factor(("K12",), 0.5, ("v_f1", "v_f2"))
    told = diagnose_factors((speeds, rates, many, arm), desk.key, desk.questions)
    assert [(d.subject, d.codes, d.basis, d.ids) for d in told] == [
        ("velocities", ("K3",), "truth", ("v_f1", "v_b2")),
        ("angular velocities", ("K9", "K2"), "truth", ("omega1", "omega2")),
        ("velocities", ("K12",), "truth", ("v_f1", "v_f2")),
    ]
    assert "feet" in told[0].hint
    assert "degrees" in told[1].hint
    assert "frame rate" in told[1].hint
    assert "half of L" in told[2].hint
    clock = Factor(("K2",), 0.06, ("v_f1", "omega1"))
    assert diagnose_factors((clock,), desk.key, desk.questions)[0].subject == "velocities"
    three = Factor(("K1", "K2", "K3"), 9.0, ("v_f1", "v_b2"))
    assert len(diagnose_factors((three,), desk.key, desk.questions)) == 1

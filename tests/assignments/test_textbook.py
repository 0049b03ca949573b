"""Textbooks: what they say of an impact is what the simulation does, and every mistake has words and a number."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import pytest

from assignments import textbook as room
from assignments.key import true_value
from assignments.load import assignment_ids, load_assignment
from assignments.names import filled, names_in, of_every_id
from assignments.textbook import every_mistake, textbook, textbook_names, textbook_of
from assignments.theory import promised, value_of
from assignments.variants import draw_variant, impact_numbers
from vml_course.errors import UnknownNameError
from vml_course.kinetics.models import model_names
from vml_course.model.camera import Camera
from vml_course.model.truth import Truth
from vml_course.synth.scene import impact_scene_names, scene_class
from vml_course.synth.simulate import simulate

SECRET = bytes(range(32))
PROMISED = 1e-6  # relative: what a simulated impact keeps of its parameters


@pytest.fixture(scope="module", params=assignment_ids())
def simulated(request: pytest.FixtureRequest) -> Truth:
    assignment = load_assignment(request.param)
    variant = draw_variant(assignment, SECRET, "s1")
    return simulate(scene_class(assignment.scene)(**variant.parameters), Camera(**variant.camera), variant.seed)


def test_every_impact_model_has_a_textbook_in_a_file_of_its_own() -> None:
    assert textbook_names() == model_names()
    files = {path.stem for path in Path(str(room.__file__)).parent.glob("*.py")} - {"__init__"}
    assert files == {name.replace("-", "_") for name in textbook_names()}
    with pytest.raises(UnknownNameError, match=r"model: expected one of ballistic-pendulum, .*got 'golf'"):
        textbook("golf")


@pytest.mark.parametrize("scene", impact_scene_names())
def test_a_scene_and_its_model_meet_in_one_textbook(scene: str) -> None:
    assert textbook_of(scene).model == scene_class(scene).model


def test_conclusions_follow_from_what_is_measured_in_the_simulation(simulated: Truth) -> None:
    book = textbook_of(simulated.scene)
    fields = {item.field: true_value(item.id, simulated) for item in book.measured if item.id not in ("v_f1", "v_f2")}
    numbers = book.record(fields, simulated.given, simulated.camera.px_per_m)
    for item in book.concluded:
        for formula in item.formulas:
            assert value_of(formula, numbers) == pytest.approx(true_value(item.id, simulated), rel=PROMISED), item.id
    assert book.is_possible(numbers)
    assert book.unfit(numbers) == ""


def test_the_closed_form_of_a_draw_is_what_is_simulated(simulated: Truth) -> None:
    book = textbook_of(simulated.scene)
    met = promised(simulated.scene, {n: v for n, v in simulated.parameters.items() if not isinstance(v, str)})
    for item in book.measured:
        assert item.true(met) == pytest.approx(true_value(item.id, simulated), rel=PROMISED, abs=1e-9), item.id


def test_right_numbers_are_no_mistake(simulated: Truth) -> None:
    """A mistake may come near the truth by chance, never by being it."""
    book = textbook_of(simulated.scene)
    numbers = book.numbers_of(
        promised(simulated.scene, {n: v for n, v in simulated.parameters.items() if not isinstance(v, str)})
    )
    for mistake in book.mistakes.values():
        right = value_of(book.conclusion(mistake.quantity).formula, numbers)
        assert not math.isclose(mistake.value(numbers), right, rel_tol=1e-9), mistake.code


@pytest.mark.parametrize("name", textbook_names())
def test_every_mistake_spoils_a_conclusion_and_has_words(name: str) -> None:
    book = textbook(name)
    for code, mistake in book.mistakes.items():
        assert mistake.code == code
        assert mistake.about
        assert every_mistake()[code].quantity == mistake.quantity  # the same code is the same mistake
        assert book.conclusion(mistake.quantity)
        assert mistake in book.mistakes_about(mistake.quantity)
    assert not any(m.scene == "soccer_kick" for m in book.mistakes_about("e", "bat_and_ball"))


@pytest.mark.parametrize("name", assignment_ids())
def test_sentences_name_the_bodies_of_the_scene(name: str) -> None:
    assignment = load_assignment(name)
    names = names_in(assignment.scene, assignment.questions)
    book = textbook_of(assignment.scene)
    for mistake in book.mistakes.values():
        if mistake.scene in {"", assignment.scene}:
            said = filled(f"{mistake.about} {mistake.hint}", names)
            assert "{" not in said
            if assignment.scene != "soccer_kick":
                assert not {"foot", "knee", "leg"} & set(said.replace("'s", "").split())


def test_symbols_of_numbers_that_nobody_asks_for_are_zero_or_those_of_the_same_number() -> None:
    assert names_in("swinging_door", load_assignment("swinging-door").questions)["v_f2"] == "v_d2"
    assert of_every_id("swinging_door", {"v_c2": "w", "v_b1": "x", "v_b2": "y", "omega2": "z"})["v_f1"] == "0"


def test_a_number_that_is_not_given_leaves_its_mistakes_without_a_value() -> None:
    assignment = load_assignment("hammer-and-block")
    numbers = impact_numbers(assignment, draw_variant(assignment, SECRET, "s1").parameters)
    assert math.isnan(numbers.D)
    assert math.isnan(textbook("hammer-block").mistakes["I9"].value(numbers))


def test_a_textbook_without_ways_wants_every_number() -> None:
    book = textbook("two-pucks")
    full = {item.field: 1.0 for item in book.measured}
    assert list(book.complete(full, {})) == [full]
    assert list(book.complete({"a1x": 1.0}, {})) == []


def test_a_ball_that_sticks_cannot_be_asked_for_its_friction() -> None:
    assignment = load_assignment("spinning-ball")
    drawn = draw_variant(assignment, SECRET, "s1").parameters
    sticking = dataclasses.replace(impact_numbers(assignment, drawn), w2=0.0, omega2=0.0)
    assert "sticks" in textbook("spin-bounce").unfit(sticking)

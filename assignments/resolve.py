"""Whether everything that an assignment names exists, and its ranges fit the scene."""

from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from assignments.derive import FORMULAS, arguments_of
from assignments.key import answerable
from assignments.model import Assignment, Draw
from assignments.textbook import textbook_of
from assignments.theory import promised
from vml_course.errors import InputError, UnknownNameError, VmlError
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model, model_names
from vml_course.model.choice import Choice, choices_of
from vml_course.model.quantity import Quantity, quantities_of
from vml_course.model.recording import Recording
from vml_course.model.units import UNITS
from vml_course.synth.scene import AnyScene, impact_scene_names, scene_class

Mistakes = Iterator[InputError]
CHECKS = ("acceleration", "angle", "angular_velocity", "conclusion", "rate", "scale", "tracking", "velocity")
"""What the grader can judge; its checks live on the floor above, where a test holds this list."""

AT_REST = 1e-9  # m/s or rad/s


def mistakes_in(assignment: Assignment) -> Mistakes:
    """Yield every mistake in what an assignment names, each with its key."""
    yield from _unknown("scene", [assignment.scene], impact_scene_names())
    yield from _unknown("model", [assignment.model], model_names())
    yield from _questions(assignment)
    yield from _givens(assignment)
    if not (Path(assignment.folder) / assignment.handout_template).is_file():
        yield InputError("handout", f"a file in {assignment.id}/", repr(assignment.handout_template))
    if assignment.scene in impact_scene_names():
        yield from _physics(assignment)
        yield from _scene(assignment, scene_class(assignment.scene))


def _physics(assignment: Assignment) -> Mistakes:
    """Yield what the scene's textbook does not know, and what is missing for what it concludes."""
    model = scene_class(assignment.scene).model
    if assignment.model != model and assignment.model in model_names():
        yield InputError("model", f"{model!r}, that of the scene {assignment.scene}", repr(assignment.model))
    book, asked = textbook_of(assignment.scene), [question.id for question in assignment.questions]
    yield from _unknown("question.id", asked, answerable(assignment.scene))
    yield from _unknown("separate.mistakes", assignment.separation.mistakes, book.mistakes)
    told = [given.id for given in assignment.givens]
    for symbol in impact_model(model).given:
        if symbol not in told:
            yield InputError("given", f"one with the id {symbol!r}, from which the answers follow", ", ".join(told))
    yield from _of_other_points(assignment)
    fields = {item.field: 1.0 for item in book.measured if item.id in asked} | book.resting(asked)
    if not any(book.complete(fields, dict.fromkeys(told, 1.0))):
        needed = ", ".join(item.id for item in book.measured if not item.may_rest)
        yield InputError("question", f"questions from which the conclusions follow, of {needed}", ", ".join(asked))


def _of_other_points(assignment: Assignment) -> Mistakes:
    """Yield questions about a number that is not the one of the formulas, and unasked bodies that do not rest."""
    usual, fixed = quantities_of(scene_class(assignment.scene)), assignment.fixed
    book = textbook_of(assignment.scene)
    try:
        met = promised(assignment.scene, {name: value for name, value in fixed.items() if name in usual})
    except InputError:  # out of range, which is said elsewhere
        return
    numbers, asked = book.numbers_of(met), {question.id for question in assignment.questions}
    resting = book.resting(asked)
    for item in book.measured:
        used = getattr(numbers, item.field)
        if item.id in asked and not math.isclose(item.true(met), used, rel_tol=1e-9, abs_tol=1e-9):
            same = [other.id for other in book.measured if other.field == item.field and other.id != item.id]
            yield InputError(f"question.{item.id}", f"{' or '.join(same)}, that of the point that is hit", item.id)
        if resting.get(item.field) == 0.0 and abs(used) > AT_REST:
            resting.pop(item.field)
            yield InputError("question", f"a question {item.id}: the body is not at rest", ", ".join(sorted(asked)))


def _questions(assignment: Assignment) -> Mistakes:
    ids = [question.id for question in assignment.questions]
    yield from _twice("question", ids)
    for question in assignment.questions:
        key = f"question.{question.id}"
        yield from _unknown(f"{key}.needs", question.needs, [other for other in ids if other != question.id])
        yield from _unknown(f"{key}.check", [question.check], CHECKS)
        yield from _unknown(f"{key}.dimension", [question.dimension], UNITS)
        si_unit = next(iter(UNITS.get(question.dimension, {question.unit: 1.0})))
        if question.unit != si_unit:
            yield InputError(f"{key}.unit", f"{si_unit!r}, the SI unit of {question.dimension}", repr(question.unit))


def _givens(assignment: Assignment) -> Mistakes:
    ids = [given.id for given in assignment.givens]
    yield from _twice("given", ids)
    yield from _unknown("stick.given", [assignment.stick.given], ids)
    units = [unit for spellings in UNITS.values() for unit in spellings]
    for given in assignment.givens:
        yield from _unknown(f"given.{given.id}.unit", [given.unit], units)
        if (given.value is None) == (not given.parameter):
            yield InputError(
                f"given.{given.id}", "either a parameter or a value", "both" if given.parameter else "none"
            )


def _scene(assignment: Assignment, scene: type[AnyScene]) -> Mistakes:
    quantities = quantities_of(scene)
    camera = quantities_of(scene.default_camera)
    drawable = {**quantities, **{f"camera.{name}": quantity for name, quantity in camera.items()}}
    yield from _named_numbers(assignment, quantities, drawable)
    yield from _twice("parameter", [*assignment.fixed, *_drawn(assignment), *_derived(assignment)])
    for name, value in assignment.fixed.items():
        yield from _inside(f"fixed.{name}", value, quantities.get(name))
    for draw in assignment.draws:
        yield from _draw(draw, drawable.get(draw.parameter))
    for name, (low, high) in assignment.limits.items():
        if not low < high:
            yield InputError(f"limits.{name}", "[low, high] with low below high", f"[{low:g}, {high:g}]")
    yield from _unknown("camera", assignment.camera, camera)
    for name, value in assignment.camera.items():
        yield from _inside(f"camera.{name}", value, camera.get(name))
    yield from _words(assignment.words, choices_of(scene_class(assignment.scene)))
    yield from _settings("recording", Recording, assignment.recording)
    yield from _settings("solve", ImpactOptions, assignment.solve)
    told = [given.parameter for given in assignment.givens if given.parameter]
    yield from _unknown("given.parameter", told, drawable)


def _named_numbers(
    assignment: Assignment, quantities: Mapping[str, Quantity], drawable: Mapping[str, Quantity]
) -> Mistakes:
    """Every number is a parameter of the scene or camera, or drawn as the input of a formula."""
    for key, names in (("fixed", assignment.fixed), ("derive", _derived(assignment)), ("limits", assignment.limits)):
        yield from _unknown(key, names, quantities)
    inputs = [name for derived in assignment.derived for name in derived.inputs.values()]
    yield from _unknown("draw", _drawn(assignment), [*drawable, *inputs])
    for derived in assignment.derived:
        key = f"derive.{derived.parameter}"
        yield from _unknown(f"{key}.formula", [derived.formula], FORMULAS)
        letters = arguments_of(derived.formula) if derived.formula in FORMULAS else tuple(derived.inputs)
        if set(letters) != set(derived.inputs):
            expected = f"the letters {', '.join(letters)}"
            yield InputError(f"{key}.inputs", expected, ", ".join(derived.inputs) or "none")
        yield from _unknown(f"{key}.inputs", derived.inputs.values(), [*_drawn(assignment), *assignment.fixed])


def _draw(draw: Draw, quantity: Quantity | None) -> Mistakes:
    key = f"draw.{draw.parameter}"
    if not draw.low < draw.high:
        yield InputError(f"{key}.high", f"more than low ({draw.low:g})", f"{draw.high:g}")
    elif draw.step > draw.high - draw.low:
        yield InputError(f"{key}.step", f"at most the range ({draw.high - draw.low:g})", f"{draw.step:g}")
    yield from _inside(f"{key}.low", draw.low, quantity)
    yield from _inside(f"{key}.high", draw.high, quantity)


def _settings(key: str, record: type[Any], settings: Mapping[str, Any]) -> Mistakes:
    """Check settings by making the laboratory's own record of them."""
    names = [field.name for field in dataclasses.fields(record)]
    yield from _unknown(key, settings, names)
    try:
        record(**{name: value for name, value in settings.items() if name in names})
    except VmlError as error:
        yield InputError(key, "settings that can be used", str(error).rstrip("."))


def _words(words: Mapping[str, str], choices: Mapping[str, Choice]) -> Mistakes:
    yield from _unknown("words", words, choices)
    for name, word in words.items():
        if name in choices and word not in choices[name].words:
            yield UnknownNameError(f"words.{name}", word, choices[name].words)


def _inside(key: str, value: float, quantity: Quantity | None) -> Mistakes:
    if quantity is not None and not quantity.low <= value <= quantity.high:
        yield InputError(key, quantity.range_text, f"{value:g}")


def _unknown(key: str, names: Iterable[str], known: Iterable[str]) -> Mistakes:
    known = tuple(dict.fromkeys(known))
    yield from (UnknownNameError(key, name, known) for name in names if name not in known)


def _twice(key: str, names: Sequence[str]) -> Mistakes:
    for name, count in Counter(names).items():
        if count > 1:
            yield InputError(key, "each name once", f"{name!r} {count} times")


def _drawn(assignment: Assignment) -> list[str]:
    return [draw.parameter for draw in assignment.draws]


def _derived(assignment: Assignment) -> list[str]:
    return [derived.parameter for derived in assignment.derived]

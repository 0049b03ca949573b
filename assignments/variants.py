"""One student's own numbers, drawn from a secret.

Each number is an HMAC-SHA256 of the course secret over (assignment, student, name of the number, count of
redraws). So nobody without the secret can compute it, a new parameter changes no other, a student who is
added changes nobody, and no library's random stream is involved, which could change with its version.

A draw is rejected when a number leaves its limits, or when common mistakes would give answers that
cannot be told from one another or from the right one.
"""

from __future__ import annotations

import base64
import dataclasses
import hashlib
import hmac
import itertools
import json
from collections import Counter
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache

from assignments.derive import FORMULAS
from assignments.errors import NoVariantError
from assignments.model import Assignment, Draw, Variant
from assignments.textbook import textbook_of
from assignments.theory import Numbers, promised, value_of
from vml_course.errors import InputError
from vml_course.model.quantity import Quantity, quantities_of
from vml_course.model.recording import Recording
from vml_course.synth.scene import scene_class

GENERATOR_VERSION = "1"  # raise it when the same secret must not be expected to give the same numbers
REDRAW_LIMIT = 500
CODE_LETTERS = 20  # of 5 bits: 100 bits cannot be guessed


def draw_variant(assignment: Assignment, secret: bytes, student: str, *, first: int = 0) -> Variant:
    """Draw a student's variant; the same arguments give the same variant, for ever.

    Parameters
    ----------
    assignment : Assignment
    secret : bytes
        The course's secret.
    student : str
        The student's pseudonym.
    first : int
        Where to start counting draws; more than the last variant's `redraws` gives the next variant.

    Raises
    ------
    NoVariantError
        When no draw of `REDRAW_LIMIT` keeps the rules.
    """
    reasons: Counter[str] = Counter()
    for redraws in range(first, first + REDRAW_LIMIT):
        numbers = _numbers(assignment, _drawn(assignment, secret, student, redraws))
        broken = next(broken_rules(assignment, _parameters(assignment, numbers)), None)
        if broken is None:
            return _variant(assignment, secret, student, numbers, redraws)
        reasons[broken] += 1
    raise NoVariantError(assignment.id, REDRAW_LIMIT, [reason for reason, _ in reasons.most_common(3)])


def given_values(assignment: Assignment, variant: Variant) -> dict[str, float]:
    """Return what the student is told, by the id of each given number."""
    numbers = {**variant.parameters, **{f"camera.{name}": value for name, value in variant.camera.items()}}
    return {
        given.id: given.value if given.value is not None else numbers[given.parameter] * given.factor
        for given in assignment.givens
    }


def impact_numbers(assignment: Assignment, parameters: Mapping[str, float]) -> Numbers:
    """Return the numbers that these scene parameters lead to, by the scene's own closed form.

    Raises
    ------
    InputError
        When the scene refuses the parameters.
    """
    return textbook_of(assignment.scene).numbers_of(promised(assignment.scene, parameters))


def broken_rules(assignment: Assignment, parameters: Mapping[str, float]) -> Iterator[str]:
    """Yield why a draw is rejected: limits first, then what cannot be asked, then answers too close together."""
    beyond = list(_beyond(assignment, parameters))
    if beyond:  # a scene refuses such numbers
        yield from beyond
        return
    try:
        numbers = impact_numbers(assignment, parameters)
    except InputError as error:
        yield f"{error.name} refused by the scene"
        return
    unfit = textbook_of(assignment.scene).unfit(numbers)
    if unfit:
        yield unfit
    yield from _too_close(assignment, numbers)


# ---------------------------------------------------------------- numbers from the secret


def digest_of(secret: bytes, *words: str | int) -> bytes:
    """Return the HMAC-SHA256 of a list of words; no two lists are written alike."""
    return hmac.new(secret, json.dumps(words, ensure_ascii=True).encode(), hashlib.sha256).digest()


def code_of(secret: bytes, assignment_id: str, student: str, redraws: int) -> str:
    """Return the variant's code: letters and digits that tell nothing."""
    digest = digest_of(secret, "code", assignment_id, student, redraws)
    return base64.b32encode(digest).decode()[:CODE_LETTERS]


def signature_of(secret: bytes, assignment_id: str, code: str) -> str:
    """Return the course's signature of a workbook's code."""
    return digest_of(secret, "workbook", assignment_id, code).hex()


def _drawn(assignment: Assignment, secret: bytes, student: str, redraws: int) -> dict[str, float]:
    return {
        draw.parameter: _pick(draw, digest_of(secret, "draw", assignment.id, student, draw.parameter, redraws))
        for draw in assignment.draws
    }


def _pick(draw: Draw, digest: bytes) -> float:
    """Pick one value of the grid; 64 bits make the unevenness of the remainder vanish."""
    values = grid_of(draw)
    return values[int.from_bytes(digest[:8], "big") % len(values)]


@cache
def grid_of(draw: Draw) -> tuple[float, ...]:
    """Return the values that can be drawn.

    Counted in fractions of the decimal numbers as written, so that 0.20 + 3 * 0.01 is 0.23 and prints so.

    >>> grid_of(Draw("ball_mass_kg", 0.2, 0.26, 0.02, avoid=((0.21, 0.23),)))
    (0.2, 0.24, 0.26)
    """
    low, high, step = (Fraction(repr(number)) for number in (draw.low, draw.high, draw.step))
    values = (float(low + k * step) for k in range((high - low) // step + 1))
    return tuple(v for v in values if not any(start <= v <= end for start, end in draw.avoid))


# ---------------------------------------------------------------- one variant


def _quantities(assignment: Assignment) -> dict[str, Quantity]:
    return quantities_of(scene_class(assignment.scene))


def _numbers(assignment: Assignment, drawn: Mapping[str, float]) -> dict[str, float]:
    """Return what is fixed, drawn and derived, by name."""
    numbers = {**assignment.fixed, **drawn}
    for derived in assignment.derived:
        inputs = {letter: numbers[name] for letter, name in derived.inputs.items()}
        numbers[derived.parameter] = FORMULAS[derived.formula](**inputs)
    return numbers


def _parameters(assignment: Assignment, numbers: Mapping[str, float]) -> dict[str, float]:
    """Return every parameter of the scene; what is not among `numbers` keeps its default."""
    return {name: numbers.get(name, quantity.default) for name, quantity in _quantities(assignment).items()}


def _camera(assignment: Assignment, numbers: Mapping[str, float]) -> dict[str, float]:
    """Return every setting of the camera: the scene's own, the assignment's, and what is drawn as `camera.<field>`."""
    usual = {**dataclasses.asdict(scene_class(assignment.scene).default_camera), **assignment.camera}
    return {name: numbers.get(f"camera.{name}", value) for name, value in usual.items()}


def _variant(
    assignment: Assignment, secret: bytes, student: str, numbers: Mapping[str, float], redraws: int
) -> Variant:
    code = code_of(secret, assignment.id, student, redraws)
    return Variant(
        assignment_id=assignment.id,
        student=student,
        code=code,
        parameters=_parameters(assignment, numbers),
        camera=_camera(assignment, numbers),
        recording={**dataclasses.asdict(Recording()), **assignment.recording},
        seed=int.from_bytes(digest_of(secret, "seed", assignment.id, student, redraws)[:4], "big") >> 1,
        redraws=redraws,
        generator_version=GENERATOR_VERSION,
        signature=signature_of(secret, assignment.id, code),
        scene=assignment.scene,
        words=dict(assignment.words),
    )


# ---------------------------------------------------------------- rules


def _beyond(assignment: Assignment, parameters: Mapping[str, float]) -> Iterator[str]:
    for name, quantity in _quantities(assignment).items():
        low, high = assignment.limits.get(name, (quantity.low, quantity.high))
        if not max(low, quantity.low) <= parameters[name] <= min(high, quantity.high):
            yield f"{name} beyond its limits"


def _too_close(assignment: Assignment, numbers: Numbers) -> Iterator[str]:
    book, asked = textbook_of(assignment.scene), {question.id: question for question in assignment.questions}
    for concluded in book.concluded:
        truth = value_of(concluded.formula, numbers)
        tolerance = asked[concluded.id].tolerance if concluded.id in asked else 0.0
        codes = [code for code in assignment.separation.mistakes if book.mistakes[code].quantity == concluded.id]
        wrong = {code: book.mistakes[code].value(numbers) for code in codes}
        for code, value in wrong.items():
            if abs(value - truth) <= tolerance * abs(truth):
                yield f"{code} inside the tolerance of {concluded.id}"
        for (one, a), (other, b) in itertools.combinations(wrong.items(), 2):
            if abs(a - b) < assignment.separation.apart * max(abs(a), abs(b)):
                yield f"{one} and {other} too close"

"""How sharply a variant can be measured, before it is rendered; a variant that is too hard is drawn again.

The true paths are blurred as the reference tracker usually blurs them, and solved. What the solver then says of its
precision is what it says of most rendered videos within some percent (`benchmarks/handing_out.py`); of the few in
which the tracker meets more than noise it says more, so that a release looks again.

The limit is one of the assignment, never of the class: who joins later changes nobody's variant.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ndtri

from assignments.errors import NoVariantError, UnfairError
from assignments.film import foresee
from assignments.key import stick_px, true_value
from assignments.model import Assignment, Question, Variant
from assignments.textbook import textbook_of
from assignments.variants import draw_variant, given_values
from vml_course.errors import VmlError
from vml_course.kinetics.calibrate import calibrate
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model
from vml_course.model.arrays import FloatArray
from vml_course.model.solution import ImpactSolution
from vml_course.model.track import Track
from vml_course.model.truth import Truth

USUAL_SIGMA_PX = 0.02  # of the reference tracker on the catalogue's videos: 0.007 to 0.024
FAIR_SHARE = 0.25  # of the tolerance: then twice the sd lies within the half that a release asks for
DRAWS = 50  # that are predicted at most


@dataclass(frozen=True)
class Prediction:
    """What is foreseen, or seen, of a variant: the answers, and how sharply they can be measured.

    Attributes
    ----------
    value, sd : mapping of str to float
        Of each conclusion by its question's id, SI units.
    """

    value: Mapping[str, float]
    sd: Mapping[str, float]


@dataclass(frozen=True)
class Fair:
    """A variant that can be measured sharply enough, and why draws before it could not."""

    variant: Variant
    prediction: Prediction
    refused: tuple[str, ...]


def fair_variant(assignment: Assignment, secret: bytes, student: str, *, first: int = 0) -> Fair:
    """Draw a student's variant that is fair; the same arguments give the same one, whoever else is in the class.

    Raises
    ------
    NoVariantError
    """
    refused: list[str] = []
    for _ in range(DRAWS):
        variant = draw_variant(assignment, secret, student, first=first)
        try:
            prediction = predict(assignment, variant)
            hold_fair(assignment, prediction)
        except VmlError as error:
            refused.append(f"draw {variant.redraws}: {error}")
            first = variant.redraws + 1
            continue
        return Fair(variant, prediction, tuple(refused))
    raise NoVariantError(assignment.id, DRAWS, refused[-3:])


def predict(assignment: Assignment, variant: Variant) -> Prediction:
    """Foresee what the reference will find in the video of a variant.

    Raises
    ------
    VmlError
        When the scene is refused, or its impact cannot be solved.
    """
    truth = foresee(variant)
    return precision(assignment, truth, solve(blurred_track(truth, assignment.points), truth, assignment, variant))


def precision(assignment: Assignment, truth: Truth, found: ImpactSolution) -> Prediction:
    """Return what is true of the conclusions, and how sharply they were found."""
    every = [question.id for question in assignment.questions]
    solved = textbook_of(truth.scene).solved(found.estimates, every, truth.given)
    asked = [question.id for question in conclusions(assignment) if question.id in solved]
    return Prediction({q: true_value(q, truth) for q in asked}, {q: solved[q].sd for q in asked})


def hold_fair(assignment: Assignment, prediction: Prediction) -> None:
    """Check that every conclusion can be measured much more sharply than is asked of the student.

    Raises
    ------
    UnfairError
    """
    for symbol, sd in prediction.sd.items():
        allowed = FAIR_SHARE * allowance(assignment.question(symbol), prediction.value[symbol])
        if not sd <= allowed:
            raise UnfairError(symbol, sd, allowed)


def solve(track: Track, truth: Truth, assignment: Assignment, variant: Variant) -> ImpactSolution:
    """Calibrate a track on the known length that the student is told, and solve the impact.

    Raises
    ------
    VmlError
    """
    options: dict[str, Any] = {**truth.declared, **assignment.solve}
    stick_m = given_values(assignment, variant)[assignment.stick.given]
    motion = calibrate(stick_px(truth, assignment), stick_m).apply(track)
    return impact_model(assignment.model).solve(motion, truth.given, ImpactOptions(**options))


def conclusions(assignment: Assignment) -> tuple[Question, ...]:
    """Return the questions whose answers are what the experiment is made for."""
    return tuple(question for question in assignment.questions if question.group == "conclusion")


def allowance(question: Question, truth: float) -> float:
    """Return by how much an answer may be off for full credit, in the question's unit."""
    return max(question.tolerance * abs(truth), question.floor)


def blurred_track(truth: Truth, points: tuple[str, ...]) -> Track:
    """Return the true paths as a tracker sees them: each coordinate off by noise of `USUAL_SIGMA_PX`.

    The noise is the same for ever: it comes from a hash, as all that decides who gets which variant.
    """
    true_px = truth.xy_px[:, [truth.points.index(point) for point in points]]
    shape = true_px.shape[:2]
    return Track(
        points=points,
        frame=np.arange(shape[0]),
        time_s=truth.time_s,
        xy_px=true_px + USUAL_SIGMA_PX * _normal_numbers(true_px.size).reshape(true_px.shape),
        sigma_px=np.full(shape, USUAL_SIGMA_PX),
        zncc=np.ones(shape),
        iterations=np.ones(shape, dtype=np.int64),
        status=np.zeros(shape, dtype=np.int8),
        gradient=np.zeros((*shape, 4)),
    )


def _normal_numbers(count: int) -> FloatArray:
    digest = hashlib.shake_256(b"noise of the usual tracker").digest(8 * count)
    uniform = (np.frombuffer(digest, dtype="<u8") + 0.5) / 2.0**64
    normal: FloatArray = ndtri(uniform)
    return normal

"""The answer key: computed once, from the very truth that was rendered, and kept by the instructor."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from importlib.metadata import version
from typing import Any

import numpy as np

from assignments.model import AnswerKey, Assignment, Variant
from assignments.textbook import textbook_of
from assignments.theory import Met
from assignments.variants import given_values
from vml_course.errors import InputError
from vml_course.model.solution import ImpactSolution
from vml_course.model.truth import Truth


def answer_key(
    assignment: Assignment, variant: Variant, truth: Truth, measured: ImpactSolution | None, video_sha256: str
) -> AnswerKey:
    """Return what is true of a variant, beside what the reference measured on its video.

    Parameters
    ----------
    assignment : Assignment
    variant : Variant
    truth : Truth
        Of the video that is handed out.
    measured : ImpactSolution or None
        What the reference tracker and solver found in that video; its standard deviations are the precision
        that can be expected of a careful student.
    video_sha256 : str

    Raises
    ------
    InputError
        When a question asks for something that no truth is known of.
    """
    estimates = measured.estimates if measured else {}
    given = given_values(assignment, variant)
    asked = [question.id for question in assignment.questions]
    solved = textbook_of(truth.scene).solved(estimates, asked, given)
    return AnswerKey(
        assignment_id=assignment.id,
        student=variant.student,
        code=variant.code,
        values={question.id: true_value(question.id, truth) for question in assignment.questions},
        expected_sd={symbol: estimate.sd for symbol, estimate in solved.items()},
        measured={symbol: estimate.value for symbol, estimate in solved.items()},
        given=given,
        truth=_further(truth) | _stick(truth, assignment),
        video_sha256=video_sha256,
        versions={
            **truth.versions,
            "vml_course": version("vml-course"),
            "generator": variant.generator_version,
            "assignment": assignment.version,
        },
        points=truth.points,
        frame=np.arange(len(truth.time_s)),
        time_s=truth.time_s,
        xy_px=truth.xy_px,
        parameters=dict(truth.parameters),
        scene=truth.scene,
    )


# ---------------------------------------------------------------- what is true

_OF_THE_CAMERA: Mapping[str, Callable[[Truth], float]] = {
    "px_per_m": lambda truth: truth.camera.px_per_m,
    "fps": lambda truth: truth.camera.fps,
}


def answerable(scene: str) -> tuple[str, ...]:
    """Return the ids of the questions whose true value is known in a scene."""
    return (*_OF_THE_CAMERA, *textbook_of(scene).answerable)


def true_value(question: str, truth: Truth) -> float:
    """Return the true answer to a question, in SI units.

    Signs and directions are those of the scene's textbook.

    Raises
    ------
    InputError
        When no truth is known of that question.
    """
    if question in _OF_THE_CAMERA:
        return float(_OF_THE_CAMERA[question](truth))
    if question not in answerable(truth.scene):
        raise InputError(f"question.{question}", f"one of {', '.join(answerable(truth.scene))}", repr(question))
    return textbook_of(truth.scene).true(question, Met(truth.met, truth.given, truth.parameters))


def stick_px(truth: Truth, assignment: Assignment) -> tuple[float, ...]:
    """Return where both ends of the known length are seen in the first frame: x1, y1, x2, y2."""
    return (*truth.mark_px(assignment.stick.tail), *truth.mark_px(assignment.stick.head))


def _further(truth: Truth) -> dict[str, float]:
    impact = truth.met
    return {
        "px_per_m": truth.camera.px_per_m,
        "fps": truth.camera.fps,
        "origin_x_px": truth.camera.origin_x_px,
        "origin_y_px": truth.camera.origin_y_px,
        "R": truth.given.get("D", math.nan) / 2,
        "arm_m": impact.arm_m,
        "impulse_N_s": impact.impulse_N_s,
        "t_impact_s": impact.time_s,
        "frame_before": float(impact.frame_before),
        **(_angles(truth) if len(truth.leg_angle_rad) else {}),
    }


def _angles(truth: Truth) -> dict[str, float]:
    """Return the striker's angle at the impact, and how far the normal is turned from its mark's path."""
    impact = truth.met
    since_s = impact.time_s - truth.time_s[impact.frame_before]  # never interpolated across the impact
    leg_rad = float(truth.leg_angle_rad[impact.frame_before] + impact.omega_before_rad_s * since_s)
    path_rad = leg_rad + math.copysign(math.pi / 2, impact.omega_before_rad_s)
    normal_rad = math.atan2(impact.normal[1], impact.normal[0])
    return {"theta_impact_rad": leg_rad, "tilt_rad": math.remainder(normal_rad - path_rad, 2 * math.pi)}


def _stick(truth: Truth, assignment: Assignment) -> dict[str, float]:
    return dict(
        zip(("stick_x1_px", "stick_y1_px", "stick_x2_px", "stick_y2_px"), stick_px(truth, assignment), strict=True)
    )


# ---------------------------------------------------------------- to keep


def to_json(key: AnswerKey) -> dict[str, Any]:
    """Return a key as plain lists, texts and numbers; an unknown number (NaN) becomes null."""
    return {field.name: _plain(getattr(key, field.name)) for field in dataclasses.fields(key)}


def from_json(content: Mapping[str, Any]) -> AnswerKey:
    """Return the key that `to_json` wrote; null becomes NaN."""
    numbers = {name: _numbers(value) for name, value in content.items() if name in _NUMBER_MAPS}
    return AnswerKey(**{**content, **numbers, "points": tuple(content["points"])})


_NUMBER_MAPS = ("values", "expected_sd", "measured", "given", "truth", "parameters")


def _numbers(values: Mapping[str, float | None]) -> dict[str, float]:
    return {name: math.nan if value is None else value for name, value in values.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Mapping):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, tuple):
        return list(value)
    return None if isinstance(value, float) and math.isnan(value) else value

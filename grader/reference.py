"""What the reference method makes of a student's own tracking table: it tells an error of tracking from a later one.

A table whose only fault is its scale, the direction of an axis or where it starts to count frames is put right first:
that slip is told by itself, and such a table still shows that the video was tracked.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from assignments.model import AnswerKey, Assignment
from assignments.textbook import textbook_of
from grader.tracked import OUR_FAILURE, FromTable
from grader.trajectory import TrajectoryFit, fit_trajectory
from vml_course.errors import VmlError
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution
from vml_course.synth.scene import Scene, scene_class


def from_table(tracking: Mapping[str, FloatArray], key: AnswerKey, assignment: Assignment) -> FromTable:
    """Solve the impact from a student's tracking table; never raises, says `OUR_FAILURE` where we cannot.

    Parameters
    ----------
    tracking : mapping of str to float array, shape (n,)
        Columns of the table, as in `fit_trajectory`.
    key : AnswerKey
    assignment : Assignment
    """
    try:
        fit = fit_trajectory(tracking, key, is_far_tried=True)
        return FromTable() if fit is None else _from_fit(fit, key, assignment)
    except Exception:  # noqa: BLE001 - our own failure must never cost a student points: a person looks
        return FromTable(why_not=OUR_FAILURE)


def _from_fit(fit: TrajectoryFit, key: AnswerKey, assignment: Assignment) -> FromTable:
    try:
        return _solved(fit, key, assignment)
    except VmlError as error:
        return FromTable(fit, why_not=str(error))
    except Exception:  # noqa: BLE001 - as above; what is known of the table is kept
        return FromTable(fit, why_not=OUR_FAILURE)


def _solved(fit: TrajectoryFit, key: AnswerKey, assignment: Assignment) -> FromTable:
    is_corrected = fit.y_down or fit.x_left or fit.is_off_scale
    motion = _motion(fit, key, 1.0 if is_corrected else fit.scale_ratio)
    kind, model = scene_class(key.scene), impact_model(assignment.model)
    declared: dict[str, Any] = dict(kind().declared()) if issubclass(kind, Scene) else {}
    given = {symbol: key.given[symbol] for symbol in (*model.given, *model.optional) if symbol in key.given}
    options = ImpactOptions(**{**declared, **assignment.solve})
    with np.errstate(all="ignore"):
        found = model.solve(motion, given, options)
    values, sds = _by_question(found, key, assignment)
    return FromTable(fit, values, sds, is_corrected, "", options.window_s)


def _motion(fit: TrajectoryFit, key: AnswerKey, ratio: float) -> Motion:
    """Return the table in metres, y up, one row a frame of the clip."""
    frame = np.rint(fit.clip_frame)
    kept = (frame >= key.frame[0]) & (frame <= key.frame[-1]) & (np.diff(frame, prepend=-np.inf) > 0)
    xy_m = fit.own_m[kept] * ratio
    return Motion(fit.points, frame[kept].astype(np.int64), fit.time_s[kept], xy_m, np.full(xy_m.shape[:2], math.nan))


def _by_question(
    found: ImpactSolution, key: AnswerKey, assignment: Assignment
) -> tuple[dict[str, float], dict[str, float]]:
    """Return values and standard deviations by question, in the textbook's signs."""
    asked = [question.id for question in assignment.questions]
    solved = textbook_of(key.scene).solved(found.estimates, asked, key.given)
    kept = {id_: solved[id_] for id_ in asked if id_ in solved}
    return {id_: one.value for id_, one in kept.items()}, {id_: one.sd for id_, one in kept.items()}

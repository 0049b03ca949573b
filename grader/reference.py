"""What the reference method makes of a student's own tracking table: it tells an error of tracking from a later one.

A table whose only fault is its scale or the direction of an axis is put right first: that slip is told by itself,
and such a table still shows that the video was tracked.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from assignments.model import AnswerKey, Assignment
from assignments.textbook import textbook_of
from assignments.theory import Textbook, value_of
from grader.trajectory import TrajectoryFit, fit_trajectory
from vml_course.errors import VmlError
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution
from vml_course.synth.scene import Scene, scene_class

SLIP = 0.02
"""From this relative error on, the scale of a table is a slip that is put right before it is solved."""

FARTHEST_PX = 4.0
"""A table that lies farther from the true path than this supports nothing."""


@dataclass(frozen=True, eq=False)
class FromTable:
    """What follows from a tracking table.

    Attributes
    ----------
    fit : TrajectoryFit or None
        The table laid over the truth; None where there is no table.
    values, sds : mapping of str to float
        By question, SI units; one standard deviation where the solver knows it. Empty where it cannot be solved.
    is_corrected : bool
        Whether scale or axis were put right first.
    why_not : str
        Why there are no values.
    """

    fit: TrajectoryFit | None = None
    values: Mapping[str, float] = field(default_factory=dict)
    sds: Mapping[str, float] = field(default_factory=dict)
    is_corrected: bool = False
    why_not: str = "there is no tracking table"

    @property
    def is_near(self) -> bool:
        """Whether the table follows the true path."""
        return self.fit is not None and self.fit.rms_px <= FARTHEST_PX


def from_table(tracking: Mapping[str, FloatArray], key: AnswerKey, assignment: Assignment) -> FromTable:
    """Solve the impact from a student's tracking table; never raises.

    Parameters
    ----------
    tracking : mapping of str to float array, shape (n,)
        Columns of the table, as in `fit_trajectory`.
    key : AnswerKey
    assignment : Assignment
    """
    try:
        fit = fit_trajectory(tracking, key)
        if fit is None:
            return FromTable()
        return _solved(fit, key, assignment)
    except VmlError as error:
        return FromTable(fit, why_not=str(error))
    except Exception:  # noqa: BLE001 - our own failure must never cost a student points: a person looks
        return FromTable(why_not="the grader could not solve the table")


def _solved(fit: TrajectoryFit, key: AnswerKey, assignment: Assignment) -> FromTable:
    is_corrected = fit.y_down or fit.x_left or abs(fit.scale_ratio - 1.0) > SLIP
    motion = _motion(fit, key, 1.0 if is_corrected else fit.scale_ratio)
    kind, model = scene_class(key.scene), impact_model(assignment.model)
    declared: dict[str, Any] = dict(kind().declared()) if issubclass(kind, Scene) else {}
    given = {symbol: key.given[symbol] for symbol in (*model.given, *model.optional) if symbol in key.given}
    with np.errstate(all="ignore"):
        found = model.solve(motion, given, ImpactOptions(**{**declared, **assignment.solve}))
    values, sds = _by_question(found, key, assignment)
    return FromTable(fit, values, sds, is_corrected, why_not="")


def _motion(fit: TrajectoryFit, key: AnswerKey, ratio: float) -> Motion:
    """Return the table in metres, y up, one row a frame of the clip."""
    frame = np.rint(fit.frame)
    kept = (frame >= key.frame[0]) & (frame <= key.frame[-1]) & (np.diff(frame, prepend=-np.inf) > 0)
    xy_m = fit.own_m[kept] * ratio
    return Motion(fit.points, frame[kept].astype(np.int64), fit.time_s[kept], xy_m, np.full(xy_m.shape[:2], math.nan))


def _by_question(
    found: ImpactSolution, key: AnswerKey, assignment: Assignment
) -> tuple[dict[str, float], dict[str, float]]:
    """Return estimates by question, in the textbook's signs; what the solver does not name follows by its formula."""
    book, asked = textbook_of(key.scene), {question.id for question in assignment.questions}
    signs = {item.id: item.solved for item in book.measured}
    values = {id_: signs.get(id_, 1.0) * estimate.value for id_, estimate in found.estimates.items() if id_ in asked}
    sds = {id_: found.estimates[id_].sd for id_ in values}
    return {**_concluded(book, values, key), **values}, sds


def _concluded(book: Textbook, values: Mapping[str, float], key: AnswerKey) -> dict[str, float]:
    fields = {item.field: values[item.id] for item in book.measured if item.id in values}
    numbers = book.record({**book.resting(key.values), **fields}, key.given)
    worked = {item.id: value_of(item.formula, numbers) for item in book.concluded if item.id in key.values}
    return {id_: value for id_, value in worked.items() if math.isfinite(value)}

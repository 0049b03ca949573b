"""What finding a block needs to know: its reference, its past, the rules, and where to look."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vml_course.correlate.icgn import UNKNOWN_PACE, Pace
from vml_course.correlate.template import Template, read_only
from vml_course.model.arrays import FloatArray
from vml_course.track.blur import Sharp
from vml_course.track.mask import NO_LESSONS, Lessons


class Rules(NamedTuple):
    """When a match counts."""

    search_radius_px: float
    zncc_lost: float
    zncc_far: float
    max_iterations: int
    give_up_frames: int
    shutter: float = 0.0


FRESH_ZNCC = 1.0  # nothing has been compared with a new reference yet
UPRIGHT = read_only(np.array([1.0, 0.0, 0.0, 1.0]))


@dataclass(frozen=True, eq=False)
class Reference:
    """A point's block in the first picture, or in the one where it was renewed.

    Attributes
    ----------
    template : Template
    block : float32 array, shape (n, m)
        Its grey levels.
    sigma_px : float
        Standard deviation of a coordinate that the block's noise leads one to expect.
    sharp : Sharp
        What its template is made from.
    base : float array, shape (4,)
        Linear part of the block's pose against the first block, when it was cut.
    drift_px : float
        Standard deviation of the place where it was cut; 0 for the first block.
    """

    template: Template
    block: NDArray[np.float32]
    sigma_px: float
    sharp: Sharp
    base: FloatArray = field(default_factory=lambda: UPRIGHT)
    drift_px: float = 0.0


class Past(NamedTuple):
    """What is remembered of a point; one is made a picture and point, so it is a plain tuple.

    Attributes
    ----------
    poses : tuple of float arrays, shape (6,)
        The newest first, at most three, of consecutive pictures.
    steady : int
        Pictures in a row in which it was where it was expected.
    lost : int
        Pictures since it was last seen.
    usual_zncc : float
    own_smear_px : float array, shape (2,), or None
        How the reference itself is smeared; None until the second picture has told.
    lessons : Lessons
        What the first pictures tell of the block's pixels.
    pace : Pace
        How the steps of its matches shrink.
    fresh_zncc : float
        Of the first match with this reference.
    weak : int
        Pictures in a row whose ZNCC was well below that.
    """

    poses: tuple[FloatArray, ...]
    steady: int = 0
    lost: int = 0
    usual_zncc: float = 1.0
    own_smear_px: FloatArray | None = None
    lessons: Lessons = NO_LESSONS
    pace: Pace = UNKNOWN_PACE
    fresh_zncc: float = FRESH_ZNCC
    weak: int = 0


class Guess(NamedTuple):
    """A pose to refine, how far it may pull, and what makes its match acceptable."""

    pose: FloatArray
    pull_px: float
    radius_px: float
    least_zncc: float
    rung: int

"""Which pixels of a block move with it, and how well each is kept: weights learned from the first pictures.

What lies beside the body in the block's corners does not fit once the body has moved, and a codec spoils strong
edges more than plain ground. Both show in the residual: each pixel counts by the inverse of its variance, which
is the median over a few pictures of its squared residual, smoothed over its neighbours. Where noise alone is
left the weights are equal to a few per cent, which costs nothing: an error of 10 % in the weights costs 1 % in
the variance.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np

from vml_course.correlate.bspline import Float32Array
from vml_course.correlate.template import Template
from vml_course.model.arrays import FloatArray

LESSONS = (1, 2, 4, 8)  # pictures after which the weights are set, from the newer half of them
MOVED_PX = 1.0  # at a corner, since the last lesson: a codec copies what stands still, with its noise
SMOOTH_PX = 3.0
LEAST_WEIGHT = 0.1  # less is another body
MASKED = 1e-4  # which then counts for nothing, but is still looked at
USUAL = 0.3  # the share of the block that surely moves with it
LEAST_SHARE = 0.2  # of the block that must remain


class Lessons(NamedTuple):
    """Squared residuals, shape (n, m) each, in grey levels, and the pose of the last one."""

    squares: tuple[Float32Array, ...] = ()
    pose: FloatArray | None = None

    @property
    def are_over(self) -> bool:
        """Whether enough has been learned."""
        return len(self.squares) >= LESSONS[-1]


NO_LESSONS = Lessons()


def attend(lessons: Lessons, template: Template, pose: FloatArray, residual: Float32Array) -> Lessons:
    """Return the lessons with one more, if the block has moved since the last one.

    Parameters
    ----------
    residual : float32 array, shape (n, m)
        As `icgn.match` returns it.
    """
    before = lessons.pose
    half = 0.5 * max(residual.shape)
    if before is not None:
        moved = np.abs(pose - before)
        if max(moved[:2].max(), 2.0 * half * moved[2:].max()) < MOVED_PX:
            return lessons
        return Lessons((*lessons.squares, residual**2 / template.weight), pose)
    return Lessons((), pose)


def is_due(lessons: Lessons) -> bool:
    """Whether the weights are to be set now."""
    return len(lessons.squares) in LESSONS


def weight_of(squares: tuple[Float32Array, ...]) -> Float32Array | None:
    """Return the share of each pixel, shape (n, m), 0 to 1; None when too little would be left."""
    newer = squares[len(squares) // 2 :]  # the older ones were pulled by what is masked since
    middle = np.median(np.stack(newer), axis=0).astype(np.float32)
    variance = cv2.GaussianBlur(middle, (0, 0), SMOOTH_PX, borderType=cv2.BORDER_REPLICATE)
    usual = float(np.quantile(variance, USUAL))
    if usual <= 0.0:
        return None
    weight = np.minimum(1.0, 2.0 * usual / (usual + variance)).astype(np.float32)
    weight[weight < LEAST_WEIGHT] = MASKED
    return weight if float((weight > 0.5).mean()) >= LEAST_SHARE else None

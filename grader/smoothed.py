"""Whether a tracking table was smoothed across the impact: that rounds off the corner of the paths, no more."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import uniform_filter1d

from assignments.model import AnswerKey
from grader.trajectory import TrajectoryFit
from vml_course.model.arrays import FloatArray

WIDTHS = (3, 5, 7, 9, 13, 17, 21)
"""Moving means that are tried, in frames."""

AROUND = 12  # frames each side of the impact
LEAST_PX = 0.2  # a rounder corner than this is seen
EXPLAINED = 0.3  # part of what remains that the rounded corner explains
CLEAR_SDS = 8.0  # of the depth of the corner: noise reaches 3
_SIZE = (0.5, 1.6)  # how deep the corner is cut, against the moving mean's


def smoothing_of(fit: TrajectoryFit, key: AnswerKey) -> int:
    """Return the width in frames of the moving mean that a table looks smoothed with, 0 when it does not.

    Parameters
    ----------
    fit : TrajectoryFit
    key : AnswerKey
    """
    if "frame_before" not in key.truth:
        return 0
    in_clip = np.isfinite(fit.true_m).all(axis=(1, 2))  # a mean over what lies outside is none
    near = np.abs(fit.clip_frame[in_clip] - key.truth["frame_before"] - 0.5) <= AROUND
    if near.sum() < AROUND:
        return 0
    own_px, true_px = (key.truth["px_per_m"] * positions[in_clip] for positions in (fit.own_m, fit.true_m))
    explained = {width: _explained(own_px - true_px, true_px, near, width) for width in WIDTHS}
    best = max(explained, key=explained.__getitem__)
    return best if explained[best] >= EXPLAINED else 0


def _explained(rest_px: FloatArray, true_px: FloatArray, near: np.ndarray, width: int) -> float:
    """Return which part of the remainder near the impact is a corner rounded off by a moving mean."""
    corner = (uniform_filter1d(true_px, width, axis=0, mode="nearest") - true_px)[near]
    rest = rest_px[near]
    seen = np.isfinite(rest)
    corner, rest = corner[seen], rest[seen]
    depth, whole = float((corner**2).sum()), float((rest**2).sum())
    if not seen.any() or whole == 0 or np.sqrt(depth / corner.size) < LEAST_PX:
        return 0.0
    size = float((corner * rest).sum()) / depth
    explained = size**2 * depth / whole
    is_clear = explained * rest.size >= CLEAR_SDS**2 * (1.0 - explained)
    return explained if is_clear and _SIZE[0] <= size <= _SIZE[1] else 0.0

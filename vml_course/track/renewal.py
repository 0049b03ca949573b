"""When a point gets a new reference block: only when the first one has stopped to be like what is seen.

As long as the first picture serves, nothing drifts. But a thing can change its look for good (it turns out of the
plane, its light changes), and then a match that converges is still a match. When ZNCC stays low for three pictures,
well below what it was at first (noise alone keeps it low from the start, and is no reason), the block is cut anew
where it was found last. Every renewal is written into the track: from there on `drift_px` holds what it may have
added, the standard deviation of the place where the block was cut.
"""

from __future__ import annotations

import numpy as np

from vml_course.correlate.icgn import Match
from vml_course.model.arrays import FloatArray
from vml_course.track.records import FRESH_ZNCC, Past

WEAK_ZNCC = 0.8
FADED = 0.1  # of ZNCC below what it was when the reference was new
WEAK_PICTURES = 3


def notice(past: Past, found: Match) -> Past:
    """Return the past with what a match says of how well its reference still serves."""
    fresh = found.zncc if past.fresh_zncc == FRESH_ZNCC else past.fresh_zncc
    is_weak = found.zncc < min(WEAK_ZNCC, fresh - FADED)
    return past._replace(fresh_zncc=fresh, weak=past.weak + 1 if is_weak else 0)


def is_due(past: Past) -> bool:
    """Whether the point has just been seen and its reference has been weak for long enough."""
    return not past.lost and past.weak >= WEAK_PICTURES


def renewed(past: Past) -> Past:
    """Return the past of a point whose block was cut anew in its last place: what was learned of the old one is gone.

    A point at offset X of the old block was at A X; seen from the new block, which is cut where it lies, the poses
    before are A A0^-1, with A0 the newest.
    """
    back = np.linalg.inv(past.poses[0][2:].reshape(2, 2))
    poses = tuple(np.concatenate([pose[:2], (pose[2:].reshape(2, 2) @ back).ravel()]) for pose in past.poses)
    return Past(poses, steady=past.steady)


def composed(gradient_now: FloatArray, base: FloatArray) -> FloatArray:
    """Return the linear part against the first block, row by row, of that against a renewed one and its own base."""
    return np.asarray((gradient_now.reshape(2, 2) @ base.reshape(2, 2)).ravel())

"""What a lens does to a straight picture: it pushes points along the rays from the picture's middle.

Radii are in units of the half diagonal: 1 is the centre of a corner pixel. Brown's radial model with one
coefficient, r' = r (1 + k r²) (Brown 1971, Photogrammetric Engineering 37, eq. 11), up to `STRAIGHT_FROM`;
beyond, which is outside the picture, the curve goes on straight, so that it never turns back and every
point has one picture.
"""

from __future__ import annotations

import numpy as np

from vml_course.model.arrays import FloatArray

STRAIGHT_FROM = 1.3
NEWTON_STEPS = 8  # from r itself; for |k| up to 0.2 six already reach the rounding


def bent(xy: FloatArray, k: float) -> FloatArray:
    """Return where the lens shows straight points: shape (..., 2), about the middle, in half diagonals."""
    radius = np.hypot(xy[..., 0], xy[..., 1])
    near = np.minimum(radius, STRAIGHT_FROM)
    seen = near * (1 + k * near**2) + (radius - near) * _slope(STRAIGHT_FROM, k)
    return np.asarray(xy * _ratio(seen, radius)[..., None])


def straightened(xy: FloatArray, k: float) -> FloatArray:
    """Return the straight points that the lens shows somewhere: the inverse of `bent`, by Newton's method.

    The curve is convex or concave all the way, and its start lies on the side from which each step stays.
    """
    if not k:
        return xy
    radius = np.hypot(xy[..., 0], xy[..., 1])
    last = STRAIGHT_FROM * (1 + k * STRAIGHT_FROM**2)
    near = np.minimum(radius, last)
    straight = near.copy()
    for _ in range(NEWTON_STEPS):
        straight -= (straight * (1 + k * straight**2) - near) / _slope(straight, k)
    straight += (radius - near) / _slope(STRAIGHT_FROM, k)
    return np.asarray(xy * _ratio(straight, radius)[..., None])


def _slope(radius: FloatArray | float, k: float) -> FloatArray | float:
    return 1 + 3 * k * radius**2


def _ratio(new: FloatArray, old: FloatArray) -> FloatArray:
    """Return new / old; 1 in the middle, where both are nothing."""
    return np.divide(new, old, out=np.ones_like(new), where=old > 0)

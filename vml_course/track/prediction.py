"""Where a point should be in the next picture, from its own past.

A pose is six numbers: x, y (px) and the linear part row by row (xx, xy, yx, yy).
"""

from __future__ import annotations

import numpy as np

from vml_course.model.arrays import FloatArray

STEADY = 2  # pictures in a row found where expected, before the acceleration is believed


def predict(poses: tuple[FloatArray, ...], steady: int, ahead: int = 1) -> FloatArray:
    """Return the pose expected `ahead` pictures after the newest.

    Parameters
    ----------
    poses : tuple of float arrays, shape (6,)
        One to three poses of consecutive pictures, newest first.
    steady : int
        How many pictures in a row were found where they were expected. The place goes on with constant
        velocity, and with constant acceleration once the motion is steady; after an impact it is not.
    ahead : int
    """
    newest = poses[0]
    if len(poses) == 1:
        return newest
    move = newest[:2] - poses[1][:2]
    if len(poses) > 2 and steady >= STEADY and ahead == 1:
        move = 2.0 * move - (poses[1][:2] - poses[2][:2])
    before, now = poses[1][2:].reshape(2, 2), newest[2:].reshape(2, 2)
    turn = np.linalg.matrix_power(now @ np.linalg.inv(before), ahead)
    return np.concatenate([newest[:2] + ahead * move, (turn @ now).ravel()])

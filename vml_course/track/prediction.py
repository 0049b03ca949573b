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
    x, y, *now = newest.tolist()
    x1, y1, *before = poses[1].tolist()
    move_x, move_y = x - x1, y - y1
    if len(poses) > 2 and steady >= STEADY and ahead == 1:
        x2, y2 = poses[2][:2].tolist()
        move_x, move_y = 2.0 * move_x - (x1 - x2), 2.0 * move_y - (y1 - y2)
    turn = _product(now, _inverse(before))
    for _ in range(ahead):
        now = _product(turn, now)
    return np.array([x + ahead * move_x, y + ahead * move_y, *now])


# Plain numbers: numpy's linear algebra on 2 x 2 costs more than matching a block for one iteration.


def _product(a: list[float], b: list[float]) -> list[float]:
    return [
        a[0] * b[0] + a[1] * b[2],
        a[0] * b[1] + a[1] * b[3],
        a[2] * b[0] + a[3] * b[2],
        a[2] * b[1] + a[3] * b[3],
    ]


def _inverse(a: list[float]) -> list[float]:
    determinant = a[0] * a[3] - a[1] * a[2]
    return [a[3] / determinant, -a[1] / determinant, -a[2] / determinant, a[0] / determinant]

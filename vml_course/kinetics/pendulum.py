"""Kernel: the angle of a body on a fixed pivot that gravity and a constant torque turn.

    angle'' = q - p cos(angle - tilt),        p = M g c / I,   q = torque / I,

with angles counter-clockwise from +x and `tilt` the direction of the horizontal. There is no closed form; the
Taylor series of the solution has one: with c_k, s_k the coefficients of cosine and sine of the angle,

    (k+1)(k+2) a_(k+2) = q [k=0] - p c_k,   (k+1) c_(k+1) = -sum (j+1) a_(j+1) s_(k-j),   s_(k+1) alike with +c.

Sixteen terms over half a radian are good to 1e-8 rad over a whole turn. Everything broadcasts and is analytic, so
that complex steps give derivatives (see `joint.py`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

TERMS = 16
PIECE_RAD = 0.5  # the longest piece of the motion that one series serves, in natural time

Array = NDArray[Any]


def swung(s: Array, is_after: Array, start: Array, rates: tuple[Array, Array], acting: tuple[Array, ...]) -> Array:
    """Return the angle about an impact that changes the rate at once, and not the angle.

    Parameters
    ----------
    s : array, shape (k, n)
        Seconds since the impact.
    is_after : bool array, shape (n,)
        On which side a frame lies. It is told, not read off `s`: the moment may be a little off while it is fitted.
    start : array, shape (k, 1)
        Angle at s = 0, rad.
    rates : two arrays, shape (k, 1)
        Angular velocity at s = 0 before and after, rad/s.
    acting : three arrays, shape (k, 1)
        p and q of the module, 1/s^2, and the direction of the horizontal, rad.

    >>> one, time = np.ones((1, 1)), np.array([[-0.5, 0.5]])
    >>> swung(time, time[0] > 0, 0.3 * one, (one, 2 * one), (0 * one, 4 * one, 0 * one))  # the drive alone: + 2 s^2
    array([[0.3, 1.8]])
    """
    pull, drive, tilt = acting
    fastest = max(np.abs(rate).max() for rate in rates) + np.sqrt(np.abs(pull).max() + np.abs(drive).max())
    step = PIECE_RAD / max(float(fastest), 1e-9) * np.array([-1.0, 1.0])
    piece = np.floor(np.abs(s.real[0]) / step[1]).astype(int)
    # Both sides at once: the first axis of angle and rate is the side.
    angle, rate = np.broadcast_arrays((start - tilt)[None], np.stack(rates))
    result = np.empty((max(len(s), angle.shape[1]), s.shape[1]), np.result_type(s, angle, rate, *acting))
    for number in range(int(piece.max(initial=0)) + 1):
        series = _series(angle, rate, pull, drive)
        for side in (0, 1):
            here = (is_after == side) & (piece == number)
            result[:, here] = _sum(series[:, side], s[:, here] - number * step[side]) + tilt
        ahead = step[:, None, None]
        angle, rate = _sum(series, ahead), _sum(series[1:] * np.arange(1, TERMS)[:, None, None, None], ahead)
    return result


def _series(angle: Array, rate: Array, pull: Array, drive: Array) -> Array:
    """Return the Taylor coefficients of the angle, shape (TERMS, k, 1)."""
    angle, rate, pull, drive = np.broadcast_arrays(angle, rate, pull, drive)
    a = np.zeros((TERMS, *angle.shape), np.result_type(angle, rate, pull, drive))
    slope, cosine, sine = np.zeros_like(a), np.zeros_like(a), np.zeros_like(a)
    a[0], a[1], slope[0], cosine[0], sine[0] = angle, rate, rate, np.cos(angle), np.sin(angle)
    for k in range(TERMS - 2):
        a[k + 2] = (drive * (k == 0) - pull * cosine[k]) / ((k + 1) * (k + 2))
        slope[k + 1] = (k + 2) * a[k + 2]
        back = slice(k, None, -1)
        cosine[k + 1] = -(slope[: k + 1] * sine[back]).sum(axis=0) / (k + 1)
        sine[k + 1] = (slope[: k + 1] * cosine[back]).sum(axis=0) / (k + 1)
    return a


def _sum(series: Array, s: Array) -> Array:
    """Evaluate a series at times (k, n) by Horner's rule."""
    total = series[-1]
    for coefficient in series[-2::-1]:
        total = total * s + coefficient
    return np.asarray(total)

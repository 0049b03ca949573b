"""Kernel: the angle of a body on a fixed pivot that gravity and a constant torque turn.

    angle'' = q - p cos(angle - tilt),        p = M g c / I,   q = torque / I,

with angles counter-clockwise from +x and `tilt` the direction of the horizontal. There is no closed form; the
Taylor series of the solution has one: with c_k, s_k the coefficients of cosine and sine of the angle,

    (k+1)(k+2) a_(k+2) = q [k=0] - p c_k,   (k+1) c_(k+1) = -sum (j+1) a_(j+1) s_(k-j),   s_(k+1) alike with +c.

One series of sixteen terms serves as long as its last terms are small, then the next one begins (Jorba & Zou,
Experimental Mathematics 14 (2005) 99): good to 5e-9 rad over whole turns. Everything broadcasts and is analytic, so
that complex steps give derivatives (see `joint.py`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

TERMS = 16
SMALL_RAD = 1e-10  # the last terms at the end of a piece
MOST_PIECES = 1000  # a fit that goes astray ends all the same
SMALLEST = 1e-40  # of a coefficient: a body at rest has none, and one series serves it for ever

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
    away_s, begin_s = np.abs(s.real[0]), 0.0
    longest_s = float(away_s.max(initial=0.0))
    # Both sides at once: the first axis of angle and rate is the side.
    angle, rate = np.broadcast_arrays((start - tilt)[None], np.stack(rates))
    shape = max(len(s), angle.shape[1]), s.shape[1]
    result = np.full(shape, np.nan, np.result_type(s, angle, rate, *acting))
    order = np.arange(TERMS)[:, None, None, None]
    while begin_s <= longest_s:
        series = _series(angle, rate, pull, drive)
        end_s = begin_s + max(_reach_s(series), longest_s / MOST_PIECES, SMALLEST)
        for side, sign in enumerate((-1.0, 1.0)):
            here = (is_after == side) & (begin_s <= away_s) & (away_s < end_s)
            if here.any():
                result[:, here] = _sum(series[:, side], s[:, here] - sign * begin_s) + tilt
        ahead = (np.array([-1.0, 1.0]) * (end_s - begin_s))[:, None, None] ** order
        angle, rate = (series * ahead).sum(axis=0), (series[1:] * order[1:] * ahead[:-1]).sum(axis=0)
        begin_s = end_s
    return result


def _series(angle: Array, rate: Array, pull: Array, drive: Array) -> Array:
    """Return the Taylor coefficients of the angle, shape (TERMS, k, 1)."""
    angle, rate, pull, drive = np.broadcast_arrays(angle, rate, pull, drive)
    a = np.zeros((TERMS, *angle.shape), np.result_type(angle, rate, pull, drive))
    slope, turned = np.zeros_like(a), np.zeros((TERMS, 2, *angle.shape), a.dtype)  # turned: cosine, sine
    a[0], a[1], slope[0], turned[0] = angle, rate, rate, (np.cos(angle), np.sin(angle))
    for k in range(TERMS - 2):
        a[k + 2] = (drive * (k == 0) - pull * turned[k, 0]) / ((k + 1) * (k + 2))
        slope[k + 1] = (k + 2) * a[k + 2]
        both = (slope[: k + 1, None] * turned[k::-1]).sum(axis=0) / (k + 1)
        turned[k + 1, 0], turned[k + 1, 1] = -both[1], both[0]
    return a


def _reach_s(series: Array) -> float:
    """Return for how long a series holds: until one of its last two terms is no longer small."""
    last = np.abs(series[-2:]).max(axis=(1, 2, 3))
    return float(min((SMALL_RAD / np.maximum(last, SMALLEST)) ** (1.0 / np.arange(TERMS - 2, TERMS))))


def _sum(series: Array, s: Array) -> Array:
    """Evaluate a series at times (k, n) by Horner's rule."""
    total = series[-1]
    for coefficient in series[-2::-1]:
        total = total * s + coefficient
    return np.asarray(total)

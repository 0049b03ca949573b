"""How fast a video runs, and whether evenly, judged from its time stamps."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from vml_course.model.arrays import IntArray

WHOLE_RATES = [
    Fraction(rate) for rate in (24, 25, 30, 48, 50, 60, 90, 100, 120, 200, 240, 250, 300, 400, 480, 500, 600, 960, 1000)
]
TELEVISION_RATES = [rate * 1000 / 1001 for rate in WHOLE_RATES]
SLACK = 1e-6
ROUNDING_TICKS = 1.5  # stamps rounded to a tick stray by one from a straight line; the line is fitted, too


def rate_of(pts: IntArray, time_base: Fraction, declared: Fraction | None) -> tuple[Fraction, bool]:
    """Return pictures per second and whether the spacing varies beyond the container's rounding.

    Parameters
    ----------
    pts : int array, shape (n,)
        Time stamps in units of `time_base`, in order.
    declared : Fraction or None
        The header's rate; taken when the stamps agree with it, because it is not rounded.

    Returns
    -------
    rate : Fraction
        1/s; the mean when the rate varies.
    is_variable : bool
    """
    if len(pts) < 2:
        return declared or Fraction(0), False
    span = int(pts[-1] - pts[0])
    mean = Fraction(len(pts) - 1) / (span * time_base) if span else Fraction(0)
    if declared and _is_even(pts, float(1 / (declared * time_base)), 1):
        return declared, False
    if not mean:
        return declared or mean, True
    number = np.arange(len(pts), dtype=np.float64)
    slope = float(np.polyfit(number, (pts - pts[0]).astype(np.float64), 1)[0])
    if not _is_even(pts, slope, _tick(pts)):
        return mean.limit_denominator(100_000), True
    return _camera_rate(pts, time_base, 1 / (Fraction(slope) * time_base)), False


def _camera_rate(pts: IntArray, time_base: Fraction, fitted: Fraction) -> Fraction:
    """Return the usual rate that rounded stamps fit best, where they fit one, else the fitted rate.

    Over 30 pictures at 480 1/s the 1 ms of Matroska leaves 483 as the mean.
    """
    for family in (WHOLE_RATES, TELEVISION_RATES):
        spread = {rate: strays(pts, float(1 / (rate * time_base))) for rate in family}
        usual = min(spread, key=spread.__getitem__)
        if spread[usual] <= 1 + SLACK:
            return usual
    return fitted.limit_denominator(100_000)


def _is_even(pts: IntArray, step: float, tick: int) -> bool:
    """Whether stamps are those of a constant rate, rounded to `tick`: then their steps differ by one tick at most.

    (Where a step has many ticks, two roundings one after the other may make it two.)
    """
    steps = np.diff(pts)
    is_rounding = bool(np.ptp(steps) <= tick) or step >= 10 * tick
    return is_rounding and strays(pts, step) <= ROUNDING_TICKS * tick


def strays(pts: IntArray, step: float) -> float:
    """Return the spread (largest less smallest) of the stamps about a line of that step, in ticks.

    >>> strays(np.array([0, 2, 4, 6, 8]), 2)
    0.0
    >>> strays(np.array([0, 2, 4, 6, 10]), 2)
    2.0
    """
    offset = (pts - pts[0]).astype(np.float64) - np.arange(len(pts)) * step
    return float(np.ptp(offset))


def _tick(pts: IntArray) -> int:
    """Return the grid on which the stamps lie: coarser than the time base after a detour by mkv (1 ms).

    A grid as coarse as the spacing itself says nothing about rounding: a dropped picture would hide in it.
    """
    steps = np.diff(pts)
    grid = int(np.gcd.reduce(steps))
    return grid if np.median(steps) >= 2 * grid else 1

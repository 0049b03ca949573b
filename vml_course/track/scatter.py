"""Sigma that a whole clip vouches for: what a block's own residual cannot see, its scatter in time shows.

A codec shifts whole blocks by fractions of a pixel, picture by picture, and one picture cannot tell that from
movement. The way of a point through five pictures is a cubic to well below that, so their fourth differences hold
nothing but scatter: 70 times its variance. Their size is found for each point and each stretch between two hits;
the stretches are those that make the differences likeliest (a hit is a difference like no other).

Half of a match's variance comes from its picture, half from the reference, and the latter shifts all pictures
alike, so that it does not scatter. The scatter therefore takes the place of the first half only, where it is larger.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.track import Track

FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
LEAST = 6  # differences of a stretch that can vouch for anything
GAIN = 40.0  # of twice the log-likelihood, that makes two stretches of one (neighbouring differences are alike)
SMALLEST_PX = 2e-4  # scatter: whole grey levels and stopping the iterations leave as much
LEAST_SIGMA_PX = 1e-3  # a codec that copies a block leaves no residual at all


def vouched(track: Track) -> Track:
    """Return the track with sigmas that cover its scatter in time as well; places stay as they are."""
    sigma = np.array(track.sigma_px)
    for k in range(len(track.points)):
        scatter = scatter_px(track.xy_px[:, k])
        half = 0.5 * sigma[:, k] ** 2
        sigma[:, k] = np.sqrt(half + np.fmax(half, scatter**2))
    return replace(track, sigma_px=np.maximum(sigma, LEAST_SIGMA_PX))


def scatter_px(xy_px: FloatArray) -> FloatArray:
    """Return the standard deviation of a coordinate from picture to picture, NaN where it cannot be told.

    Parameters
    ----------
    xy_px : float array, shape (n, 2)
        Places in consecutive pictures, NaN where lost.

    Returns
    -------
    float array, shape (n,)
    """
    scatter = np.full(len(xy_px), np.nan)
    if len(xy_px) < len(FOURTH):
        return scatter
    four = np.stack([np.convolve(xy_px[:, c], FOURTH, mode="valid") for c in (0, 1)], axis=1) / np.sqrt(70.0)
    for start, end in stretches(four, 0, len(xy_px)):
        found = _inside(four, start, end)
        if len(found) >= LEAST:
            robust = float(np.median(np.abs(found))) / 0.6745
            scatter[start:end] = robust * np.sqrt(1.0 + 2.0 / len(found))
    return scatter


def stretches(four: FloatArray, start: int, end: int) -> list[tuple[int, int]]:
    """Return first and last + 1 of the pictures of each stretch, from fourth differences, shape (n - 4, 2)."""
    together = _inside(four, start, end)
    best, where = _cost(together), None
    for cut in range(start + LEAST + 4, end - LEAST - 3):
        parts = _inside(four, start, cut), _inside(four, cut, end)
        # the differences across the cut hold the hit: they count like the others of both sides
        share = len(together) / max(sum(len(part) for part in parts), 1)
        cost = share * sum(_cost(part) for part in parts) + GAIN
        if cost < best:
            best, where = cost, cut
    if where is None:
        return [(start, end)]
    return stretches(four, start, where) + stretches(four, where, end)


def _inside(four: FloatArray, start: int, end: int) -> FloatArray:
    part = four[start : max(start, end - 4)]
    return np.asarray(part[np.isfinite(part[:, 0])])


def _cost(found: FloatArray) -> float:
    """Return twice the negative log-likelihood of differences of one size, but for a constant."""
    if not len(found):
        return 0.0
    return 2.0 * len(found) * float(np.log(np.mean(found**2) + SMALLEST_PX**2))

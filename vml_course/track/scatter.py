"""Sigma that a whole clip vouches for: what a block's own residual cannot see, its scatter in time shows.

A codec shifts whole blocks by fractions of a pixel, picture by picture, and one picture cannot tell that from
movement. The way of a point through five pictures is a cubic to well below that, so their fourth differences hold
nothing but scatter: 70 times its variance. Where a codec's shifts last for several pictures, pictures further apart
show more of it; they count as long as their differences look like noise. The size is found for each point and each
stretch between two hits; the stretches are those that make the differences likeliest (a hit is a difference like no
other).

Half of a match's variance comes from its picture, half from the reference, and the latter shifts all pictures
alike, so that it does not scatter. The scatter therefore takes the place of the first half only, where it is larger
by more than so few pictures may have it by chance.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.track import Track

FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
LEAST = 6  # differences of a stretch that can vouch for anything
GAIN = 40.0  # of twice the log-likelihood, that makes two stretches of one (neighbouring differences are alike)
EXCESS = 1.25  # a robust standard deviation of 12 differences, two coordinates each, is 0.2 sure
STRIDES = (1, 2, 3, 4)  # pictures: a codec that copies most of a block shifts it for several pictures alike
NOISE_ALTERNATES = -0.6
SMALLEST_PX = 2e-4  # scatter: whole grey levels and stopping the iterations leave as much
LEAST_SIGMA_PX = 1e-3  # a codec that copies a block leaves no residual at all


def vouched(track: Track) -> Track:
    """Return the track with sigmas that cover its scatter in time as well; places stay as they are."""
    sigma = np.array(track.sigma_px)
    for k in range(len(track.points)):
        scatter = scatter_px(track.xy_px[:, k])
        half = 0.5 * sigma[:, k] ** 2
        sigma[:, k] = np.sqrt(half + np.where(scatter > EXCESS * np.sqrt(half), scatter**2, half))
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
    for start, end in stretches(fourth_differences(xy_px), 0, len(xy_px)):
        scatter[start:end] = _scatter_of(xy_px[start:end])
    return scatter


def fourth_differences(xy_px: FloatArray, stride: int = 1) -> FloatArray:
    """Return fourth differences of pictures `stride` apart, shape (n - 4 stride, 2); white noise keeps its size."""
    taps = np.zeros(4 * stride + 1)
    taps[::stride] = FOURTH
    four = np.stack([np.convolve(xy_px[:, c], taps, mode="valid") for c in (0, 1)], axis=1)
    return np.asarray(four / np.sqrt(70.0))


def _scatter_of(xy_px: FloatArray) -> float:
    """Return the scatter within one stretch; NaN when there are too few differences."""
    best = float("nan")
    for stride in STRIDES:
        if len(xy_px) < 4 * stride + LEAST:
            break
        four = fourth_differences(xy_px, stride)
        found = four[np.isfinite(four[:, 0])]
        if len(found) < LEAST or (stride > 1 and not alternate(four, stride)):
            continue
        robust = float(np.median(np.abs(found))) / 0.6745 * float(np.sqrt(1.0 + 2.0 / len(found)))
        if stride == 1 or not robust <= EXCESS * best:
            best = robust
    return best


def alternate(four: FloatArray, stride: int) -> bool:
    """Whether fourth differences are those of noise, not of the motion: one after the other they change sign.

    Those of white noise have a correlation of -56 / 70 one stride apart, those of a smooth way one near 1.
    """
    one, other = four[stride:], four[:-stride]
    both = np.isfinite(one[:, 0]) & np.isfinite(other[:, 0])
    size = float(np.sqrt((one[both] ** 2).sum() * (other[both] ** 2).sum()))
    return size > 0.0 and float((one[both] * other[both]).sum()) / size < NOISE_ALTERNATES


def stretches(four: FloatArray, start: int, end: int) -> list[tuple[int, int]]:
    """Return first and last + 1 of the pictures of each stretch, from fourth differences, shape (n - 4, 2)."""
    return _split(_Sums.of(four), start, end)


class _Sums(NamedTuple):
    """Running sums over the first k differences, shape (n - 3,): how many there are, and their squares."""

    number: FloatArray
    squares: FloatArray

    @classmethod
    def of(cls, four: FloatArray) -> _Sums:
        rows = (four**2).sum(axis=1)
        found = np.isfinite(rows)
        ahead = np.zeros(1)
        return cls(
            np.concatenate([ahead, np.cumsum(found)]), np.concatenate([ahead, np.cumsum(np.where(found, rows, 0.0))])
        )

    def cost(self, start: IntArray | int, end: IntArray | int) -> tuple[FloatArray, FloatArray]:
        """Return twice the negative log-likelihood of stretches, but for a constant, and the number of differences."""
        last = np.maximum(start, np.asarray(end) - (len(FOURTH) - 1))
        count = self.number[last] - self.number[start]
        mean = (self.squares[last] - self.squares[start]) / np.maximum(2.0 * count, 1.0)
        return 2.0 * count * np.log(np.maximum(mean, 0.0) + SMALLEST_PX**2), count


def _split(sums: _Sums, start: int, end: int) -> list[tuple[int, int]]:
    cuts = np.arange(start + LEAST + 4, end - LEAST - 3)
    if not len(cuts):
        return [(start, end)]
    together, count = sums.cost(start, end)
    before, after = sums.cost(start, cuts), sums.cost(cuts, end)
    # the differences across a cut hold the hit: they count like the others of both sides
    share = count / np.maximum(before[1] + after[1], 1.0)
    costs = share * (before[0] + after[0]) + GAIN
    best = int(np.argmin(costs))
    if not costs[best] < together:
        return [(start, end)]
    return _split(sums, start, int(cuts[best])) + _split(sums, int(cuts[best]), end)

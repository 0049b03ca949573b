"""What residuals tell of the errors: how large, how alike from frame to frame, and how much of them is pixel locking.

A tracker's bias repeats with the sub-pixel place, A sin(2 pi x + phase), x in pixels, with a phase of each point and
axis. A point that crosses pixels shows it as scatter; of one that hangs still it is one offset that no residual
shows. With the phase unknown it is c sin(2 pi x) + d cos(2 pi x), c and d of variance A^2 / 2: two columns W of known
shape, so that its effect on the unknowns follows exactly however far a point moves, and the points that move tell A
for those that do not (variance components: Rao, J. Multivariate Analysis 1 (1971) 257).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray, IntArray

LEAST_LOCKING_PX = 0.02  # amplitude that is allowed for unseen: the usual one of a fitted parabola; DIC has a tenth
MOST_ALIKE = 0.95  # correlation of neighbours: more is no noise
LEAST_SHARE = 0.1  # of the scatter is noise, whatever the waves explain


@dataclass(frozen=True, eq=False, slots=True)
class Scatter:
    """Variances of the errors behind some residuals.

    Attributes
    ----------
    noise : float
        Variance of what is left without locking, in units of sigma^2.
    lag1 : float
        Correlation of its neighbours in time.
    locking_px2 : float
        A^2 / 2 of the locking as it was seen; 0 where none was.
    """

    noise: float
    lag1: float
    locking_px2: float

    @property
    def widened(self) -> float:
        """The noise's variance times (1 + rho) / (1 - rho): what a mean over many frames has."""
        return self.noise * (1.0 + self.lag1) / (1.0 - self.lag1)

    @property
    def allowed_px2(self) -> float:
        """A^2 / 2 that is allowed for: as seen, but no less than is usual."""
        return max(self.locking_px2, 0.5 * LEAST_LOCKING_PX**2)


def waves(place_m: FloatArray, sigma_m: FloatArray, pixel_m: float) -> FloatArray:
    """Return the two columns of a coordinate's locking, shape (n, 2), for 1 px of amplitude, in units of sigma."""
    phase = 2.0 * math.pi * place_m / pixel_m
    return np.stack([np.sin(phase), np.cos(phase)], axis=1) * (pixel_m / sigma_m)[:, None]


def scatter_of(
    residual: FloatArray, left: FloatArray, wave: FloatArray, freedom: int, series: Sequence[IntArray]
) -> Scatter:
    """Return the variances that explain the residuals of a fit.

    With R what the fit leaves of an error, and M = W^T R W, the residuals r = R (noise + W c) have

        E[r^T r] = s^2 freedom + h tr M,     E[|W^T r|^2] = s^2 tr M + h |M|^2.

    Parameters
    ----------
    residual : float array, shape (n,)
        In units of sigma.
    left : float array, shape (n, k)
        R W.
    wave : float array, shape (n, k)
        W; k = 0 where the size of a pixel is not known.
    freedom : int
        n less the number of unknowns.
    series : sequence of int array
        Rows that follow one another in time.
    """
    total = float(residual @ residual)
    if not wave.shape[1]:
        return Scatter(total / freedom, lag1_correlation(residual, series), 0.0)
    inner, told = wave.T @ left, wave.T @ residual
    trace, square = float(np.trace(inner)), float(np.sum(inner**2))
    apart = freedom * square - trace**2
    seen = max((freedom * float(told @ told) - trace * total) / apart, 0.0) if apart > 1e-9 * freedom * square else 0.0
    noise = max(total - seen * trace, LEAST_SHARE * total) / freedom
    if seen > 0:
        # The likely bias (a mean over what c may be) is taken off, or it would pass for noise that is alike.
        residual = residual - left @ np.linalg.solve(inner + noise / seen * np.eye(len(inner)), told)
    return Scatter(noise, lag1_correlation(residual, series), seen)


def lag1_correlation(residual: FloatArray, series: Sequence[IntArray]) -> float:
    """Return the mean correlation of residuals of neighbouring frames, not below 0.

    Fitting about a line to each series of n frames pulls the estimate r down by (2 + 4 r) / n (Kendall's bias with a
    trend), which is put back.
    """
    parts = [residual[rows] for rows in series]
    pairs = sum(float(part[1:] @ part[:-1]) / max(len(part) - 1, 1) for part in parts)
    squares = sum(float(part @ part) / len(part) for part in parts)
    frames = float(np.mean([len(part) for part in parts]))
    raw = pairs / squares if squares > 0 else 0.0
    return float(np.clip((frames * raw + 2.0) / max(frames - 4.0, 1.0), 0.0, MOST_ALIKE))

"""The noise of a tracking table: what is left when the true path and everything slow has been taken off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from assignments.model import AnswerKey
from grader.trajectory import TrajectoryFit
from vml_course.model.arrays import FloatArray

CORRELATED = 0.4
"""A copy with jitter twice as large as the noise of the points still has this."""

LEAST_FRAMES = 8  # each side of the impact
_SLOW = 3  # degree of the polynomial that is taken off each side: calibration, lag, lens


@dataclass(frozen=True, eq=False)
class Residual:
    """Noise by frame of the video that a table follows.

    Attributes
    ----------
    frame : int array, shape (n,)
    points : tuple of str
    noise_px : float array, shape (n, p, 2)
        NaN where nothing is known.
    """

    frame: FloatArray
    points: tuple[str, ...]
    noise_px: FloatArray


def residual_of(fit: TrajectoryFit, key: AnswerKey) -> Residual | None:
    """Return the noise of a table; None where too little of it lies on either side of the impact."""
    noise_px = (fit.own_m - fit.true_m) * key.truth["px_per_m"]
    frame = np.rint(fit.frame - fit.lag_frames)
    seen = np.isfinite(noise_px).all(axis=(1, 2))
    before = frame <= key.truth.get("frame_before", np.inf)
    result = np.full_like(noise_px, np.nan)
    for side in (seen & before, seen & ~before):
        if side.sum() >= LEAST_FRAMES:
            result[side] = _quick(frame[side], noise_px[side])
    if not np.isfinite(result).any():
        return None
    return Residual(frame, fit.points, result)


def _quick(frame: FloatArray, noise_px: FloatArray) -> FloatArray:
    """Return what a polynomial in time leaves over."""
    t = (frame - frame.mean()) / max(float(np.ptp(frame)), 1.0)
    powers = np.vander(t, _SLOW + 1)
    flat = noise_px.reshape(len(frame), -1)
    return np.asarray((flat - powers @ np.linalg.lstsq(powers, flat, rcond=None)[0]).reshape(noise_px.shape))


def correlations(residuals: Sequence[Residual]) -> tuple[FloatArray, FloatArray]:
    """Return the correlation of every pair, and from how many independent numbers it comes, shape (k, k) both."""
    if not residuals:
        return np.zeros((0, 0)), np.zeros((0, 0))
    noise = _by_frame(residuals)
    flat = noise.reshape(len(residuals), -1)
    seen = np.isfinite(flat)
    values, known = np.where(seen, flat, 0.0), seen.astype(float)
    with np.errstate(invalid="ignore", divide="ignore"):
        power = (values**2) @ known.T  # of one, where the other is known
        rho = (values @ values.T) / np.sqrt(power * power.T)
    free = np.sqrt(np.outer(*(2 * [_independent(noise)])))
    return np.nan_to_num(rho), (known @ known.T) * free


def _by_frame(residuals: Sequence[Residual]) -> FloatArray:
    """Return all noise in one array, shape (k, frames, points, 2)."""
    names = sorted({point for one in residuals for point in one.points})
    last = max(int(one.frame.max()) for one in residuals)
    noise = np.full((len(residuals), last + 1, len(names), 2), np.nan)
    for number, one in enumerate(residuals):
        kept = one.frame >= 0
        for column, point in enumerate(one.points):
            noise[number, one.frame[kept].astype(int), names.index(point)] = one.noise_px[kept, column]
    return noise


def _independent(noise: FloatArray) -> FloatArray:
    """Return which part of each table's numbers is independent: smooth tables have few."""
    now, then = noise[:, 1:], noise[:, :-1]
    both = np.isfinite(now) & np.isfinite(then)
    product = np.where(both, now * then, 0.0).sum(axis=(1, 2, 3))
    power = np.where(both, (now**2 + then**2) / 2, 0.0).sum(axis=(1, 2, 3))
    alike = np.clip(product / np.where(power > 0, power, np.inf), 0.0, 0.99)
    return np.asarray((1 - alike**2) / (1 + alike**2))

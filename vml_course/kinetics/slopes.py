"""Methods that differentiate one piece of a path: from positions to velocity, acceleration and their errors.

All take time (n,), path (n, d) without NaN, sigma (n,) of a coordinate (NaN where unknown) and a half-width in frames,
and know nothing of impacts: `differentiate.py` cuts the path there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.signal import savgol_coeffs

from vml_course.model.arrays import FloatArray, IntArray

Slopes = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
Method = Callable[[FloatArray, FloatArray, FloatArray, int], Slopes]
EVEN = 0.05  # of a step: as even as frames of a camera are


def local_quadratic(time_s: FloatArray, path: FloatArray, sigma: FloatArray, half_width: int) -> Slopes:
    """Fit a parabola about each frame of one piece and read its derivatives there.

    Parameters
    ----------
    time_s, path, sigma : float array, shape (n,), (n, d), (n,)
        One piece without NaN positions. Where sigma is unknown the scatter about the parabola serves.
    half_width : int
        The window holds 2 half_width + 1 frames: one-sided at the ends of the piece.

    Returns
    -------
    velocity, acceleration : float array, shape (n, d)
    velocity_sd, acceleration_sd : float array, shape (n,)
        Of one component: with weights c of the linear estimate, the root of sum(c^2 sigma^2).
    """
    n, width = len(time_s), 2 * half_width + 1
    slopes, errors = np.full((n, 2, path.shape[1]), np.nan), np.full((n, 2), np.nan)
    for i in range(n) if n >= 3 else ():
        start = min(max(i - half_width, 0), max(n - width, 0))
        near = slice(start, start + width)
        t = time_s[near] - time_s[i]
        weights = np.linalg.pinv(np.stack([np.ones_like(t), t, 0.5 * t**2], axis=1))
        slopes[i] = weights[1:] @ path[near]
        errors[i] = np.sqrt(weights[1:] ** 2 @ _variance(t, path[near], sigma[near]))
    return slopes[:, 0], slopes[:, 1], errors[:, 0], errors[:, 1]


def _variance(t: FloatArray, path: FloatArray, sigma: FloatArray) -> FloatArray:
    """Return each frame's variance of a coordinate: of the tracker, else from the scatter."""
    if np.isfinite(sigma).all():
        return np.asarray(sigma**2)
    basis = np.stack([np.ones_like(t), t, t**2], axis=1)
    rest = path - basis @ np.linalg.lstsq(basis, path, rcond=None)[0]
    freedom = path.shape[1] * (len(t) - 3)
    return np.full(len(t), float(np.sum(rest**2)) / freedom if freedom else np.nan)


def central(time_s: FloatArray, path: FloatArray, sigma: FloatArray, half_width: int) -> Slopes:  # noqa: ARG001
    """Take central differences over one frame each side; the ends of a piece have none.

    v = (x[i+1] - x[i-1]) / (t[i+1] - t[i-1]), a = difference of the two one-step velocities.
    """
    n = len(time_s)
    slopes, errors = np.full((n, 2, path.shape[1]), np.nan), np.full((n, 2), np.nan)
    if n >= 3:
        left, right = np.diff(time_s)[:-1], np.diff(time_s)[1:]
        steps = np.diff(path, axis=0) / np.diff(time_s)[:, None]
        variance, whole = sigma**2, left + right
        slopes[1:-1, 0] = (path[2:] - path[:-2]) / whole[:, None]
        slopes[1:-1, 1] = 2.0 * np.diff(steps, axis=0) / whole[:, None]
        errors[1:-1, 0] = np.sqrt(variance[2:] + variance[:-2]) / whole
        outer = variance[2:] / right**2 + variance[:-2] / left**2
        errors[1:-1, 1] = 2.0 / whole * np.sqrt(outer + variance[1:-1] * (1 / left + 1 / right) ** 2)
    return slopes[:, 0], slopes[:, 1], errors[:, 0], errors[:, 1]


def savitzky_golay(time_s: FloatArray, path: FloatArray, sigma: FloatArray, half_width: int) -> Slopes:
    """Fit a cubic about each frame of an evenly spaced run (Savitzky & Golay 1964); one-sided at its ends.

    A run ends where frames are missing. Runs shorter than the window take a shorter one; below 5 frames there is none.
    """
    whole = _nothing(path)
    for run in _even_runs(time_s):
        width = min(2 * half_width + 1, len(run) - (1 - len(run) % 2))
        if width < 5:
            continue
        step = float(np.mean(np.diff(time_s[run])))
        for k, i in enumerate(run):
            start = min(max(k - width // 2, 0), len(run) - width)
            near = run[start : start + width]
            for order in (1, 2):
                weights = savgol_coeffs(width, 3, deriv=order, delta=step, pos=k - start, use="dot")
                whole[order - 1][i] = weights @ path[near]
                whole[order + 1][i] = np.sqrt(weights**2 @ _variance(time_s[near], path[near], sigma[near]))
    return whole


def tracker(time_s: FloatArray, path: FloatArray, sigma: FloatArray, half_width: int) -> Slopes:  # noqa: ARG001
    """Take the formulas of the program Tracker (Open Source Physics); a missing neighbour gives NaN.

    v = (x[i+1] - x[i-1]) / (t[i+1] - t[i-1]),
    a = (2 x[i-2] - x[i-1] - 2 x[i] - x[i+1] + 2 x[i+2]) / (7 dt^2) with dt = (t[i+2] - t[i-2]) / 4,

    the second being the curvature of a parabola through five points. Tracker knows no impacts: without `contacts` its
    numbers are found again, next to an impact too, where they are wrong.
    """
    whole, weights = _nothing(path), np.array([2.0, -1.0, -2.0, -1.0, 2.0]) / 7.0
    for run in _even_runs(time_s):
        for k in range(1, len(run) - 1):
            i, (left, right) = run[k], run[[k - 1, k + 1]]
            wide = time_s[right] - time_s[left]
            whole[0][i], whole[2][i] = (path[right] - path[left]) / wide, np.hypot(sigma[left], sigma[right]) / wide
        for k in range(2, len(run) - 2):
            near = run[k - 2 : k + 3]
            step = (time_s[near[4]] - time_s[near[0]]) / 4.0
            whole[1][run[k]] = weights @ path[near] / step**2
            whole[3][run[k]] = np.sqrt(weights**2 @ sigma[near] ** 2) / step**2
    return whole


def _nothing(path: FloatArray) -> Slopes:
    n = len(path)
    return np.full(path.shape, np.nan), np.full(path.shape, np.nan), np.full(n, np.nan), np.full(n, np.nan)


def _even_runs(time_s: FloatArray) -> list[IntArray]:
    """Return the indices of runs without a missing frame."""
    if len(time_s) < 2:
        return []
    steps = np.diff(time_s)
    breaks = np.flatnonzero(np.abs(steps / np.median(steps) - 1.0) > EVEN) + 1
    return [run for run in np.split(np.arange(len(time_s)), breaks) if len(run) > 1]

"""A Kalman filter run forwards and a smoother run backwards (Rauch and others, AIAA Journal 3, 1965).

The body's acceleration is taken to wander: d^3x/dt^3 is white noise of density q, which is chosen so that the data are
most likely. So there is no window; where motion is calm the whole record helps. Its standard errors hold both noise and
what may have been smoothed away, so they are wider than the scatter of repeated noise.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vml_course.kinetics.slopes import Slopes
from vml_course.model.arrays import FloatArray

DENSITIES = np.logspace(-4.0, 6.0, 21)  # in units of the path's own size and duration
LEAST = 5


class _Steps(NamedTuple):
    """Predicted and filtered states (n, 3, d), covariances and transitions (n, 3, 3), and -2 log likelihood."""

    predicted: FloatArray
    filtered: FloatArray
    predicted_cov: FloatArray
    filtered_cov: FloatArray
    moves: FloatArray
    misfit: float


def rts(time_s: FloatArray, path: FloatArray, sigma: FloatArray, half_width: int) -> Slopes:  # noqa: ARG001
    """Smooth one piece; see `slopes.py` for what goes in and comes out.

    Where sigma is unknown it is taken from the third differences of the path, in which motion hardly shows.
    """
    n, d = path.shape
    if n < LEAST:
        return np.full((n, d), np.nan), np.full((n, d), np.nan), np.full(n, np.nan), np.full(n, np.nan)
    noise = sigma if np.isfinite(sigma).all() and (sigma > 0).all() else np.full(n, _noise(path))
    duration = float(np.ptp(time_s))
    unit = float(np.median(noise)) ** 2 / duration**5
    tries = [_forwards(time_s, path, noise, float(density) * unit * 1e3) for density in DENSITIES]
    states, covariances = _backwards(min(tries, key=lambda steps: steps.misfit))
    sds = np.sqrt(np.maximum(covariances[:, [1, 2], [1, 2]], 0.0))
    return states[:, 1], states[:, 2], sds[:, 0], sds[:, 1]


def _noise(path: FloatArray) -> float:
    """Return a coordinate's standard deviation: third differences of white noise have 20 times its variance."""
    floor = 1e-9 * float(np.ptp(path, axis=0).max()) + 1e-15
    return max(float(np.sqrt(np.mean(np.diff(path, 3, axis=0) ** 2) / 20.0)), floor)


def _forwards(time_s: FloatArray, path: FloatArray, noise: FloatArray, density: float) -> _Steps:
    n, d = path.shape
    predicted, filtered, moves = np.zeros((n, 3, d)), np.zeros((n, 3, d)), np.zeros((n, 3, 3))
    predicted_cov, filtered_cov, misfit = np.zeros((n, 3, 3)), np.zeros((n, 3, 3)), 0.0
    # A start that says nothing: far wider than the record's own place, velocity and acceleration.
    size, duration = float(np.ptp(path, axis=0).max()) + 1e3 * float(noise.max()), float(np.ptp(time_s))
    state = np.zeros((3, d))
    state[0] = path[0]
    covariance = np.diag((1e3 * size / np.array([1.0, duration, duration**2])) ** 2)
    for i in range(n):
        if i:
            moves[i], wander = _transition(float(time_s[i] - time_s[i - 1]), density)
            state, covariance = moves[i] @ state, moves[i] @ covariance @ moves[i].T + wander
        predicted[i], predicted_cov[i] = state, covariance
        spread, off = covariance[0, 0] + noise[i] ** 2, path[i] - state[0]
        gain = covariance[:, 0] / spread
        state = state + np.outer(gain, off)
        keep = np.eye(3) - np.outer(gain, [1.0, 0.0, 0.0])
        covariance = keep @ covariance @ keep.T + noise[i] ** 2 * np.outer(gain, gain)  # Joseph's form stays positive
        filtered[i], filtered_cov[i] = state, covariance
        if i >= 3:  # the first three only find the start
            misfit += float(d * np.log(spread) + off @ off / spread)
    return _Steps(predicted, filtered, predicted_cov, filtered_cov, moves, misfit)


def _transition(step_s: float, density: float) -> tuple[FloatArray, FloatArray]:
    """Return how a state (x, v, a) moves in one step, and the covariance that white jerk adds."""
    h = step_s
    move = np.array([[1.0, h, h**2 / 2], [0.0, 1.0, h], [0.0, 0.0, 1.0]])
    wander = np.array([
        [h**5 / 20, h**4 / 8, h**3 / 6], [h**4 / 8, h**3 / 3, h**2 / 2], [h**3 / 6, h**2 / 2, h],
    ])  # fmt: skip
    return move, density * wander


def _backwards(steps: _Steps) -> tuple[FloatArray, FloatArray]:
    states, covariances = steps.filtered.copy(), steps.filtered_cov.copy()
    for i in range(len(states) - 2, -1, -1):
        gain = np.linalg.solve(steps.predicted_cov[i + 1], steps.moves[i + 1] @ steps.filtered_cov[i]).T
        states[i] += gain @ (states[i + 1] - steps.predicted[i + 1])
        covariances[i] += gain @ (covariances[i + 1] - steps.predicted_cov[i + 1]) @ gain.T
    return states, covariances

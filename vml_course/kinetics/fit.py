"""Least squares of the swing kernel, and how sure the result is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from vml_course.kinetics import swing
from vml_course.kinetics.arc import centre_at_distance, fit_arc
from vml_course.kinetics.straight import fit_line
from vml_course.kinetics.swing import Seen, SwingData
from vml_course.model.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class SwingFit:
    """Result of the least squares.

    Attributes
    ----------
    x : float array, shape (k,)
        The estimated unknowns, in the order of `data.unknowns`.
    covariance : float array, shape (k, k)
        (J^T J)^-1 s^2, inflated by (1 + rho) / (1 - rho) for residuals that are alike from frame to frame.
    residual : float array, shape (rows,)
        In units of sigma; the last one is that of the length.
    lag1 : float
        Mean lag-1 correlation rho of the residuals.
    length_slope : float array, shape (k,)
        How the unknowns follow a change of the given length.
    """

    data: SwingData
    x: FloatArray
    covariance: FloatArray
    residual: FloatArray
    lag1: float
    length_slope: FloatArray

    @property
    def unknowns(self) -> FloatArray:
        """All unknowns of the kernel, zeros for those not estimated."""
        return swing.full(self.x, self.data.unknowns)

    @property
    def residual_rms_m(self) -> float:
        """Root mean square of the residuals, in metres."""
        foot, ball = self.data.foot, self.data.ball
        sigma = np.concatenate([np.tile(foot.sigma_m, 2), np.tile(ball.sigma_m, 2)])
        return float(np.sqrt(np.mean((self.residual[: len(sigma)] * sigma) ** 2)))


def fit_swing(data: SwingData) -> SwingFit:
    """Fit the kernel to a foot and a ball by weighted least squares (Levenberg-Marquardt)."""
    found = least_squares(
        swing.residuals, _start(data), jac=swing.jacobian, method="lm", x_scale="jac", args=(data,),
        xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=200,
    )  # fmt: skip
    x = np.asarray(found.x, dtype=np.float64)
    slopes, residual = swing.jacobian(x, data), swing.residuals(x, data)
    scale = np.sqrt(np.sum(slopes**2, axis=0))
    inverse = np.linalg.pinv(slopes / scale, rcond=1e-12)
    lag1 = lag1_correlation(residual, data)
    variance = residual @ residual / max(len(residual) - len(x), 1) * (1.0 + lag1) / (1.0 - lag1)
    return SwingFit(
        data=data,
        x=x,
        covariance=variance * (inverse @ inverse.T) / np.outer(scale, scale),
        residual=residual,
        lag1=lag1,
        length_slope=-(inverse @ swing.length_slope(x, data)) / scale,
    )


def _start(data: SwingData) -> FloatArray:
    """Return a first guess: pivot from the foot's arc, rates and velocities from straight lines."""
    foot, ball = data.foot, data.ball
    pivot = centre_at_distance(foot.xy_m, fit_arc(foot.xy_m), data.length_m)
    order = np.argsort(foot.time_s)
    angle = np.empty(len(order))
    angle[order] = np.unwrap(np.arctan2(*(foot.xy_m - pivot)[order].T[::-1]))
    leg = [fit_line(foot.time_s[side], angle[side, None]) for side in (~foot.is_after, foot.is_after)]
    path = [fit_line(ball.time_s[side], ball.xy_m[side]) for side in (~ball.is_after, ball.is_after)]
    whole = np.zeros(len(swing.UNKNOWNS))
    whole[swing.K : swing.K + 2], whole[swing.R] = pivot, data.length_m
    whole[[swing.THETA, swing.W1, swing.W2]] = leg[0].position(0.0)[0], leg[0].slope[0], leg[1].slope[0]
    whole[swing.B : swing.B + 2] = path[0].position(0.0)
    whole[swing.V1 : swing.V1 + 2], whole[swing.V2 : swing.V2 + 2] = path[0].slope, path[1].slope
    return whole[list(data.unknowns)]


def lag1_correlation(residual: FloatArray, data: SwingData) -> float:
    """Return the mean correlation of residuals of neighbouring frames, not below 0.

    Each coordinate of each point on each side is one series of n frames. Fitting about a line to each
    pulls the estimate r down by (2 + 4 r) / n (Kendall's bias with a trend), which is put back.
    """
    pairs, squares, start = 0.0, 0.0, 0
    frames = float(np.mean([split_seen(seen) for seen in (data.foot, data.ball)]))
    for seen in (data.foot, data.ball):
        for _ in range(2):
            series = residual[start : start + len(seen.time_s)]
            start += len(seen.time_s)
            for side in (~seen.is_after, seen.is_after):
                part = series[side]
                pairs += float(part[1:] @ part[:-1]) / max(len(part) - 1, 1)
                squares += float(part @ part) / max(len(part), 1)
    raw = pairs / squares if squares > 0 else 0.0
    return float(np.clip((frames * raw + 2.0) / max(frames - 4.0, 1.0), 0.0, 0.95))


Outcome = Callable[[FloatArray, float], FloatArray]


def outcome_slopes(outcome: Outcome, fit: SwingFit) -> tuple[FloatArray, FloatArray]:
    """Return derivatives of derived quantities: by the unknowns, shape (o, k), and by the length, (o,).

    The second is total: the unknowns follow the length.
    """
    data = fit.data

    def at(x: FloatArray, length_m: float) -> FloatArray:
        return outcome(swing.full(x, data.unknowns), length_m)

    steps = np.maximum(1e-2 * np.sqrt(np.diag(fit.covariance)), 1e-7 * np.maximum(np.abs(fit.x), 1e-2))
    columns = []
    for j, step in enumerate(steps):
        aside = np.zeros_like(fit.x)
        aside[j] = step
        columns.append((at(fit.x + aside, data.length_m) - at(fit.x - aside, data.length_m)) / (2 * step))
    slopes, change = np.stack(columns, axis=1), 1e-6 * data.length_m
    direct = (at(fit.x, data.length_m + change) - at(fit.x, data.length_m - change)) / (2 * change)
    return slopes, direct + slopes @ fit.length_slope


def split_seen(seen: Seen) -> tuple[int, int]:
    """Return how many frames lie before and after the impact."""
    return int(np.sum(~seen.is_after)), int(np.sum(seen.is_after))

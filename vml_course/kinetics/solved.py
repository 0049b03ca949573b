"""From a fit to a solution: every quantity with its uncertainty, and the figures that all models report."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vml_course.kinetics.clear_frames import ClearFrames
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.joint import Derived, Fit, Outcome
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion
from vml_course.model.solution import Estimate, ImpactSolution

UNITS_OF: Mapping[str, str] = {
    "I": "kg m^2", "M": "kg", "omega1": "rad/s", "omega2": "rad/s", "v1": "m/s", "v_f1": "m/s", "v_f2": "m/s",
    "v_b1": "m/s", "v_b2": "m/s", "v_t1": "m/s", "v_t2": "m/s", "J": "N s", "t_impact": "s", "loss": "J", "a": "m",
    "theta_max": "rad",
    **dict.fromkeys(("v_a1", "v_a2", "v_g1", "v_g2"), "m/s"),
    **{f"v_{body}{side}{axis}": "m/s" for body in "ab" for side in "12" for axis in "xy"},
}  # fmt: skip
FLOOR = {"e": 0.003, "I": 0.005, "M": 0.005, "mu": 0.005, "v1": 0.003}  # relative: a real measurement's own faults
DOUBT_SD = 3.0


@dataclass(frozen=True, eq=False, slots=True)
class Solving:
    """What was asked, and which frames answer it."""

    model: str
    motion: Motion
    given: Mapping[str, float]
    options: ImpactOptions
    frames: ClearFrames


def estimates_of(derived: Derived, fit: Fit, solving: Solving) -> tuple[dict[str, Estimate], FloatArray]:
    """Return the estimates and their covariance: tracks, what is held, given numbers, scale, and the floor.

    The delta method: with S the total slopes by a given number g, S S^T sd(g)^2 adds to the part of the fit.
    """
    options, total = solving.options, derived.covariance.copy()
    for column, symbol in zip(derived.by_known.T, fit.problem.known, strict=True):
        sd = options.scale_sd if symbol == "scale" else options.given_sd.get(symbol, 0.0)
        total += np.outer(column, column) * sd**2
    values = derived.values.copy()
    total += np.diag(
        [(FLOOR.get(symbol, 0.0) * value) ** 2 for symbol, value in zip(derived.names, values, strict=True)]
    )
    values[derived.names.index("t_impact")] += solving.frames.impact.time_s
    sds = np.sqrt(np.diag(total))
    found = zip(derived.names, values, sds, strict=True)
    return {name: Estimate(float(value), float(sd), UNITS_OF.get(name, "")) for name, value, sd in found}, total


def common_figures(derived: Derived, fit: Fit, solving: Solving) -> dict[str, float]:
    """Return what every solution reports: frames, residuals, and the sd from noise alone of what was asked."""
    before, after = np.max([point.seen.counts for point in fit.problem.watched], axis=0)
    sds = dict(zip(derived.names, np.sqrt(np.diag(derived.noise)), strict=True))
    return {
        "frames_before": float(before),
        "frames_after": float(after),
        "contact_frames": float(solving.frames.contact_frames),
        "residual_rms_m": fit.residual_rms_m,
        "residual_lag1": fit.scatter.lag1,
        "locking_px": math.sqrt(2.0 * fit.scatter.locking_px2),
        **{f"{symbol}_sd_random": float(sds[symbol]) for symbol in FLOOR if symbol in sds},
    }


def common_notes(figures: Mapping[str, float], estimates: Mapping[str, Estimate]) -> list[str]:
    """Return what a person should know of any solution: alike residuals, impossible e, contact."""
    e = estimates.get("e", Estimate(0.0, 0.0))
    told = {
        f"residuals of neighbouring frames are alike (lag-1 correlation {figures['residual_lag1']:.2f}); "
        "the uncertainties are widened for it": figures["residual_lag1"] > 0.3 and figures["residual_rms_m"] > 1e-6,
        f"e = {e.value:.3f} is outside 0 to 1: the impact would make or lose more energy than there is; "
        "check frame rate, scale, lengths and contact frames": not -DOUBT_SD * e.sd <= e.value <= 1 + DOUBT_SD * e.sd,
        _contact_note(int(figures["contact_frames"])): figures["contact_frames"] > 0,
    }
    return [note for note, is_true in told.items() if is_true]


def _contact_note(frames: int) -> str:
    if frames == 1:
        return "1 frame next to the impact shows contact and was left out"
    return f"{frames} frames next to the impact show contact and were left out"


def joint_solution(
    solving: Solving, fit: Fit, outcome: Outcome, figures: Mapping[str, float], notes: list[str]
) -> ImpactSolution:
    """Put a solution together; `figures` and `notes` are those of the model beside the common ones."""
    derived = fit.derive(outcome)
    estimates, covariance = estimates_of(derived, fit, solving)
    every = {**common_figures(derived, fit, solving), **figures}
    return ImpactSolution(
        model=solving.model,
        method="joint",
        estimates=estimates,
        correlation_e_I=_correlation(derived, "e", "I"),
        frame_before=_frame_before(solving, estimates["t_impact"].value),
        notes=(*common_notes(every, estimates), *notes),
        figures={name: float(value) for name, value in every.items()},
        covariance=covariance,
        fitted=fitted_motion(fit, solving),
    )


def _frame_before(solving: Solving, impact_s: float) -> int:
    """Return the last frame before the contact, or before the fitted moment where no frame shows contact."""
    motion, last = solving.motion, solving.frames.impact.last_before
    if solving.frames.contact_frames == 0:
        near = slice(max(last - 1, 0), last + 3)  # the moment is a frame off at most
        last = near.start + max(int(np.sum(motion.time_s[near] <= impact_s)) - 1, 0)
    return int(motion.frame[last])


def fitted_motion(fit: Fit, solving: Solving) -> Motion:
    """Return where the model puts every fitted point in the motion's frames, NaN where a frame was not fitted."""
    motion, names = solving.motion, tuple(point.name for point in fit.problem.watched)
    xy, start = np.full((len(motion.time_s), len(names), 2), np.nan), 0
    for k, point in enumerate(fit.problem.watched):
        seen, count = point.seen, len(point.seen.time_s)
        frames = np.searchsorted(motion.time_s, seen.time_s + solving.frames.impact.time_s - 1e-9)
        rest = fit.residual[start : start + 2 * count].reshape(2, count)
        xy[frames, k] = seen.xy_m + (rest * seen.sigma_m).T
        start += 2 * count
    return Motion(names, motion.frame, motion.time_s, xy, np.full(xy.shape[:2], np.nan))


def _correlation(derived: Derived, first: str, second: str) -> float:
    """Return the correlation coefficient of two quantities by noise, NaN where one is not estimated."""
    if not {first, second} <= set(derived.names):
        return math.nan
    i, j = derived.names.index(first), derived.names.index(second)
    sd = math.sqrt(derived.covariance[i, i] * derived.covariance[j, j])
    return float(derived.covariance[i, j] / max(sd, 1e-300))


def interval(estimate: Estimate, sds: float = 1.96, *, log: bool = False) -> tuple[float, float]:
    """Return the interval of `sds` standard deviations; on a log scale for what is positive, such as I.

    A small difference of rates makes I's distribution skew: from sd = 10 % on the log scale is the honest one.

    >>> low, high = interval(Estimate(1.88, 0.188, "kg m^2"), log=True)
    >>> f"{low:.2f} to {high:.2f}"
    '1.55 to 2.29'
    """
    if log:
        factor = math.exp(sds * estimate.sd / abs(estimate.value))
        return estimate.value / factor, estimate.value * factor
    return estimate.value - sds * estimate.sd, estimate.value + sds * estimate.sd

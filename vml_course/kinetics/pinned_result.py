"""From fitted paths to what is asked: e, I, velocities, impulse and loss, each with its uncertainty."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vml_course.kinetics import swing
from vml_course.kinetics.clear_frames import ClearFrames
from vml_course.kinetics.fit import SwingFit, outcome_slopes, split_seen
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.pinned import inertia_about_pivot, restitution
from vml_course.kinetics.pinned_checks import apparent_gravity, knee_offset, notes_on
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion
from vml_course.model.solution import Estimate, ImpactSolution

UNITS_OF = {
    "e": "", "I": "kg m^2", "omega1": "rad/s", "omega2": "rad/s", "v_f1": "m/s", "v_f2": "m/s",
    "v_b1": "m/s", "v_b2": "m/s", "J": "N s", "t_impact": "s", "loss": "J", "a": "m",
}  # fmt: skip
FLOOR = {"e": 0.003, "I": 0.005}  # relative: what remains of a real measurement's own faults
_LENGTH_POWER = {"e": 0, "I": 2, "v_f1": 1, "v_f2": 1, "v_b1": 1, "v_b2": 1, "J": 1, "loss": 2, "a": 1}
_MASS_POWER = {"I": 1, "J": 1, "loss": 1}


def outcome(u: FloatArray, length_m: float, mass_kg: float) -> FloatArray:
    """Return the quantities of `UNITS_OF` from the kernel's unknowns, in that order.

    Without friction the impulse is along the change of the ball's velocity: that is the realised normal n.
    Its arm about the pivot is a = (r x n); foot speeds are counted positive towards the ball.
    """
    v1, v2 = u[swing.V1 : swing.V1 + 2], u[swing.V2 : swing.V2 + 2]
    jump = v2 - v1
    n = jump / np.hypot(*jump)
    arm = length_m * float(np.cos(u[swing.THETA]) * n[1] - np.sin(u[swing.THETA]) * n[0])
    w1, w2, u1, u2 = float(u[swing.W1]), float(u[swing.W2]), float(v1 @ n), float(v2 @ n)
    e = restitution(arm, w1, w2, u1, u2)
    inertia = inertia_about_pivot(mass_kg, arm, w1, w2, u1, u2)
    speed = length_m * np.sign(arm)
    reduced = 1.0 / (arm**2 / inertia + 1.0 / mass_kg)
    loss = 0.5 * reduced * (1.0 - e**2) * (arm * w1 - u1) ** 2
    impulse = mass_kg * (u2 - u1)
    return np.array(
        [e, inertia, w1, w2, speed * w1, speed * w2, u1, u2, impulse, u[swing.T], loss, abs(arm)]
    )  # fmt: skip


def result_of(
    model: str, fit: SwingFit, motion: Motion, given: Mapping[str, float], options: ImpactOptions, frames: ClearFrames
) -> ImpactSolution:
    """Turn a fit into a solution with uncertainties, figures and notes."""
    values = outcome(fit.unknowns, given["L"], given["m"])
    slopes, by_length = outcome_slopes(lambda u, length: outcome(u, length, given["m"]), fit)
    covariance = slopes @ fit.covariance @ slopes.T
    random_sd = np.sqrt(np.diag(covariance))
    known_sd = _systematic(values, by_length, given, options)
    values[_index("t_impact")] += frames.impact.time_s
    estimates = {
        symbol: Estimate(float(value), float(np.hypot(*parts)), UNITS_OF[symbol])
        for symbol, value, *parts in zip(UNITS_OF, values, random_sd, known_sd, strict=True)
    }
    figures = _figures(fit, motion, options, estimates, frames)
    figures |= {"e_sd_random": float(random_sd[0]), "I_sd_random": float(random_sd[1])}
    e = estimates["e"]
    return ImpactSolution(
        model=model,
        method="joint",
        estimates=estimates,
        correlation_e_I=float(covariance[0, 1] / max(random_sd[0] * random_sd[1], 1e-300)),
        frame_before=int(motion.frame[frames.impact.last_before]),
        notes=notes_on(figures, (e.value, e.sd), options),
        figures=figures,
    )


def _index(symbol: str) -> int:
    return list(UNITS_OF).index(symbol)


def _systematic(
    values: FloatArray, by_length: FloatArray, given: Mapping[str, float], options: ImpactOptions
) -> FloatArray:
    """Return the part of each sd that no repetition shows: floor, L, m and scale in quadrature.

    Enlarging the whole picture by a factor c leaves e, multiplies speeds by c and I by c^2 when L grows
    along; so the effect of the scale alone is that power less the effect of L.
    """
    length_sd, mass_sd = options.given_sd.get("L", 0.0), options.given_sd.get("m", 0.0)
    total = np.zeros(len(UNITS_OF))
    for i, symbol in enumerate(UNITS_OF):
        by_scale = _LENGTH_POWER.get(symbol, 0) * values[i] - by_length[i] * given["L"]
        by_mass = _MASS_POWER.get(symbol, 0) * values[i] / given["m"]
        parts = (FLOOR.get(symbol, 0.0) * values[i], by_length[i] * length_sd, by_mass * mass_sd)
        total[i] = float(np.sqrt(np.sum(np.square([*parts, by_scale * options.scale_sd]))))
    return total


def _figures(
    fit: SwingFit, motion: Motion, options: ImpactOptions, estimates: Mapping[str, Estimate], frames: ClearFrames
) -> dict[str, float]:
    u, (before, after) = fit.unknowns, split_seen(fit.data.foot)
    fall = apparent_gravity(fit.data.ball, options.up_angle_rad)
    figures = {
        "r": 1.0 - u[swing.W2] / u[swing.W1],
        "frames_before": before,
        "frames_after": after,
        "contact_frames": frames.impact.first_after - frames.impact.last_before - 1,
        "residual_rms_m": fit.residual_rms_m,
        "residual_lag1": fit.lag1,
        "pivot_x_m": u[swing.K],
        "pivot_y_m": u[swing.K + 1],
        "theta_impact_rad": u[swing.THETA],
        "arc_radius_m": u[swing.R],
        "arc_radius_off": u[swing.R] / fit.data.length_m - 1.0,
        "apparent_g_m_s2": fall.value,
        "apparent_g_sd_m_s2": fall.sd,
        "drive_rad_s2": u[swing.Q],
        "I_log_sd": estimates["I"].sd / abs(estimates["I"].value),
        "I_sd_predicted": estimates["I"].value * predicted_relative_sd(fit),
    }
    if options.knee in motion.points:
        pivot_sd = float(np.sqrt(fit.covariance[0, 0] + fit.covariance[1, 1]))
        offset = knee_offset(motion.of(options.knee), u[swing.K : swing.K + 2], pivot_sd)
        if offset is not None:
            figures |= {"knee_offset_m": offset[0], "knee_offset_sd_m": offset[1]}
    return {name: float(value) for name, value in figures.items()}


def predicted_relative_sd(fit: SwingFit) -> float:
    """Return what a straight line a side would reach: sd(I)/I = sqrt(2) sigma_w / (w1 - w2).

    sigma_w = sigma_theta sqrt(12 / (N (N^2 - 1))) fps, sigma_theta = sqrt(2) sigma / L, for N evenly spaced
    frames a side, with sigma the scatter of a coordinate.
    """
    u, count = fit.unknowns, min(split_seen(fit.data.foot))
    step_s = float(np.median(np.diff(np.sort(fit.data.foot.time_s))))
    sigma_w = np.sqrt(2.0) * fit.residual_rms_m / fit.data.length_m * np.sqrt(12.0 / (count * (count**2 - 1))) / step_s
    return float(np.sqrt(2.0) * sigma_w / abs(u[swing.W1] - u[swing.W2]))

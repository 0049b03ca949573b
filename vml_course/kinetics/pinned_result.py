"""From fitted paths of a pivoted body and a struck one to what is asked: e, I, velocities, impulse and loss."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from vml_course.kinetics.calibration_checks import apparent_gravity, knee_offset
from vml_course.kinetics.joint import Fit, Problem, fit
from vml_course.kinetics.paths import Symbols, direction
from vml_course.kinetics.pinned import inertia_about_pivot, restitution
from vml_course.kinetics.pinned_checks import pinned_notes
from vml_course.kinetics.solved import Solving, joint_solution
from vml_course.model.solution import ImpactSolution


def outcome(u: Symbols) -> Mapping[str, Any]:
    """Return what is asked, from the unknowns of `pinned_problem`.

    Without friction the impulse is along the change of the struck body's velocity: that is the realised normal n.
    Its arm about the pivot is the given `a`, else a = (r x n) at the tracked point; that point's speeds are counted
    positive towards the struck body.
    """
    nx, ny = direction(u["b2x"] - u["b1x"], u["b2y"] - u["b1y"])
    arm = u["L"] * (np.cos(u["theta"]) * ny - np.sin(u["theta"]) * nx)
    side = np.sign(arm.real)
    if "a" in u:
        arm = side * u["a"]
    w1, w2, mass = u["w1"], u["w2"], u["m"]
    u1, u2 = u["b1x"] * nx + u["b1y"] * ny, u["b2x"] * nx + u["b2y"] * ny
    e = restitution(arm, w1, w2, u1, u2)
    inertia = inertia_about_pivot(mass, arm, w1, w2, u1, u2)
    reduced = 1.0 / (arm**2 / inertia + 1.0 / mass)
    speed = u["L"] * side
    found = {"e": e, "I": inertia, "omega1": w1, "omega2": w2, "v_f1": speed * w1, "v_f2": speed * w2}
    found |= {"v_b1": u1, "v_b2": u2, "J": mass * (u2 - u1), "t_impact": u["t"]}
    found |= {"loss": 0.5 * reduced * (1.0 - e**2) * (arm * w1 - u1) ** 2, "a": side * arm}
    return {**found, **({"mu": u["mu"]} if "mu" in u else {})}


def pinned_solution(solving: Solving, problem: Problem) -> ImpactSolution:
    """Fit, and put the solution together with the figures and notes of a pivoted body."""
    found = fit(problem)
    figures = _figures(found, solving)
    return joint_solution(solving, found, outcome, figures, pinned_notes(figures, solving.options))


def _figures(found: Fit, solving: Solving) -> dict[str, float]:
    motion, options = solving.motion, solving.options
    _, ball = (point.seen for point in found.problem.watched)
    fall = apparent_gravity(ball, options.up_angle_rad)
    inertia = float(outcome(found.problem.symbols(found.problem.rows(found.x)))["I"][0, 0])
    figures = {
        # What stood still before lost no share of its rate.
        "r": 1.0 - found["w2"] / found["w1"] if abs(found["w1"]) > abs(found["w2"] - found["w1"]) / 10 else math.nan,
        "pivot_x_m": found["kx"],
        "pivot_y_m": found["ky"],
        "theta_impact_rad": found["theta"],
        "arc_radius_m": found["r"],
        "arc_radius_sd_m": found.sd("r"),
        "arc_radius_off": found["r"] / solving.given["L"] - 1.0,
        "apparent_g_m_s2": fall.value,
        "apparent_g_sd_m_s2": fall.sd,
        "drive_rad_s2": found["q"],
        "I_sd_predicted": inertia * predicted_relative_sd(found),
    }
    derived = found.derive(outcome)
    figures["I_log_sd"] = float(np.sqrt(derived.covariance[1, 1])) / abs(inertia)
    if options.knee in motion.points:
        offset = knee_offset(
            motion.of(options.knee), np.array([found["kx"], found["ky"]]), math.hypot(found.sd("kx"), found.sd("ky"))
        )
        if offset is not None:
            figures |= {"knee_offset_m": offset[0], "knee_offset_sd_m": offset[1]}
    return figures


def predicted_relative_sd(found: Fit) -> float:
    """Return what a straight line a side would reach: sd(I)/I = sqrt(2) sigma_w / (w1 - w2).

    sigma_w = sigma_theta sqrt(12 / (N (N^2 - 1))) fps, sigma_theta = sqrt(2) sigma / L, for N evenly spaced
    frames a side, with sigma the scatter of a coordinate.
    """
    foot = found.problem.watched[0].seen
    count = min(foot.counts)
    step_s = float(np.median(np.diff(np.sort(foot.time_s))))
    sigma_w = np.sqrt(2.0) * found.residual_rms_m / found["r"] * np.sqrt(12.0 / (count * (count**2 - 1))) / step_s
    return float(np.sqrt(2.0) * sigma_w / abs(found["w1"] - found["w2"]))

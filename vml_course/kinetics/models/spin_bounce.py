"""A spinning ball meets the floor obliquely and bounces: restitution along the normal, friction across it.

With the normal n up from the floor, t to the right of it, velocities u along n and w along t, the ball's spin omega
(counter-clockwise) and radius R, moment of inertia k m R^2, the contact point slips with s = w + R omega:

    e = -u2/u1,   e_t = -s2/s1,   k R (omega2 - omega1) = w2 - w1  (angular momentum about the contact point)

Friction mu (Coulomb) gives |w2 - w1| = mu (1 + e) |u1| while the ball slips throughout; where that would reverse the
slip, the ball sticks: s2 = 0, and the ratio of the impulses is only a lower bound of mu.
Cross, "Grip-slip behavior of a bouncing ball", American Journal of Physics 70 (2002) 1093.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, final

import numpy as np

from vml_course.errors import OutOfRangeError, UpsideDownError
from vml_course.kinetics.clear_frames import ClearFrames, Seen, clear_frames
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.joint import Problem, Watched, fit
from vml_course.kinetics.paths import Symbols, flying, turning
from vml_course.kinetics.pinned_problem import body_start, both_lines
from vml_course.kinetics.solved import DOUBT_SD, Solving, joint_solution
from vml_course.kinetics.vectors import unwrapped
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution

STICK_SHARE = 0.02  # of the slip before: less than this is left of it when the ball sticks


@final
class SpinBounce:
    """The impact model "spin-bounce"."""

    name = "spin-bounce"
    title = "A spinning ball that bounces on the floor"
    given: Mapping[str, str] = {"m": "mass", "R": "length", "k": "number"}
    optional: Mapping[str, str] = {}
    usual = ImpactOptions(striker="rim", flight="always")

    def predict(self, parameters: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
        """Return the state after the bounce, in closed form.

        Parameters
        ----------
        parameters : mapping
            `e`, `R` (m), `k`, `m` (kg), and either `mu` or `e_t`.
        before : mapping
            `u1` (m/s, along the normal, negative), `w1` (m/s, to the right of the normal), `omega1` (rad/s).

        Returns
        -------
        after : dict
            `u2`, `w2`, `omega2`, `J` (N s, along the normal), `loss` (J), `s2` (m/s, slip).

        >>> ball = {"e": 0.8, "mu": 0.05, "R": 0.1, "k": 0.4, "m": 0.2}
        >>> after = MODEL.predict(ball, {"u1": -5.0, "w1": 3.0, "omega1": 0.0})
        >>> round(after["u2"], 9), round(after["w2"], 9), round(after["omega2"], 9)  # slips all the time
        (4.0, 2.55, -11.25)
        >>> stuck = MODEL.predict({**ball, "mu": 1.0}, {"u1": -5.0, "w1": 3.0, "omega1": 0.0})
        >>> round(stuck["w2"] + 0.1 * stuck["omega2"], 9)
        0.0
        """
        e, radius, k, mass = (parameters[symbol] for symbol in ("e", "R", "k", "m"))
        u1, w1, omega1 = (before[symbol] for symbol in ("u1", "w1", "omega1"))
        slip, ease = w1 + radius * omega1, 1.0 + 1.0 / k
        if "e_t" in parameters:
            change = -(1.0 + parameters["e_t"]) * slip / ease
        else:
            change = -math.copysign(min(parameters["mu"] * (1.0 + e) * abs(u1), abs(slip) / ease), slip)
        u2, w2, omega2 = -e * u1, w1 + change, omega1 + change / (k * radius)
        loss = 0.5 * mass * (u1**2 - u2**2 + w1**2 - w2**2 + k * radius**2 * (omega1**2 - omega2**2))
        return {
            "u2": u2, "w2": w2, "omega2": omega2, "J": mass * (u2 - u1), "loss": loss, "s2": w2 + radius * omega2,
        }  # fmt: skip

    def solve(self, motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None) -> ImpactSolution:
        """Return e, mu and e_t, from the paths of the ball's centre and of a mark on it.

        Parameters
        ----------
        motion : Motion
            Metres, y up; the floor is level.
        given : mapping of str to float
            `m` mass in kg, `R` radius in m, `k` = I / (m R^2): 0.4 of a solid ball, 2/3 of a shell, 0.5 of a disc.
        options : ImpactOptions, optional
            `struck` is the ball's centre, `striker` the mark. The ball flies on both sides.

        Raises
        ------
        InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError, UpsideDownError
        OutOfRangeError
            When the ball turns more than half a turn from frame to frame, so that its spin cannot be told.
        """
        options = replace(options or self.usual, flight="always")
        check_given(given, self.given)
        frames = clear_frames(motion, options, options.window_s)
        ball, rim = frames.seen(motion, options.struck), frames.seen(motion, options.striker)
        _refuse_ceiling(frames, options)
        gravity, up = np.array(options.gravity_xy_m_s2), options.up_angle_rad
        known = {symbol: given[symbol] for symbol in self.given}
        known |= {"nx": math.cos(up), "ny": math.sin(up)}
        start, seen_spin = _spin_start(ball, rim)
        centre = flying("b", gravity, gravity)
        mark = turning(centre, lambda u: u["rho"], lambda u: (u["w1"], _spin_after(u)))
        found = fit(
            Problem(
                {"t": 0.0, **start, **body_start("b", ball)},
                known,
                (Watched(options.struck, ball, centre), Watched(options.striker, rim, mark)),
            )
        )
        u = {name: float(value[0, 0]) for name, value in found.problem.symbols(found.problem.rows(found.x)).items()}
        _refuse_fast_spin(u, motion)
        derived = found.derive(_outcome)
        slip_sd = float(np.sqrt(derived.covariance[2, 2]))
        e_t = float(derived.values[2])
        sticks = abs(e_t) < max(DOUBT_SD * slip_sd, STICK_SHARE)
        figures = {"sticks": float(sticks), "spin_after_seen_rad_s": seen_spin, "mark_radius_m": u["rho"]}
        solving = Solving(self.name, motion, given, options, frames)
        return joint_solution(solving, found, _outcome, figures, _notes(sticks, seen_spin, _spin_after(u)))


def _refuse_ceiling(frames: ClearFrames, options: ImpactOptions) -> None:
    """Refuse a ball whose velocity jumps down: a floor throws it up."""
    up = np.array([math.cos(options.up_angle_rad), math.sin(options.up_angle_rad)])
    jump = float(frames.impact.jump_m_s @ up)
    if jump < 0:
        hint = "World coordinates have y up; set the axes, or change the sign of y."
        got = f"{-jump:.1f} m/s downwards"
        raise UpsideDownError(options.struck, "a ball that the floor throws up", got, hint)


def _spin_start(ball: Seen, rim: Seen) -> tuple[dict[str, float], float]:
    """Return a first guess of the mark's angle and spin, and the spin after that straight lines show."""
    both = np.isin(ball.time_s, rim.time_s), np.isin(rim.time_s, ball.time_s)
    way, time = rim.xy_m[both[1]] - ball.xy_m[both[0]], ball.time_s[both[0]]
    seen = Seen(time, way, np.ones(len(time)), ball.is_after[both[0]])
    angle = unwrapped(np.arctan2(way[:, 1], way[:, 0]))
    before, after = both_lines(time, angle[:, None], seen)
    start = {"theta": before.position(0.0)[0], "w1": before.slope[0], "rho": np.hypot(*way.T).mean()}
    return {name: float(value) for name, value in start.items()}, float(after.slope[0])


def _spin_after(u: Symbols) -> Any:
    """Return omega2 = omega1 + (w2 - w1) / (k R)."""
    across = (u["b2x"] - u["b1x"]) * u["ny"] - (u["b2y"] - u["b1y"]) * u["nx"]
    return u["w1"] + across / (u["k"] * u["R"])


def _outcome(u: Symbols) -> dict[str, Any]:
    """Return what is asked, with the equations of the module."""
    nx, ny, radius, mass = u["nx"], u["ny"], u["R"], u["m"]
    u1, u2 = (u[f"b{side}x"] * nx + u[f"b{side}y"] * ny for side in "12")
    w1, w2 = (u[f"b{side}x"] * ny - u[f"b{side}y"] * nx for side in "12")
    o1, o2 = u["w1"], _spin_after(u)
    e, e_t = -u2 / u1, -(w2 + radius * o2) / (w1 + radius * o1)
    mu = np.sign(np.real(w1 - w2)) * (w1 - w2) / (u2 - u1)
    found = {"e": e, "mu": mu, "e_t": e_t, "omega1": o1, "omega2": o2, "v_b1": u1, "v_b2": u2, "v_t1": w1, "v_t2": w2}
    loss = 0.5 * mass * (u1**2 - u2**2 + w1**2 - w2**2 + u["k"] * radius**2 * (o1**2 - o2**2))
    return {**found, "J": mass * (u2 - u1), "t_impact": u["t"], "loss": loss}


def _refuse_fast_spin(u: Mapping[str, float], motion: Motion) -> None:
    """Refuse a spin that a camera cannot tell from its mirror image."""
    limit = math.pi / float(np.median(np.diff(motion.time_s)))
    for spin in (u["w1"], float(_spin_after(u))):
        if abs(spin) > 0.95 * limit:
            raise OutOfRangeError("spin", -limit, limit, "rad/s (half a turn a frame)", spin)


def _notes(sticks: bool, seen: float, told: float) -> list[str]:  # noqa: FBT001
    notes = []
    if sticks:
        notes.append("the ball sticks at the end of the contact: mu is at least what is told, not that")
    if abs(seen - told) > 0.05 * abs(told) + 1.0:
        notes.append(
            f"the mark turns with {seen:.1f} rad/s after the bounce, k and R say {told:.1f}: check them, and whether "
            "the mark turned more than half a turn a frame"
        )
    return notes


MODEL = SpinBounce()

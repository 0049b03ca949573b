"""A ball strikes a free rod on an air table at the distance b from its centre.

Eccentric impact in general plane motion: Beer & Johnston, *Dynamics*, "Eccentric impact"; Hibbeler, *Dynamics*, 19.4.
With the normal n from the rod to the ball, the impulse J on the ball along n, and -J on the rod at the arm b about its
centre G:

    m (u2 - u1) = J,   M (g2 - g1) = -J n,   I (w2 - w1) = -b J,   e = (u2 - c2) / (c1 - u1),   c = g.n + b w.

G need not be marked: it lies on the line of the rod's two marks, near their middle, and moves as momentum says.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, final

import numpy as np

from vml_course.kinetics.clear_frames import ClearFrames, clear_frames
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.joint import Held, Problem, Watched, fit
from vml_course.kinetics.paths import Path, Symbols, direction, flying, turning
from vml_course.kinetics.pinned_problem import body_start, both_lines
from vml_course.kinetics.solved import DOUBT_SD, Solving, joint_solution
from vml_course.kinetics.vectors import unwrapped
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution

MIDDLE_SD = 0.02  # of the marks' distance: how far G may lie from their middle
ARM_NOTE = 0.02


@final
class FreeRod:
    """The impact model "free-rod"."""

    name = "free-rod"
    title = "A free rod and a ball that strikes it off its centre"
    given: Mapping[str, str] = {"m": "mass", "M": "mass", "b": "length"}
    optional: Mapping[str, str] = {}
    usual = ImpactOptions(striker="tail", striker_mark="tip", flight="never", gravity_m_s2=0.0, window_s=0.1)

    def predict(self, parameters: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
        """Return the state after the impact, in closed form; velocities along the normal, from the rod to the ball.

        J = (1 + e) (g1 + b w1 - u1) / (1/M + b^2/I + 1/m).

        Parameters
        ----------
        parameters : mapping
            `e`, `I` (kg m^2, about the centre), `M` and `m` (kg; rod and ball), `b` (m, signed arm (r x n)).
        before : mapping
            `g1` and `u1` (m/s; rod's centre and ball) and `omega1` (rad/s).

        Returns
        -------
        after : dict
            `g2`, `u2`, `omega2`, `J`, `loss`.

        >>> rod = {"e": 1.0, "I": 1.0, "M": 1.0, "m": 1.0, "b": 1.0}
        >>> after = MODEL.predict(rod, {"g1": 0.0, "u1": -3.0, "omega1": 0.0})
        >>> after["g2"], after["u2"], after["omega2"], after["loss"]
        (-2.0, -1.0, -2.0, 0.0)
        """
        e, inertia, rod, ball, arm = (parameters[symbol] for symbol in ("e", "I", "M", "m", "b"))
        approach = before["g1"] + arm * before["omega1"] - before["u1"]
        reduced = 1.0 / (1.0 / rod + arm**2 / inertia + 1.0 / ball)
        impulse = (1.0 + e) * reduced * approach
        return {
            "g2": before["g1"] - impulse / rod,
            "u2": before["u1"] + impulse / ball,
            "omega2": before["omega1"] - arm * impulse / inertia,
            "J": impulse,
            "loss": 0.5 * reduced * (1.0 - e**2) * approach**2,
        }

    def solve(self, motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None) -> ImpactSolution:
        """Return e and I about the rod's centre, from the paths of its two marks and of the ball.

        Parameters
        ----------
        motion : Motion
            Metres; seen from above declare gravity 0.
        given : mapping of str to float
            `m` ball and `M` rod mass in kg, `b` distance of the ball's line from the rod's centre in m.
        options : ImpactOptions, optional
            `striker` and `striker_mark` are the rod's marks, `struck` the ball.

        Raises
        ------
        InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError
        """
        options = options or self.usual
        check_given(given, self.given)
        frames = clear_frames(motion, options, options.window_s)
        known = {symbol: given[symbol] for symbol in self.given}
        problem = _problem(motion, known, options, frames)
        found = fit(problem)
        u = {name: float(value[0, 0]) for name, value in _tied(problem.symbols(problem.rows(found.x))).items()}
        figures = {"arm_seen_m": abs(_arm_seen(u)), "centre_at": u["lam"], "rod_marks_m": u["ell"]}
        solving = Solving(self.name, motion, given, options, frames)
        return joint_solution(solving, found, _outcome, figures, _notes(figures, given))


def _problem(motion: Motion, known: Mapping[str, float], options: ImpactOptions, frames: ClearFrames) -> Problem:
    """Unknowns: G (gx, gy, g1x, g1y), the rod's angle and rates, where G is between the marks, and the ball."""
    tail, tip = (frames.seen(motion, name) for name in (options.striker, options.striker_mark))
    ball = frames.seen(motion, options.struck)
    start = {"t": 0.0, **_rod_start(tail, tip), **body_start("b", ball)}
    still = np.zeros(2)
    free = flying("g", still, still)

    def centre(u: Symbols, s: Any, is_after: Any) -> Any:
        return free(_tied(u), s, is_after)

    def mark(share: float) -> Path:
        return turning(centre, lambda u: (share - u["lam"]) * u["ell"], lambda u: (u["w1"], u["w2"]))

    watched = (
        Watched(options.striker, tail, mark(0.0)),
        Watched(options.striker_mark, tip, mark(1.0)),
        Watched(options.struck, ball, flying("b", still, still)),
    )
    return Problem(start, known, watched, (Held(lambda u: u["lam"] - 0.5, MIDDLE_SD),))


def _rod_start(tail: Any, tip: Any) -> dict[str, float]:
    """Return a first guess from the frames in which both marks are seen."""
    both = np.isin(tail.time_s, tip.time_s), np.isin(tip.time_s, tail.time_s)
    way, is_after = tip.xy_m[both[1]] - tail.xy_m[both[0]], tail.is_after[both[0]]
    middle = 0.5 * (tip.xy_m[both[1]] + tail.xy_m[both[0]])
    time = tail.time_s[both[0]]
    angle = unwrapped(np.arctan2(way[:, 1], way[:, 0]))
    seen = type(tail)(time, middle, np.ones(len(time)), is_after)
    (turn1, turn2), (path, _) = both_lines(time, angle[:, None], seen), both_lines(time, middle, seen)
    values = *path.position(0.0), *path.slope, turn1.position(0.0)[0], turn1.slope[0], turn2.slope[0]
    names = ("gx", "gy", "g1x", "g1y", "theta", "w1", "w2")
    return {**dict(zip(names, map(float, values), strict=True)), "lam": 0.5, "ell": float(np.hypot(*way.T).mean())}


def _tied(u: Symbols) -> dict[str, Any]:
    """Add the velocity of the rod's centre after, which conservation of momentum gives."""
    share = u["m"] / u["M"]
    return {**u, **{f"g2{axis}": u[f"g1{axis}"] - share * (u[f"b2{axis}"] - u[f"b1{axis}"]) for axis in "xy"}}


def _arm_seen(u: Symbols) -> Any:
    """Return the arm of the ball's centre about G at the impact, (r x n): a round ball's normal passes its centre."""
    nx, ny = direction(u["b2x"] - u["b1x"], u["b2y"] - u["b1y"])
    return (u["bx"] - u["gx"]) * ny - (u["by"] - u["gy"]) * nx


def _outcome(u: Symbols) -> dict[str, Any]:
    """Return what is asked, with the equations of the module."""
    u = _tied(u)
    nx, ny = direction(u["b2x"] - u["b1x"], u["b2y"] - u["b1y"])
    b1, b2, g1, g2 = (u[f"{body}{side}x"] * nx + u[f"{body}{side}y"] * ny for body in "bg" for side in "12")
    arm, w1, w2, mass = np.sign(np.real(_arm_seen(u))) * u["b"], u["w1"], u["w2"], u["m"]
    impulse = mass * (b2 - b1)
    inertia = arm * impulse / (w1 - w2)
    c1, c2 = g1 + arm * w1, g2 + arm * w2
    e, reduced = (b2 - c2) / (c1 - b1), 1.0 / (1.0 / u["M"] + arm**2 / inertia + 1.0 / mass)
    found = {"e": e, "I": inertia, "omega1": w1, "omega2": w2, "v_g1": g1, "v_g2": g2, "v_b1": b1, "v_b2": b2}
    return {**found, "J": impulse, "t_impact": u["t"], "loss": 0.5 * reduced * (1.0 - e**2) * (c1 - b1) ** 2}


def _notes(figures: Mapping[str, float], given: Mapping[str, float]) -> list[str]:
    off, notes = abs(figures["centre_at"] - 0.5), []
    if off > DOUBT_SD * MIDDLE_SD:
        notes.append(
            f"the rod's centre of mass is {1000 * off * figures['rod_marks_m']:.0f} mm from the middle of its marks: "
            "check M, the scale, and whether the rod was free"
        )
    if abs(figures["arm_seen_m"] - given["b"]) > max(ARM_NOTE * figures["rod_marks_m"], 0.005):
        seen = 1000 * figures["arm_seen_m"]
        notes.append(f"the ball's line passes the rod's centre at {seen:.0f} mm, b says {1000 * given['b']:.0f} mm")
    return notes


MODEL = FreeRod()

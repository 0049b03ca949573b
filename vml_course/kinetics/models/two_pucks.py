"""Two pucks collide obliquely on an air table: central impact without friction.

Beer & Johnston, *Dynamics*, "Oblique central impact"; Hibbeler, *Dynamics*, 15.4. Restitution acts along the line n of
the centres alone, what is across it stays; momentum is conserved: M (a1 - a2) = m (b2 - b1) for the velocities a of the
striking and b of the struck puck. So the change of either velocity is the normal that was realised.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, final

import numpy as np

from vml_course.kinetics.clear_frames import clear_frames
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.joint import Problem, Watched, fit
from vml_course.kinetics.paths import Symbols, direction, flying
from vml_course.kinetics.pinned_problem import body_start
from vml_course.kinetics.solved import Solving, joint_solution
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution

NORMAL_NOTE_DEG = 2.0


@final
class TwoPucks:
    """The impact model "two-pucks"."""

    name = "two-pucks"
    title = "Two pucks that collide obliquely"
    given: Mapping[str, str] = {"m": "mass"}
    optional: Mapping[str, str] = {}
    usual = ImpactOptions(striker="puck_a", struck="puck_b", flight="never", gravity_m_s2=0.0, window_s=0.12)

    def predict(self, parameters: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
        """Return the velocities after the impact, in closed form.

        J = (1 + e) (a1 - b1).n / (1/M + 1/m);  a2 = a1 - n J/M;  b2 = b1 + n J/m.

        Parameters
        ----------
        parameters : mapping
            `e`, `M` and `m` (kg; striking and struck puck), `normal` (rad: from the first centre to the second,
            counter-clockwise from +x).
        before : mapping
            `a1x`, `a1y`, `b1x`, `b1y` (m/s).

        >>> equal = {"e": 1.0, "M": 0.2, "m": 0.2, "normal": 0.0}
        >>> after = MODEL.predict(equal, {"a1x": 2.0, "a1y": 1.0, "b1x": 0.0, "b1y": 0.0})
        >>> after["a2x"], after["a2y"], after["b2x"], after["b2y"]  # the normal parts are exchanged
        (0.0, 1.0, 2.0, 0.0)
        """
        e, first, second = parameters["e"], parameters["M"], parameters["m"]
        nx, ny = math.cos(parameters["normal"]), math.sin(parameters["normal"])
        approach = (before["a1x"] - before["b1x"]) * nx + (before["a1y"] - before["b1y"]) * ny
        reduced = 1.0 / (1.0 / first + 1.0 / second)
        impulse = (1.0 + e) * reduced * approach
        return {
            "a2x": before["a1x"] - nx * impulse / first,
            "a2y": before["a1y"] - ny * impulse / first,
            "b2x": before["b1x"] + nx * impulse / second,
            "b2y": before["b1y"] + ny * impulse / second,
            "J": impulse,
            "loss": 0.5 * reduced * (1.0 - e**2) * approach**2,
        }

    def solve(self, motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None) -> ImpactSolution:
        """Return e and the mass M of the striking puck, from the paths of both centres.

        Parameters
        ----------
        motion : Motion
            Metres; seen from above declare gravity 0.
        given : mapping of str to float
            `m` mass of the struck puck in kg.
        options : ImpactOptions, optional

        Raises
        ------
        InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError
        """
        options = options or self.usual
        check_given(given, self.given)
        frames = clear_frames(motion, options, options.window_s)
        first, second = frames.seen(motion, options.striker), frames.seen(motion, options.struck)
        start = {"t": 0.0, **body_start("a", first), **body_start("b", second)}
        known = {"m": given["m"]}
        if options.at_rest:
            known |= {name: 0.0 * start.pop(name) for name in ("b1x", "b1y")}
        # Momentum ties the second puck's velocity after to the first one's.
        jumps = [
            np.array([start[f"{body}2{axis}"] - (start | known)[f"{body}1{axis}"] for axis in "xy"]) for body in "ab"
        ]
        start["M"] = given["m"] * float(np.hypot(*jumps[1]) / max(float(np.hypot(*jumps[0])), 1e-12))
        del start["b2x"], start["b2y"]
        g, none = np.array(options.gravity_xy_m_s2), np.zeros(2)
        gravity = g if options.flight == "always" else none, none if options.flight == "never" else g
        paths = flying("a", *gravity), flying("b", *gravity)
        watched = (
            Watched(options.striker, first, paths[0]),
            Watched(options.struck, second, lambda u, s, is_after: paths[1](_tied(u), s, is_after)),
        )
        found = fit(Problem(start, known, watched))
        solving = Solving(self.name, motion, given, options, frames)
        off_deg = _normal_off_deg(found.problem.symbols(found.problem.rows(found.x)))
        return joint_solution(solving, found, _outcome, {"normal_off_deg": off_deg}, _notes(off_deg))


def _tied(u: Symbols) -> dict[str, Any]:
    """Add the struck puck's velocity after, which conservation of momentum gives."""
    after = {f"b2{axis}": u[f"b1{axis}"] + u["M"] / u["m"] * (u[f"a1{axis}"] - u[f"a2{axis}"]) for axis in "xy"}
    return {**u, **after}


def _outcome(u: Symbols) -> dict[str, Any]:
    """Return what is asked; velocities along the normal from the striking to the struck puck, and along x and y."""
    u = _tied(u)
    nx, ny = direction(u["b2x"] - u["b1x"], u["b2y"] - u["b1y"])
    a1, a2, b1, b2 = (u[f"{body}{side}x"] * nx + u[f"{body}{side}y"] * ny for body in "ab" for side in "12")
    e, reduced = (b2 - a2) / (a1 - b1), 1.0 / (1.0 / u["M"] + 1.0 / u["m"])
    found = {"e": e, "M": u["M"], "v_a1": a1, "v_a2": a2, "v_b1": b1, "v_b2": b2, "J": u["m"] * (b2 - b1)}
    found |= {"t_impact": u["t"], "loss": 0.5 * reduced * (1.0 - e**2) * (a1 - b1) ** 2}
    return found | {
        f"v_{body}{side}{axis}": u[f"{body}{side}{axis}"] for body in "ab" for side in "12" for axis in "xy"
    }


def _normal_off_deg(u: Symbols) -> float:
    """Return the angle between the line of the centres at the impact and the normal that was realised."""
    u = {name: float(value[0, 0]) for name, value in _tied(u).items()}
    normal = math.atan2(u["b2y"] - u["b1y"], u["b2x"] - u["b1x"])
    centres = math.atan2(u["by"] - u["ay"], u["bx"] - u["ax"])
    return math.degrees(math.remainder(normal - centres, 2.0 * math.pi))


def _notes(off_deg: float) -> list[str]:
    if abs(off_deg) < NORMAL_NOTE_DEG:
        return []
    note = (
        f"the impulse is {abs(off_deg):.1f} deg off the line of the centres: there was friction, or the tracked points"
    )
    return [f"{note} are not the centres"]


MODEL = TwoPucks()

"""A rigid leg on a fixed pivot kicks a ball: the impact of the VML paper, bats, hammers and doors alike.

A door that a ball strikes is one too: it is at rest before, and `a` says where it is hit.

Unknown pivot, joint least squares of both paths, shared impact time, gravity on leg and ball, and, unless
it is declared absent, a constant driving acceleration. See `kinetics/README.md` for what each choice costs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import final

import numpy as np

from vml_course.kinetics.clear_frames import clear_frames
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.paths import flying
from vml_course.kinetics.pinned import after_impact
from vml_course.kinetics.pinned_checks import refuse_misfits
from vml_course.kinetics.pinned_problem import mark_at, pinned_problem
from vml_course.kinetics.pinned_result import pinned_solution
from vml_course.kinetics.solved import Solving
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution


@final
class FixedPivot:
    """The impact model "fixed-pivot"."""

    name = "fixed-pivot"
    title = "A body on a fixed pivot and a ball"
    given: Mapping[str, str] = {"m": "mass", "L": "length"}
    optional: Mapping[str, str] = {"a": "length"}
    usual = ImpactOptions()

    def predict(self, parameters: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
        """Return the state after the impact, in closed form.

        Parameters
        ----------
        parameters : mapping
            `e`, `I` (kg m^2), `m` (kg) and `L` (m), or `a` (m) when the contact normal passes the foot obliquely.
        before : mapping
            `omega1` (rad/s) and `u1` (m/s).

        >>> after = MODEL.predict({"e": 11 / 15, "I": 1.8816, "m": 0.5, "L": 0.56}, {"omega1": 15 / 0.56, "u1": 0.0})
        >>> round(after["u2"], 6), round(after["omega2"] * 0.56, 6)
        (24.0, 13.0)
        """
        arm = parameters.get("a", parameters["L"])
        after = after_impact(
            parameters["e"], parameters["I"], parameters["m"], arm, before["omega1"], before["u1"]
        )  # fmt: skip
        return {"omega2": after.omega2, "u2": after.u2, "J": after.impulse, "loss": after.loss}

    def solve(self, motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None) -> ImpactSolution:
        """Return e, I and the state before and after, from the paths of foot and ball.

        Parameters
        ----------
        motion : Motion
            Metres, y up.
        given : mapping of str to float
            `m` ball mass in kg, `L` distance from the pivot to the tracked striking point in m; `a` lever arm of the
            contact normal in m, where the ball meets the body elsewhere than at the tracked point (a door).
        options : ImpactOptions, optional

        Raises
        ------
        InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError, UpsideDownError,
        LengthMismatchError
        """
        options = options or self.usual
        check_given(given, self.given, self.optional)
        frames = clear_frames(motion, options, options.window_s)
        foot, ball = frames.seen(motion, options.striker), frames.seen(motion, options.struck)
        refuse_misfits(foot, ball, given["L"], options)
        gravity, none = np.array(options.gravity_xy_m_s2), np.zeros(2)
        path = flying(
            "b", gravity if options.flight == "always" else none, none if options.flight == "never" else gravity
        )
        known = {symbol: given[symbol] for symbol in (*self.given, *self.optional) if symbol in given}
        problem = pinned_problem(foot, ball, path, known, options, mark_at(motion, options.knee))
        return pinned_solution(Solving(self.name, motion, given, options, frames), problem)


MODEL = FixedPivot()

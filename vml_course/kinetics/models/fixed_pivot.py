"""A rigid leg on a fixed pivot kicks a ball: the impact of the VML paper, bats, hammers and doors alike.

Unknown pivot, joint least squares of both paths, shared impact time, gravity on leg and ball, and, unless
it is declared absent, a constant driving acceleration. See `kinetics/README.md` for what each choice costs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import final

import numpy as np

from vml_course.kinetics.clear_frames import clear_frames
from vml_course.kinetics.fit import fit_swing
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.pinned import after_impact
from vml_course.kinetics.pinned_checks import refuse_misfits
from vml_course.kinetics.pinned_result import result_of
from vml_course.kinetics.swing import UNKNOWNS, V1, P, Q, SwingData
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution


@final
class FixedPivot:
    """The impact model "fixed-pivot"."""

    name = "fixed-pivot"
    title = "A body on a fixed pivot and a ball"
    given: Mapping[str, str] = {"m": "mass", "L": "length"}

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
            `m` ball mass in kg, `L` distance from the pivot to the striking point in m.
        options : ImpactOptions, optional

        Raises
        ------
        InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError, UpsideDownError,
        LengthMismatchError
        """
        options = options or ImpactOptions()
        check_given(given, self.given)
        frames = clear_frames(motion, options, options.window_s)
        foot, ball = frames.seen(motion, options.striker), frames.seen(motion, options.struck)
        gravity, none = np.array(options.gravity_xy_m_s2), np.zeros(2)
        data = SwingData(
            foot=foot,
            ball=ball,
            length_m=given["L"],
            gravity_before=gravity if options.flight == "always" else none,
            gravity_after=none if options.flight == "never" else gravity,
            tilt_rad=options.up_angle_rad - np.pi / 2,
            unknowns=_unknowns(options),
        )
        refuse_misfits(data, options)
        return result_of(self.name, fit_swing(data), motion, given, options, frames)


def _unknowns(options: ImpactOptions) -> tuple[int, ...]:
    """Return what is estimated: no gravity term in a top view, no drive nor velocity where none is declared."""
    absent = {P} if options.gravity_m_s2 == 0 else set()
    absent |= {Q} if options.drive == "none" else set()
    absent |= {V1, V1 + 1} if options.at_rest else set()
    return tuple(index for index in range(len(UNKNOWNS)) if index not in absent)


MODEL = FixedPivot()

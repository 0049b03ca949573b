"""A pendulum hammer strikes a block at rest, which slides on until friction has stopped it.

The impact is that of a pinned body and a particle (Beer & Johnston, "Eccentric impact"); friction during the impact is
neglected. Afterwards the block loses the speed mu g every second (Coulomb), which gives mu. The hammer's head must be
round and strike at the height of the block's centre, else the block turns and the lever arm is another one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import final

import numpy as np

from vml_course.errors import OutOfRangeError
from vml_course.kinetics.clear_frames import LEAST_FRAMES, ClearFrames, frames_about
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.paths import sliding
from vml_course.kinetics.pinned import after_impact
from vml_course.kinetics.pinned_checks import refuse_misfits
from vml_course.kinetics.pinned_problem import mark_at, pinned_problem
from vml_course.kinetics.pinned_result import pinned_solution
from vml_course.kinetics.solved import Solving
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution

FIRST_GUESS_MU = 0.2
FRAMES_OFF = 3  # next to the impact, where the rough split may be wrong
MOVING_SHARE = 0.75  # of the way that is seen: there the block has not stopped yet


@final
class HammerBlock:
    """The impact model "hammer-block"."""

    name = "hammer-block"
    title = "A pendulum hammer and a sliding block"
    given: Mapping[str, str] = {"m": "mass", "L": "length"}
    optional: Mapping[str, str] = {}
    usual = ImpactOptions(striker="head", struck="block", knee="pivot", flight="never", window_s=0.15)

    def predict(self, parameters: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
        """Return the state after the impact and the way that the block slides, in closed form.

        Parameters
        ----------
        parameters : mapping
            `e`, `I` (kg m^2, about the pivot), `m` (block, kg), `L` (m), `mu`, and `g` (m/s^2; 9.81 if absent).
        before : mapping
            `omega1` (rad/s, counter-clockwise) and `u1` (m/s, block).

        Returns
        -------
        after : dict
            `omega2`, `u2`, `J` (N s), `loss` (J), and `slide` = u2^2 / (2 mu g) (m).

        >>> hammer = {"e": 0.5, "I": 1.0, "m": 1.0, "L": 1.0, "mu": 0.25, "g": 10.0}
        >>> after = MODEL.predict(hammer, {"omega1": 4.0, "u1": 0.0})
        >>> after["omega2"], after["u2"], after["slide"]
        (1.0, 3.0, 1.8)
        """
        e, inertia, mass, arm = (parameters[symbol] for symbol in ("e", "I", "m", "L"))
        after = after_impact(e, inertia, mass, arm, before["omega1"], before["u1"])
        slide = after.u2**2 / (2.0 * parameters["mu"] * parameters.get("g", 9.81))
        return {"omega2": after.omega2, "u2": after.u2, "J": after.impulse, "loss": after.loss, "slide": slide}

    def solve(self, motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None) -> ImpactSolution:
        """Return e, I, mu and the state before and after, from the paths of head and block.

        Parameters
        ----------
        motion : Motion
            Metres, y up.
        given : mapping of str to float
            `m` block mass in kg, `L` distance from the pivot to the striking point in m.
        options : ImpactOptions, optional
            A longer window (0.2 s) is sharper in mu, as long as the block slides.

        Raises
        ------
        InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError, LengthMismatchError
        """
        options = replace(options or self.usual, flight="never")
        check_given(given, self.given)
        if options.gravity_m_s2 <= 0:
            raise OutOfRangeError("gravity", 0.1, 30.0, "m/s^2", options.gravity_m_s2)
        frames = _frames(motion, options)
        head, block = frames.seen(motion, options.striker), frames.seen(motion, options.struck)
        refuse_misfits(head, block, given["L"], options)
        known = {symbol: given[symbol] for symbol in self.given}
        path, beside = sliding("b", options.gravity_m_s2), {"mu": FIRST_GUESS_MU}
        problem = pinned_problem(head, block, path, known, options, mark_at(motion, options.knee), beside)
        return pinned_solution(Solving(self.name, motion, given, options, frames), problem)


def _frames(motion: Motion, options: ImpactOptions) -> ClearFrames:
    """Find the impact, with the block's deceleration taken off as gravity would be."""
    struck = motion.of(options.struck)
    seen = np.isfinite([motion.of(options.striker), struck]).all(axis=(0, 2))
    rough = frames_about(motion, options.struck, np.asarray(seen), (None, None), options.window_s)
    late = rough.after[FRAMES_OFF:]
    way = np.hypot(*(struck[late] - struck[rough.after[0]]).T)
    moving = late[way < MOVING_SHARE * way.max()]
    if len(moving) < LEAST_FRAMES:
        return rough
    slowing = 2.0 * np.polynomial.polynomial.polyfit(motion.time_s[moving], struck[moving], 2)[2]
    return frames_about(motion, options.struck, np.asarray(seen), (None, slowing), options.window_s)


MODEL = HammerBlock()

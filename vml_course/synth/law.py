"""The physics of an impact: what pymunk is told, and the textbook's answer to hold it against.

A law is a small frozen record of numbers. Scenes choose one, give it their numbers, and add looks. The laws
are in `synth/laws`; the checks in `honesty.py` run over whatever law it is.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.truth import Realised
from vml_course.synth.clock import Clock
from vml_course.synth.run import Run
from vml_course.synth.stage import Stage, Vector
from vml_course.synth.stepping import run_stage


class Movement(NamedTuple):
    """Poses and velocities of b bodies at n times, shape (n, b, 3) each."""

    pose: FloatArray
    rate: FloatArray


class Answer(NamedTuple):
    """An impact in closed form: velocities after it, shape (b, 3), and the impulse on the struck body, shape (2,)."""

    after: FloatArray
    impulse_N_s: FloatArray  # noqa: N815 - the unit is newton second


class Law(ABC):
    """One kind of impact. Arrays of shape (b, 3) are as in `run.py`; time 0 is the impact.

    Attributes
    ----------
    normal : (float, float)
        Unit vector of the contact, from the striker to the struck body.
    striker, struck : int
        Which of the bodies these are; the same where a body meets the ground.
    about_m : (float, float)
        A point about which angular momentum is conserved.
    """

    normal: Vector
    striker: int = 0
    struck: int = 1
    about_m: Vector = (0.0, 0.0)

    @property
    def duration_s(self) -> float:
        """How long the contact lasts: an instant, unless a law says otherwise."""
        return 0.0

    @property
    @abstractmethod
    def arm_m(self) -> float:
        """Lever arm of the normal about the striker's origin."""

    @property
    @abstractmethod
    def mass(self) -> FloatArray:
        """What multiplies velocities in momentum and energy, as in `ImpactTruth`."""

    @property
    @abstractmethod
    def before(self) -> FloatArray:
        """Velocities before the impact, shape (b, 3)."""

    @abstractmethod
    def answer(self) -> Answer:
        """Return the impact in closed form, without pymunk."""

    @abstractmethod
    def motion(self, time_s: FloatArray) -> Movement:
        """Return the motion in closed form or by Runge-Kutta, without pymunk.

        Parameters
        ----------
        time_s : float array, shape (n,)
            Ascending, 0 at the impact; the velocities at 0 are those before it.
        """

    @abstractmethod
    def potential(self, pose: FloatArray, *, after: bool) -> float:
        """Return the work, in J, that the forces have taken since the impact: 0 in the pose of the impact."""

    @abstractmethod
    def unknowns(self, run: Run) -> Mapping[str, Realised]:
        """Return what students look for, by symbol, as the run realised it."""

    @abstractmethod
    def run(self, clock: Clock, log_every: int | None = None) -> Run:
        """Simulate a clip; log every frame, or every so many steps."""

    def kinetic(self, rate: FloatArray) -> float:
        """Return the kinetic energy in J of velocities of shape (b, 3)."""
        return 0.5 * float((self.mass * rate**2).sum())

    def start(self, impact_s: float) -> tuple[FloatArray, FloatArray]:
        """Return pose and velocities `impact_s` before the impact, shape (b, 3) each."""
        moved = self.motion(np.array([-impact_s]))
        return moved.pose[0], moved.rate[0]


class SteppedLaw(Law):
    """A law whose impact pymunk works out."""

    @abstractmethod
    def stage(self, impact_s: float) -> Stage:
        """Set pymunk up so that the bodies meet with the promised velocities at `impact_s`."""

    def run(self, clock: Clock, log_every: int | None = None) -> Run:
        """Simulate a clip step by step; log every frame, or every so many steps."""
        return run_stage(self.stage(clock.impact_s), clock, log_every)


def cross(arm: Vector | FloatArray, along: Vector | FloatArray) -> float:
    """Return the moment of a unit vector along a line through `arm`."""
    return float(arm[0] * along[1] - arm[1] * along[0])

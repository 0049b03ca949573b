"""Two free bodies on an air table: pucks, or a rod that is hit off its centre; no friction, no forces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pymunk

from vml_course.model.arrays import FloatArray
from vml_course.model.truth import Realised
from vml_course.synth.closed_form import free_mass
from vml_course.synth.law import Answer, Movement, SteppedLaw, cross
from vml_course.synth.run import Run
from vml_course.synth.stage import OVERLAP_M, Stage, Vector, add_bar, add_disc, add_free, make_space


@dataclass(frozen=True)
class Free:
    """A round body, or an upright bar.

    Attributes
    ----------
    mass_kg, inertia_kg_m2 : float
        About the centre.
    radius_m : float
        Of the disc, or half the width of the bar.
    velocity_m_s : (float, float)
        Before the impact.
    half_bar_m : float
        Half the length of the bar between the middles of its round ends; 0 for a disc.
    """

    mass_kg: float
    inertia_kg_m2: float
    radius_m: float
    velocity_m_s: Vector = (0.0, 0.0)
    half_bar_m: float = 0.0


@dataclass(frozen=True)
class FreeStrike(SteppedLaw):
    """The first body's centre is the world's origin at the impact; both keep their velocities but for the impact.

    Attributes
    ----------
    restitution : float
    first, second : Free
        The first may be a bar; the second is round.
    normal : (float, float)
        Unit vector of the contact, from the first to the second.
    asked : tuple of str
        What is looked for: `e`, and `I` (of the first about its centre) or `M` (of the first).
    offset_m : float
        Height above the bar's centre at which it is hit.
    """

    restitution: float
    first: Free
    second: Free
    normal: Vector
    asked: tuple[str, ...]
    offset_m: float = 0.0

    @property
    def about_m(self) -> Vector:  # type: ignore[override]
        """A point beside the line of the impact, so that there is something to keep."""
        return -self.normal[1], self.normal[0]

    @property
    def arm_m(self) -> float:
        """Lever arm of the normal about the first body's centre."""
        return cross((0.0, self.offset_m), self.normal)

    @property
    def mass(self) -> FloatArray:
        """Masses and inertias."""
        return np.array([[body.mass_kg, body.mass_kg, body.inertia_kg_m2] for body in (self.first, self.second)])

    @property
    def before(self) -> FloatArray:
        """Velocities before the impact; nothing turns."""
        return np.array([[*body.velocity_m_s, 0.0] for body in (self.first, self.second)])

    def answer(self) -> Answer:
        """Return the impact in closed form."""
        normal, before = np.array(self.normal), self.before
        impulse = (1 + self.restitution) * self._pair_mass() * float((before[0, :2] - before[1, :2]) @ normal)
        after = before.copy()
        after[0, :2] -= impulse / self.first.mass_kg * normal
        after[0, 2] -= self.arm_m * impulse / self.first.inertia_kg_m2
        after[1, :2] += impulse / self.second.mass_kg * normal
        return Answer(after, impulse * normal)

    def motion(self, time_s: FloatArray) -> Movement:
        """Return uniform motion before and after."""
        after = (time_s > 0)[:, None, None]
        rate = np.where(after, self.answer().after, self.before)
        return Movement(self._pose() + rate * time_s[:, None, None], rate)

    def potential(self, pose: FloatArray, *, after: bool) -> float:  # noqa: ARG002 - nothing acts
        """Return nothing: no forces act."""
        return 0.0

    def unknowns(self, run: Run) -> dict[str, Realised]:
        """Return what is asked for."""
        contact = run.met
        normal, a = contact.normal, cross(contact.point_m - contact.pose[0, :2], contact.normal)
        closing = [
            float((rate[0, :2] - rate[1, :2]) @ normal + a * rate[0, 2]) for rate in (contact.before, contact.after)
        ]
        change = contact.after - contact.before
        gained, lost = self.second.mass_kg * float(change[1, :2] @ normal), -float(change[0, :2] @ normal)
        impulse, turned = float(contact.impulse_N_s @ normal), -float(change[0, 2])
        real = {
            "e": (-closing[1] / closing[0], impulse / (self._pair_mass() * closing[0]) - 1.0, self.restitution),
            "M": (gained / lost, impulse / lost, self.first.mass_kg),
        }
        if turned:
            real["I"] = a * gained / turned, a * impulse / turned, self.first.inertia_kg_m2
        return {symbol: Realised(*real[symbol]) for symbol in self.asked}

    def stage(self, impact_s: float) -> Stage:
        """Set both bodies up in pymunk."""
        space, (pose, rate) = make_space(), self.start(impact_s)
        placed = zip((self.first, self.second), pose, rate, strict=True)
        bodies, skins = zip(*(_put(space, *one) for one in placed), strict=True)
        skins[0].elasticity = self.restitution
        return Stage(space, bodies, skins, (None, None), (None, None))

    def _pair_mass(self) -> float:
        first = self.first.mass_kg, self.first.inertia_kg_m2, self.arm_m
        return free_mass(first, (self.second.mass_kg, self.second.inertia_kg_m2, 0.0))

    def _pose(self) -> FloatArray:
        """Return where the bodies are at the impact."""
        gap = self.first.radius_m + self.second.radius_m - OVERLAP_M
        x, y = gap * self.normal[0], gap * self.normal[1] + self.offset_m
        return np.array([[0.0, 0.0, 0.0], [x, y, 0.0]])


def _put(space: pymunk.Space, body: Free, pose: FloatArray, rate: FloatArray) -> tuple[pymunk.Body, pymunk.Shape]:
    made = add_free(space, body.mass_kg, body.inertia_kg_m2, pose, rate)
    if body.half_bar_m:
        ends = (0.0, -body.half_bar_m), (0.0, body.half_bar_m)
        return made, add_bar(made, space, ends, body.radius_m)
    return made, add_disc(made, space, body.radius_m)

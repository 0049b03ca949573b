"""A pellet flies into a pendulum at rest and stays in it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.truth import Realised
from vml_course.synth.closed_form import glide, swing
from vml_course.synth.law import Answer, Movement, SteppedLaw
from vml_course.synth.run import Run
from vml_course.synth.stage import (
    GRAVITY_M_S2,
    OVERLAP_M,
    Push,
    Stage,
    Vector,
    add_disc,
    add_free,
    add_pinned,
    make_space,
)


@dataclass(frozen=True)
class Embedding(SteppedLaw):
    """The pivot is the world's origin; the pellet, a particle, stops straight below it and swings along from there.

    In pymunk it meets a stop without restitution; once its velocity is that of the place where it sits, the two
    become one body.

    Attributes
    ----------
    inertia_kg_m2 : float
        Of the pendulum alone, about the pivot.
    mass_kg, centre_m : float
        Of the pendulum, and how far its centre of mass hangs below the pivot.
    pellet_mass_kg, pellet_radius_m, pellet_speed_m_s : float
        The pellet flies level to the right at the impact.
    depth_m : float
        How far the pellet's line passes below the pivot.
    """

    inertia_kg_m2: float
    mass_kg: float
    centre_m: float
    pellet_mass_kg: float
    pellet_radius_m: float
    pellet_speed_m_s: float
    depth_m: float

    normal: Vector = (-1.0, 0.0)

    @property
    def arm_m(self) -> float:
        """Lever arm of the normal about the pivot: the impulse on the pellet turns clockwise."""
        return -self.depth_m

    @property
    def joined_kg_m2(self) -> float:
        """Inertia of pendulum and pellet together."""
        return self.inertia_kg_m2 + self.pellet_mass_kg * self.depth_m**2

    @property
    def mass(self) -> FloatArray:
        """The pendulum's inertia, and the pellet's mass."""
        return np.array([[0.0, 0.0, self.inertia_kg_m2], [self.pellet_mass_kg, self.pellet_mass_kg, 0.0]])

    @property
    def before(self) -> FloatArray:
        """The pendulum hangs still."""
        return np.array([[0.0, 0.0, 0.0], [self.pellet_speed_m_s, 0.0, 0.0]])

    def answer(self) -> Answer:
        """Return the impact in closed form: angular momentum about the pivot is kept."""
        omega = self.pellet_mass_kg * self.pellet_speed_m_s * self.depth_m / self.joined_kg_m2
        speed = omega * self.depth_m
        impulse = np.array([self.pellet_mass_kg * (speed - self.pellet_speed_m_s), 0.0])
        return Answer(np.array([[0.0, 0.0, omega], [speed, 0.0, omega]]), impulse)

    def torque(self, angle_rad: float, *, after: bool) -> float:
        """Return the torque of weight about the pivot, in N m."""
        moment = self.mass_kg * self.centre_m + after * self.pellet_mass_kg * self.depth_m
        return -moment * GRAVITY_M_S2 * math.sin(angle_rad)

    def motion(self, time_s: FloatArray) -> Movement:
        """Return the pellet's parabola and the swing of both."""
        first, later = time_s[time_s <= 0], time_s[time_s > 0]
        pose, rate = np.zeros((len(time_s), 2, 3)), np.zeros((len(time_s), 2, 3))
        way, velocity = glide(self.before[1, :2], np.array([0.0, -GRAVITY_M_S2]), first)
        pose[: len(first), 1, :2], rate[: len(first), 1, :2] = np.add(way, (0.0, -self.depth_m)), velocity
        omega = float(self.answer().after[0, 2])
        turn = swing(self.joined_kg_m2, lambda angle: self.torque(angle, after=True), (0.0, omega), later)
        for body in (0, 1):
            pose[len(first) :, body, 2], rate[len(first) :, body, 2] = turn.T
        sine, cosine = np.sin(turn[:, 0]), np.cos(turn[:, 0])
        pose[len(first) :, 1, :2] = self.depth_m * np.column_stack([sine, -cosine])
        rate[len(first) :, 1, :2] = self.depth_m * np.column_stack([cosine, sine]) * turn[:, 1:]
        return Movement(pose, rate)

    def potential(self, pose: FloatArray, *, after: bool) -> float:  # noqa: ARG002 - weight acts always
        """Return the energy of height of both."""
        risen = self.mass_kg * self.centre_m * (1.0 - math.cos(pose[0, 2]))
        return GRAVITY_M_S2 * (risen + self.pellet_mass_kg * float(pose[1, 1] + self.depth_m))

    def unknowns(self, run: Run) -> dict[str, Realised]:
        """Return the pendulum's inertia and the pellet's speed."""
        contact, m, d = run.met, self.pellet_mass_kg, self.depth_m
        v1, w2 = float(contact.before[1, 0]), float(contact.after[0, 2])
        lost = -float(contact.impulse_N_s[0])
        return {
            "I": Realised(m * d * v1 / w2 - m * d * d, d * lost / w2, self.inertia_kg_m2),
            "v1": Realised(self.joined_kg_m2 * w2 / (m * d), lost / m + w2 * d, self.pellet_speed_m_s),
        }

    def stage(self, impact_s: float) -> Stage:
        """Set pendulum and pellet up in pymunk."""
        space, (pose, rate) = make_space(), self.start(impact_s)
        bob = add_pinned(space, self.inertia_kg_m2, float(pose[0, 2]), float(rate[0, 2]))
        stop = add_disc(bob, space, self.pellet_radius_m, (2 * self.pellet_radius_m - OVERLAP_M, -self.depth_m))
        pellet = add_free(space, self.pellet_mass_kg, self.pellet_mass_kg * self.pellet_radius_m**2, pose[1], rate[1])
        skin = add_disc(pellet, space, self.pellet_radius_m)
        stop.elasticity = 0.0
        weight = (0.0, -self.pellet_mass_kg * GRAVITY_M_S2, 0.0)
        stage = Stage(
            space,
            (bob, pellet),
            (stop, skin),
            (self._push(after=False), lambda *_: weight),
            (self._push(after=True), None),
        )

        def join() -> None:
            space.remove(pellet, skin)
            bob.moment = self.joined_kg_m2
            stage.follow = follow

        def follow() -> None:
            at = (0.0, -self.depth_m)
            pellet.position, pellet.velocity = bob.local_to_world(at), bob.velocity_at_local_point(at)
            pellet.angle, pellet.angular_velocity = bob.angle, bob.angular_velocity

        stage.on_impact = join
        return stage

    def _push(self, *, after: bool) -> Push:
        return lambda angle, *_: (0.0, 0.0, self.torque(angle, after=after))

"""A body on a fixed pivot and a body that it strikes, or that strikes it: kicks, bats, hammers and doors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.truth import Realised
from vml_course.synth.closed_form import pair_mass, pinned_impact, swing
from vml_course.synth.law import Answer, Movement, SteppedLaw, cross
from vml_course.synth.laws.struck import Struck
from vml_course.synth.run import Contact, Run
from vml_course.synth.stage import GRAVITY_M_S2, Stage, Vector, add_bar, add_disc, add_pinned, make_space


@dataclass(frozen=True)
class PinnedStrike(SteppedLaw):
    """The pivot is the world's origin, angle 0 the pose at the impact; e and I are looked for.

    Signs: x right, y up, angles counter-clockwise.

    Attributes
    ----------
    inertia_kg_m2 : float
        About the pivot.
    restitution : float
    omega_before_rad_s : float
        Angular velocity at the impact; 0 for a door that waits.
    head_m : (float, float)
        Centre of the striking circle at angle 0, or of the part of a bar that is hit.
    head_radius_m : float
    normal : (float, float)
        Unit vector of the contact, from the pinned body to the other.
    other : Struck
    bar_m : ((float, float), (float, float)), optional
        Ends of a straight bar of half-width `head_radius_m`, at angle 0; without it the head is a circle.
    gravity_moment_N_m : float
        Weight times distance of the pinned body's true centre of mass, which hangs below the pivot at angle 0.
    drive_torque_N_m : float
        Constant torque, counter-clockwise.
    """

    inertia_kg_m2: float
    restitution: float
    omega_before_rad_s: float
    head_m: Vector
    head_radius_m: float
    normal: Vector
    other: Struck
    bar_m: tuple[Vector, Vector] | None = None
    gravity_moment_N_m: float = 0.0  # noqa: N815 - the unit is newton metre
    drive_torque_N_m: float = 0.0  # noqa: N815

    @property
    def arm_m(self) -> float:
        """Lever arm of the normal about the pivot."""
        return cross(self.head_m, self.normal)

    @property
    def ball_m(self) -> FloatArray:
        """Where the struck body is at the impact, shape (2,)."""
        return self.other.centre(self.head_m, self.head_radius_m, self.normal)

    @property
    def mass(self) -> FloatArray:
        """The pinned body's inertia, the other's mass."""
        other = self.other
        turning = 0.0 if other.flat_m else other.inertia_kg_m2
        return np.array([[0.0, 0.0, self.inertia_kg_m2], [other.mass_kg, other.mass_kg, turning]])

    @property
    def before(self) -> FloatArray:
        """Velocities before the impact."""
        return np.array([[0.0, 0.0, self.omega_before_rad_s], [*self.other.velocity_m_s, 0.0]])

    def answer(self) -> Answer:
        """Return the impact in closed form."""
        normal = np.array(self.normal)
        J, w2, _ = pinned_impact(  # noqa: N806 - textbook letters
            self.inertia_kg_m2,
            self.other.mass_kg,
            self.arm_m,
            self.restitution,
            self.omega_before_rad_s,
            float(np.dot(self.other.velocity_m_s, normal)),
        )
        after = self.other.velocity_m_s + J / self.other.mass_kg * normal
        return Answer(np.array([[0.0, 0.0, w2], [*after, 0.0]]), J * normal)

    def torque(self, angle_rad: float) -> float:
        """Return the torque about the pivot of weight and drive, in N m."""
        return self.drive_torque_N_m - self.gravity_moment_N_m * math.sin(angle_rad)

    def motion(self, time_s: FloatArray) -> Movement:
        """Return swing and flight."""
        sides = time_s[time_s <= 0], time_s[time_s > 0]
        rates, pose, rate = (self.before, self.answer().after), [], []
        for after, (time, known) in enumerate(zip(sides, rates, strict=True)):
            turn = self._swing(float(known[0, 2]), time)
            way, velocity = self.other.glide(known[1, :2], time, after=bool(after))
            still, zero = np.zeros((len(time), 2)), np.zeros(len(time))
            places = np.column_stack([still, turn[:, 0], self.ball_m + way, zero])
            pose.append(places.reshape(-1, 2, 3))
            rate.append(np.column_stack([still, turn[:, 1], velocity, zero]).reshape(-1, 2, 3))
        return Movement(np.concatenate(pose), np.concatenate(rate))

    def _swing(self, omega_rad_s: float, time_s: FloatArray) -> FloatArray:
        """Return angle and angular velocity; times lie on one side of the impact, ascending."""
        away = slice(None, None, -1) if len(time_s) and time_s[0] < 0 else slice(None)
        return swing(self.inertia_kg_m2, self.torque, (0.0, omega_rad_s), time_s[away])[away]

    def potential(self, pose: FloatArray, *, after: bool) -> float:
        """Return the work of weights, drive and friction since the impact."""
        angle = float(pose[0, 2])
        lifted = self.gravity_moment_N_m * (1.0 - math.cos(angle)) - self.drive_torque_N_m * angle
        return lifted + self.other.potential(pose[1, :2] - self.ball_m, after=after)

    def unknowns(self, run: Run) -> dict[str, Realised]:
        """Return e and I, and the friction of a block that slides."""
        contact = run.met
        found = self._impact_unknowns(contact)
        if self.other.friction:
            slid = float(np.hypot(*(run.pose[-1, 1, :2] - contact.pose[1, :2])))
            end, first = run.end[1, :2] @ run.end[1, :2], contact.after[1, :2]
            given = contact.impulse_N_s / self.other.mass_kg + contact.before[1, :2]
            real = [float(v @ v - end) / (2 * GRAVITY_M_S2 * slid) for v in (first, given)]
            found["mu"] = Realised(real[0], real[1], self.other.friction)
        return found

    def _impact_unknowns(self, contact: Contact) -> dict[str, Realised]:
        m, normal = self.other.mass_kg, contact.normal
        a = cross(contact.point_m, normal)
        w1, w2 = contact.before[0, 2], contact.after[0, 2]
        u1, u2 = contact.before[1, :2] @ normal, contact.after[1, :2] @ normal
        impulse, approach = contact.impulse_N_s @ normal, a * w1 - u1
        e = (u2 - a * w2) / approach, impulse / (pair_mass(self.inertia_kg_m2, m, a) * approach) - 1.0
        inertia = m * a * (u2 - u1) / (w1 - w2), a * impulse / (w1 - w2)
        return {
            "e": Realised(float(e[0]), float(e[1]), self.restitution),
            "I": Realised(float(inertia[0]), float(inertia[1]), self.inertia_kg_m2),
        }

    def stage(self, impact_s: float) -> Stage:
        """Set the strike up in pymunk."""
        space, (pose, rate) = make_space(), self.start(impact_s)
        body = add_pinned(space, self.inertia_kg_m2, float(pose[0, 2]), float(rate[0, 2]))
        if self.bar_m:
            head = add_bar(body, space, self.bar_m, self.head_radius_m)
        else:
            head = add_disc(body, space, self.head_radius_m, self.head_m)
        head.elasticity = self.restitution
        other, skin = self.other.put(space, pose[1], rate[1])
        before, after = self.other.pushes()
        return Stage(space, (body, other), (head, skin), (self._push, before), (self._push, after))

    def _push(self, angle_rad: float, *_: object) -> tuple[float, float, float]:
        return 0.0, 0.0, self.torque(angle_rad)

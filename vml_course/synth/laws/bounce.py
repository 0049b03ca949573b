"""A ball that spins meets level ground obliquely: restitution along the normal, Coulomb friction across it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.truth import Realised
from vml_course.synth.closed_form import Bounce, glide, rough_bounce
from vml_course.synth.law import Answer, Movement, SteppedLaw
from vml_course.synth.run import Run
from vml_course.synth.stage import GRAVITY_M_S2, OVERLAP_M, Stage, Vector, add_bar, add_disc, add_free, make_space

WIDE_M = 50.0  # of the ground, either way


@dataclass(frozen=True)
class GroundBounce(SteppedLaw):
    """The point of the contact is the world's origin, the ground level; the normal points up.

    Where the ball slips throughout, friction is found from the impulse; where its skin comes to rest on the
    ground, only that it does (a tangential restitution of 0).

    Attributes
    ----------
    mass_kg, radius_m : float
    gyration : float
        The ball's inertia is `gyration * mass * radius²`.
    restitution, friction : float
    velocity_m_s : (float, float)
        Of the centre at the impact, downwards.
    spin_rad_s : float
        Counter-clockwise.
    """

    mass_kg: float
    radius_m: float
    gyration: float
    restitution: float
    friction: float
    velocity_m_s: Vector
    spin_rad_s: float

    normal: Vector = (0.0, 1.0)
    struck: int = 0
    about_m: Vector = (0.0, -OVERLAP_M)  # the ball's lowest point, where friction acts

    @property
    def arm_m(self) -> float:
        """Nothing: the normal passes through the ball's centre."""
        return 0.0

    @property
    def mass(self) -> FloatArray:
        """The ball's mass and inertia."""
        return np.array([[self.mass_kg, self.mass_kg, self.gyration * self.mass_kg * self.radius_m**2]])

    @property
    def before(self) -> FloatArray:
        """Velocity and spin before the impact."""
        return np.array([[*self.velocity_m_s, self.spin_rad_s]])

    @property
    def slip_m_s(self) -> float:
        """Velocity of the lowest point along the ground, before the impact."""
        return self.velocity_m_s[0] + self.radius_m * self.spin_rad_s

    def bounce(self) -> Bounce:
        """Return the impulses in closed form."""
        speed = -self.velocity_m_s[1]
        return rough_bounce(self.mass_kg, self.gyration, self.restitution, self.friction, speed, self.slip_m_s)

    def answer(self) -> Answer:
        """Return the impact in closed form."""
        normal, tangent, _ = self.bounce()
        impulse = np.array([tangent, normal])
        after = self.before + np.array([[tangent, normal, self.radius_m * tangent]]) / self.mass
        return Answer(after, impulse)

    def motion(self, time_s: FloatArray) -> Movement:
        """Return both parabolas, with uniform spin."""
        pose, rate = np.zeros((len(time_s), 1, 3)), np.zeros((len(time_s), 1, 3))
        for side, known in ((time_s <= 0, self.before[0]), (time_s > 0, self.answer().after[0])):
            way, rate[side, 0, :2] = glide(known[:2], np.array([0.0, -GRAVITY_M_S2]), time_s[side])
            pose[side, 0, :2], pose[side, 0, 2] = way + self._centre(), known[2] * time_s[side]
            rate[side, 0, 2] = known[2]
        return Movement(pose, rate)

    def potential(self, pose: FloatArray, *, after: bool) -> float:  # noqa: ARG002 - weight acts always
        """Return the energy of height."""
        return self.mass_kg * GRAVITY_M_S2 * float(pose[0, 1] - self._centre()[1])

    def unknowns(self, run: Run) -> dict[str, Realised]:
        """Return e, and friction where the ball slips throughout, or else the tangential restitution."""
        contact, k, R = run.met, self.gyration, self.radius_m  # noqa: N806 - textbook letters
        (vx, vy, w), (ux, uy, s) = contact.before[0], contact.after[0]
        across, along = contact.impulse_N_s
        slips = float(vx + R * w), float(ux + R * s)
        found = {"e": Realised(float(-uy / vy), float(-along / (self.mass_kg * vy)) - 1.0, self.restitution)}
        if self.bounce().sticks:
            by_impulse = slips[0] + float(across) / self.mass_kg * (1 + 1 / k)
            return found | {"e_t": Realised(-slips[1] / slips[0], -by_impulse / slips[0], 0.0)}
        real = abs(float((ux - vx) / (uy - vy))), abs(float(across / along))
        return found | {"mu": Realised(real[0], real[1], self.friction)}

    def stage(self, impact_s: float) -> Stage:
        """Set ball and ground up in pymunk."""
        space, (pose, rate) = make_space(), self.start(impact_s)
        ground = add_bar(space.static_body, space, ((-WIDE_M, -1.0), (WIDE_M, -1.0)), 1.0)
        ball = add_free(space, self.mass_kg, float(self.mass[0, 2]), pose[0], rate[0])
        skin = add_disc(ball, space, self.radius_m)
        ground.elasticity, ground.friction, skin.friction = self.restitution, self.friction, 1.0
        weight = (0.0, -self.mass_kg * GRAVITY_M_S2, 0.0)

        def push(*_: object) -> tuple[float, float, float]:
            return weight

        return Stage(space, (ball,), (ground, skin), (push,), (push,))

    def _centre(self) -> FloatArray:
        return np.array([0.0, self.radius_m - OVERLAP_M])

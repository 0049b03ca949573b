"""A scene set up in pymunk for one simulation: a pinned striker and a body that it strikes.

How pymunk must be set up to be exact (each of these was measured):

- The striker's centre of mass is put at the pivot and the body is made heavy; only its inertia about the
  pivot matters then, and the joint has nothing to correct. Gravity and muscles act as a torque of ours.
- Elasticity multiplies, so e stands on one shape and 1 on the other. Friction is zero.
- `collision_slop` is in metres and generous: pymunk then never pushes bodies apart behind the physics' back.
- Shapes carry no mass: it would overrule the body's own mass and inertia.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pymunk

from vml_course.model.arrays import FloatArray
from vml_course.synth.closed_form import Torque, swing

HEAVY_KG = 1.0e4
OVERLAP_M = 1.0e-7  # makes sure that pymunk sees the contact in the very step that was aimed at
GRAVITY_M_S2 = 9.81


@dataclass(frozen=True)
class PinnedStrike:
    """A body on a fixed pivot with a round head that strikes a ball; angle 0 is the pose at the impact.

    The pivot is the world's origin. Signs: x right, y up, angles counter-clockwise.

    Attributes
    ----------
    inertia_kg_m2 : float
        About the pivot.
    restitution : float
    omega_before_rad_s : float
        Angular velocity at the impact.
    head_m : (float, float)
        Centre of the striking circle at angle 0.
    head_radius_m : float
    normal : (float, float)
        Unit vector of the contact, from striker to ball.
    ball_mass_kg, ball_radius_m, ball_gyration : float
        The ball's inertia is `ball_gyration * mass * radius²` (2/3 for a thin shell).
    gravity_moment_N_m : float
        Weight times distance of the striker's true centre of mass, which hangs below the pivot at angle 0.
    drive_torque_N_m : float
        Constant torque, counter-clockwise.
    """

    inertia_kg_m2: float
    restitution: float
    omega_before_rad_s: float
    head_m: tuple[float, float]
    head_radius_m: float
    normal: tuple[float, float]
    ball_mass_kg: float
    ball_radius_m: float
    ball_gyration: float = 2 / 3
    gravity_moment_N_m: float = 0.0  # noqa: N815 - the unit is newton metre
    drive_torque_N_m: float = 0.0  # noqa: N815

    @property
    def arm_m(self) -> float:
        """Lever arm of the normal about the pivot, the cross product of contact point and normal."""
        return self.head_m[0] * self.normal[1] - self.head_m[1] * self.normal[0]

    @property
    def ball_m(self) -> FloatArray:
        """Where the ball rests: it touches the head at angle 0, a hair deep."""
        gap = self.head_radius_m + self.ball_radius_m - OVERLAP_M
        return np.asarray(np.array(self.head_m) + gap * np.array(self.normal))

    def torque(self, angle_rad: float) -> float:
        """Return the torque about the pivot of weight and drive, in N m."""
        return self.drive_torque_N_m - self.gravity_moment_N_m * float(np.sin(angle_rad))

    def energy(self, angle_rad: float, omega_rad_s: float) -> float:
        """Return kinetic and potential energy of the striker, in J."""
        potential = -self.gravity_moment_N_m * float(np.cos(angle_rad)) - self.drive_torque_N_m * angle_rad
        return 0.5 * self.inertia_kg_m2 * omega_rad_s**2 + potential


@dataclass
class Stage:
    """What pymunk needs for one simulation; never stored.

    Attributes
    ----------
    space : pymunk.Space
    striker, struck : pymunk.Body
        The moving bodies, in the order of `Truth.bodies`.
    head, ball : pymunk.Shape
        The shapes of the two that may meet.
    torque : callable
        On the striker, N m, as a function of its angle.
    weight_N : (float, float)
        On the ball once it is struck; until then a tee holds it.
    """

    space: pymunk.Space
    striker: pymunk.Body
    struck: pymunk.Body
    head: pymunk.Shape
    ball: pymunk.Shape
    torque: Torque
    weight_N: tuple[float, float]  # noqa: N815 - the unit is newton


def pinned_stage(strike: PinnedStrike, impact_s: float) -> Stage:
    """Set up a strike so that the bodies meet at angle 0, with the promised velocity, at `impact_s`."""
    space = pymunk.Space()
    space.iterations, space.gravity, space.collision_slop, space.collision_bias = 30, (0, 0), 0.1, 1.0
    striker, head = _striker(space, strike)
    ball = pymunk.Body(strike.ball_mass_kg, strike.ball_gyration * strike.ball_mass_kg * strike.ball_radius_m**2)
    ball.position = tuple(strike.ball_m)
    skin = pymunk.Circle(ball, strike.ball_radius_m)
    skin.elasticity, skin.friction = 1.0, 0.0
    space.add(ball, skin)
    start = swing(
        strike.inertia_kg_m2, strike.torque, (0.0, strike.omega_before_rad_s), np.array([-impact_s / 2, -impact_s])
    )
    striker.angle, striker.angular_velocity = start[-1].tolist()
    weight = (0.0, -strike.ball_mass_kg * GRAVITY_M_S2)
    return Stage(space, striker, ball, head, skin, strike.torque, weight)


def _striker(space: pymunk.Space, strike: PinnedStrike) -> tuple[pymunk.Body, pymunk.Shape]:
    body = pymunk.Body(HEAVY_KG, strike.inertia_kg_m2)
    head = pymunk.Circle(body, strike.head_radius_m, strike.head_m)
    head.elasticity, head.friction = strike.restitution, 0.0
    pin = pymunk.PivotJoint(space.static_body, body, (0, 0), (0, 0))
    pin.error_bias = 0
    space.add(body, head, pin)
    return body, head

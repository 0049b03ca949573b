"""A scene set up in pymunk for one simulation.

How pymunk must be set up to be exact (each of these was measured):

- A pinned body's centre of mass is put at its pivot and the body is made heavy; only its inertia about the
  pivot matters then, and the joint has nothing to correct. Gravity and muscles act as a torque of ours.
- Elasticity multiplies, so e stands on one shape and 1 on the other; friction likewise.
- `collision_slop` is in metres and generous: pymunk then never pushes bodies apart behind the physics' back.
- Shapes carry no mass: it would overrule the body's own mass and inertia.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import pymunk

from vml_course.model.arrays import FloatArray

HEAVY_KG = 1.0e4
OVERLAP_M = 1.0e-7  # makes sure that pymunk sees the contact in the very step that was aimed at
GRAVITY_M_S2 = 9.81

Vector = tuple[float, float]
Push = Callable[[float, Vector, float], tuple[float, float, float]]
"""Force in N and torque in N m on a body, from its angle in rad, its velocity in m/s, and the step in s."""


@dataclass
class Stage:
    """What pymunk needs for one simulation; never stored.

    Attributes
    ----------
    space : pymunk.Space
    bodies : tuple of pymunk.Body
        The moving bodies, in the order of `Truth.bodies`.
    pair : (pymunk.Shape, pymunk.Shape)
        The shapes that may meet; the normal points from the first to the second.
    before, after : tuple of Push or None
        What acts on each body until the impact, and after it.
    on_impact : callable, optional
        Called at the end of the step of the impact: joins bodies.
    follow : callable, optional
        Called before states are read: puts bodies where those are that carry them.
    """

    space: pymunk.Space
    bodies: tuple[pymunk.Body, ...]
    pair: tuple[pymunk.Shape, pymunk.Shape]
    before: Sequence[Push | None]
    after: Sequence[Push | None]
    on_impact: Callable[[], None] | None = None
    follow: Callable[[], None] | None = None


def make_space() -> pymunk.Space:
    """Return an empty space that is exact."""
    space = pymunk.Space()
    space.iterations, space.gravity, space.collision_slop, space.collision_bias = 30, (0, 0), 0.1, 1.0
    return space


def add_pinned(space: pymunk.Space, inertia_kg_m2: float, angle_rad: float, omega_rad_s: float) -> pymunk.Body:
    """Add a body on a pivot at the world's origin."""
    body = pymunk.Body(HEAVY_KG, inertia_kg_m2)
    body.angle, body.angular_velocity = angle_rad, omega_rad_s
    pin = pymunk.PivotJoint(space.static_body, body, (0, 0), (0, 0))
    pin.error_bias = 0
    space.add(body, pin)
    return body


def add_free(
    space: pymunk.Space, mass_kg: float, inertia_kg_m2: float, pose: FloatArray, rate: FloatArray
) -> pymunk.Body:
    """Add a body that nothing holds; `inertia_kg_m2` may be infinite. Pose and rate have shape (3,)."""
    body = pymunk.Body(mass_kg, inertia_kg_m2)
    x, y, body.angle = pose.tolist()
    u, v, body.angular_velocity = rate.tolist()
    body.position, body.velocity = (x, y), (u, v)
    space.add(body)
    return body


def add_disc(body: pymunk.Body, space: pymunk.Space, radius_m: float, at_m: Vector = (0.0, 0.0)) -> pymunk.Shape:
    """Add a round skin; elasticity 1, friction 0."""
    return _add(space, pymunk.Circle(body, radius_m, at_m))


def add_bar(body: pymunk.Body, space: pymunk.Space, ends_m: tuple[Vector, Vector], radius_m: float) -> pymunk.Shape:
    """Add a straight skin with round ends: what is nearer to the line between two points than a radius."""
    return _add(space, pymunk.Segment(body, *ends_m, radius_m))


def _add(space: pymunk.Space, skin: pymunk.Shape) -> pymunk.Shape:
    skin.elasticity, skin.friction = 1.0, 0.0
    space.add(skin)
    return skin

"""The body that is struck: a ball on a tee or in flight, a puck, a block that slides and stops."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pymunk

from vml_course.model.arrays import FloatArray
from vml_course.synth.closed_form import glide
from vml_course.synth.stage import GRAVITY_M_S2, OVERLAP_M, Push, Vector, add_bar, add_disc, add_free


@dataclass(frozen=True)
class Struck:
    """A body under a constant force before the impact, and another after it.

    Attributes
    ----------
    mass_kg, radius_m : float
    gyration : float
        A ball's inertia is `gyration * mass * radius²` (2/3 for a thin shell).
    velocity_m_s : (float, float)
        At the impact.
    weight_before, weight_after : float
        Which part of its weight acts: none on a tee or an air table.
    friction : float
        Of a block that slides after the impact, until it stops.
    flat_m : float
        Half the height of a block's upright face, `radius_m` away from its centre; it does not turn. 0: a ball.
    """

    mass_kg: float
    radius_m: float
    gyration: float = 2 / 3
    velocity_m_s: Vector = (0.0, 0.0)
    weight_before: float = 0.0
    weight_after: float = 0.0
    friction: float = 0.0
    flat_m: float = 0.0

    def centre(self, from_m: Vector, gap_m: float, normal: Vector) -> FloatArray:
        """Return the centre at the impact, a hair deep, `gap_m` and its own radius away from a point."""
        return np.asarray(np.array(from_m) + (gap_m + self.radius_m - OVERLAP_M) * np.array(normal))

    @property
    def inertia_kg_m2(self) -> float:
        """About its centre; infinite for a block."""
        return math.inf if self.flat_m else self.gyration * self.mass_kg * self.radius_m**2

    def glide(self, velocity_m_s: FloatArray, time_s: FloatArray, *, after: bool) -> tuple[FloatArray, FloatArray]:
        """Return way since the impact and velocity, shape (n, 2) each."""
        if after and self.friction:
            speed = float(np.hypot(*velocity_m_s)) or 1.0
            return glide(velocity_m_s, -self.friction * GRAVITY_M_S2 / speed * velocity_m_s, time_s, stops=True)
        part = self.weight_after if after else self.weight_before
        return glide(velocity_m_s, np.array([0.0, -part * GRAVITY_M_S2]), time_s)

    def potential(self, shift_m: FloatArray, *, after: bool) -> float:
        """Return the work that weight or friction has taken over a way from the impact, in J."""
        if after and self.friction:
            return self.friction * self.mass_kg * GRAVITY_M_S2 * float(np.hypot(*shift_m))
        part = self.weight_after if after else self.weight_before
        return part * self.mass_kg * GRAVITY_M_S2 * float(shift_m[1])

    def pushes(self) -> tuple[Push | None, Push | None]:
        """Return what acts on it before and after the impact."""
        after = self._friction if self.friction else _weight(self.weight_after * self.mass_kg)
        return _weight(self.weight_before * self.mass_kg), after

    def put(self, space: pymunk.Space, pose: FloatArray, rate: FloatArray) -> tuple[pymunk.Body, pymunk.Shape]:
        """Add body and skin to a space."""
        body = add_free(space, self.mass_kg, self.inertia_kg_m2, pose, rate)
        if self.flat_m:
            return body, add_bar(body, space, ((0.0, -self.flat_m), (0.0, self.flat_m)), self.radius_m)
        return body, add_disc(body, space, self.radius_m)

    def _friction(self, _: float, velocity: Vector, step_s: float) -> tuple[float, float, float]:
        speed = math.hypot(*velocity)
        slowing = min(self.friction * GRAVITY_M_S2, speed / step_s) / (speed or 1.0)
        return -self.mass_kg * slowing * velocity[0], -self.mass_kg * slowing * velocity[1], 0.0


def _weight(mass_kg: float) -> Push | None:
    if not mass_kg:
        return None
    force = (0.0, -mass_kg * GRAVITY_M_S2, 0.0)
    return lambda *_: force

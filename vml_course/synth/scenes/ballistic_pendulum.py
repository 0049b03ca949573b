"""A ball flies into a hanging catcher, stays there, and both swing up."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.errors import InputError
from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.synth.bodies import CATCHER_HUB_M, Catcher
from vml_course.synth.laws.embed import Embedding
from vml_course.synth.scene import Marker
from vml_course.synth.views import SideView

MARK_BELOW_BALL_M = 0.045


@dataclass(frozen=True)
class BallisticPendulum(SideView):
    """The pivot is the world's origin; the ball stops straight below it, `arm_m` deep."""

    name: ClassVar[str] = "ballistic_pendulum"
    title: ClassVar[str] = "A ball flies into a hanging catcher and stays there"
    model: ClassVar[str] = "ballistic-pendulum"
    story: ClassVar[str] = (
        "A launcher shoots a tennis ball level into a catcher that hangs still from a pivot. The ball sticks in the "
        "putty straight below the pivot (e = 0), and both swing up. You know the ball's mass m, the distance d from "
        "the pivot to the ball's line, the catcher's mass M and the distance c from the pivot to its centre of mass. "
        "Find the catcher's inertia I about the pivot from the angular momentum, and the ball's speed v1 from the "
        "rise of both by energy; compare it with the speed that the film shows. How much energy is lost in the "
        "impact?"
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "I": "the catcher's inertia about the pivot, without the ball",
        "v1": "speed of the ball before the impact",
    }
    default_camera: ClassVar[Camera] = Camera(px_per_m=1000.0, origin_x_px=680.0, origin_y_px=90.0)
    bodies: ClassVar[tuple[str, ...]] = ("pendulum", "pellet")
    vector: ClassVar[tuple[str, str] | None] = ("pivot", "bob")
    seen_s: ClassVar[float] = math.inf

    time_after_s: float = quantity(0.34, "s", 0.04, 0.5, about="time shown after the impact")
    inertia_kg_m2: float = quantity(
        0.075, "kg m^2", 0.005, 1.0, symbol="I", about="the catcher's inertia about the pivot"
    )
    mass_kg: float = quantity(0.8, "kg", 0.1, 5.0, symbol="M", about="mass of the catcher")
    centre_m: float = quantity(
        0.28, "m", 0.1, 0.5, symbol="c", about="distance from the pivot to the catcher's centre of mass"
    )
    pellet_mass_kg: float = quantity(0.058, "kg", 0.01, 0.3, symbol="m", about="mass of the ball")
    arm_m: float = quantity(0.33, "m", 0.2, 0.5, symbol="d", about="distance from the pivot to the ball's line")
    pellet_speed_m_s: float = quantity(10.0, "m/s", 2.0, 25.0, symbol="v1", about="speed of the ball")
    pellet_radius_m: float = quantity(0.033, "m", 0.015, 0.04, about="radius of the ball")

    def __post_init__(self) -> None:
        super().__post_init__()
        least = self.mass_kg * self.centre_m**2
        if self.inertia_kg_m2 < least:
            wanted = f"at least M c^2, {least:.4g} kg m^2"
            raise InputError("inertia_kg_m2 (I)", wanted, f"{self.inertia_kg_m2:g} kg m^2")

    def law(self) -> Embedding:
        """Return the physics in numbers."""
        return Embedding(
            inertia_kg_m2=self.inertia_kg_m2,
            mass_kg=self.mass_kg,
            centre_m=self.centre_m,
            pellet_mass_kg=self.pellet_mass_kg,
            pellet_radius_m=self.pellet_radius_m,
            pellet_speed_m_s=self.pellet_speed_m_s,
            depth_m=self.arm_m,
        )

    def markers(self) -> tuple[Marker, ...]:
        """Return the mark below the tunnel, the pivot, and the ball's centre."""
        catcher = self.catcher
        return (
            Marker("bob", "pendulum", (0.0, -self.arm_m - catcher.mark_m), catcher.card_m),
            Marker("pivot", "pendulum", (0.0, 0.0), CATCHER_HUB_M),
            Marker("pellet", "pellet", (0.0, 0.0), self.pellet_radius_m),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 50 cm bar on the floor."""
        height = -(self.catcher.bottom_m + 0.12)
        return {"bar_left": (-0.25, height), "bar_right": (0.25, height)}

    def given(self) -> dict[str, float]:
        """Return the masses, the arm of the ball's line, and where the catcher's centre of mass is."""
        return {"m": self.pellet_mass_kg, "d": self.arm_m, "M": self.mass_kg, "c": self.centre_m}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked, and that the ball flies before the impact."""
        return {"striker": "bob", "struck": "pellet", "knee": "pivot", "flight": "always", "drive": "none"}

    @property
    def catcher(self) -> Catcher:
        """Sizes of the catcher."""
        return Catcher(self.arm_m, self.pellet_radius_m, 1.2 * self.pellet_radius_m + MARK_BELOW_BALL_M)

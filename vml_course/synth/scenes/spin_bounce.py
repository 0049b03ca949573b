"""A ball with spin meets the floor obliquely."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.errors import InputError
from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.synth.laws.bounce import GroundBounce
from vml_course.synth.scene import Marker
from vml_course.synth.views import SideView

RIM_AT = 0.6  # of the radius
STILL_SLIP_M_S = 0.05


@dataclass(frozen=True)
class SpinBounce(SideView):
    """The point of the contact is the world's origin; the ball comes from the left."""

    name: ClassVar[str] = "spin_bounce"
    title: ClassVar[str] = "A ball with spin bounces off the floor, with friction"
    model: ClassVar[str] = "spin-bounce"
    story: ClassVar[str] = (
        "A basketball with backspin comes down on the floor obliquely. While it touches, the floor pushes it up and "
        "rubs along it. You know the ball's mass m, its radius R and the factor k of its inertia, I = k m R^2. From "
        "the motion of its centre and of the mark near its rim, find the coefficient of restitution e of the normal "
        "velocities and the coefficient of friction mu; check first that the ball slips to the end of the contact, "
        "for where it sticks only the tangential restitution can be found."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "e": "coefficient of restitution of the normal velocities",
        "mu": "coefficient of friction between ball and floor, where the ball slips throughout",
        "e_t": "restitution of the tangential velocities, where the ball sticks",
    }
    default_camera: ClassVar[Camera] = Camera(px_per_m=900.0, origin_x_px=560.0, origin_y_px=580.0)
    bodies: ClassVar[tuple[str, ...]] = ("ball",)
    vector: ClassVar[tuple[str, str] | None] = ("ball", "rim")

    time_before_s: float = quantity(0.07, "s", 0.04, 0.15, about="time shown before the impact")
    time_after_s: float = quantity(0.09, "s", 0.04, 0.15, about="time shown after the impact")
    restitution: float = quantity(0.78, "", 0.05, 1.0, symbol="e", about="coefficient of restitution, normal")
    friction: float = quantity(0.2, "", 0.02, 1.5, symbol="mu", about="coefficient of friction of ball and floor")
    ball_mass_kg: float = quantity(0.6, "kg", 0.03, 2.0, symbol="m", about="mass of the ball")
    ball_radius_m: float = quantity(0.12, "m", 0.04, 0.16, symbol="R", about="radius of the ball")
    gyration: float = quantity(2 / 3, "", 0.4, 0.7, symbol="k", about="the ball's inertia as a part of m R^2")
    speed_m_s: float = quantity(5.2, "m/s", 1.0, 12.0, symbol="v", about="speed of the centre at the impact")
    incidence_deg: float = quantity(34.0, "deg", -60.0, 60.0, about="angle of the centre's velocity from the normal")
    spin_rad_s: float = quantity(
        28.0, "rad/s", -150.0, 150.0, symbol="omega1", about="spin before the impact, counter-clockwise"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        slip = self.law().slip_m_s
        if abs(slip) < STILL_SLIP_M_S:
            least, got = f"a slip of at least {STILL_SLIP_M_S:g} m/s on the floor", f"{slip:.3g} m/s"
            raise InputError("spin_rad_s (omega1)", least, got, "Change the spin or the incidence.")

    def law(self) -> GroundBounce:
        """Return the physics in numbers."""
        angle = math.radians(self.incidence_deg)
        return GroundBounce(
            mass_kg=self.ball_mass_kg,
            radius_m=self.ball_radius_m,
            gyration=self.gyration,
            restitution=self.restitution,
            friction=self.friction,
            velocity_m_s=(self.speed_m_s * math.sin(angle), -self.speed_m_s * math.cos(angle)),
            spin_rad_s=self.spin_rad_s,
        )

    def markers(self) -> tuple[Marker, ...]:
        """Return the mark near the rim and the centre."""
        mark = RIM_AT * self.ball_radius_m
        return (
            Marker("rim", "ball", (mark, 0.0), self.ball_radius_m - mark),
            Marker("ball", "ball", (0.0, 0.0), self.ball_radius_m),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 1 m bar on the floor."""
        return {"bar_left": (-0.5, -0.09), "bar_right": (0.5, -0.09)}

    def given(self) -> dict[str, float]:
        """Return mass, radius and inertia factor of the ball."""
        return {"m": self.ball_mass_kg, "R": self.ball_radius_m, "k": self.gyration}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked, and that the ball flies before the impact too."""
        return {"striker": "rim", "struck": "ball", "flight": "always"}

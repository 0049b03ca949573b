"""A bat on a batting rig meets a softball that flies towards it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.synth.bodies import BAT_CLAMP_M
from vml_course.synth.laws.pinned import PinnedStrike
from vml_course.synth.laws.struck import Struck
from vml_course.synth.scene import Marker
from vml_course.synth.views import SideView

BAR_BELOW_BARREL_M = 0.18


@dataclass(frozen=True)
class BatAndBall(SideView):
    """The pivot of the rig, where the hands would be, is the world's origin; the bat hangs down at the impact."""

    name: ClassVar[str] = "bat_and_ball"
    title: ClassVar[str] = "A bat that swings about the hands hits an incoming ball"
    model: ClassVar[str] = "fixed-pivot"
    story: ClassVar[str] = (
        "A rig swings a bat about its handle, downwards like a pendulum, into a softball that is pitched at it. You "
        "know the ball's mass m and the distance L from the pivot to the point of the barrel that hits. Mind the "
        "sign of the incoming ball's velocity: from the motion of barrel and ball before and after the impact, find "
        "the coefficient of restitution e and the bat's inertia I about the pivot."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "e": "coefficient of restitution",
        "I": "the bat's inertia about the pivot",
    }
    default_camera: ClassVar[Camera] = Camera(px_per_m=720.0, origin_x_px=520.0, origin_y_px=80.0)
    bodies: ClassVar[tuple[str, ...]] = ("bat", "ball")
    vector: ClassVar[tuple[str, str] | None] = ("hands", "barrel")

    restitution: float = quantity(0.5, "", 0.05, 1.0, symbol="e", about="coefficient of restitution")
    inertia_kg_m2: float = quantity(0.25, "kg m^2", 0.05, 1.0, symbol="I", about="the bat's inertia about the pivot")
    ball_mass_kg: float = quantity(0.19, "kg", 0.04, 0.5, symbol="m", about="mass of the ball")
    barrel_distance_m: float = quantity(
        0.62, "m", 0.4, 0.8, symbol="L", about="distance from the pivot to the point of the barrel that hits"
    )
    ball_diameter_m: float = quantity(0.097, "m", 0.06, 0.12, symbol="D", about="diameter of the ball")
    omega_before_rad_s: float = quantity(
        20.0, "rad/s", 3.0, 45.0, symbol="omega1", about="the bat's angular velocity at the impact"
    )
    ball_speed_m_s: float = quantity(8.0, "m/s", 0.0, 40.0, symbol="v", about="speed of the ball towards the bat")
    barrel_radius_m: float = quantity(0.034, "m", 0.025, 0.045, about="radius of the barrel where it hits")
    normal_tilt_deg: float = quantity(
        0.0, "deg", -5.0, 5.0, about="tilt of the contact normal from the barrel's velocity"
    )
    gravity_moment_N_m: float = quantity(  # noqa: N815 - the unit is newton metre
        4.0, "N m", 0.0, 20.0, about="the bat's weight times its centre of mass's distance from the pivot"
    )
    drive_torque_N_m: float = quantity(0.0, "N m", -100.0, 100.0, about="constant torque of the rig")  # noqa: N815

    def law(self) -> PinnedStrike:
        """Return the physics in numbers."""
        tilt = math.radians(self.normal_tilt_deg)
        return PinnedStrike(
            inertia_kg_m2=self.inertia_kg_m2,
            restitution=self.restitution,
            omega_before_rad_s=self.omega_before_rad_s,
            head_m=(0.0, -self.barrel_distance_m),
            head_radius_m=self.barrel_radius_m,
            normal=(math.cos(tilt), math.sin(tilt)),
            other=Struck(
                self.ball_mass_kg,
                self.ball_diameter_m / 2,
                velocity_m_s=(-self.ball_speed_m_s, 0.0),
                weight_before=1.0,
                weight_after=1.0,
            ),
            gravity_moment_N_m=self.gravity_moment_N_m,
            drive_torque_N_m=self.drive_torque_N_m,
        )

    def markers(self) -> tuple[Marker, ...]:
        """Return the barrel where it hits, the hands, and the ball's centre."""
        return (
            Marker("barrel", "bat", (0.0, -self.barrel_distance_m), self.barrel_radius_m),
            Marker("hands", "bat", (0.0, 0.0), BAT_CLAMP_M),
            Marker("ball", "ball", (0.0, 0.0), self.ball_diameter_m / 2),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 1 m bar on the floor."""
        height = -(self.barrel_distance_m + BAR_BELOW_BARREL_M)
        return {"bar_left": (-0.45, height), "bar_right": (0.55, height)}

    def given(self) -> dict[str, float]:
        """Return ball mass and distance from pivot to barrel."""
        return {"m": self.ball_mass_kg, "L": self.barrel_distance_m}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked, and that the ball flies before the impact too."""
        drive = "free" if self.drive_torque_N_m else "none"
        return {"striker": "barrel", "struck": "ball", "knee": "hands", "flight": "always", "drive": drive}

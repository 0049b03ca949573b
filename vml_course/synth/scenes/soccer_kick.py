"""The kick of the paper: a leg swings about the knee and kicks a football off a tee."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.model.camera import Camera
from vml_course.model.choice import choice
from vml_course.model.quantity import quantity
from vml_course.synth.laws.pinned import PinnedStrike
from vml_course.synth.laws.soft import SoftStrike, soften
from vml_course.synth.laws.struck import Struck
from vml_course.synth.scene import Marker
from vml_course.synth.views import ROOMS, SideView

KNEE_M = 0.09
SHIN_M = 0.08
SHIN_AT = 0.5  # of the way from knee to foot
BAR_LEFT_M = -0.25
BAR_BELOW_FOOT_M = 0.26


@dataclass(frozen=True)
class SoccerKick(SideView):
    """Leg, ball and impact; the default is the paper's example (15, 13, 0 and 24 m/s) in exact numbers.

    The knee is the world's origin. The leg hangs straight down at the impact; the ball lies so that the
    contact normal is tilted up by `normal_tilt_deg` from the foot's velocity.
    """

    name: ClassVar[str] = "soccer_kick"
    title: ClassVar[str] = "A leg that swings about the knee kicks a football off a tee"
    model: ClassVar[str] = "fixed-pivot"
    story: ClassVar[str] = (
        "A leg swings about its knee, which is held, and kicks a football off a tee. You know the ball's mass m, the "
        "distance L from knee to foot, and the ball's diameter D. From the motion of foot and ball before and after "
        "the impact, find the coefficient of restitution e and the leg's inertia I about the knee."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "e": "coefficient of restitution",
        "I": "the leg's inertia about the knee",
    }
    default_camera: ClassVar[Camera] = Camera()
    bodies: ClassVar[tuple[str, str]] = ("leg", "ball")
    vector: ClassVar[tuple[str, str]] = ("knee", "foot")

    restitution: float = quantity(11 / 15, "", 0.05, 1.0, symbol="e", about="coefficient of restitution")
    inertia_kg_m2: float = quantity(1.8816, "kg m^2", 0.05, 10.0, symbol="I", about="the leg's inertia about the knee")
    ball_mass_kg: float = quantity(0.5, "kg", 0.05, 2.0, symbol="m", about="mass of the ball")
    leg_length_m: float = quantity(0.56, "m", 0.3, 0.8, symbol="L", about="distance from knee to foot point")
    ball_diameter_m: float = quantity(0.22, "m", 0.1, 0.4, symbol="D", about="diameter of the ball")
    omega_before_rad_s: float = quantity(
        15 / 0.56, "rad/s", 3.0, 60.0, symbol="omega1", about="the leg's angular velocity at the impact"
    )
    foot_radius_m: float = quantity(0.075, "m", 0.03, 0.12, about="radius of the boot's striking circle")
    normal_tilt_deg: float = quantity(
        0.0, "deg", -5.0, 5.0, about="tilt of the contact normal from the foot's velocity"
    )
    gravity_moment_N_m: float = quantity(  # noqa: N815 - the unit is newton metre
        9.4, "N m", 0.0, 40.0, about="the leg's weight times its centre of mass's distance from the knee"
    )
    drive_torque_N_m: float = quantity(0.0, "N m", -100.0, 100.0, about="constant muscle torque at the knee")  # noqa: N815
    contact_ms: float = quantity(0.0, "ms", 0.0, 12.0, about="how long foot and ball touch; 0 is an instant")

    knee: str = choice("marked", ("marked", "plain"), about="a plain knee has nothing that could be tracked")
    background: str = choice("gym", ROOMS, about="what is behind")
    scale: str = choice("bar", ("bar", "ball"), about="what to calibrate with: a bar, or the ball's own diameter")

    def __post_init__(self) -> None:
        super().__post_init__()
        self.law()

    def law(self) -> PinnedStrike | SoftStrike:
        """Return the physics in numbers."""
        tilt = math.radians(self.normal_tilt_deg)
        strike = PinnedStrike(
            inertia_kg_m2=self.inertia_kg_m2,
            restitution=self.restitution,
            omega_before_rad_s=self.omega_before_rad_s,
            head_m=(0.0, -self.leg_length_m),
            head_radius_m=self.foot_radius_m,
            normal=(math.cos(tilt), math.sin(tilt)),
            other=Struck(self.ball_mass_kg, self.ball_diameter_m / 2, weight_after=1.0),
            gravity_moment_N_m=self.gravity_moment_N_m,
            drive_torque_N_m=self.drive_torque_N_m,
        )
        return soften(strike, 1e-3 * self.contact_ms)

    def markers(self) -> tuple[Marker, ...]:
        """Return foot (centre of the striking circle), knee, shin and the ball's centre."""
        length = self.leg_length_m
        return (
            Marker("foot", "leg", (0.0, -length), self.foot_radius_m),
            Marker("knee", "leg", (0.0, 0.0), KNEE_M),
            Marker("shin", "leg", (0.0, -SHIN_AT * length), SHIN_M),
            Marker("ball", "ball", (0.0, 0.0), self.ball_diameter_m / 2),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 1 m bar on the floor, or of the resting ball's level diameter."""
        height = self.floor_m
        if self.scale == "bar":
            return {"bar_left": (BAR_LEFT_M, height), "bar_right": (BAR_LEFT_M + 1.0, height)}
        (x, y), radius = self.law().ball_m.tolist(), self.ball_diameter_m / 2
        return {"ball_left": (x - radius, y), "ball_right": (x + radius, y)}

    @property
    def floor_m(self) -> float:
        """The height of the bar on the floor."""
        return -(self.leg_length_m + BAR_BELOW_FOOT_M)

    def given(self) -> dict[str, float]:
        """Return ball mass, leg length and ball diameter."""
        return {"m": self.ball_mass_kg, "L": self.leg_length_m, "D": self.ball_diameter_m}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked."""
        return {"striker": "foot", "struck": "ball", "knee": "knee"}

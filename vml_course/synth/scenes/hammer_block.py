"""A pendulum hammer hits a block that slides away and is slowed by friction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.synth.bodies import HAMMER_HUB_M
from vml_course.synth.laws.pinned import PinnedStrike
from vml_course.synth.laws.struck import Struck
from vml_course.synth.scene import Marker
from vml_course.synth.views import SideView

BAR_BELOW_HEAD_M = 0.2


@dataclass(frozen=True)
class HammerBlock(SideView):
    """The hammer's pivot is the world's origin; it hangs down at the impact, at the height of the block's centre."""

    name: ClassVar[str] = "hammer_block"
    title: ClassVar[str] = "A pendulum hammer hits a block that slides away with friction"
    model: ClassVar[str] = "hammer-block"
    story: ClassVar[str] = (
        "A hammer with a rounded head swings on a pivot and hits a wooden block at rest, at the height of the "
        "block's centre, so that the block slides but does not tip. You know the block's mass m and the distance L "
        "from the pivot to the middle of the head. From the motion of head and block, find the coefficient of "
        "restitution e, the hammer's inertia I about the pivot, and, from how the block slows down, the coefficient "
        "of sliding friction mu."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "e": "coefficient of restitution",
        "I": "the hammer's inertia about the pivot",
        "mu": "coefficient of sliding friction of the block",
    }
    default_camera: ClassVar[Camera] = Camera(px_per_m=860.0, origin_x_px=500.0, origin_y_px=80.0)
    bodies: ClassVar[tuple[str, ...]] = ("hammer", "block")
    vector: ClassVar[tuple[str, str] | None] = ("pivot", "head")

    time_before_s: float = quantity(0.06, "s", 0.04, 0.2, about="time shown before the impact")
    time_after_s: float = quantity(0.18, "s", 0.04, 0.3, about="time shown after the impact")
    restitution: float = quantity(0.5, "", 0.05, 1.0, symbol="e", about="coefficient of restitution")
    inertia_kg_m2: float = quantity(0.4, "kg m^2", 0.1, 3.0, symbol="I", about="the hammer's inertia about the pivot")
    block_mass_kg: float = quantity(1.2, "kg", 0.3, 5.0, symbol="m", about="mass of the block")
    hammer_length_m: float = quantity(
        0.5, "m", 0.3, 0.7, symbol="L", about="distance from the pivot to the middle of the head"
    )
    omega_before_rad_s: float = quantity(
        5.0, "rad/s", 2.0, 12.0, symbol="omega1", about="the hammer's angular velocity at the impact"
    )
    friction: float = quantity(
        0.35, "", 0.02, 1.0, symbol="mu", about="coefficient of sliding friction between block and bench"
    )
    head_radius_m: float = quantity(0.045, "m", 0.03, 0.06, about="radius of the head's rounded face")
    block_half_width_m: float = quantity(0.075, "m", 0.04, 0.12, about="half the width of the block")
    block_half_height_m: float = quantity(0.06, "m", 0.04, 0.1, about="half the height of the block")
    gravity_moment_N_m: float = quantity(  # noqa: N815 - the unit is newton metre
        4.5, "N m", 0.0, 20.0, about="the hammer's weight times its centre of mass's distance from the pivot"
    )
    drive_torque_N_m: float = quantity(0.0, "N m", -20.0, 20.0, about="constant torque on the hammer")  # noqa: N815

    def law(self) -> PinnedStrike:
        """Return the physics in numbers."""
        block = Struck(
            self.block_mass_kg, self.block_half_width_m, friction=self.friction, flat_m=self.block_half_height_m
        )
        return PinnedStrike(
            inertia_kg_m2=self.inertia_kg_m2,
            restitution=self.restitution,
            omega_before_rad_s=self.omega_before_rad_s,
            head_m=(0.0, -self.hammer_length_m),
            head_radius_m=self.head_radius_m,
            normal=(1.0, 0.0),
            other=block,
            gravity_moment_N_m=self.gravity_moment_N_m,
            drive_torque_N_m=self.drive_torque_N_m,
        )

    def markers(self) -> tuple[Marker, ...]:
        """Return the middle of the head, the pivot, and the block's centre."""
        wide = max(self.block_half_width_m, self.block_half_height_m)
        return (
            Marker("head", "hammer", (0.0, -self.hammer_length_m), self.head_radius_m),
            Marker("pivot", "hammer", (0.0, 0.0), HAMMER_HUB_M),
            Marker("block", "block", (0.0, 0.0), wide),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 1 m bar."""
        height = -(self.hammer_length_m + BAR_BELOW_HEAD_M)
        return {"bar_left": (-0.35, height), "bar_right": (0.65, height)}

    def given(self) -> dict[str, float]:
        """Return the block's mass and the distance from pivot to head."""
        return {"m": self.block_mass_kg, "L": self.hammer_length_m}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked, that the block does not fly, and that it takes time to slow down."""
        points: dict[str, str | float | bool] = {"striker": "head", "struck": "block", "knee": "pivot"}
        drive = "free" if self.drive_torque_N_m else "none"
        return points | {"flight": "never", "drive": drive, "window_s": 0.15}

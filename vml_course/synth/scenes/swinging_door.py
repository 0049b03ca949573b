"""A ball hits a door that stands still, seen from above."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.errors import InputError
from vml_course.model.camera import Camera
from vml_course.model.choice import choice
from vml_course.model.quantity import quantity
from vml_course.synth.laws.pinned import PinnedStrike
from vml_course.synth.laws.struck import Struck
from vml_course.synth.scene import Marker
from vml_course.synth.views import FLOORS, TopView

CARD_M = 0.05


@dataclass(frozen=True)
class SwingingDoor(TopView):
    """The hinge is the world's origin; the door reaches down in the picture, the ball comes from the right."""

    name: ClassVar[str] = "swinging_door"
    title: ClassVar[str] = "A ball bounces off a door that stands still (seen from above)"
    model: ClassVar[str] = "fixed-pivot"
    story: ClassVar[str] = (
        "Seen from above: a ball glides over the floor and hits a light swing door at rest, squarely, at the "
        "distance a from the hinge. You know the ball's mass m, the distance a, and the distance L from the hinge to "
        "the mark at the door's edge. Gravity plays no part. From the motion of edge and ball, find the coefficient "
        "of restitution e and the door's inertia I about its hinge; note on which side the ball goes on."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "e": "coefficient of restitution",
        "I": "the door's inertia about its hinge",
    }
    default_camera: ClassVar[Camera] = Camera(px_per_m=640.0, origin_x_px=560.0, origin_y_px=92.0)
    bodies: ClassVar[tuple[str, ...]] = ("door", "ball")
    vector: ClassVar[tuple[str, str] | None] = ("hinge", "edge")

    time_after_s: float = quantity(0.08, "s", 0.04, 0.2, about="time shown after the impact")
    restitution: float = quantity(0.6, "", 0.05, 1.0, symbol="e", about="coefficient of restitution")
    inertia_kg_m2: float = quantity(0.6, "kg m^2", 0.1, 10.0, symbol="I", about="the door's inertia about its hinge")
    ball_mass_kg: float = quantity(0.43, "kg", 0.1, 1.0, symbol="m", about="mass of the ball")
    arm_m: float = quantity(0.5, "m", 0.2, 0.7, symbol="a", about="distance from the hinge to where the ball hits")
    door_length_m: float = quantity(0.72, "m", 0.5, 0.9, symbol="L", about="distance from the hinge to the edge's mark")
    ball_diameter_m: float = quantity(0.2, "m", 0.08, 0.25, symbol="D", about="diameter of the ball")
    ball_speed_m_s: float = quantity(6.0, "m/s", 1.0, 15.0, symbol="v", about="speed of the ball towards the door")
    door_thickness_m: float = quantity(0.04, "m", 0.03, 0.06, about="thickness of the door")
    background: str = choice("boards", FLOORS, about="what is below")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.arm_m > self.door_length_m:
            raise InputError("arm_m (a)", f"at most door_length_m (L), {self.door_length_m:g} m", f"{self.arm_m:g} m")

    def law(self) -> PinnedStrike:
        """Return the physics in numbers."""
        return PinnedStrike(
            inertia_kg_m2=self.inertia_kg_m2,
            restitution=self.restitution,
            omega_before_rad_s=0.0,
            head_m=(0.0, -self.arm_m),
            head_radius_m=self.door_thickness_m / 2,
            normal=(1.0, 0.0),
            other=Struck(self.ball_mass_kg, self.ball_diameter_m / 2, velocity_m_s=(-self.ball_speed_m_s, 0.0)),
            bar_m=((0.0, 0.0), (0.0, -self.door_length_m)),
        )

    def markers(self) -> tuple[Marker, ...]:
        """Return the marks at edge and hinge, and the ball's centre."""
        return (
            Marker("edge", "door", (0.0, -self.door_length_m), CARD_M),
            Marker("hinge", "door", (0.0, 0.0), CARD_M),
            Marker("ball", "ball", (0.0, 0.0), self.ball_diameter_m / 2),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 1 m bar on the floor."""
        height = -(self.door_length_m + 0.14)
        return {"bar_left": (-0.2, height), "bar_right": (0.8, height)}

    def given(self) -> dict[str, float]:
        """Return ball mass, distance from hinge to edge, and the ball's lever arm."""
        return {"m": self.ball_mass_kg, "L": self.door_length_m, "a": self.arm_m}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked, and that neither gravity nor a drive acts."""
        points: dict[str, str | float | bool] = {"striker": "edge", "struck": "ball", "knee": "hinge"}
        return points | {"flight": "never", "gravity_m_s2": 0.0, "drive": "none", "window_s": 0.08}

"""A puck hits a free rod away from its centre, on an air table seen from above."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.errors import InputError
from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.synth.laws.free import Free, FreeStrike
from vml_course.synth.scene import Marker
from vml_course.synth.views import TopView

MARK_AT = 0.86  # of the way from the centre to an end


@dataclass(frozen=True)
class StruckRod(TopView):
    """The rod's centre at rest is the world's origin; the puck comes from the left, `offset_m` above it."""

    name: ClassVar[str] = "struck_rod"
    title: ClassVar[str] = "A puck hits a free rod off its centre (air table, seen from above)"
    model: ClassVar[str] = "free-rod"
    story: ClassVar[str] = (
        "On an air table, seen from above, a puck glides towards a wooden rod that lies still and is held by "
        "nothing. It hits the rod squarely at the offset b from the rod's centre G. You know the puck's mass m, the "
        "rod's mass M and the offset b. The rod then moves and turns: from its two marks and the puck, find the "
        "coefficient of restitution e and the rod's inertia I about G, and compare I with that of a slender rod."
    )
    unknowns: ClassVar[Mapping[str, str]] = {
        "e": "coefficient of restitution",
        "I": "the rod's inertia about its centre",
    }
    default_camera: ClassVar[Camera] = Camera(px_per_m=900.0, origin_x_px=560.0, origin_y_px=340.0)
    bodies: ClassVar[tuple[str, ...]] = ("rod", "ball")
    vector: ClassVar[tuple[str, str] | None] = ("tail", "tip")

    time_before_s: float = quantity(0.08, "s", 0.04, 0.3, about="time shown before the impact")
    time_after_s: float = quantity(0.12, "s", 0.04, 0.3, about="time shown after the impact")
    restitution: float = quantity(0.7, "", 0.05, 1.0, symbol="e", about="coefficient of restitution")
    inertia_kg_m2: float = quantity(0.026, "kg m^2", 0.003, 0.2, symbol="I", about="the rod's inertia about its centre")
    ball_mass_kg: float = quantity(0.25, "kg", 0.05, 1.0, symbol="m", about="mass of the puck")
    rod_mass_kg: float = quantity(0.8, "kg", 0.2, 4.0, symbol="M", about="mass of the rod")
    offset_m: float = quantity(0.16, "m", 0.02, 0.3, symbol="b", about="offset of the hit from the rod's centre")
    rod_length_m: float = quantity(0.62, "m", 0.4, 0.8, symbol="L", about="length of the rod")
    ball_speed_m_s: float = quantity(3.0, "m/s", 0.5, 8.0, symbol="v", about="speed of the puck towards the rod")
    ball_radius_m: float = quantity(0.045, "m", 0.03, 0.06, about="radius of the puck")
    rod_half_width_m: float = quantity(0.036, "m", 0.025, 0.05, about="half the width of the rod")

    def __post_init__(self) -> None:
        super().__post_init__()
        straight = self.rod_length_m / 2 - self.rod_half_width_m
        if self.offset_m > straight:
            most = f"at most {straight:.4g} m, where the rod's flank ends"
            raise InputError("offset_m (b)", most, f"{self.offset_m:g} m")

    def law(self) -> FreeStrike:
        """Return the physics in numbers."""
        half, radius = self.rod_half_width_m, self.ball_radius_m
        rod = Free(self.rod_mass_kg, self.inertia_kg_m2, half, half_bar_m=self.rod_length_m / 2 - half)
        puck = Free(
            self.ball_mass_kg, 0.5 * self.ball_mass_kg * radius**2, radius, velocity_m_s=(self.ball_speed_m_s, 0.0)
        )
        return FreeStrike(self.restitution, rod, puck, (-1.0, 0.0), ("e", "I"), self.offset_m)

    def markers(self) -> tuple[Marker, ...]:
        """Return the rod's two marks and the puck's centre."""
        height = MARK_AT * self.rod_length_m / 2
        return (
            Marker("tail", "rod", (0.0, -height), self.rod_half_width_m),
            Marker("tip", "rod", (0.0, height), self.rod_half_width_m),
            Marker("ball", "ball", (0.0, 0.0), self.ball_radius_m),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 50 cm bar on the table."""
        return {"bar_left": (-0.5, -0.37), "bar_right": (0.0, -0.37)}

    def given(self) -> dict[str, float]:
        """Return the masses of puck and rod, and the offset."""
        return {"m": self.ball_mass_kg, "M": self.rod_mass_kg, "b": self.offset_m}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked, that no gravity acts, and that nothing changes for a long time."""
        points: dict[str, str | float | bool] = {"striker": "tail", "striker_mark": "tip", "struck": "ball"}
        return points | {"flight": "never", "gravity_m_s2": 0.0, "window_s": 0.1}

"""Two pucks meet obliquely on an air table, seen from above."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from vml_course.errors import InputError
from vml_course.model.camera import Camera
from vml_course.model.quantity import quantity
from vml_course.synth.laws.free import Free, FreeStrike
from vml_course.synth.scene import Marker
from vml_course.synth.views import TopView

SLOWEST_M_S = 0.1


@dataclass(frozen=True)
class TwoPucks(TopView):
    """Puck A, whose centre at the impact is the world's origin, comes from the left; puck B lies still or drifts."""

    name: ClassVar[str] = "two_pucks"
    title: ClassVar[str] = "Two pucks meet obliquely (air table, seen from above)"
    model: ClassVar[str] = "two-pucks"
    story: ClassVar[str] = (
        "On an air table, seen from above, puck 1 glides into puck 2, off the line of their centres. The pucks are "
        "smooth, so that the impulse acts along the line of centres only, and what each has across it stays. You "
        "know the mass m of puck 2. From the paths of both centres, find the direction of the impulse, the "
        "coefficient of restitution e (along that direction, not along x), and the mass M of puck 1."
    )
    unknowns: ClassVar[Mapping[str, str]] = {"e": "coefficient of restitution", "M": "mass of puck 1"}
    default_camera: ClassVar[Camera] = Camera(px_per_m=1150.0, origin_x_px=440.0, origin_y_px=330.0)
    bodies: ClassVar[tuple[str, ...]] = ("puck_a", "puck_b")

    time_before_s: float = quantity(0.12, "s", 0.04, 0.3, about="time shown before the impact")
    time_after_s: float = quantity(0.15, "s", 0.04, 0.3, about="time shown after the impact")
    restitution: float = quantity(0.85, "", 0.05, 1.0, symbol="e", about="coefficient of restitution")
    puck_a_mass_kg: float = quantity(0.3, "kg", 0.05, 1.0, symbol="M", about="mass of puck 1, which comes")
    puck_b_mass_kg: float = quantity(0.2, "kg", 0.05, 1.0, symbol="m", about="mass of puck 2, which is hit")
    speed_m_s: float = quantity(2.5, "m/s", 0.3, 6.0, symbol="v", about="speed of puck 1 before the impact")
    normal_deg: float = quantity(30.0, "deg", -60.0, 60.0, about="angle from the path of puck 1 to the line of centres")
    drift_m_s: float = quantity(0.0, "m/s", -1.0, 1.0, about="speed of puck 2 up the picture, before the impact")
    puck_a_radius_m: float = quantity(0.05, "m", 0.03, 0.07, about="radius of puck 1")
    puck_b_radius_m: float = quantity(0.042, "m", 0.03, 0.07, about="radius of puck 2")

    def __post_init__(self) -> None:
        super().__post_init__()
        angle = math.radians(self.normal_deg)
        closing = self.speed_m_s * math.cos(angle) - self.drift_m_s * math.sin(angle)
        if closing < SLOWEST_M_S:
            wanted = f"speeds with which the pucks close in by at least {SLOWEST_M_S:g} m/s"
            raise InputError("speed_m_s (v)", wanted, f"{closing:.3g} m/s", "Nothing would be hit.")

    def law(self) -> FreeStrike:
        """Return the physics in numbers."""
        angle = math.radians(self.normal_deg)
        first = _puck(self.puck_a_mass_kg, self.puck_a_radius_m, (self.speed_m_s, 0.0))
        second = _puck(self.puck_b_mass_kg, self.puck_b_radius_m, (0.0, self.drift_m_s))
        return FreeStrike(self.restitution, first, second, (math.cos(angle), math.sin(angle)), ("e", "M"))

    def markers(self) -> tuple[Marker, ...]:
        """Return both centres."""
        return (
            Marker("puck_a", "puck_a", (0.0, 0.0), self.puck_a_radius_m),
            Marker("puck_b", "puck_b", (0.0, 0.0), self.puck_b_radius_m),
        )

    def marks_m(self) -> dict[str, tuple[float, float]]:
        """Return both ends of the 50 cm bar on the table."""
        return {"bar_left": (-0.33, -0.28), "bar_right": (0.17, -0.28)}

    def given(self) -> dict[str, float]:
        """Return the mass of the puck that is hit."""
        return {"m": self.puck_b_mass_kg}

    def declared(self) -> dict[str, str | float | bool]:
        """Return which points are tracked, that no gravity acts, and that nothing changes for a long time."""
        points: dict[str, str | float | bool] = {"striker": "puck_a", "struck": "puck_b"}
        return points | {"flight": "never", "gravity_m_s2": 0.0, "window_s": 0.12}


def _puck(mass_kg: float, radius_m: float, velocity_m_s: tuple[float, float]) -> Free:
    return Free(mass_kg, 0.5 * mass_kg * radius_m**2, radius_m, velocity_m_s)

"""Impacts whose numbers are known in closed form, for the tests of mistakes and of grading."""

from __future__ import annotations

import math
from collections.abc import Mapping

from assignments.mistakes import ImpactNumbers


def numbers_of_impact(
    given: Mapping[str, float], *, px_per_m: float = math.nan, tilt_rad: float = 0.0
) -> ImpactNumbers:
    """Return the velocities that `e`, `I`, `m`, `L`, `D`, `omega1` and `u1` (default 0) lead to.

    Closed form of an eccentric impact about a fixed axis (Beer & Johnston, *Dynamics*, eccentric impact):
    impulse J = (1 + e) (L omega1 - u1) / (L^2/I + 1/m).
    """
    e, inertia, m, length, omega1 = (given[symbol] for symbol in ("e", "I", "m", "L", "omega1"))
    u1 = given.get("u1", 0.0)
    impulse = (1 + e) * (length * omega1 - u1) / (length**2 / inertia + 1 / m)
    omega2, u2 = omega1 - length * impulse / inertia, u1 + impulse / m
    return ImpactNumbers(
        v1=omega1 * length,
        v2=omega2 * length,
        u1=u1,
        u2=u2,
        omega1=omega1,
        omega2=omega2,
        m=m,
        L=length,
        D=given.get("D", math.nan),
        S=px_per_m,
        tilt_rad=tilt_rad,
    )

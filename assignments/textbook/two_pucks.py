"""Two smooth pucks that meet obliquely (Beer & Johnston, *Dynamics*, "Oblique central impact").

The impulse acts along the line of the centres, n at the angle phi from the way of puck 1. Puck 2 was at rest or drifts.

    M (a1 - a2) = m (b2 - b1),   e = (b2 - a2).n / (a1 - b1).n
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from math import nan

from assignments.mistakes import MISTAKES
from assignments.slips import slips_of_mass
from assignments.theory import Concluded, Measured, Met, Mistake, Textbook, by_code, unknown


@dataclass(frozen=True)
class PuckNumbers:
    """Velocities in m/s of puck 1 (a) and puck 2 (b) before and after; x along the way of puck 1, y to its left.

    `own_phi` is the angle that a student found, where one was written.
    """

    a1x: float = nan
    a1y: float = nan
    a2x: float = nan
    a2y: float = nan
    b1x: float = nan
    b1y: float = nan
    b2x: float = nan
    b2y: float = nan
    m: float = nan
    S: float = nan
    own_phi: float = nan

    @property
    def phi(self) -> float:
        """Direction of the impulse on puck 2, in rad."""
        return math.atan2(self.b2y - self.b1y, self.b2x - self.b1x)

    def along(self, vx: float, vy: float) -> float:
        """Return the component along the impulse."""
        return vx * math.cos(self.phi) + vy * math.sin(self.phi)

    @property
    def approach(self) -> float:
        """Speed of approach along the impulse."""
        return self.along(self.a1x - self.b1x, self.a1y - self.b1y)

    @property
    def e(self) -> float:
        """Coefficient of restitution."""
        return self.along(self.b2x - self.a2x, self.b2y - self.a2y) / self.approach

    @property
    def e_by_own_phi(self) -> float:
        """Coefficient of restitution along the direction that was found before."""
        phi = self.phi if math.isnan(self.own_phi) else self.own_phi
        separation = (self.b2x - self.a2x) * math.cos(phi) + (self.b2y - self.a2y) * math.sin(phi)
        return separation / ((self.a1x - self.b1x) * math.cos(phi) + (self.a1y - self.b1y) * math.sin(phi))

    @property
    def gained(self) -> float:
        """Momentum of puck 2 along the impulse, in N s."""
        return self.m * self.along(self.b2x - self.b1x, self.b2y - self.b1y)

    @property
    def M(self) -> float:  # noqa: N802 - the textbook's letter
        """Mass of puck 1."""
        return self.gained / self.along(self.a1x - self.a2x, self.a1y - self.a2y)

    @property
    def speeds(self) -> tuple[float, float, float]:
        """Whole speeds: puck 1 before and after, puck 2 after."""
        return math.hypot(self.a1x, self.a1y), math.hypot(self.a2x, self.a2y), math.hypot(self.b2x, self.b2y)


def _component(body: str, side: str, axis: int) -> Callable[[Met], float]:
    def true(met: Met) -> float:
        index = met.impact.striker if body == "a" else met.impact.struck
        states = met.impact.before if side == "1" else met.impact.after
        return float(states[index, axis])

    return true


def _total(n: PuckNumbers) -> float:
    before, after, struck = n.speeds
    return (struck - after) / before


def _mass_of_speeds(n: PuckNumbers) -> float:
    before, after, struck = n.speeds
    return n.m * struck / (before - after)


def _mass_of_energies(n: PuckNumbers) -> float:
    before, after, struck = n.speeds
    return n.m * struck**2 / (before**2 - after**2)


def _energies(n: PuckNumbers) -> float:
    before, after, struck = n.speeds
    return (n.M * after**2 + n.m * struck**2) / (n.M * before**2)


_MISTAKES = (
    Mistake(
        "PE1", "e", "inverted: approach over separation", lambda n: 1 / n.e,
        "Your e looks turned over: the speed of separation belongs above the line.",
    ),
    Mistake(
        "PE2", "e", "along x instead of along the impulse", lambda n: (n.b2x - n.a2x) / n.a1x,
        "It looks as if the components along x were used. e compares the components along the impulse, at the angle φ.",
    ),
    Mistake(
        "PE3", "e", "whole speeds instead of components", _total,
        "It looks as if whole speeds were used. e compares the components along the impulse only.",
    ),
    Mistake(
        "PE4", "e", "velocity of puck 1 after the impact left out",
        lambda n: n.along(n.b2x - n.b1x, n.b2y - n.b1y) / n.approach,
        "Puck 1 still moves along the impulse after it. Does your separation speed contain that?",
    ),
    Mistake(
        "PE5", "e", "sign of puck 1 after the impact",
        lambda n: n.along(n.b2x + n.a2x, n.b2y + n.a2y) / n.approach,
        "Look at the sign of puck 1's velocity after: the separation is puck 2 minus puck 1.",
    ),
    Mistake(
        "PE6", "e", "whole speed of approach instead of its component",
        lambda n: n.e * n.approach / n.speeds[0],
        "Below the line it looks as if the whole speed of puck 1 stood. Only its component along the impulse counts.",
    ),
    Mistake("PE9", "e", "sign of one of the differences", lambda n: -n.e,
            "The size fits, the sign does not. Take puck 2 minus puck 1 above the line, puck 1 minus puck 2 below."),
    Mistake("PE10", "e", "ratio of kinetic energies", _energies,
            "Your value looks like a ratio of kinetic energies. e is a ratio of velocities along the impulse."),
    MISTAKES["E7"],
    MISTAKES["E8"],
    Mistake(
        "PM1", "M", "masses exchanged", lambda n: n.m**2 / n.M,
        "The ratio of the masses looks turned over: the heavier puck changes its velocity less.",
    ),
    Mistake(
        "PM2", "M", "whole speeds instead of vectors", _mass_of_speeds,
        "It looks as if speeds were subtracted. Momentum is a vector: subtract components.",
    ),
    Mistake("PM3", "M", "kinetic energy conserved", _mass_of_energies,
            "Your value fits conservation of kinetic energy, which is lost. Momentum is conserved."),
    Mistake("PM4", "M", "change of puck 1 taken as its velocity after",
            lambda n: n.gained / n.along(n.a2x, n.a2y),
            "Puck 1's momentum changes by M times the change of its velocity, not times its velocity after."),
    Mistake("PM5", "M", "change of puck 1 taken as its velocity before",
            lambda n: n.gained / n.along(n.a1x, n.a1y),
            "Puck 1 keeps a part of its velocity: M times the change of it is what puck 2 gains."),
    Mistake("PM6", "M", "velocities of puck 1 added", lambda n: n.m * n.b2x / (n.a1x + n.a2x),
            "It looks as if the velocities of puck 1 before and after were added. What it loses is their difference."),
    Mistake("PM7", "M", "pucks stuck together", lambda n: n.m * n.b2x / (n.a1x - n.b2x),
            "Your value fits pucks that stay together. They leave with two velocities: use both."),
    Mistake("PM8", "M", "sign", lambda n: -n.M, "A mass is positive: look at the order of the difference."),
    *slips_of_mass("PM9", "M", lambda n: n.M),
    Mistake("PA1", "phi", "angle from y instead of from x", lambda n: math.pi / 2 - n.phi,
            "The angle looks as if it were counted from y. It is asked from the way of puck 1."),
    Mistake("PA2", "phi", "way of puck 1 after the impact", lambda n: math.atan2(n.a2y, n.a2x),
            "Your angle looks like that of puck 1 after. The impulse gives puck 2, which lay still, its direction."),
    Mistake("PA3", "phi", "sign: y axis pointing down", lambda n: -n.phi,
            "The size fits, the sign does not. Pixels count downwards; φ is positive to the left of puck 1's way."),
    Mistake("PA4", "phi", "degrees where radians were chosen", lambda n: math.degrees(n.phi),
            "The number looks like degrees. Choose the unit that it has."),
    Mistake("PA5", "phi", "angle between the pucks' ways after",
            lambda n: n.phi - math.atan2(n.a2y, n.a2x),
            "Your angle looks like the one between both ways after. It is asked from the way of puck 1 before."),
)  # fmt: skip

_SIDES = [(body, side, axis) for body in "ab" for side in "12" for axis in "xy"]

TEXTBOOK = Textbook(
    model="two-pucks",
    numbers=PuckNumbers,
    measured=tuple(
        Measured(
            f"v_{body}{side}{axis}",
            f"{body}{side}{axis}",
            _component(body, side, "xy".index(axis)),
            may_rest=side == "1" and (body, axis) != ("a", "x"),
        )
        for body, side, axis in _SIDES
    ),
    concluded=(
        Concluded(
            "phi",
            "arctan({v_b2y} / {v_b2x})",
            lambda n: n.phi,
            lambda met: math.atan2(met.impact.normal[1], met.impact.normal[0]),
            also=(lambda n: math.atan2(n.a1y - n.a2y, n.a1x - n.a2x),),
        ),
        Concluded(
            "e",
            "(({v_b2x} − {v_a2x}) cos φ + ({v_b2y} − {v_a2y}) sin φ) / ({v_a1x} cos φ)",
            lambda n: n.e,
            unknown("e"),
            also=(lambda n: n.e_by_own_phi,),
        ),
        Concluded(
            "M",
            "{m} · {v_b2x} / ({v_a1x} − {v_a2x})",
            lambda n: n.M,
            unknown("M"),
            also=(lambda n: n.m * (n.b2x - n.b1x) / (n.a1x - n.a2x), lambda n: n.m * (n.b2y - n.b1y) / (n.a1y - n.a2y)),
        ),
    ),
    mistakes=by_code(*_MISTAKES),
    is_possible=lambda n: n.approach > 0 and n.gained > 0 and 0 < n.e <= 1.2,
)

"""A puck strikes a free rod off its centre (Beer & Johnston, *Dynamics*, "Eccentric impact").

Velocities are positive in the direction in which the puck comes, angular velocities counter-clockwise; the puck hits at
b to the left of its way past the rod's centre G, so that the rod turns clockwise.

    M g2 = m (u1 - u2),   I omega2 = -b m (u1 - u2),   e = (c2 - u2) / u1,   c2 = g2 - b omega2
"""

from __future__ import annotations

from dataclasses import dataclass
from math import nan

from assignments.mistakes import DEGREES, MISTAKES
from assignments.slips import slips_of_mass, slips_of_rate
from assignments.theory import Concluded, Measured, Met, Mistake, Textbook, Values, along, by_code, unknown


@dataclass(frozen=True)
class RodNumbers:
    """Puck before and after (u), rod's centre (g) and rate; masses of puck and rod, offset b, length L of the rod."""

    u1: float = nan
    u2: float = nan
    g2: float = nan
    omega2: float = nan
    m: float = nan
    M: float = nan
    b: float = nan
    L: float = nan
    S: float = nan

    @property
    def c2(self) -> float:
        """Velocity of the point of the rod that was hit, after."""
        return self.g2 - self.b * self.omega2

    @property
    def e(self) -> float:
        """Coefficient of restitution."""
        return (self.c2 - self.u2) / self.u1

    @property
    def J(self) -> float:  # noqa: N802 - the textbook's letter
        """Impulse on the rod."""
        return self.m * (self.u1 - self.u2)

    @property
    def I(self) -> float:  # noqa: E743, N802
        """Moment of inertia of the rod about its centre."""
        return -self.b * self.J / self.omega2


def _towards(met: Met, velocity_m_s: object) -> float:
    return -along(velocity_m_s, met.impact.normal)  # the normal points from the rod to the puck


def _reversed(_: Values) -> float:
    return -1.0  # the solver counts along the normal


_MISTAKES = (
    Mistake("RE1", "e", "inverted: approach over separation", lambda n: 1 / n.e,
            "Your e looks turned over: the speed of separation belongs above the line."),
    Mistake("RE2", "e", "turning of the rod left out", lambda n: (n.g2 - n.u2) / n.u1,
            "The point that was hit moves faster than the rod's centre: its speed is that of G plus b times the rate."),
    Mistake("RE3", "e", "sign of the turning", lambda n: (n.g2 + n.b * n.omega2 - n.u2) / n.u1,
            "Look at the sign of ω: the point that was hit moves faster than the rod's centre, not slower."),
    Mistake("RE4", "e", "rod left out", lambda n: -n.u2 / n.u1,
            "Only the puck's velocities seem to be used. The rod moves after the impact: it belongs into e."),
    Mistake("RE5", "e", "puck after over puck before", lambda n: n.u2 / n.u1,
            "Your value looks like a ratio of the puck's velocities. The rod's belongs into e as well."),
    Mistake("RE6", "e", "sign of the puck after the impact", lambda n: (n.c2 + n.u2) / n.u1,
            "Look at the sign of {v_b2}: the separation is the rod's point minus the puck."),
    Mistake("RE7", "e", "half of the rod's length instead of b", lambda n: (n.g2 - n.L / 2 * n.omega2 - n.u2) / n.u1,
            "The point that was hit is at the distance b from G, not at the end of the rod."),
    Mistake("RE8", "e", "angular velocity in deg/s", lambda n: (n.g2 - n.b * DEGREES * n.omega2 - n.u2) / n.u1,
            "It looks as if ω was in degrees per second when you multiplied it by b. Use rad/s."),
    Mistake("RE9", "e", "sign of one of the differences", lambda n: -n.e,
            "The size fits, the sign does not: rod minus puck above the line, puck minus rod below it."),
    Mistake("RE10", "e", "angular velocity taken as a speed", lambda n: (n.g2 - n.omega2 - n.u2) / n.u1,
            "It looks as if ω was added to a velocity. The point's speed from turning is b ω."),
    Mistake("RE11", "e", "centre of the rod left out", lambda n: (-n.b * n.omega2 - n.u2) / n.u1,
            "The rod's centre moves too: the point that was hit has the velocity of G and that of turning."),
    MISTAKES["E7"],
    MISTAKES["E8"],
    Mistake("RI1", "I", "offset b left out", lambda n: n.I / n.b,
            "The arm b seems to be missing: what is kept is the moment of momentum about G, m b v."),
    Mistake("RI2", "I", "one b too many", lambda n: n.I * n.b,
            "There seems to be one b too many. The puck's moment of momentum about G is m b v."),
    Mistake("RI3", "I", "half of the rod's length instead of b", lambda n: n.I * n.L / 2 / n.b,
            "The arm looks like half of the rod's length. The puck's way passes G at the distance b."),
    Mistake("RI4", "I", "formula of a slender rod instead of the measurement", lambda n: n.M * n.L**2 / 12,
            "Your value is that of a slender uniform rod. It is the one that follows from your film that is asked."),
    Mistake("RI5", "I", "puck after the impact left out", lambda n: -n.b * n.m * n.u1 / n.omega2,
            "The puck still moves after the impact: the impulse is m ({v_b1} − {v_b2})."),
    Mistake("RI6", "I", "sign of the puck after the impact", lambda n: -n.b * n.m * (n.u1 + n.u2) / n.omega2,
            "Look at the sign of {v_b2}: the impulse is m ({v_b1} − {v_b2})."),
    Mistake("RI7", "I", "about the point that was hit", lambda n: n.I + n.M * n.b**2,
            "Your value looks like one about the point that was hit. It is asked about the centre."),
    Mistake("RI7b", "I", "M b^2 subtracted", lambda n: n.I - n.M * n.b**2,
            "M b² seems to be subtracted. The moment of momentum was already about the centre."),
    Mistake("RI8", "I", "kinetic energy conserved",
            lambda n: (n.m * (n.u1**2 - n.u2**2) - n.M * n.g2**2) / n.omega2**2,
            "Your value fits conservation of energy, which is lost. The moment of momentum about G is conserved."),
    Mistake("RI10", "I", "puck's change taken as the rod's velocity", lambda n: -n.b * n.m * n.g2 / n.omega2,
            "It looks as if the rod's velocity was multiplied by m. The impulse is m ({v_b1} − {v_b2})."),
    Mistake("RI11", "I", "sign", lambda n: -n.I,
            "A moment of inertia is positive. ω is negative where the rod turns clockwise: so is the puck's moment."),
    Mistake("RI12", "I", "m b^2 of the puck", lambda n: n.m * n.b**2,
            "Your value looks like m b² of the puck. It is the rod's moment of inertia that is asked."),
    Mistake("RI13", "I", "half", lambda n: n.I / 2),
    Mistake("RI13b", "I", "double", lambda n: n.I * 2),
    *slips_of_mass("RI6", "I", lambda n: n.I),
    *slips_of_rate("RI9", "I", lambda n: n.I),
)  # fmt: skip

TEXTBOOK = Textbook(
    model="free-rod",
    numbers=RodNumbers,
    measured=(
        Measured("v_b1", "u1", lambda met: _towards(met, met.impact.struck_before_m_s), factor=_reversed),
        Measured("v_b2", "u2", lambda met: _towards(met, met.impact.struck_after_m_s), factor=_reversed),
        Measured("v_g2", "g2", lambda met: _towards(met, met.impact.after[met.impact.striker, :2]), factor=_reversed),
        Measured("omega2", "omega2", lambda met: met.impact.omega_after_rad_s),
    ),
    concluded=(
        Concluded("e", "({v_g2} − {b} · {omega2} − {v_b2}) / {v_b1}", lambda n: n.e, unknown("e")),
        Concluded(
            "I",
            "−{b} · {m} · ({v_b1} − {v_b2}) / {omega2}",
            lambda n: n.I,
            unknown("I"),
            also=(lambda n: -n.b * n.M * n.g2 / n.omega2,),
        ),
    ),
    mistakes=by_code(*_MISTAKES),
    is_possible=lambda n: n.u1 > n.u2 and n.omega2 != 0 and 0 < n.e <= 1.2,
)

"""A spinning ball bounces on a rough floor (Cross, American Journal of Physics 70 (2002) 1093).

u up from the floor, w along it, omega counter-clockwise, slip s = w + R omega of the lowest point:

    e = -u2 / u1,   mu = |w2 - w1| / (u2 - u1) while it slips,   k R (omega2 - omega1) = w2 - w1
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from math import nan

from assignments.mistakes import DEGREES, MISTAKES
from assignments.theory import Concluded, Measured, Mistake, Textbook, by_code, unknown

LEAST_SLIP = 0.1  # of the slip before; with less, a small error would turn slipping into sticking


@dataclass(frozen=True)
class BounceNumbers:
    """Centre along the normal (u) and along the floor (w), spin; mass, radius and k = I / (m R^2)."""

    u1: float = nan
    u2: float = nan
    w1: float = nan
    w2: float = nan
    omega1: float = nan
    omega2: float = nan
    m: float = nan
    R: float = nan
    k: float = nan
    S: float = nan

    @property
    def e(self) -> float:
        """Coefficient of restitution of the normal velocities."""
        return -self.u2 / self.u1

    @property
    def rubbed(self) -> float:
        """Change of the velocity along the floor, as a size."""
        return abs(self.w2 - self.w1)

    @property
    def mu(self) -> float:
        """Coefficient of friction, as long as the ball slips."""
        return self.rubbed / (self.u2 - self.u1)

    @property
    def s1(self) -> float:
        """Slip before."""
        return self.w1 + self.R * self.omega1

    @property
    def s2(self) -> float:
        """Slip after."""
        return self.w2 + self.R * self.omega2


def _spun(n: BounceNumbers, k: float) -> float:
    """Return mu by the spin, with a given k."""
    return k * n.R * abs(n.omega2 - n.omega1) / (n.u2 - n.u1)


def _slip_after(n: BounceNumbers) -> str:
    return "the ball sticks or hardly slips" if n.s2 * n.s1 <= LEAST_SLIP * n.s1**2 else ""


def _energies(n: BounceNumbers) -> float:
    def twice(u: float, w: float, omega: float) -> float:
        return u**2 + w**2 + n.k * (n.R * omega) ** 2

    return twice(n.u2, n.w2, n.omega2) / twice(n.u1, n.w1, n.omega1)


_MISTAKES = (
    Mistake("SE1", "e", "inverted: before over after", lambda n: 1 / n.e,
            "Your e looks turned over: the speed after belongs above the line."),
    Mistake("SE2", "e", "sign", lambda n: -n.e,
            "The size fits, the sign does not: {v_b1} is negative, the ball comes down."),
    Mistake("SE3", "e", "whole speeds instead of normal components",
            lambda n: math.hypot(n.u2, n.w2) / math.hypot(n.u1, n.w1),
            "It looks as if whole speeds were used. e compares the components normal to the floor only."),
    Mistake("SE4", "e", "components along the floor", lambda n: n.w2 / n.w1,
            "It looks as if the components along the floor were used. e compares those normal to it."),
    Mistake("SE5", "e", "ratio of kinetic energies", _energies,
            "Your value looks like a ratio of kinetic energies. e is a ratio of normal velocities."),
    Mistake("SE6", "e", "ratio of slips", lambda n: n.s2 / n.s1,
            "Your value looks like a ratio of slips. e compares the velocities normal to the floor."),
    MISTAKES["E7"],
    MISTAKES["E8"],
    Mistake("SM1", "mu", "velocities after: along over normal", lambda n: abs(n.w2 / n.u2),
            "It looks as if velocities after were divided. μ is a ratio of impulses, so of changes of velocity."),
    Mistake("SM1b", "mu", "velocities before: along over normal", lambda n: abs(n.w1 / n.u1),
            "It looks as if velocities before were divided. μ is a ratio of impulses, so of changes of velocity."),
    Mistake("SM2", "mu", "only the normal velocity before", lambda n: n.rubbed / abs(n.u1),
            "The normal impulse also throws the ball up again: divide by {v_b2} − {v_b1}."),
    Mistake("SM2b", "mu", "only the normal velocity after", lambda n: n.rubbed / n.u2,
            "The normal impulse also stops the falling ball: divide by {v_b2} − {v_b1}."),
    Mistake("SM3", "mu", "sign of the normal velocity before lost", lambda n: n.rubbed / abs(n.u2 + n.u1),
            "Look at the sign of {v_b1}: the ball comes down, so the change of its normal velocity is a sum of sizes."),
    Mistake("SM4", "mu", "inverted: normal over along", lambda n: 1 / n.mu,
            "Your μ looks turned over: friction belongs above the line, the normal impulse below."),
    Mistake("SM5", "mu", "k left out", lambda n: _spun(n, 1.0),
            "The factor k seems to be missing: friction changes the spin by its moment over k m R²."),
    Mistake("SM5b", "mu", "k of a disc", lambda n: _spun(n, 0.5) if n.k != 0.5 else nan,
            "It looks as if k of a disc, ½, was used. Your handout gives the ball's own k."),
    Mistake("SM5c", "mu", "k of a solid sphere", lambda n: _spun(n, 0.4) if n.k != 0.4 else nan,
            "It looks as if k of a solid sphere, 0.4, was used. Your handout gives the ball's own k."),
    Mistake("SM6", "mu", "change of the slip instead of the velocity", lambda n: abs(n.s2 - n.s1) / (n.u2 - n.u1),
            "It looks as if the change of slip was used. Friction changes the centre's velocity along the floor."),
    Mistake("SM7", "mu", "sign", lambda n: -n.mu, "The size fits, the sign does not: μ is positive."),
    Mistake("SM8", "mu", "velocities along the floor added", lambda n: abs(n.w1 + n.w2) / (n.u2 - n.u1),
            "It looks as if {v_t1} and {v_t2} were added. Friction makes the one the other: take the difference."),
    Mistake("SS1", "s2", "spin left out", lambda n: n.w2,
            "The spin seems to be missing: the lowest point moves with {v_t2} + R {omega2}."),
    Mistake("SS2", "s2", "sign of the spin", lambda n: n.w2 - n.R * n.omega2,
            "Look at the sign of the spin: counter-clockwise, the lowest point moves to the right."),
    Mistake("SS3", "s2", "diameter instead of radius", lambda n: n.w2 + 2 * n.R * n.omega2,
            "It looks as if the diameter was used. The lowest point is R from the centre."),
    Mistake("SS4", "s2", "spin in deg/s", lambda n: n.w2 + DEGREES * n.R * n.omega2,
            "It looks as if the spin was in degrees per second. Use rad/s."),
    Mistake("SS5", "s2", "slip before the bounce", lambda n: n.s1,
            "Your value is the slip before the bounce. The one after it is asked."),
    Mistake("SS6", "s2", "centre left out", lambda n: n.R * n.omega2,
            "The centre's velocity seems to be missing: the lowest point moves with {v_t2} + R {omega2}."),
    Mistake("SS7", "s2", "radius left out", lambda n: n.w2 + n.omega2,
            "The radius seems to be missing: the spin gives the lowest point the speed R {omega2}."),
)  # fmt: skip

TEXTBOOK = Textbook(
    model="spin-bounce",
    numbers=BounceNumbers,
    measured=(
        Measured("v_b1", "u1", lambda met: float(met.impact.before[0, 1])),
        Measured("v_b2", "u2", lambda met: float(met.impact.after[0, 1])),
        Measured("v_t1", "w1", lambda met: float(met.impact.before[0, 0])),
        Measured("v_t2", "w2", lambda met: float(met.impact.after[0, 0])),
        Measured("omega1", "omega1", lambda met: float(met.impact.before[0, 2])),
        Measured("omega2", "omega2", lambda met: float(met.impact.after[0, 2])),
    ),
    concluded=(
        Concluded("e", "−{v_b2} / {v_b1}", lambda n: n.e, unknown("e")),
        Concluded(
            "mu",
            "|{v_t2} − {v_t1}| / ({v_b2} − {v_b1})",
            lambda n: n.mu,
            unknown("mu"),
            also=(lambda n: _spun(n, n.k),),
        ),
        Concluded(
            "s2",
            "{v_t2} + {R} · {omega2}",
            lambda n: n.s2,
            lambda met: float(met.impact.after[0, 0] + met.given["R"] * met.impact.after[0, 2]),
        ),
    ),
    mistakes=by_code(*_MISTAKES),
    is_possible=lambda n: n.u1 < 0 < n.u2 and 0 < n.e <= 1.2 and n.w1 != n.w2,
    unfit=_slip_after,
)

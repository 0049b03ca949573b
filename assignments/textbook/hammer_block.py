"""A pendulum hammer strikes a block at rest, which then slides on (Beer & Johnston, *Dynamics*, "Eccentric impact").

The impact is that of a body about a fixed axis; afterwards friction alone slows the block: a = mu g.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import nan

from assignments.mistakes import FEET, MISTAKES, STANDARD_GRAVITY, ImpactNumbers
from assignments.pinned_body import CONCLUDED, FACTS, MEASURED, is_possible, told, ways
from assignments.theory import Concluded, Measured, Mistake, Textbook, Values, by_code, unknown


@dataclass(frozen=True)
class HammerNumbers(ImpactNumbers):
    """The impact's numbers, and the deceleration `a` of the sliding block, positive when it slows down."""

    a: float = nan
    g: float = STANDARD_GRAVITY

    @property
    def mu(self) -> float:
        """Coefficient of sliding friction."""
        return self.a / self.g


def _told(given: Values) -> Values:
    return {**told(given), "g": given.get("g", STANDARD_GRAVITY)}


_MISTAKES = (
    Mistake("HM1", "mu", "g left out: the deceleration itself", lambda n: n.a,
            "Your value looks like the deceleration. Friction slows the block by μ g."),
    Mistake("HM2", "mu", "inverted: g over a", lambda n: n.g / n.a,
            "Your μ looks turned over: the deceleration belongs above the line."),
    Mistake("HM3", "mu", "half: a / (2 g)", lambda n: n.mu / 2,
            "Your value is half as large: x = v t − ½ a t² has the ½ in it already."),
    Mistake("HM4", "mu", "double: the coefficient of t^2 taken for a/4", lambda n: n.mu * 2,
            "Your value is twice as large: the coefficient of t² is half of the deceleration."),
    Mistake("HM5", "mu", "sign", lambda n: -n.mu,
            "The size fits, the sign does not: μ is positive, and the block slows down."),
    Mistake("HM6", "mu", "force of friction instead of its coefficient", lambda n: n.m * n.a,
            "Your value looks like the force of friction, m a. Divide it by the normal force, m g."),
    Mistake("HM7", "mu", "mass left in", lambda n: n.m * n.mu,
            "The mass seems to be left in. It cancels: μ m g = m a."),
    Mistake("HM7b", "mu", "divided by the mass", lambda n: n.mu / n.m,
            "You seem to have divided by the mass. It cancels: μ m g = m a."),
    Mistake("HM8", "mu", "deceleration in ft/s^2", lambda n: n.mu * FEET,
            "The deceleration looks as if it were in feet. Use metres, or g in feet too."),
    Mistake("HM9", "mu", "speed after the impact over g", lambda n: n.u2 / n.g,
            "It looks as if a speed was divided by g. It is the deceleration, the slope of the speed, that is μ g."),
)  # fmt: skip

TEXTBOOK = Textbook(
    model="hammer-block",
    numbers=HammerNumbers,
    measured=(
        *MEASURED,
        Measured(
            "a_b",
            "a",
            lambda met: met.parameters["friction"] * STANDARD_GRAVITY,
            symbol="mu",
            factor=lambda _: STANDARD_GRAVITY,
        ),
    ),
    concluded=(*CONCLUDED, Concluded("mu", "{a_b} / {g}", lambda n: n.mu, unknown("mu"))),
    mistakes={**MISTAKES, **by_code(*_MISTAKES)},
    is_possible=is_possible,
    told=_told,
    ways=ways,
    facts=FACTS,
)

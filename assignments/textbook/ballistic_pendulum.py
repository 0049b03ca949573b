"""A ball stays in a pendulum at rest (Beer & Johnston, *Dynamics*, "Conservation of angular momentum"; e = 0).

    m v d = (I + m d^2) omega2,   1/2 (I + m d^2) omega2^2 = (M c + m d) g (1 - cos theta)

Angular momentum about the pivot is kept in the hit, energy in the rise; each alone gives the inertia.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from math import nan

from assignments.mistakes import STANDARD_GRAVITY
from assignments.slips import slips_of_rate
from assignments.theory import Concluded, Measured, Met, Mistake, Textbook, by_code, unknown
from vml_course.kinetics.models import impact_model

MODEL = "ballistic-pendulum"


@dataclass(frozen=True)
class PendulumNumbers:
    """Speed v of the ball on the film, rate and highest angle after; m, d of the ball, M, c of the pendulum."""

    v: float = nan
    omega2: float = nan
    theta: float = nan
    m: float = nan
    M: float = nan
    d: float = nan
    c: float = nan
    S: float = nan
    g: float = STANDARD_GRAVITY

    @property
    def inside(self) -> float:
        """Moment of inertia of the ball in the pendulum."""
        return self.m * self.d**2

    @property
    def I(self) -> float:  # noqa: E743, N802 - the textbook's letter
        """Moment of inertia of the pendulum alone, by angular momentum."""
        return self.m * self.v * self.d / self.omega2 - self.inside

    @property
    def rise(self) -> float:
        """Work of the weight up to the highest point, in J."""
        return (self.M * self.c + self.m * self.d) * self.g * (1 - math.cos(self.theta))

    @property
    def I_by_energy(self) -> float:  # noqa: N802
        """The same by the energy of the rise."""
        return 2 * self.rise / self.omega2**2 - self.inside

    @property
    def v1(self) -> float:
        """Speed of the ball by the rise of both."""
        return 2 * self.rise / (self.omega2 * self.m * self.d)

    @property
    def brought(self) -> float:
        """Kinetic energy of the ball before."""
        return 0.5 * self.m * self.v**2

    @property
    def loss(self) -> float:
        """Energy lost in the hit."""
        return self.brought - 0.5 * self.m * self.v * self.d * self.omega2


def _highest(met: Met) -> float:
    """Return the angle at which the pendulum turns back, by the impact model's closed form."""
    inertia = float(met.impact.mass[met.impact.striker, 2])
    parameters = {symbol: met.given[symbol] for symbol in ("m", "M", "d", "c")}
    return impact_model(MODEL).predict({**parameters, "I": inertia}, {"v1": _speed(met)})["theta_max"]


def _speed(met: Met) -> float:
    return math.hypot(*met.impact.struck_before_m_s)


def _loss(met: Met) -> float:
    before, after = (0.5 * float((met.impact.mass * rate**2).sum()) for rate in (met.impact.before, met.impact.after))
    return before - after


_MISTAKES = (
    Mistake("BI1", "I", "ball in the pendulum forgotten", lambda n: n.I + n.inside,
            "The ball swings with the catcher: m d² belongs to the turning body and has to be taken off for I."),
    Mistake("BI1b", "I", "m d^2 added instead of subtracted", lambda n: n.I + 2 * n.inside,
            "m d² of the ball seems to be added. I alone is asked: what turns is I + m d²."),
    Mistake("BI2", "I", "arm d left out", lambda n: n.m * n.v / n.omega2 - n.inside,
            "The arm d seems to be missing: what is kept is the moment of momentum about the pivot, m v d."),
    Mistake("BI3", "I", "energy conserved in the hit", lambda n: n.m * n.v**2 / n.omega2**2 - n.inside,
            "Your value fits conservation of energy in the hit, where most of it is lost. Angular momentum is kept."),
    Mistake("BI4", "I", "c instead of d", lambda n: n.m * n.v * n.c / n.omega2 - n.inside,
            "The arm looks like c. The ball's line passes the pivot at the distance d."),
    Mistake("BI5", "I", "one d too many", lambda n: n.m * n.v * n.d**2 / n.omega2 - n.inside,
            "There seems to be one d too many. The ball's moment of momentum is m v d."),
    Mistake("BI6", "I", "catcher as a particle, M c^2", lambda n: n.M * n.c**2,
            "Your value is M c², that of a particle. I has to be found from the motion."),
    Mistake("BI7", "I", "mass in grams", lambda n: 1000 * (n.I + n.inside) - 1000 * n.inside,
            "The ball's mass looks as if it were in grams. Use kg."),
    Mistake("BI8", "I", "ball's mass added to the catcher's", lambda n: (n.M + n.m) * n.v * n.d / n.omega2 - n.inside,
            "Only the ball moves before the hit: its momentum is m v."),
    *slips_of_rate("BI9", "I", lambda n: n.I + n.inside),
    Mistake("BV1", "v1", "energy conserved in the hit", lambda n: math.sqrt(2 * n.rise / n.m),
            "Your value fits conservation of energy from the ball to the highest point. In the hit it is lost."),
    Mistake("BV2", "v1", "ball left out of the rise", lambda n: n.v1 * n.M * n.c / (n.M * n.c + n.m * n.d),
            "The ball rises too: the weight's arm is M c + m d."),
    Mistake("BV3", "v1", "both masses at d", lambda n: n.v1 * (n.M + n.m) * n.d / (n.M * n.c + n.m * n.d),
            "The catcher's centre of mass is at c, not at d: the weight's arm is M c + m d."),
    Mistake("BV4", "v1", "sine instead of 1 - cosine",
            lambda n: n.v1 * math.sin(n.theta) / (1 - math.cos(n.theta)),
            "The height looks like d sin θ. What rises by turning through θ rises by 1 − cos θ."),
    Mistake("BV4b", "v1", "cosine instead of 1 - cosine",
            lambda n: n.v1 * math.cos(n.theta) / (1 - math.cos(n.theta)),
            "The height looks like c cos θ. It is measured from the lowest point: 1 − cos θ."),
    Mistake("BV5", "v1", "factor 2 left out", lambda n: n.v1 / 2,
            "Your value is half as large: kinetic energy has a ½ in it."),
    Mistake("BV6", "v1", "speed of the catcher after the hit", lambda n: n.omega2 * n.d,
            "Your value is the catcher's speed where the ball sits, ω₂ d. The ball's before the hit is asked."),
    Mistake("BV7", "v1", "catcher as a particle at d", lambda n: (n.M + n.m) / n.m * n.omega2 * n.d,
            "Your value fits a catcher that is a particle at d. It is a body: use I + m d²."),
    Mistake("BV7b", "v1", "catcher as a particle that rises by d (1 - cos)",
            lambda n: (n.M + n.m) / n.m * math.sqrt(2 * n.g * n.d * (1 - math.cos(n.theta))),
            "Your value fits a catcher that is a particle on a string. It is a body: use I + m d²."),
    Mistake("BV8", "v1", "cosine of an angle in degrees",
            lambda n: n.v1 * (1 - math.cos(math.degrees(n.theta))) / (1 - math.cos(n.theta)),
            "It looks as if the cosine was taken of degrees. A spreadsheet's COS takes radians."),
    Mistake("BL1", "loss", "kinetic energy of the ball alone", lambda n: n.brought,
            "Your value is the ball's energy before the hit. What turns after it still has a part of that."),
    Mistake("BL2", "loss", "energy of the rise", lambda n: n.brought - n.loss,
            "Your value is the energy after the hit. What is lost is the ball's energy before minus that."),
    Mistake("BL3", "loss", "factor 1/2 left out", lambda n: 2 * n.loss,
            "Your value is twice as large: kinetic energy has a ½ in it."),
    Mistake("BL4", "loss", "as a share of the energy before", lambda n: n.loss / n.brought,
            "Your value is a share. The loss itself is asked, in joules."),
    Mistake("BL5", "loss", "sign", lambda n: -n.loss, "The size fits, the sign does not: a loss is positive here."),
    Mistake("BL6", "loss", "catcher as a particle", lambda n: n.brought * n.M / (n.M + n.m),
            "Your value fits a catcher that is a particle. It is a body: its energy after is ½ (I + m d²) ω₂²."),
    Mistake("BL7", "loss", "ball left out of what turns", lambda n: n.brought - 0.5 * n.I * n.omega2**2,
            "The ball turns with the catcher: the energy after is ½ (I + m d²) ω₂²."),
)  # fmt: skip

TEXTBOOK = Textbook(
    model=MODEL,
    numbers=PendulumNumbers,
    measured=(
        Measured("v_b1", "v", _speed, symbol="v1"),  # of film, momentum and rise at once: the sharpest there is
        Measured("omega2", "omega2", lambda met: met.impact.omega_after_rad_s),
        Measured("theta_max", "theta", _highest),
    ),
    concluded=(
        Concluded(
            "I",
            "{m} · {v_b1} · {d} / {omega2} − {m} · {d}²",
            lambda n: n.I,
            unknown("I"),
            also=(lambda n: n.I_by_energy,),
        ),
        Concluded(
            "v1",
            "2 · ({M} · {c} + {m} · {d}) · {g} · (1 − cos {theta_max}) / ({m} · {d} · {omega2})",
            lambda n: n.v1,
            unknown("v1"),
        ),
        Concluded(
            "loss",
            "½ · {m} · {v_b1}² − ½ · {m} · {v_b1} · {d} · {omega2}",
            lambda n: n.loss,
            _loss,
            also=(lambda n: n.brought - n.rise,),
        ),
    ),
    mistakes=by_code(*_MISTAKES),
    is_possible=lambda n: n.v > 0 and n.omega2 > 0 and n.omega2 * n.d < n.v and 0 < n.theta < math.pi,
    told=lambda given: {"g": STANDARD_GRAVITY, **given},
)

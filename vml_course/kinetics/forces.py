"""Forces and moments of an impact about a fixed pivot, and of the swing before and after it.

Signs as everywhere: x right, y up, angles, rates and moments counter-clockwise. n is the contact normal from the
striker to the struck body, a = (r x n) its arm about the pivot. Beer & Johnston, *Dynamics*: "Eccentric impact" and
"Noncentroidal rotation"; Hibbeler, *Dynamics*, 17.4 and 19.4.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vml_course.errors import OutOfRangeError
from vml_course.model.arrays import FloatArray
from vml_course.model.solution import Estimate, ImpactSolution

LONGEST_CONTACT_S = 0.1


def mean_force(impulse_n_s: float, contact_s: float) -> float:
    """Return the mean contact force J / t_c in N.

    Raises
    ------
    OutOfRangeError
        When the contact's duration is not positive, or longer than 0.1 s.

    The paper's 12 N s: 192 N over its whole window of 62.5 ms, 1200 N over a contact of 10 ms, which is what feet and
    balls have.

    >>> mean_force(12.0, 0.0625), mean_force(12.0, 0.010)
    (192.0, 1200.0)
    """
    if not 0 < contact_s <= LONGEST_CONTACT_S:
        raise OutOfRangeError("contact time", 0.0, LONGEST_CONTACT_S, "s", contact_s)
    return impulse_n_s / contact_s


def pin_impulse(impulse_n_s: float, mass_kg: float, centre_m: float, omega1: float, omega2: float) -> float:
    """Return the impulse of the pin on the body along n, in N s: R = M c (w2 - w1) + J.

    The rates are counted positive where they move the striking point along n; `centre_m` is the distance c from the
    pivot to the centre of mass. Positive: the pin is pushed against n, and pushes back along it.

    A leg of 4 kg with its centre at 0.25 m, the paper's kick:

    >>> round(pin_impulse(12.0, 4.0, 0.25, 15 / 0.56, 13 / 0.56), 3)
    8.429
    """
    return mass_kg * centre_m * (omega2 - omega1) + impulse_n_s


def centre_of_percussion(inertia_kg_m2: float, mass_kg: float, centre_m: float) -> float:
    """Return the arm a = I / (M c) at which the pin feels nothing, in m.

    A uniform rod on its end: two thirds of its length.

    >>> round(centre_of_percussion(2.0 * 0.9**2 / 3, 2.0, 0.45) / 0.9, 6)
    0.666667
    """
    return inertia_kg_m2 / (mass_kg * centre_m)


def torque(inertia_kg_m2: float, alpha_rad_s2: FloatArray | float) -> FloatArray | float:
    """Return the resultant moment about the pivot, I alpha, in N m.

    >>> torque(1.88, 5.0)
    9.4
    """
    return inertia_kg_m2 * alpha_rad_s2


@dataclass(frozen=True, slots=True)
class EnergyBalance:
    """Kinetic energies of an impact, J: striker and struck body, before and after, and what is lost."""

    striker_before: float
    striker_after: float
    struck_before: float
    struck_after: float

    @property
    def loss(self) -> float:
        """Energy that is no longer kinetic."""
        return self.striker_before + self.struck_before - self.striker_after - self.struck_after

    @property
    def loss_share(self) -> float:
        """The loss as a share of the energy before."""
        return self.loss / (self.striker_before + self.struck_before)


def energy_balance(
    inertia_kg_m2: float, mass_kg: float, omega1: float, omega2: float, u1: float, u2: float
) -> EnergyBalance:
    """Return who had which energy; 1/2 I w^2 of the striker and 1/2 m u^2 of the struck body.

    The paper's kick: 675 J before, 24 J (3.6 %) lost.

    >>> kick = energy_balance(1.8816, 0.5, 15 / 0.56, 13 / 0.56, 0.0, 24.0)
    >>> round(kick.striker_before, 3), round(kick.loss, 3), round(100 * kick.loss_share, 1)
    (675.0, 24.0, 3.6)
    """
    return EnergyBalance(
        0.5 * inertia_kg_m2 * omega1**2, 0.5 * inertia_kg_m2 * omega2**2, 0.5 * mass_kg * u1**2, 0.5 * mass_kg * u2**2
    )


@dataclass(frozen=True, slots=True)
class PinnedRod:
    """A rigid body on a fixed pivot: mass M, distance c from pivot to centre of mass, inertia I about the pivot."""

    mass_kg: float
    centre_m: float
    inertia_kg_m2: float
    gravity_m_s2: float = 9.81


@dataclass(frozen=True, eq=False, slots=True)
class RodForces:
    """What makes a pinned rod move as it does; arrays of shape (n,), forces (n, 2).

    Attributes
    ----------
    torque_n_m : float array
        Moment that must drive the rod at the pivot beside gravity.
    gravity_n_m : float array
        Moment of the weight about the pivot.
    pin_n : float array, shape (n, 2)
        Force of the pin on the rod.
    power_w : float array
        Of the driving moment.
    """

    torque_n_m: FloatArray
    gravity_n_m: FloatArray
    pin_n: FloatArray
    power_w: FloatArray


def inverse_dynamics(rod: PinnedRod, angle_rad: FloatArray, omega: FloatArray, alpha: FloatArray) -> RodForces:
    """Return moments and pin force of a rod from its motion, all (n,): angle of its centre about the pivot, and so on.

    T = I alpha + M g c cos(angle),
    R = M (a_G + g y),   a_G = c (alpha t - omega^2 r),   r = (cos, sin), t = (-sin, cos).

    A rod that hangs still is held by its weight, without a moment:

    >>> still = inverse_dynamics(PinnedRod(2.0, 0.5, 0.7, 10.0), *(np.array([x]) for x in (-np.pi / 2, 0.0, 0.0)))
    >>> still.pin_n.round(9) + 0.0, still.torque_n_m.round(9) + 0.0
    (array([[ 0., 20.]]), array([0.]))
    """
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    weight = rod.mass_kg * rod.gravity_m_s2
    needed = rod.inertia_kg_m2 * np.asarray(alpha) + weight * rod.centre_m * c
    radial, across = np.stack([c, s], axis=-1), np.stack([-s, c], axis=-1)
    acceleration = rod.centre_m * (np.asarray(alpha)[..., None] * across - np.asarray(omega)[..., None] ** 2 * radial)
    pin = rod.mass_kg * acceleration + np.array([0.0, weight])
    return RodForces(needed, -weight * rod.centre_m * c, pin, needed * omega)


def forces_of(
    solution: ImpactSolution, contact_s: float | None = None, striker: PinnedRod | None = None
) -> Mapping[str, Estimate]:
    """Return impulse, mean force, moment about the pivot and pin reaction of a solved impact about a pivot.

    Standard deviations are relative to that of the impulse; contact time, M and c are taken as exact.

    Parameters
    ----------
    solution : ImpactSolution
        Of a pinned model: with `J`, `omega1`, `omega2` and `loss`.
    contact_s : float, optional
        Duration of the contact; without it there is no force.
    striker : PinnedRod, optional
        Without it there is no pin reaction.
    """
    impulse = solution.estimates["J"]
    arm = solution.estimates.get("a")
    share = impulse.sd / abs(impulse.value)
    found = {"J": impulse, "loss": solution.estimates["loss"]}
    if arm is not None:
        found["H"] = Estimate(impulse.value * arm.value, abs(impulse.value * arm.value) * share, "N m s")
    if contact_s is not None:
        force = mean_force(impulse.value, contact_s)
        found["F"] = Estimate(force, abs(force) * share, "N")
    if striker is not None:
        towards = (
            math.copysign(1.0, solution.value("v_f1") * solution.value("omega1"))
            if "v_f1" in solution.estimates
            else 1.0
        )
        rates = towards * solution.value("omega1"), towards * solution.value("omega2")
        pin = pin_impulse(impulse.value, striker.mass_kg, striker.centre_m, *rates)
        found["R"] = Estimate(pin, abs(impulse.sd), "N s")
        percussion = centre_of_percussion(striker.inertia_kg_m2, striker.mass_kg, striker.centre_m)
        found["a_percussion"] = Estimate(percussion, 0.0, "m")
    return found

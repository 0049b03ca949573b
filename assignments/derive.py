"""Formulas by which a scene parameter follows from drawn numbers.

Some parameters are better not drawn themselves: a moment of inertia that is drawn blindly gives kicks in
which the leg hardly slows down, and then nobody can measure it. An assignment draws the slowdown instead
and names a formula of this table. The arguments are the formula's own letters; the assignment says which
number each takes. To add one, add a function and its line in `FORMULAS`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping


def rate_of_speed(v: float, a: float) -> float:
    """Angular velocity of a body whose point at the distance `a` from its axis has the speed `v`."""
    return v / a


def inertia_of_slowdown(r: float, e: float, m: float, a: float) -> float:
    """Moment of inertia with which a body loses the share `r` of its rate in striking a resting mass `m`.

    From r = (1 + e) k / (1 + k) with k = m a^2 / I, `a` the arm of the contact normal about the axis and
    `e` the coefficient of restitution (eccentric impact of a body about a fixed axis).
    """
    return m * a**2 * (1 + e - r) / r


def inertia_of_slowdown_in_flight(r: float, e: float, m: float, a: float, s: float, v: float) -> float:
    """Moment of inertia with which a body loses the share `r` of its rate in striking a mass `m` that comes towards it.

    `s` is the speed of the striking point at the arm `a`, `v` that of the mass: from I r s/a = m a (u2 + v), with
    u2 = e (s + v) + (1 - r) s by restitution.
    """
    return m * a**2 * (e * (s + v) + (1 - r) * s + v) / (r * s)


def inertia_of_mass_ratio(k: float, m: float, a: float) -> float:
    """Moment of inertia of a body at rest to which a mass `m` that hits it at the arm `a` is k = m a^2 / I."""
    return m * a**2 / k


def inertia_of_rod(f: float, M: float, L: float) -> float:  # noqa: N803 - textbook letters
    """Moment of inertia about its centre of a rod of length `L`: `f` times that of a slender uniform one, M L^2/12."""
    return f * M * L**2 / 12


def inertia_of_centre(f: float, M: float, c: float) -> float:  # noqa: N803
    """Moment of inertia about the pivot of a body whose centre of mass is at `c`: `f` times that of a particle, M c^2.

    `f` is more than 1.
    """
    return f * M * c**2


FORMULAS: Mapping[str, Callable[..., float]] = {
    formula.__name__: formula
    for formula in (
        rate_of_speed,
        inertia_of_slowdown,
        inertia_of_slowdown_in_flight,
        inertia_of_mass_ratio,
        inertia_of_rod,
        inertia_of_centre,
    )
}


def arguments_of(formula: str) -> tuple[str, ...]:
    """Return the letters that a formula asks for."""
    return tuple(inspect.signature(FORMULAS[formula]).parameters)

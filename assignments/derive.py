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


FORMULAS: Mapping[str, Callable[..., float]] = {
    formula.__name__: formula for formula in (rate_of_speed, inertia_of_slowdown)
}


def arguments_of(formula: str) -> tuple[str, ...]:
    """Return the letters that a formula asks for."""
    return tuple(inspect.signature(FORMULAS[formula]).parameters)

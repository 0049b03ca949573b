"""Closed form of a body that turns about a fixed pivot and strikes (or is struck by) a particle.

Beer & Johnston, *Dynamics*, "Eccentric impact"; Hibbeler, *Dynamics*, 19.4. No friction: the impulse is
along the contact normal n, whose lever arm about the pivot is a = (r x n). Rates are counter-clockwise,
u is the particle's velocity along n; a and the rates may both be negative (a kick to the left).
"""

from __future__ import annotations

from typing import NamedTuple


class After(NamedTuple):
    """State after the impact: rad/s, m/s, N s, J."""

    omega2: float
    u2: float
    impulse: float
    loss: float


def after_impact(e: float, inertia: float, mass: float, arm: float, omega1: float, u1: float) -> After:
    """Return the state after the impact.

    J = (1 + e) mu (a w1 - u1), mu = 1 / (a^2/I + 1/m);  w2 = w1 - a J/I;  u2 = u1 + J/m.

    The kick of the VML paper, 15 m/s before:

    >>> kick = after_impact(e=11 / 15, inertia=1.8816, mass=0.5, arm=0.56, omega1=15 / 0.56, u1=0.0)
    >>> round(kick.omega2 * 0.56, 6), round(kick.u2, 6), round(kick.impulse, 6), round(kick.loss, 6)
    (13.0, 24.0, 12.0, 24.0)
    """
    reduced = 1.0 / (arm**2 / inertia + 1.0 / mass)
    approach = arm * omega1 - u1
    impulse = (1.0 + e) * reduced * approach
    loss = 0.5 * reduced * (1.0 - e**2) * approach**2
    return After(omega1 - arm * impulse / inertia, u1 + impulse / mass, impulse, loss)


def restitution(arm: float, omega1: float, omega2: float, u1: float, u2: float) -> float:
    """Return e = (u2 - a w2) / (a w1 - u1).

    The paper's numbers (foot 15 -> 13 m/s, ball 0 -> 24 m/s). Its 0.73 is worth what the whole numbers
    are: rounding them to 1 m/s alone leaves 0.65 to 0.83 open.

    >>> round(restitution(0.56, 15 / 0.56, 13 / 0.56, 0.0, 24.0), 4)
    0.7333
    >>> low = restitution(1.0, 15.5, 13.5, 0.0, 23.5)
    >>> high = restitution(1.0, 14.5, 12.5, 0.0, 24.5)
    >>> f"{low:.3f} to {high:.3f}"
    '0.645 to 0.828'
    """
    return (u2 - arm * omega2) / (arm * omega1 - u1)


def inertia_about_pivot(mass: float, arm: float, omega1: float, omega2: float, u1: float, u2: float) -> float:
    """Return I = m a (u2 - u1) / (w1 - w2), from the angular momentum about the pivot.

    The paper's numbers give its 1.88 kg m^2; but 15 - 13 is a small difference of rounded numbers, so
    that anything from 1.23 to 3.84 is possible: not even its first digit is certain.

    >>> round(inertia_about_pivot(0.5, 0.56, 15 / 0.56, 13 / 0.56, 0.0, 24.0), 4)
    1.8816
    >>> low = inertia_about_pivot(0.5, 0.56, 15.5 / 0.56, 12.5 / 0.56, 0.0, 23.5)
    >>> high = inertia_about_pivot(0.5, 0.56, 14.5 / 0.56, 13.5 / 0.56, 0.0, 24.5)
    >>> f"{low:.2f} to {high:.2f}"
    '1.23 to 3.84'
    """
    return mass * arm * (u2 - u1) / (omega1 - omega2)

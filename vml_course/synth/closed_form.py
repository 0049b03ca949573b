"""The textbook's answer for a pinned body that strikes a particle, to hold the simulation against.

Source: principle of angular impulse and momentum about a fixed axis with a coefficient of restitution,
for instance Beer & Johnston, Vector Mechanics for Engineers: Dynamics, chapter on plane impulsive motion.
Letters: I inertia about the pivot, m particle's mass, a lever arm of the contact normal about the pivot,
w angular velocity, u the particle's velocity along the normal; 1 before, 2 after.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from vml_course.model.arrays import FloatArray

Torque = Callable[[float], float]


def pair_mass(I: float, m: float, a: float) -> float:  # noqa: E741, N803 - textbook letters
    """Return the effective mass of the pair along the normal, 1 / (a²/I + 1/m), in kg."""
    return 1.0 / (a * a / I + 1.0 / m)


def pinned_impact(
    I: float,  # noqa: E741, N803
    m: float,
    a: float,
    e: float,
    w1: float,
    u1: float,
) -> tuple[float, float, float]:
    """Return impulse J in N s, w2 in rad/s and u2 in m/s of an instantaneous impact without friction.

    >>> J, w2, u2 = pinned_impact(I=1.8816, m=0.5, a=0.56, e=11 / 15, w1=15 / 0.56, u1=0.0)
    >>> [round(x, 9) for x in (J, w2 * 0.56, u2)]
    [12.0, 13.0, 24.0]
    """
    impulse = (1 + e) * pair_mass(I, m, a) * (a * w1 - u1)
    return impulse, w1 - a * impulse / I, u1 + impulse / m


def pinned_loss(mu: float, e: float, approach: float) -> float:
    """Return the energy lost, ½ μ (1 - e²) v², in J; `approach` is the closing speed v along the normal."""
    return 0.5 * mu * (1 - e * e) * approach * approach


def swing(I: float, torque: Torque, start: tuple[float, float], time_s: FloatArray) -> FloatArray:  # noqa: E741, N803
    """Return angle and angular velocity of a pinned body, I θ'' = torque(θ), by a fine Runge-Kutta method.

    Parameters
    ----------
    I : float
        Inertia about the pivot, kg m².
    torque : callable
        N m as a function of the angle in rad.
    start : (float, float)
        Angle in rad and angular velocity in rad/s at time 0.
    time_s : float array, shape (n,)
        Times in s, all of one sign, moving away from 0.

    Returns
    -------
    float array, shape (n, 2)
    """
    if not len(time_s) or time_s[-1] == 0:
        return np.tile(np.asarray(start, dtype=np.float64), (len(time_s), 1))

    def rate(_: float, state: FloatArray) -> tuple[float, float]:
        return state[1], torque(state[0]) / I

    found = solve_ivp(rate, (0.0, time_s[-1]), start, method="DOP853", t_eval=time_s, rtol=1e-12, atol=1e-13)
    return np.asarray(found.y.T)

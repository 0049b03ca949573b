"""The textbook's answers to plane impacts, to hold the simulation against.

Source: principle of angular impulse and momentum about a fixed axis with a coefficient of restitution,
for instance Beer & Johnston, Vector Mechanics for Engineers: Dynamics, chapter on plane impulsive motion.
Letters: I inertia about the pivot (or about the centre of a free body), m mass, a lever arm of the contact normal
about pivot or centre, w angular velocity, u velocity along the normal; 1 before, 2 after.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

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


def free_mass(*bodies: tuple[float, float, float]) -> float:
    """Return the effective mass along the normal of free bodies, 1 / Σ (1/m + a²/I), in kg.

    Parameters
    ----------
    *bodies : (float, float, float)
        Mass, inertia about the centre, and lever arm of the normal about the centre, of each.

    >>> free_mass((2.0, 1.0, 0.0), (2.0, 1.0, 0.0))
    1.0
    """
    return 1.0 / sum(1.0 / m + a * a / inertia for m, inertia, a in bodies)


class Bounce(NamedTuple):
    """What the ground gives a ball, in N s, and whether the ball's skin comes to rest on it."""

    normal: float
    tangent: float
    sticks: bool


def rough_bounce(m: float, k: float, e: float, mu: float, speed: float, slip: float) -> Bounce:
    """Return the impulses of a bounce with Coulomb friction.

    Parameters
    ----------
    m : float
        Mass of the ball, whose inertia is k m R².
    k, e, mu : float
    speed : float
        With which the centre comes down on the ground, m/s.
    slip : float
        Velocity of the ball's lowest point along the ground, m/s.

    >>> rough_bounce(m=1.0, k=0.4, e=0.5, mu=1.0, speed=2.0, slip=1.4)
    Bounce(normal=3.0, tangent=-0.4, sticks=True)
    """
    normal = (1 + e) * m * speed
    to_stick = -m * k / (1 + k) * slip
    if abs(to_stick) <= mu * normal:
        return Bounce(normal, to_stick, sticks=True)
    return Bounce(normal, -mu * normal * float(np.sign(slip)), sticks=False)


def glide(v: FloatArray, a: FloatArray, time_s: FloatArray, *, stops: bool = False) -> tuple[FloatArray, FloatArray]:
    """Return way and velocity, shape (n, 2) each, under a constant acceleration; friction ends where it has stopped."""
    if stops and np.any(a):
        time_s = np.minimum(time_s, np.hypot(*v) / np.hypot(*a))
    t = time_s[:, None]
    return v * t + 0.5 * a * t * t, v + a * t


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

"""A round head on a pivot presses on a ball by a force law: one contact, from touch-down to separation.

Hunt and Crossley's force F = k δ^1.5 (1 + λ δ'), δ the overlap, gives exactly the restitution that is asked for,
whatever the masses, when λ solves a transcendental equation (the usual approximations are up to half wrong). Here
the striker turns meanwhile, so that λ is found by bisection on the whole plane motion.

Source of the force law: K. H. Hunt and F. R. E. Crossley, Coefficient of restitution interpreted as damping in
vibroimpact, J. Appl. Mech. 42 (1975) 440.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray
from vml_course.synth.closed_form import pair_mass
from vml_course.synth.law import Movement
from vml_course.synth.laws.pinned import PinnedStrike

POWER = 1.5
MOST_DAMPING = 50.0  # times that of a straight impact


class Touch(NamedTuple):
    """A contact from touch-down to separation.

    Attributes
    ----------
    start, end : float array, shape (2, 3)
        Poses at touch-down and separation.
    rate_end : float array, shape (2, 3)
    duration_s : float
    impulse_N_s : float array, shape (2,)
        On the ball.
    moment_N_m_s : float
        Of that impulse about the pivot.
    stiffness, damping : float
        k in N/m^1.5 and λ in s/m.
    path : callable
        Time since touch-down -> angle, rate, x, y, vx, vy and more, shape (9, n).
    """

    start: FloatArray
    end: FloatArray
    rate_end: FloatArray
    duration_s: float
    impulse_N_s: FloatArray  # noqa: N815 - the unit is newton second
    moment_N_m_s: float  # noqa: N815
    stiffness: float
    damping: float
    path: Any


@lru_cache(maxsize=64)
def settle(strike: PinnedStrike, contact_s: float) -> Touch:
    """Return the contact that realises the strike's restitution, by bisection on the damping.

    Raises
    ------
    InputError
        When the two slide off one another, so that there is none.
    """
    closing = strike.arm_m * strike.omega_before_rad_s
    pair = pair_mass(strike.inertia_kg_m2, strike.other.mass_kg, strike.arm_m)
    first = straight_damping(strike.restitution)
    lasts = straight_duration(first)
    stiffness = pair * closing ** (1 - POWER) * (lasts / contact_s) ** (POWER + 1)

    def off(damping: float) -> float:
        return _restitution(strike, _integrate(strike, contact_s, stiffness, damping)) - strike.restitution

    low, high = 0.5 * first / closing, 1.5 * first / closing
    while off(low) < 0 and low > 1e-9 / closing:
        low *= 0.25
    while off(high) > 0:
        if high > MOST_DAMPING * first / closing:
            got = f"no damping that gives e = {strike.restitution:g}"
            raise InputError("contact_ms", "a contact in which foot and ball stay together", got, "Shorten it.")
        high *= 1.5
    damping = float(brentq(off, low, high, xtol=1e-14, rtol=1e-13))
    return _integrate(strike, contact_s, stiffness, damping)


def straight_damping(e: float) -> float:
    """Return d = λ v0 of a straight impact with restitution e: the root of (1+e) d = ln((1+d)/(1-d e)).

    >>> round(straight_damping(0.5), 5)
    1.43275
    """

    def off(d: float) -> float:
        return ((1 + e) * d - math.log((1 + d) / (1 - d * e))) / (d * d)

    return float(brentq(off, 1e-6, (1 - 1e-12) / e, xtol=1e-15, rtol=1e-14))


def straight_duration(d: float) -> float:
    """Return how long a straight impact of unit mass, stiffness and speed lasts.

    >>> round(straight_duration(straight_damping(0.5)), 3)
    3.604
    """

    def rate(_: float, state: FloatArray) -> tuple[float, float]:
        depth, speed = state
        return speed, -(max(depth, 0.0) ** POWER) * (1 + d * speed)

    return float(_until_apart(rate, (0.0, 1.0), 100.0, lambda _, state: state[0]).t[-1])


def _integrate(strike: PinnedStrike, contact_s: float, stiffness: float, damping: float) -> Touch:
    """Return a contact: the states are angle, rate, x, y, vx, vy, impulse (two) and its moment about the pivot."""
    start, reach = _touch_down(strike, contact_s), strike.head_radius_m + strike.other.radius_m
    m, inertia = strike.other.mass_kg, strike.inertia_kg_m2

    def overlap(_: float, state: FloatArray) -> float:
        hx, hy = head_at(strike, state[0])
        return reach - math.hypot(state[2] - hx, state[3] - hy)

    def rate(_: float, state: FloatArray) -> tuple[float, ...]:
        turn, omega, x, y, vx, vy = state[:6]
        hx, hy = head_at(strike, turn)
        apart = math.hypot(x - hx, y - hy)
        nx, ny = (x - hx) / apart, (y - hy) / apart
        depth, closing = max(reach - apart, 0.0), (-omega * hy - vx) * nx + (omega * hx - vy) * ny
        force = max(stiffness * depth**POWER * (1 + damping * closing), 0.0)
        arm = hx * ny - hy * nx
        return (
            omega,
            -force * arm / inertia,
            vx,
            vy,
            force * nx / m,
            force * ny / m,
            force * nx,
            force * ny,
            force * arm,
        )

    first = (start[0, 2], strike.omega_before_rad_s, *start[1, :2], 0.0, 0.0, 0.0, 0.0, 0.0)
    found = _until_apart(rate, first, 20.0 * contact_s, overlap)
    moved, last = as_movement(found.y[:6, -1:].T), found.y[:, -1]
    return Touch(
        start=start,
        end=moved.pose[0],
        rate_end=moved.rate[0],
        duration_s=float(found.t[-1]),
        impulse_N_s=last[6:8],
        moment_N_m_s=float(last[8]),
        stiffness=stiffness,
        damping=damping,
        path=found.sol,
    )


def _until_apart(rate: Any, start: tuple[float, ...], longest_s: float, depth: Any) -> Any:
    def apart(time_s: float, state: FloatArray) -> float:
        return float(depth(time_s, state))

    apart.terminal, apart.direction = True, -1.0  # type: ignore[attr-defined]
    return solve_ivp(
        rate, (0.0, longest_s), start, "DOP853", events=apart, dense_output=True, rtol=1e-11, atol=1e-14
    )  # fmt: skip


def _touch_down(strike: PinnedStrike, contact_s: float) -> FloatArray:
    """Return the poses at touch-down: half of the contact's turning before the striker hangs down."""
    angle = -0.5 * contact_s * strike.omega_before_rad_s
    hx, hy = head_at(strike, angle)
    reach, y = strike.head_radius_m + strike.other.radius_m, float(strike.ball_m[1])
    return np.array([[0.0, 0.0, angle], [hx + math.sqrt(reach**2 - (y - hy) ** 2), y, 0.0]])


def _restitution(strike: PinnedStrike, touch: Touch) -> float:
    size = float(np.hypot(*touch.impulse_N_s))
    arm, u2 = touch.moment_N_m_s / size, float(touch.rate_end[1, :2] @ touch.impulse_N_s) / size
    return (u2 - arm * float(touch.rate_end[0, 2])) / (arm * strike.omega_before_rad_s)


def head_at(strike: PinnedStrike, angle: Any) -> tuple[Any, Any]:
    """Return where the head's centre is at an angle (or at many): x and y in m."""
    (x, y), c, s = strike.head_m, np.cos(angle), np.sin(angle)
    return x * c - y * s, x * s + y * c


def as_movement(state: FloatArray) -> Movement:
    """Turn rows of angle, rate, x, y, vx, vy into poses and velocities."""
    pose, rate = np.zeros((len(state), 2, 3)), np.zeros((len(state), 2, 3))
    pose[:, 0, 2], rate[:, 0, 2] = state[:, 0], state[:, 1]
    pose[:, 1, :2], rate[:, 1, :2] = state[:, 2:4], state[:, 4:]
    return Movement(pose, rate)

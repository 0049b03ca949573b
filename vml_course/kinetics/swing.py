"""Kernel: where the foot of a leg on a fixed pivot and a ball are, before and after an impact.

Vector of unknowns, in the order of `UNKNOWNS` (p and q may be absent; then they are zero):

    kx ky      pivot, m                     theta      angle of the foot at the impact, from +x, rad
    w1 w2      rate before, after, rad/s    t          time of the impact, s
    bx by      ball at the impact, m        v1x v1y v2x v2y   ball's velocity before, after, m/s
    p          gravity's angular acceleration M g c / I, 1/s^2     q    constant driving acceleration, rad/s^2
    r          radius of the foot's path, m: the given length to within `LENGTH_PRIOR`, since a click beside the
               mark (or a scale a little off) makes it another one, and rates would take the blame

Perturbation of a fast rotation by gravity (p << w^2), with s = t - t_impact, phi = theta + w s and the
leg's angle counted from the x axis when y is up:

    angle = phi + q s^2/2 + p h(s),   h'' = -cos(phi),   h = (cos phi - cos theta + w s sin theta) / w^2
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vml_course.model.arrays import FloatArray

UNKNOWNS = ("kx", "ky", "theta", "w1", "w2", "t", "bx", "by", "v1x", "v1y", "v2x", "v2y", "p", "q", "r")
K, THETA, W1, W2, T, B, V1, V2, P, Q, R = 0, 2, 3, 4, 5, 6, 8, 10, 12, 13, 14
LENGTH_PRIOR = 0.01  # of the length: a click is a pixel or two off, a tape measure 5 mm
_SMALL_TURN = 0.05


@dataclass(frozen=True, eq=False, slots=True)
class Seen:
    """Clear frames of one point: time (n,), position (n, 2), sigma (n,), and whether after the impact (n,)."""

    time_s: FloatArray
    xy_m: FloatArray
    sigma_m: FloatArray
    is_after: NDArray[np.bool_]


@dataclass(frozen=True, eq=False, slots=True)
class SwingData:
    """All that is compared with the kernel.

    Attributes
    ----------
    foot, ball : Seen
    length_m : float
        Pivot to foot.
    gravity_before, gravity_after : float array, shape (2,)
        Of the free ball.
    tilt_rad : float
        Angle of the horizontal against the x axis.
    unknowns : tuple of int
        Which entries of `UNKNOWNS` are estimated; the others stay zero.
    """

    foot: Seen
    ball: Seen
    length_m: float
    gravity_before: FloatArray
    gravity_after: FloatArray
    tilt_rad: float
    unknowns: tuple[int, ...]


def full(x: FloatArray, unknowns: tuple[int, ...]) -> FloatArray:
    """Return the vector of all unknowns, zeros for those that are not estimated."""
    whole = np.zeros(len(UNKNOWNS))
    whole[list(unknowns)] = x
    return whole


def residuals(x: FloatArray, data: SwingData) -> FloatArray:
    """Return (model - measured) / sigma, shape (2 n_foot + 2 n_ball + 1,): foot x, y, ball x, y, the length."""
    u = full(x, data.unknowns)
    angle, _ = _leg(u, data)
    foot = u[K : K + 2, None] + u[R] * np.stack([np.cos(angle), np.sin(angle)])
    ball, _ = _ball(u, data)
    return np.concatenate([
        ((foot - data.foot.xy_m.T) / data.foot.sigma_m).ravel(),
        ((ball - data.ball.xy_m.T) / data.ball.sigma_m).ravel(),
        [(u[R] - data.length_m) / (LENGTH_PRIOR * data.length_m)],
    ])  # fmt: skip


def jacobian(x: FloatArray, data: SwingData) -> FloatArray:
    """Return the derivatives of `residuals`, shape (2 n_foot + 2 n_ball + 1, unknowns)."""
    u, n, m = full(x, data.unknowns), len(data.foot.time_s), len(data.ball.time_s)
    angle, slopes = _leg(u, data)
    across = u[R] * np.stack([-np.sin(angle), np.cos(angle)])
    foot, ball = np.zeros((len(UNKNOWNS), 2, n)), np.zeros((len(UNKNOWNS), 2, m))
    foot[K, 0], foot[K + 1, 1] = 1.0, 1.0
    foot[R] = np.stack([np.cos(angle), np.sin(angle)])
    length = np.zeros((len(UNKNOWNS), 1))
    length[R] = 1.0 / (LENGTH_PRIOR * data.length_m)
    for index, slope in slopes.items():
        foot[index] = slope * across
    s, velocity = _ball(u, data)[1]
    for axis in (0, 1):
        ball[B + axis, axis] = 1.0
        ball[V1 + axis, axis] = np.where(data.ball.is_after, 0.0, s)
        ball[V2 + axis, axis] = np.where(data.ball.is_after, s, 0.0)
    ball[T] = -velocity
    rows = [(foot / data.foot.sigma_m).reshape(-1, 2 * n), (ball / data.ball.sigma_m).reshape(-1, 2 * m), length]
    return np.asarray(np.concatenate(rows, axis=1)[list(data.unknowns)].T)


def length_slope(x: FloatArray, data: SwingData) -> FloatArray:
    """Return the derivative of `residuals` by the given length."""
    rows = np.zeros(2 * (len(data.foot.time_s) + len(data.ball.time_s)) + 1)
    rows[-1] = -full(x, data.unknowns)[R] / (LENGTH_PRIOR * data.length_m**2)
    return rows


def _leg(u: FloatArray, data: SwingData) -> tuple[FloatArray, dict[int, FloatArray]]:
    """Return the leg's angle and its derivatives by theta, w1, w2, t, p, q."""
    s = data.foot.time_s - u[T]
    omega = np.where(data.foot.is_after, u[W2], u[W1])
    sag, sag_theta, sag_omega, sag_s = gravity_sag(s, u[THETA] - data.tilt_rad, omega)
    angle = u[THETA] + omega * s + 0.5 * u[Q] * s**2 + u[P] * sag
    by_omega = s + u[P] * sag_omega
    slopes = {
        THETA: 1.0 + u[P] * sag_theta,
        W1: np.where(data.foot.is_after, 0.0, by_omega),
        W2: np.where(data.foot.is_after, by_omega, 0.0),
        T: -(omega + u[Q] * s + u[P] * sag_s),
        P: sag,
        Q: 0.5 * s**2,
    }
    return angle, slopes


def gravity_sag(
    s: FloatArray, theta: float, omega: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return h(s) of the module's docstring and its derivatives by theta, w and s.

    Near w s = 0 the closed form cancels to nothing; a series takes its place.
    """
    turn = omega * s
    is_small = np.abs(turn) < _SMALL_TURN
    w = np.where(is_small, 1.0, omega)
    phi, cos_0, sin_0 = theta + turn, np.cos(theta), np.sin(theta)
    bracket = np.cos(phi) - cos_0 + turn * sin_0
    sine = sin_0 - np.sin(phi)
    by_theta = -np.sin(phi) + sin_0 + turn * cos_0
    exact = (bracket / w**2, by_theta / w**2, s * sine / w**2 - 2.0 * bracket / w**3, sine / w)
    series = (
        s**2 * (-cos_0 / 2 + sin_0 * turn / 6 + cos_0 * turn**2 / 24 - sin_0 * turn**3 / 120),
        s**2 * (sin_0 / 2 + cos_0 * turn / 6 - sin_0 * turn**2 / 24 - cos_0 * turn**3 / 120),
        s**3 * (sin_0 / 6 + cos_0 * turn / 12 - sin_0 * turn**2 / 40),
        s * (-cos_0 + sin_0 * turn / 2 + cos_0 * turn**2 / 6 - sin_0 * turn**3 / 24),
    )
    a, b, c, d = (np.where(is_small, near, far) for near, far in zip(series, exact, strict=True))
    return a, b, c, d


def _ball(u: FloatArray, data: SwingData) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Return the ball's position, shape (2, m), its time since the impact and its velocity."""
    s = data.ball.time_s - u[T]
    velocity = np.where(data.ball.is_after, u[V2 : V2 + 2, None], u[V1 : V1 + 2, None])
    gravity = np.where(data.ball.is_after, data.gravity_after[:, None], data.gravity_before[:, None])
    position = u[B : B + 2, None] + velocity * s + 0.5 * gravity * s**2
    return position, (s, velocity + gravity * s)

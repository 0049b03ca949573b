"""Kernels: the paths that bodies take before and after an impact. Impact models put their motions together from these.

A path is a function (u, s, is_after) -> (x, y): `u` maps the name of every unknown and given number to an array of
shape (k, 1), `s` holds seconds since the impact, shape (k, n), `is_after` says on which side a frame lies, shape (n,).
Everything is analytic (no absolute value, no arctan2), so that complex steps give exact derivatives.

A body "b" has the unknowns bx, by (position at the impact, m), b1x, b1y and b2x, b2y (velocity before and after, m/s).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from vml_course.kinetics.pendulum import swung

Symbols = Mapping[str, Any]
Path = Callable[[Symbols, Any, Any], "Place"]


class Place(NamedTuple):
    """Coordinates, each of shape (k, n): metres."""

    x: Any
    y: Any


def flying(body: str, gravity_before: Any, gravity_after: Any) -> Path:
    """Return the path of a free body: a straight line or a parabola each side, g (2,) in m/s^2."""

    def path(u: Symbols, s: Any, is_after: Any) -> Place:
        side = np.where(is_after, 2, 1)
        g = np.where(is_after, np.asarray(gravity_after)[:, None], np.asarray(gravity_before)[:, None])
        velocity = [np.where(side == 2, u[f"{body}2{axis}"], u[f"{body}1{axis}"]) for axis in "xy"]
        return Place(*(u[f"{body}{axis}"] + velocity[i] * s + 0.5 * g[i] * s**2 for i, axis in enumerate("xy")))

    return path


def sliding(body: str, gravity_m_s2: float) -> Path:
    """Return the path of a block that slides on after the impact until friction "mu" has stopped it.

    x = b + v s - mu g s^2 v/(2 |v|) for s < |v| / (mu g); straight before the impact.
    """

    def path(u: Symbols, s: Any, is_after: Any) -> Place:
        vx, vy = u[f"{body}2x"], u[f"{body}2y"]
        speed, mu = size(vx, vy), u["mu"]
        stop = speed / np.where(mu.real > 1e-9, mu * gravity_m_s2, 1e-9)
        until = np.where(s.real < stop.real, s, stop)
        way = until - 0.5 * mu * gravity_m_s2 * until**2 / speed
        x = np.where(is_after, vx * way, u[f"{body}1x"] * s)
        y = np.where(is_after, vy * way, u[f"{body}1y"] * s)
        return Place(u[f"{body}x"] + x, u[f"{body}y"] + y)

    return path


def swinging(tilt_rad: float) -> Path:
    """Return the path of a point on a pivoted body: pivot (kx, ky), radius r, angle theta at the impact.

    Rates w1 and w2; gravity's p and the drive's q (see `pendulum.py`) are zero where they are no symbols.
    """

    def path(u: Symbols, s: Any, is_after: Any) -> Place:
        angle = swing_angle(u, s, is_after, tilt_rad)
        return Place(u["kx"] + u["r"] * np.cos(angle), u["ky"] + u["r"] * np.sin(angle))

    return path


def swing_angle(u: Symbols, s: Any, is_after: Any, tilt_rad: Any) -> Any:
    """Return the angle of a pivoted body, shape (k, n)."""
    none = np.zeros_like(u["theta"])
    p, q = u.get("p", none), u.get("q", none)
    if "p" not in u:
        rate = np.where(is_after, u["w2"], u["w1"])
        return u["theta"] + rate * s + 0.5 * q * s**2
    return swung(s, is_after, u["theta"], (u["w1"], u["w2"]), (p, q, none + tilt_rad))


def turning(centre: Path, across: Callable[[Symbols], Any], rates: Callable[[Symbols], tuple[Any, Any]]) -> Path:
    """Return the path of a mark on a free body that turns steadily about its moving centre.

    The mark is `across(u)` away from the centre, at the angle theta + w s with the `rates(u)` before and after.
    """

    def path(u: Symbols, s: Any, is_after: Any) -> Place:
        w1, w2 = rates(u)
        angle = u["theta"] + np.where(is_after, w2, w1) * s
        at, reach = centre(u, s, is_after), across(u)
        return Place(at.x + reach * np.cos(angle), at.y + reach * np.sin(angle))

    return path


def size(x: Any, y: Any) -> Any:
    """Return the length of a vector; unlike np.hypot it takes complex steps."""
    return np.sqrt(x * x + y * y)


def direction(x: Any, y: Any) -> tuple[Any, Any]:
    """Return the unit vector along (x, y)."""
    length = size(x, y)
    return x / length, y / length

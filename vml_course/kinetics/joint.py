"""Joint least squares of all tracked paths, and how sure the result is.

A model says which numbers are unknown, which are given, and where each tracked point is at any time (`paths.py`).
Derivatives come by complex steps, f'(x) = Im f(x + ih) / h, exact to rounding: nobody writes a Jacobian by hand
(Squire & Trapp, SIAM Review 40, 1998). All steps are one evaluation, stacked along the first axis.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from vml_course.kinetics.clear_frames import Seen
from vml_course.kinetics.paths import Path, Symbols
from vml_course.model.arrays import FloatArray, IntArray

STEP = 1e-30
MOST_MISPLACED = 2  # frames of a point
Outcome = Callable[[Symbols], Mapping[str, Any]]


@dataclass(frozen=True, eq=False, slots=True)
class Watched:
    """Name and clear frames of one point, and where the model says that it is."""

    name: str
    seen: Seen
    path: Path


@dataclass(frozen=True, eq=False, slots=True)
class Held:
    """Something known beside the tracks: `distance(u)` is zero to within one standard deviation `sd`."""

    distance: Callable[[Symbols], Any]
    sd: float


@dataclass(frozen=True, eq=False)
class Problem:
    """What is fitted to what.

    Attributes
    ----------
    start : mapping of str to float
        The unknowns by name with a first guess; "t", the time of the impact, is always among them.
    given : mapping of str to float
        Numbers that are known, by symbol. "scale" is added: the measured positions are multiplied by it, so that
        its uncertainty is that of every other given number.
    watched : tuple of Watched
    held : tuple of Held
    """

    start: Mapping[str, float]
    given: Mapping[str, float]
    watched: tuple[Watched, ...]
    held: tuple[Held, ...] = ()

    @cached_property
    def known(self) -> dict[str, float]:
        """The given numbers and the scale."""
        return {**self.given, "scale": 1.0}

    def symbols(self, rows: Any) -> dict[str, Any]:
        """Name the columns of (k, unknowns + known) numbers."""
        return {name: rows[:, [i]] for i, name in enumerate((*self.start, *self.known))}

    def rows(self, x: Any) -> Any:
        """Return unknowns and known numbers as one row, shape (1, unknowns + known)."""
        return np.concatenate([x, list(self.known.values())])[None]

    def stepped(self, x: FloatArray) -> Any:
        """Return a row for each unknown and known number, with a complex step in it."""
        row = self.rows(x)
        return row + 1j * STEP * np.eye(row.shape[1])


def residuals(problem: Problem, rows: Any) -> Any:
    """Return (model - measured) / sigma, shape (k, all): x then y of each point, then what is held."""
    u, parts = problem.symbols(rows), []
    for point in problem.watched:
        seen = point.seen
        place = point.path(u, seen.time_s - u["t"], seen.is_after)
        parts += [(place[axis] - u["scale"] * seen.xy_m[:, axis]) / seen.sigma_m for axis in (0, 1)]
    parts += [held.distance(u) / held.sd for held in problem.held]
    return np.concatenate(parts, axis=1)


def slopes(problem: Problem, x: FloatArray) -> FloatArray:
    """Return the derivatives of `residuals` by unknowns and known numbers, shape (all, unknowns + known)."""
    return np.asarray(residuals(problem, problem.stepped(x)).imag.T / STEP)


@dataclass(frozen=True, eq=False)
class Fit:
    """Result of the least squares.

    Attributes
    ----------
    x : float array, shape (k,)
        The unknowns, in the order of `problem.start`.
    covariance : float array, shape (k, k)
        (J^T J)^-1 s^2, inflated by (1 + rho) / (1 - rho) for residuals that are alike from frame to frame.
    residual : float array, shape (rows,)
        In units of sigma.
    lag1 : float
        Mean lag-1 correlation rho of the residuals.
    by_known : float array, shape (k, known)
        How the unknowns follow a change of the known numbers.
    """

    problem: Problem
    x: FloatArray
    covariance: FloatArray
    residual: FloatArray
    lag1: float
    by_known: FloatArray

    def __getitem__(self, name: str) -> float:
        """Return an unknown by its name, zero where it was not estimated."""
        names = list(self.problem.start)
        return float(self.x[names.index(name)]) if name in names else 0.0

    def sd(self, name: str) -> float:
        """Return one standard deviation of an unknown, from noise alone."""
        at = list(self.problem.start).index(name)
        return float(np.sqrt(self.covariance[at, at]))

    @property
    def residual_rms_m(self) -> float:
        """Root mean square of the residuals of all coordinates, in metres."""
        sigma = np.concatenate([np.tile(point.seen.sigma_m, 2) for point in self.problem.watched])
        return float(np.sqrt(np.mean((self.residual[: len(sigma)] * sigma) ** 2)))

    def derive(self, outcome: Outcome) -> Derived:
        """Return derived quantities with their derivatives by unknowns and known numbers."""
        found = outcome(self.problem.symbols(self.problem.stepped(self.x)))
        rows = np.stack(
            [np.broadcast_to(value, (self.x.size + self.by_known.shape[1], 1))[:, 0] for value in found.values()]
        )
        by_x, by_known = rows.imag[:, : self.x.size] / STEP, rows.imag[:, self.x.size :] / STEP
        return Derived(tuple(found), rows.real[:, 0], by_x @ self.covariance @ by_x.T, by_known + by_x @ self.by_known)


@dataclass(frozen=True, eq=False, slots=True)
class Derived:
    """Values (o,) with their covariance from noise (o, o), and their total slopes by the known numbers (o, known)."""

    names: tuple[str, ...]
    values: FloatArray
    covariance: FloatArray
    by_known: FloatArray


def fit(problem: Problem) -> Fit:
    """Fit by weighted least squares (Levenberg-Marquardt).

    A frame right beside the impact can have been put on the wrong side of it. The fitted moment tells; such frames are
    left out, and the rest is fitted again.
    """
    found = _fit(problem)
    watched = tuple(_rightly_sided(point, found["t"]) for point in problem.watched)
    if all(new is old for new, old in zip(watched, problem.watched, strict=True)):
        return found
    start = dict(zip(problem.start, map(float, found.x), strict=True))
    return _fit(replace(problem, start=start, watched=watched))


def _rightly_sided(point: Watched, time_s: float) -> Watched:
    """Return a point without the frames whose side a moment contradicts; many such frames speak against the moment."""
    seen = point.seen
    right = (seen.time_s > time_s) == seen.is_after
    if right.all() or np.sum(~right) > MOST_MISPLACED:
        return point
    kept = Seen(seen.time_s[right], seen.xy_m[right], seen.sigma_m[right], seen.is_after[right])
    return replace(point, seen=kept)


def _fit(problem: Problem) -> Fit:
    count = len(problem.start)

    def misfit(x: FloatArray) -> FloatArray:
        return np.asarray(residuals(problem, problem.rows(x))[0])

    def by_unknowns(x: FloatArray) -> FloatArray:
        return slopes(problem, x)[:, :count]

    found = least_squares(
        misfit, np.array(list(problem.start.values())), jac=by_unknowns, method="lm", x_scale="jac",
        xtol=1e-13, ftol=1e-13, gtol=1e-13, max_nfev=100,
    )  # fmt: skip
    x = np.asarray(found.x, dtype=np.float64)
    every, residual = slopes(problem, x), misfit(x)
    scale = np.maximum(np.sqrt(np.sum(every[:, :count] ** 2, axis=0)), 1e-300)
    inverse = np.linalg.pinv(every[:, :count] / scale, rcond=1e-12)
    lag1 = lag1_correlation(residual, problem)
    variance = residual @ residual / max(len(residual) - count, 1) * (1.0 + lag1) / (1.0 - lag1)
    return Fit(
        problem=problem,
        x=x,
        covariance=variance * (inverse @ inverse.T) / np.outer(scale, scale),
        residual=residual,
        lag1=lag1,
        by_known=-(inverse @ every[:, count:]) / scale[:, None],
    )


def lag1_correlation(residual: FloatArray, problem: Problem) -> float:
    """Return the mean correlation of residuals of neighbouring frames, not below 0.

    Each coordinate of each point on each side is one series of n frames. Fitting about a line to each
    pulls the estimate r down by (2 + 4 r) / n (Kendall's bias with a trend), which is put back.
    """
    parts = [residual[rows] for rows in series_of(problem)]
    pairs = sum(float(part[1:] @ part[:-1]) / max(len(part) - 1, 1) for part in parts)
    squares = sum(float(part @ part) / len(part) for part in parts)
    frames = float(np.mean([len(part) for part in parts]))
    return _unbiased(pairs / squares if squares > 0 else 0.0, frames)


def series_of(problem: Problem) -> list[IntArray]:
    """Return the rows of `residuals` that belong together, in time: each coordinate of each point on each side."""
    series, start = [], 0
    for point in problem.watched:
        seen = point.seen
        for _ in range(2):
            rows = start + np.argsort(seen.time_s, kind="stable")
            after = seen.is_after[rows - start]
            series += [part for part in (rows[~after], rows[after]) if len(part)]
            start += len(rows)
    return series


def _unbiased(raw: float, frames: float) -> float:
    return float(np.clip((frames * raw + 2.0) / max(frames - 4.0, 1.0), 0.0, 0.95))

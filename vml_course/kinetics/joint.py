"""Joint least squares of all tracked paths, and how sure the result is.

A model says which numbers are unknown, which are given, and where each tracked point is at any time (`paths.py`).
Derivatives come by complex steps, f'(x) = Im f(x + ih) / h, exact to rounding: nobody writes a Jacobian by hand
(Squire & Trapp, SIAM Review 40, 1998). All steps are one evaluation, stacked along the first axis.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from vml_course.kinetics.clear_frames import Seen
from vml_course.kinetics.paths import Path, Symbols
from vml_course.kinetics.scatter import Scatter, scatter_of, waves
from vml_course.model.arrays import FloatArray, IntArray

STEP = 1e-30
MOST_MISPLACED = 2  # frames of a point
SMALLEST = 1e-6  # of the said scatter: motions without noise stay within numbers
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


class Misfit:
    """Residuals of a problem and their derivatives: a fit asks for both at one place, and one evaluation holds both."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._x: FloatArray | None = None
        self._stepped: Any = None

    def residuals(self, x: FloatArray) -> FloatArray:
        """Return the residuals, shape (all,)."""
        return np.ascontiguousarray(self._at(x)[0].real)

    def slopes(self, x: FloatArray) -> FloatArray:
        """Return the derivatives by unknowns and known numbers, shape (all, unknowns + known)."""
        return np.asarray(self._at(x).imag.T / STEP)

    def _at(self, x: FloatArray) -> Any:
        if self._x is None or not np.array_equal(x, self._x):
            self._x, self._stepped = x.copy(), residuals(self._problem, self._problem.stepped(x))
        return self._stepped


@dataclass(frozen=True, eq=False)
class Fit:
    """Result of the least squares.

    Attributes
    ----------
    x : float array, shape (k,)
        The unknowns, in the order of `problem.start`.
    noise : float array, shape (k, k)
        Covariance by the errors of the tracks alone: noise, alike from frame to frame, and pixel locking.
    covariance : float array, shape (k, k)
        The same and how well that which is held is known.
    residual : float array, shape (rows,)
        In units of sigma.
    scatter : Scatter
        What the residuals tell of the errors.
    by_known : float array, shape (k, known)
        How the unknowns follow a change of the known numbers.
    """

    problem: Problem
    x: FloatArray
    noise: FloatArray
    covariance: FloatArray
    residual: FloatArray
    scatter: Scatter
    by_known: FloatArray

    def __getitem__(self, name: str) -> float:
        """Return an unknown by its name, zero where it was not estimated."""
        names = list(self.problem.start)
        return float(self.x[names.index(name)]) if name in names else 0.0

    def sd(self, name: str) -> float:
        """Return one standard deviation of an unknown, the given numbers taken as exact."""
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
        noise, whole = (by_x @ part @ by_x.T for part in (self.noise, self.covariance))
        return Derived(tuple(found), rows.real[:, 0], noise, whole, by_known + by_x @ self.by_known)


@dataclass(frozen=True, eq=False, slots=True)
class Derived:
    """Values (o,) with their covariances (o, o) as those of `Fit`, and total slopes by the known numbers (o, known)."""

    names: tuple[str, ...]
    values: FloatArray
    noise: FloatArray
    covariance: FloatArray
    by_known: FloatArray


def fit(problem: Problem) -> Fit:
    """Fit by weighted least squares (Levenberg-Marquardt).

    A frame right beside the impact can have been put on the wrong side of it. The fitted moment tells; such frames are
    left out. Where something is held, and the sigma of the tracks was but a guess, they must weigh against it as they
    scatter. In either case the rest is fitted again.
    """
    found = _fit(problem)
    # In powers of 16: a tracker's sigma is never a factor of four off, a guessed one is.
    rms = float(np.sqrt(np.mean(found.residual[: -len(problem.held)] ** 2))) if problem.held else 1.0
    factor = 16.0 ** round(math.log(max(rms, SMALLEST), 16.0))
    watched = tuple(_reweighted(_rightly_sided(point, found["t"]), factor) for point in problem.watched)
    if all(new is old for new, old in zip(watched, problem.watched, strict=True)):
        return found
    start = dict(zip(problem.start, map(float, found.x), strict=True))
    return _fit(replace(problem, start=start, watched=watched))


def _reweighted(point: Watched, factor: float) -> Watched:
    """Return a point whose sigma is larger by a factor."""
    if factor == 1.0:
        return point
    return replace(point, seen=replace(point.seen, sigma_m=point.seen.sigma_m * factor))


def _rightly_sided(point: Watched, time_s: float) -> Watched:
    """Return a point without the frames whose side a moment contradicts; many such frames speak against the moment."""
    seen = point.seen
    right = (seen.time_s > time_s) == seen.is_after
    if right.all() or np.sum(~right) > MOST_MISPLACED:
        return point
    return replace(point, seen=seen.kept(right))


def _fit(problem: Problem) -> Fit:
    count, misfit = len(problem.start), Misfit(problem)

    def by_unknowns(x: FloatArray) -> FloatArray:
        return misfit.slopes(x)[:, :count]

    found = least_squares(
        misfit.residuals, np.array(list(problem.start.values())), jac=by_unknowns, method="lm", x_scale="jac",
        xtol=1e-13, ftol=1e-13, gtol=1e-13, max_nfev=100,
    )  # fmt: skip
    x = np.asarray(found.x, dtype=np.float64)
    every, residual = misfit.slopes(x), misfit.residuals(x)
    scale = np.maximum(np.sqrt(np.sum(every[:, :count] ** 2, axis=0)), 1e-300)
    inverse = np.linalg.pinv(every[:, :count] / scale, rcond=1e-12) / scale[:, None]
    scatter, noise, whole = _errors(problem, residual, every[:, :count], inverse)
    return Fit(
        problem=problem,
        x=x,
        noise=noise,
        covariance=whole,
        residual=residual,
        scatter=scatter,
        by_known=-inverse @ every[:, count:],
    )


def _errors(
    problem: Problem, residual: FloatArray, slope: FloatArray, inverse: FloatArray
) -> tuple[Scatter, FloatArray, FloatArray]:
    """Return what the residuals tell, and the covariance of the unknowns: by the tracks alone, and in all.

    An error d of the rows moves the unknowns by -G d, G = `inverse`. What is held errs by its own sd, not as tracks do.
    """
    tracked = len(residual) - len(problem.held)
    wave = _locking_waves(problem)
    left = wave - slope[:tracked] @ (inverse[:, :tracked] @ wave)
    freedom = max(len(residual) - len(inverse), 1)
    scatter = scatter_of(residual[:tracked], left, wave, freedom, series_of(problem))
    by_noise, by_wave, by_held = inverse[:, :tracked], inverse[:, :tracked] @ wave, inverse[:, tracked:]
    noise = scatter.widened * by_noise @ by_noise.T + scatter.allowed_px2 * by_wave @ by_wave.T
    return scatter, noise, noise + by_held @ by_held.T


def _locking_waves(problem: Problem) -> FloatArray:
    """Return two columns for each coordinate of the points whose pixels are known, shape (tracked rows, columns)."""
    rows = sum(2 * len(point.seen.time_s) for point in problem.watched)
    columns, start = [np.zeros((rows, 0))], 0
    for seen in (point.seen for point in problem.watched):
        for place in seen.xy_m.T:
            if np.isfinite(seen.pixel_m):
                column = np.zeros((rows, 2))
                column[start : start + len(place)] = waves(place, seen.sigma_m, seen.pixel_m)
                columns.append(column)
            start += len(place)
    return np.concatenate(columns, axis=1)


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

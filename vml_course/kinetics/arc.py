"""A circle through the striker's path: where the pivot is, without trusting a mark on the knee."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from vml_course.kinetics.scatter import MOST_ALIKE, scatter_of, waves
from vml_course.model.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Arc:
    """A fitted circle: centre (2,), radius with its standard deviation, scatter across the path; metres.

    The standard deviation allows for errors that are alike from point to point, and for pixel locking.
    """

    centre_m: FloatArray
    radius_m: float
    radius_sd_m: float
    scatter_m: float


SHORT = 0.3  # of its radius: a shorter arc is as good as a parabola, and its radius is known by the curvature alone


def fit_arc(xy_m: FloatArray, pixel_m: float = math.nan, rounds: int = 30) -> Arc:
    """Fit a circle to points in the order of time, shape (n, 2), n >= 4, without NaN.

    Starts from the algebraic fit (linear, but drawn inwards by noise) and minimises the distances across
    the path by Gauss-Newton steps. A short arc, whose steps run away, is taken as a parabola over its chord.
    Pixel locking is allowed for where the size of a pixel is told.
    """
    short = _short_arc(xy_m, pixel_m)
    if short is not None:
        return short
    middle = xy_m.mean(axis=0)
    x, y = (xy_m - middle).T
    a, b, c = np.linalg.lstsq(np.stack([2 * x, 2 * y, np.ones_like(x)], axis=1), x**2 + y**2, rcond=None)[0]
    unknown = np.array([a, b, np.sqrt(max(c + a**2 + b**2, 1e-12))])
    for _ in range(rounds):
        step = np.linalg.lstsq(*_linearised(x, y, unknown), rcond=None)[0]
        unknown = unknown + step
        if np.abs(step).max() < 1e-12:
            break
    slopes, rest = _linearised(x, y, unknown)
    radius_sd, scatter = _last_sd(slopes, rest, _locked_across(xy_m, slopes[:, :2], pixel_m))
    return Arc(unknown[:2] + middle, float(unknown[2]), radius_sd, scatter)


def _short_arc(xy_m: FloatArray, pixel_m: float) -> Arc | None:
    """Return the arc of a path that is nearly straight; None when it is not.

    Along the chord h = a + b s + k s^2/2 has the curvature k, which noise shifts to either side alike.
    """
    middle = xy_m.mean(axis=0)
    along = np.linalg.svd(xy_m - middle, full_matrices=False)[2][0]
    across = np.array([-along[1], along[0]])
    s, h = (xy_m - middle) @ along, (xy_m - middle) @ across
    basis = np.stack([np.ones_like(s), s, 0.5 * s**2], axis=1)
    _, slope, curvature = found = np.linalg.pinv(basis) @ h
    length = float(np.ptp(s))
    wave = _locked_across(xy_m, np.broadcast_to(across, xy_m.shape), pixel_m)
    curvature_sd, scatter = _last_sd(basis, h - basis @ found, wave)
    if not (abs(curvature) * length < SHORT and scatter < 0.02 * length):
        return None
    bend = curvature if abs(curvature) > 1e-9 else 1e-9
    centre = middle + (across - slope * along) / bend
    return Arc(centre, 1.0 / abs(bend), curvature_sd / bend**2, scatter)


def _locked_across(xy_m: FloatArray, normal: FloatArray, pixel_m: float) -> FloatArray:
    """Return the columns of x's and y's locking across the path, shape (n, 4); (n, 0) where no pixel is known."""
    if not math.isfinite(pixel_m):
        return np.zeros((len(xy_m), 0))
    metres = np.ones(len(xy_m))
    return np.hstack([waves(xy_m[:, axis], metres, pixel_m) * normal[:, [axis]] for axis in (0, 1)])


def _last_sd(slopes: FloatArray, rest: FloatArray, wave: FloatArray) -> tuple[float, float]:
    """Return the sd of the last of three unknowns, and the scatter about the curve in metres.

    One short series cannot tell locking from noise that is alike, so that both are allowed for in full. It also knows
    its correlation badly, sd = sqrt((1 - rho^2) / n): by that much it is taken to be larger. Else 3 sd were exceeded by
    2 % of the circles.
    """
    count, weights = len(rest), np.linalg.pinv(slopes)
    freedom, series = max(count - 3, 1), [np.arange(count)]
    noise = scatter_of(rest, wave[:, :0], wave[:, :0], freedom, series)
    alike = min(noise.lag1 + math.sqrt((1.0 - noise.lag1**2) / count), MOST_ALIKE)
    locking = scatter_of(rest, wave - slopes @ (weights @ wave), wave, freedom, series).allowed_px2
    variance = replace(noise, lag1=alike).widened * float(weights[2] @ weights[2])
    return math.sqrt(variance + locking * float(np.sum((weights[2] @ wave) ** 2))), math.sqrt(noise.noise)


def centre_at_distance(xy_m: FloatArray, arc: Arc, radius_m: float, rounds: int = 20) -> FloatArray:
    """Return the centre that fits best when the radius is known, on the side that the free fit says."""
    middle = xy_m.mean(axis=0)
    inward = (arc.centre_m - middle) / max(float(np.hypot(*(arc.centre_m - middle))), 1e-12)
    centre = arc.centre_m + inward * (radius_m - arc.radius_m)
    x, y = (xy_m - middle).T
    for _ in range(rounds):
        slopes, rest = _linearised(x, y, np.append(centre - middle, radius_m))
        step = np.linalg.lstsq(slopes[:, :2], rest, rcond=None)[0]
        centre = centre + step
        if np.abs(step).max() < 1e-12:
            break
    return np.asarray(centre)


def _linearised(x: FloatArray, y: FloatArray, unknown: FloatArray) -> tuple[FloatArray, FloatArray]:
    away_x, away_y = x - unknown[0], y - unknown[1]
    distance = np.maximum(np.hypot(away_x, away_y), 1e-12)
    return np.stack([away_x / distance, away_y / distance, np.ones_like(x)], axis=1), distance - unknown[2]

"""Is the scale right, is the frame rate, is the body rigid, is the pivot at its mark? The clip itself can tell."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vml_course.kinetics.arc import fit_arc
from vml_course.kinetics.clear_frames import Seen
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion

RATES = (30.0, 60.0, 120.0, 240.0, 480.0, 960.0)  # 1/s, of cameras and players
NEAR = 0.04
STRETCH = 0.005  # of a rigid body's length: more is not tracking noise


@dataclass(frozen=True, slots=True)
class Fall:
    """Downward acceleration of the free ball with its standard deviation, m/s^2 (NaN: too few frames)."""

    value: float
    sd: float


def apparent_gravity(ball: Seen, up_angle_rad: float) -> Fall:
    """Measure the free ball's downward acceleration after the impact.

    A wrong frame rate shows as the square of its factor, a wrong scale as its factor.
    """
    t, xy = ball.time_s[ball.is_after], ball.xy_m[ball.is_after]
    if len(t) < 6:
        return Fall(float("nan"), float("inf"))
    down = -(xy @ np.array([np.cos(up_angle_rad), np.sin(up_angle_rad)]))
    middle = float(t.mean())
    basis = np.stack([np.ones_like(t), t - middle, 0.5 * (t - middle) ** 2], axis=1)
    weights = np.linalg.pinv(basis)
    rest = down - basis @ (weights @ down)
    scatter = float(np.sqrt(rest @ rest / (len(t) - 3)))
    return Fall(float((weights @ down)[2]), scatter * float(np.sqrt(weights[2] @ weights[2])) + 1e-9)


def gravity_cause(apparent_m_s2: float, gravity_m_s2: float) -> str:
    """Return what would explain an apparent gravity, as words to put after "check frame rate and scale".

    Times longer by c make g smaller by c^2; lengths larger by c make it larger by c.

    >>> gravity_cause(9.81 / 256, 9.81)
    ' (times are 16 times too long, as when 30 frames/s were typed for 480 or 60 for 960)'
    >>> gravity_cause(4.9, 9.81)
    ' (lengths are 0.499 times what they should be, as when a radius was typed for a diameter)'
    >>> gravity_cause(-3.0, 9.81)
    ''
    """
    if not (apparent_m_s2 > 0 and gravity_m_s2 > 0 and math.isfinite(apparent_m_s2)):
        return ""
    share = apparent_m_s2 / gravity_m_s2
    for factor, words in ((0.5, "a radius was typed for a diameter"), (2.0, "a diameter was typed for a radius")):
        if abs(share / factor - 1) < NEAR:
            return f" (lengths are {share:.3g} times what they should be, as when {words})"
    stretch = math.sqrt(1.0 / share)
    pairs = [(typed, real) for typed in RATES for real in RATES if typed != real]
    fitting = [(typed, real) for typed, real in pairs if abs(real / typed / stretch - 1) < NEAR / 2]
    if not fitting:
        return ""
    (typed, real), *others = fitting
    more = "".join(f" or {a:g} for {b:g}" for a, b in others)
    return f" (times are {stretch:.3g} times too long, as when {typed:g} frames/s were typed for {real:g}{more})"


@dataclass(frozen=True, slots=True)
class Rigidity:
    """How constant the distance of two marks on one body is.

    Attributes
    ----------
    length_m : float
        Median distance.
    spread_m : float
        Scatter of the distance about it.
    expected_m : float
        Scatter that the tracker's sigma lets expect, NaN where that is unknown.
    trend : float
        Change from the first to the last tenth of the frames, as a share of the length: a body that leaves the plane.
    is_rigid : bool
    """

    length_m: float
    spread_m: float
    expected_m: float
    trend: float
    is_rigid: bool


def check_rigid(motion: Motion, tail: str, head: str) -> Rigidity:
    """Check that two marks keep their distance.

    Raises
    ------
    UnknownNameError
    """
    length = np.hypot(*(motion.of(head) - motion.of(tail)).T)
    seen = np.isfinite(length)
    sigmas = [motion.sigma_m[seen, motion.points.index(name)] for name in (tail, head)]
    expected = float(np.sqrt(np.mean(sigmas[0] ** 2 + sigmas[1] ** 2)))
    length = length[seen]
    middle, part = float(np.median(length)), max(len(length) // 10, 1)
    spread = float(np.sqrt(np.mean((length - middle) ** 2)))
    trend = float(np.median(length[-part:]) - np.median(length[:part])) / middle
    most = STRETCH * middle + (3.0 * expected if math.isfinite(expected) else 0.0)
    return Rigidity(middle, spread, expected, trend, bool(spread < most and abs(trend) * middle < most))


@dataclass(frozen=True, eq=False, slots=True)
class PivotCheck:
    """The centre of a mark's arc against the mark at the pivot; metres, (2,) where a place."""

    pivot_m: FloatArray
    radius_m: float
    radius_sd_m: float
    offset_m: FloatArray
    offset_sd_m: float

    @property
    def distance_m(self) -> float:
        """How far the mark is from the pivot."""
        return float(np.hypot(*self.offset_m))


def check_pivot(motion: Motion, striker: str, knee: str) -> PivotCheck:
    """Compare the centre of the striker's arc with the mark at the pivot.

    A knee mark 20 mm off costs 15 to 32 % of I where it is trusted.

    Raises
    ------
    UnknownNameError
    """
    foot, mark = motion.of(striker), motion.of(knee)
    arc = fit_arc(foot[np.isfinite(foot).all(axis=1)])
    seen = mark[np.isfinite(mark).all(axis=1)]
    middle = np.median(seen, axis=0)
    scatter = float(np.sqrt(np.mean((seen - middle) ** 2)))
    return PivotCheck(
        arc.centre_m, arc.radius_m, arc.radius_sd_m, middle - arc.centre_m, math.hypot(arc.radius_sd_m, scatter)
    )


def knee_offset(knee_m: FloatArray, pivot_m: FloatArray, pivot_sd_m: float) -> tuple[float, float] | None:
    """Return the distance of the knee mark from the fitted pivot with its sd, metres; None without a mark."""
    seen = knee_m[np.isfinite(knee_m).all(axis=1)]
    if len(seen) == 0:
        return None
    middle = np.median(seen, axis=0)
    scatter = float(np.sqrt(np.mean((seen - middle) ** 2)))
    return float(np.hypot(*(middle - pivot_m))), float(np.hypot(pivot_sd_m, scatter))

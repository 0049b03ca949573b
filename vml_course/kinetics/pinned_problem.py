"""What is fitted when a body on a fixed pivot strikes, or is struck: its mark on a circle, the other body's own path.

Unknowns: pivot kx, ky; radius r of the mark's path; its angle theta at the impact; rates w1, w2; time t; gravity's p
and the drive's q (`pendulum.py`); the struck body's place and velocities (`paths.py`). The radius is the given length
to within `LENGTH_PRIOR`, since a click beside the mark (or a scale a little off) makes it another one, and the rates
would take the blame.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from vml_course.kinetics.arc import Arc, centre_at_distance, fit_arc
from vml_course.kinetics.clear_frames import Seen
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.joint import Held, Problem, Watched
from vml_course.kinetics.paths import Path, swinging
from vml_course.kinetics.straight import Line, fit_line
from vml_course.kinetics.vectors import unwrapped
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion

LENGTH_PRIOR = 0.01  # of the length: a click is a pixel or two off, a tape measure 5 mm
WEAK_ARC = 0.05  # relative sd of a radius from which on the arc does not tell on which side its centre is


def pinned_problem(  # noqa: PLR0913, PLR0917 - two bodies, their numbers, and where the pivot is marked
    foot: Seen,
    struck: Seen,
    struck_path: Path,
    given: Mapping[str, float],
    options: ImpactOptions,
    knee_m: FloatArray | None,
    beside: Mapping[str, float] | None = None,
) -> Problem:
    """Return the least-squares problem of a pivoted body and a struck one.

    Parameters
    ----------
    foot, struck : Seen
    struck_path : Path
        Of the body "b".
    given : mapping of str to float
        With `L`, from the pivot to the tracked mark.
    options : ImpactOptions
    knee_m : float array, shape (2,), or None
        A mark near the pivot; used only to tell on which side of a short arc the pivot is.
    beside : mapping of str to float, optional
        More unknowns with their first guess.
    """
    start = {**_swing_start(foot, given["L"], knee_m), "t": 0.0, **body_start("b", struck), **(beside or {})}
    known = dict(given)
    if options.gravity_m_s2 > 0:
        start["p"] = 0.0
    if options.drive != "none":
        start["q"] = 0.0
    if options.at_rest:
        known |= {name: 0.0 * start.pop(name) for name in ("b1x", "b1y")}
    watched = (
        Watched(options.striker, foot, swinging(options.up_angle_rad - np.pi / 2)),
        Watched(options.struck, struck, struck_path),
    )
    length = given["L"]
    return Problem(start, known, watched, (Held(lambda u: u["r"] - u["L"], LENGTH_PRIOR * length),))


def mark_at(motion: Motion, name: str) -> FloatArray | None:
    """Return the middle of a mark that hardly moves, None where it was not tracked."""
    if name not in motion.points:
        return None
    seen = motion.of(name)[np.isfinite(motion.of(name)).all(axis=1)]
    return np.median(seen, axis=0) if len(seen) else None


def body_start(body: str, seen: Seen) -> dict[str, float]:
    """Return a first guess of a free body's place and velocities, from straight lines."""
    before, after = both_lines(seen.time_s, seen.xy_m, seen)
    names = [f"{body}{part}{axis}" for part in ("", "1", "2") for axis in "xy"]
    return dict(zip(names, map(float, [*before.position(0.0), *before.slope, *after.slope]), strict=True))


def both_lines(time_s: FloatArray, path: FloatArray, seen: Seen) -> tuple[Line, Line]:
    """Return straight lines through the frames before and after."""
    before = ~seen.is_after
    return fit_line(time_s[before], path[before]), fit_line(time_s[seen.is_after], path[seen.is_after])


def _swing_start(foot: Seen, length_m: float, knee_m: FloatArray | None) -> dict[str, float]:
    """Return a first guess of pivot, angle and rates: pivot from the foot's arc, the rest from straight lines."""
    pivot = centre_at_distance(foot.xy_m, towards_mark(foot, fit_arc(foot.xy_m), knee_m), length_m)
    order, angle = np.argsort(foot.time_s), np.empty(len(foot.time_s))
    angle[order] = unwrapped(np.arctan2(*(foot.xy_m - pivot)[order].T[::-1]))
    before, after = both_lines(foot.time_s, angle[:, None], foot)
    names = ("kx", "ky", "r", "theta", "w1", "w2")
    values = *pivot, length_m, before.position(0.0)[0], before.slope[0], after.slope[0]
    return dict(zip(names, map(float, values), strict=True))


def towards_mark(foot: Seen, arc: Arc, knee_m: FloatArray | None) -> Arc:
    """Return the arc, or where it is too short to tell its centre's side, one whose centre is the mark."""
    if knee_m is None or arc.radius_sd_m < WEAK_ARC * arc.radius_m:
        return arc
    radius = float(np.hypot(*(foot.xy_m.mean(axis=0) - knee_m)))
    return Arc(knee_m, radius, arc.radius_sd_m, arc.scatter_m)

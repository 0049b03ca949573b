"""Filling gaps of a track between places that are known. A choice of a person: nothing is measured there."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from vml_course.errors import UnknownNameError
from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.track import Status, Track

WAYS = {"linear": 1, "quadratic": 2}
SIDE = 3  # known places on each side of a gap that a parabola is fitted to


class Gap(NamedTuple):
    """Rows of a gap, and the known rows on both sides from which it is filled."""

    rows: IntArray
    known: IntArray


def interpolated(track: Track, point: str, way: str = "linear", *, longest: int | None = None) -> Track:
    """Return the track with the gaps of a point filled, status `interp`; gaps at the ends stay lost.

    Linear: straight from the last known place to the next. Quadratic: the parabola in time of least squares through
    three known places on each side (fewer where there are not so many; a line where there are only two). Neither knows
    of an impact in the gap. Sigma is that of the known places, propagated; it does not hold what the curve leaves out.

    Parameters
    ----------
    track : Track
    point : str
    way : "linear" or "quadratic"
    longest : int, optional
        Longer gaps, in frames of the track, are left alone.

    Raises
    ------
    UnknownNameError
        When there is no such point or way.
    """
    if way not in WAYS:
        raise UnknownNameError("interpolation", way, WAYS)
    column = track.point_index(point)
    fields: dict[str, Any] = {name: np.array(getattr(track, name)) for name in ("xy_px", "sigma_px", "status")}
    for rows, known in gaps(track, column, SIDE if way == "quadratic" else 1):
        if longest is None or len(rows) <= longest:
            share = _shares(track.time_s[known], track.time_s[rows], WAYS[way])
            fields["xy_px"][rows, column] = share @ track.xy_px[known, column]
            fields["sigma_px"][rows, column] = np.sqrt(share**2 @ track.sigma_px[known, column] ** 2)
            fields["status"][rows, column] = Status.INTERP
    return replace(track, **fields)


def gaps(track: Track, column: int, side: int) -> list[Gap]:
    """Return the gaps between known places of a point, and up to `side` known rows before and after each."""
    is_known = ~track.is_lost[:, column]
    known = np.flatnonzero(is_known)
    found = []
    for before, after in pairwise(known.tolist()):
        if after > before + 1:
            place = int(np.searchsorted(known, after))
            around = known[max(place - side, 0) : place + side]
            found.append(Gap(np.arange(before + 1, after), around))
    return found


def _shares(known_s: FloatArray, wanted_s: FloatArray, degree: int) -> FloatArray:
    """Return how much each known place counts in each wanted one, by least squares in powers of time."""
    middle, half = 0.5 * (known_s[0] + known_s[-1]), 0.5 * (known_s[-1] - known_s[0])
    degree = min(degree, len(known_s) - 1)
    powers = np.vander((known_s - middle) / half, degree + 1)
    return np.asarray(np.vander((wanted_s - middle) / half, degree + 1) @ np.linalg.pinv(powers))

"""What fades into a loss is lost: pictures beside a gap in which a block looked unlike its usual self.

A point that is covered, or leaves the picture, is found for a picture or two more, by what is left of its block; what
covers it pulls the match. Only the gap that follows tells such pictures from others that are hard to see.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from vml_course.model.track import Status, Track
from vml_course.track.renewal import FADED, WEAK_ZNCC


def without_fading(track: Track) -> Track:
    """Return the track with gaps that reach as far as their neighbours were weak: ZNCC low, and lower than usual."""
    names = ("xy_px", "sigma_px", "zncc", "gradient", "drift_px")
    columns: dict[str, Any] = {name: np.array(getattr(track, name)) for name in names}
    status = np.array(track.status)
    for point in range(len(track.points)):
        rows = list(_fading(track, point))
        status[rows, point] = Status.LOST
        for values in columns.values():
            values[rows, point] = np.nan
    return replace(track, status=status, **columns)


def _fading(track: Track, point: int) -> Iterator[int]:
    """Yield the rows of a point that were tracked, but look like the gap beside them."""
    zncc, is_auto = track.zncc[:, point], track.status[:, point] == Status.AUTO
    if is_auto.all() or not is_auto.any():
        return
    least = min(WEAK_ZNCC, float(np.nanmedian(zncc[is_auto])) - FADED)
    is_weak = is_auto & (zncc < least)
    lost = np.flatnonzero(track.is_lost[:, point])
    for row, way in [(row, way) for row in lost.tolist() for way in (-1, 1)]:
        beside = row + way
        while 0 <= beside < len(is_weak) and is_weak[beside]:
            yield beside
            beside += way

"""How well each point was tracked, in a few numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.track import Status
from vml_course.model.tracked import Tracked


@dataclass(frozen=True, slots=True)
class PointSummary:
    """One point.

    Attributes
    ----------
    name : str
    found, frames : int
        In how many of the frames it has a place.
    worst_zncc, median_sigma_px : float
        NaN: never found.
    statuses : mapping of str to int
        In how many frames it is `auto`, `manual`, `interp`, `virtual`, `lost`; those that occur.
    references : tuple of int
        Frames whose block it was compared with; more than one where its look changed or a mark did not fit.
    drift_px : float
        What blocks cut anew may have added, at most.
    """

    name: str
    found: int
    frames: int
    worst_zncc: float
    median_sigma_px: float
    statuses: Mapping[str, int]
    references: tuple[int, ...]
    drift_px: float


def summarise(tracked: Tracked) -> list[PointSummary]:
    """Return one summary a point, in the order of the track."""
    track, lost = tracked.track, tracked.track.is_lost
    return [
        PointSummary(
            name,
            int(np.sum(~lost[:, number])),
            len(track.frame),
            float(np.min(seen, initial=np.inf)) if len(seen := _known(track.zncc[:, number])) else float("nan"),
            float(np.median(spread)) if len(spread := _known(track.sigma_px[:, number])) else float("nan"),
            {one.name.lower(): count for one in Status if (count := int(np.sum(track.status[:, number] == one)))},
            tuple(int(frame) for frame in np.unique(track.reference[:, number]) if frame >= 0),
            float(np.max(_known(track.drift_px[:, number]), initial=0.0)),
        )
        for number, name in enumerate(track.points)
    ]


def _known(values: FloatArray) -> FloatArray:
    return values[np.isfinite(values)]

"""How well each point was tracked, in a few numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.tracked import Tracked


@dataclass(frozen=True, slots=True)
class PointSummary:
    """One point: found in how many of the frames, its worst correlation, its median sigma (NaN: never found).

    `renewed_at` are the frames in which its reference block was cut anew, `drift_px` what that may have added at most.
    """

    name: str
    found: int
    frames: int
    worst_zncc: float
    median_sigma_px: float
    renewed_at: tuple[int, ...]
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
            tuple(int(track.frame[row - 1]) for row in track.renewals(number)),
            float(np.max(_known(track.drift_px[:, number]), initial=0.0)),
        )
        for number, name in enumerate(track.points)
    ]


def _known(values: FloatArray) -> FloatArray:
    return values[np.isfinite(values)]

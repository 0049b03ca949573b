"""What a person should know of a track: gaps, new references, points that cannot be right together."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from vml_course.model.track import Track
from vml_course.track.virtual import stretch
from vml_course.usecases.find_shutter import SHUTTER_SD
from vml_course.usecases.retrack import seen_at

if TYPE_CHECKING:
    from vml_course.usecases.track_clip import TrackRequest

MERGED_PX = 1.5
UNSTEADY = 0.02  # change of a distance on what should be a rigid body


def track_warnings(request: TrackRequest, track: Track) -> tuple[str, ...]:
    """Return one sentence for each thing that a person should look at."""
    return (
        *_silent_shutter(request, track),
        *_lost_points(track),
        *_new_references(request, track),
        *_unsteady_carriers(request, track),
        *_merged_points(track),
    )


def _silent_shutter(request: TrackRequest, track: Track) -> Iterator[str]:
    if request.finds_shutter and SHUTTER_SD not in track.settings:
        yield "shutter: the clip does not tell; no point that was still at first is fast enough. Blur is left alone."


def _lost_points(track: Track) -> Iterator[str]:
    for number, point in enumerate(track.points):
        lost = np.flatnonzero(track.is_lost[:, number])
        if len(lost):
            first = int(track.frame[lost[0]])
            yield f"{point}: lost in {len(lost)} of {len(track.frame)} frames, first in frame {first}."


def _new_references(request: TrackRequest, track: Track) -> Iterator[str]:
    for seed in request.seeds:
        point, number = seed.name, track.point_index(seed.name)
        first = int(track.frame[0]) if seed.frame is None else seed.frame
        for frame in np.unique(track.reference[:, number]).tolist():
            rows = np.flatnonzero(track.reference[:, number] == frame)
            if frame not in {first, -1}:
                span = f"{track.frame[rows[0]]} to {track.frame[rows[-1]]}"
                yield f"{point}: frames {span} were compared with its block in frame {frame}, not in frame {first}."


def _unsteady_carriers(request: TrackRequest, track: Track) -> Iterator[str]:
    for virtual in request.virtuals:
        change = stretch(track, seen_at(request, virtual))
        if change > UNSTEADY:
            names = ", ".join(virtual.of)
            yield f"{virtual.name}: {names} do not stay the same distance apart ({100 * change:.1f} %): not one body?"


def _merged_points(track: Track) -> Iterator[str]:
    """Say when two points come to lie on one place: with marks that look alike, one track can jump to the other."""
    for one, other in combinations(range(len(track.points)), 2):
        apart = np.hypot(*(track.xy_px[:, one] - track.xy_px[:, other]).T)
        merged = np.flatnonzero(apart < MERGED_PX)
        if len(merged) and apart[0] > 5 * MERGED_PX:
            first = int(track.frame[merged[0]])
            yield f"{track.points[one]} and {track.points[other]}: on one place from frame {first} on; one has jumped."

"""What a person should know of a track: gaps, new references, points that cannot be right together."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from vml_course.model.arrays import IntArray
from vml_course.model.track import Status, Track
from vml_course.track.virtual import stretch
from vml_course.usecases.find_shutter import SHUTTER_SD
from vml_course.usecases.retrack import seen_at

if TYPE_CHECKING:
    from vml_course.usecases.track_clip import TrackRequest

MERGED_PX = 1.5
UNSURE_PX = 0.25  # as `trackability` calls a block poor
UNSTEADY = 0.02  # change of a distance on what should be a rigid body


def track_warnings(request: TrackRequest, track: Track) -> tuple[str, ...]:
    """Return one sentence for each thing that a person should look at."""
    return (
        *_silent_shutter(request, track),
        *_lost_points(track),
        *_unsure_points(track),
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


def _unsure_points(track: Track) -> Iterator[str]:
    """Say when a block was hard to hold all along: plain ground, or an edge along which it slides."""
    for number, point in enumerate(track.points):
        found = track.sigma_px[track.status[:, number] == Status.AUTO, number]
        usual = float(np.median(found)) if len(found) else 0.0
        if usual > UNSURE_PX:
            yield f"{point}: unsure by {usual:.2f} px: too little texture, or an edge along which it slides (--check)."


def _new_references(request: TrackRequest, track: Track) -> Iterator[str]:
    for seed in request.seeds:
        point, number = seed.name, track.point_index(seed.name)
        first = int(track.frame[0]) if seed.frame is None else seed.frame
        for frame in np.unique(track.reference[:, number]).tolist():
            rows = np.flatnonzero(track.reference[:, number] == frame)
            if frame not in {first, -1}:
                span, drift = f"{track.frame[rows[0]]} to {track.frame[rows[-1]]}", _drift(track, rows, number)
                how = f"compared with its block in frame {frame}, not in frame {first}"
                yield f"{point}: frames {span} were {how}{drift}."


def _drift(track: Track, rows: IntArray, number: int) -> str:
    """Say what a look that changed may have added; a block at a mark has no drift, it is where the hand says."""
    drift_px = float(np.max(np.nan_to_num(track.drift_px[rows, number]), initial=0.0))
    return f"; its look had changed, which may have added {drift_px:.2f} px" if drift_px else ""


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

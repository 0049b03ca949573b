"""How long tracking will take, measured on the first pictures: the gate before a long run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from time import perf_counter

from vml_course.io.source import open_source
from vml_course.model.frame import Frame
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker
from vml_course.usecases.track_clip import TrackRequest, check_request, clock, picture_count

PILOT_FRAMES = 5


@dataclass(frozen=True)
class TrackEstimate:
    """Seconds for the whole clip, and what they were reckoned from."""

    seconds: float
    frames: int
    points: int
    seconds_per_frame: float


def estimate_track(request: TrackRequest) -> TrackEstimate:
    """Track the first five pictures twice, the first time to warm up, and reckon the time for all.

    Raises
    ------
    VmlError
        As `track_clip` does.
    """
    check_request(request)
    source = open_source(request.video)
    total = picture_count(request, source)
    pilot, decoded_s = _decoded(clock(request, source)[1])
    _track(request, pilot)
    started = perf_counter()
    _track(request, pilot)
    tracked_s = perf_counter() - started
    per_frame = max(decoded_s / max(len(pilot) - 1, 1), tracked_s / len(pilot))  # they run side by side
    return TrackEstimate(per_frame * total, total, len(request.seeds), per_frame)


def _decoded(frames: Iterator[Frame]) -> tuple[list[Frame], float]:
    """Return the first pictures, and the seconds from the first to the last: finding the place is done once."""
    pilot = [next(frames)]
    started = perf_counter()
    pilot += islice(frames, PILOT_FRAMES - 1)
    return pilot, perf_counter() - started


def _track(request: TrackRequest, pilot: list[Frame]) -> None:
    run(make_tracker(request.method, **request.settings), pilot, request.seeds)

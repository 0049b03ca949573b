"""How long tracking will take, measured on the first pictures: the gate before a long run."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice, pairwise
from time import perf_counter, process_time
from typing import NamedTuple

from vml_course.model.frame import Frame
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker
from vml_course.usecases.reel import open_reel
from vml_course.usecases.track_clip import TrackRequest, check_request

PILOT_FRAMES = 5
DECODED_FRAMES = 24  # decoders hand out their first pictures in bursts, as many as they have threads


@dataclass(frozen=True)
class TrackEstimate:
    """Seconds for the whole clip, and what they were reckoned from."""

    seconds: float
    frames: int
    points: int
    seconds_per_frame: float


class _Cost(NamedTuple):
    """Seconds on the clock, and of all processors."""

    wall_s: float
    cpu_s: float


def estimate_track(request: TrackRequest) -> TrackEstimate:
    """Track the first five pictures twice, the first time to warm up, and reckon the time for all.

    Decoding and tracking run side by side: a picture takes as long as the slower of them, or as both together
    keep all processors busy. Opening the file and finding the first picture are counted once.

    Raises
    ------
    VmlError
        As `track_clip` does.
    """
    check_request(request)
    started = perf_counter()
    reel = open_reel(request)
    way = reel.way(request.seeds)
    total = way.total
    frames, longest = max((way.onwards, way.onwards_count), (way.back, way.back_count), key=lambda one: one[1])
    pilot = [next(frames)]
    opened_s = perf_counter() - started
    decoded = _cost_each(lambda: pilot.extend(islice(frames, DECODED_FRAMES - 1)), min(longest, DECODED_FRAMES) - 1)
    shown = pilot[:PILOT_FRAMES]
    _steps(request, shown)
    tracked = _steps(request, shown)
    busy_s = (decoded.cpu_s + tracked.cpu_s) / (os.cpu_count() or 1)
    per_frame = max(decoded.wall_s, tracked.wall_s, busy_s)
    return TrackEstimate(opened_s + per_frame * (total - 1), total, len(request.seeds), per_frame)


def _cost_each(work: Callable[[], object], count: int) -> _Cost:
    wall_s, cpu_s = perf_counter(), process_time()
    work()
    share = 1.0 / max(count, 1)
    return _Cost(share * (perf_counter() - wall_s), share * (process_time() - cpu_s))


def _steps(request: TrackRequest, pilot: list[Frame]) -> _Cost:
    """Return the middle cost of a step: learning the blocks and the first search happen once in a clip.

    Points that are placed elsewhere cost what those do that are placed in the first picture of the pilot.
    """
    stamps: list[_Cost] = []
    tracker = make_tracker(request.method, **request.settings)
    here = [seed for seed in request.seeds if seed.frame in {None, pilot[0].index}]
    run(tracker, pilot, here, on_frame=lambda *_: stamps.append(_Cost(perf_counter(), process_time())))
    steps = [(b.wall_s - a.wall_s, b.cpu_s - a.cpu_s) for a, b in pairwise(stamps)] or [(0.0, 0.0)]
    more = len(request.seeds) / len(here)
    wall_s, cpu_s = min(steps)
    return _Cost(more * wall_s, more * cpu_s)

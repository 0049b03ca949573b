"""Following points through a whole clip."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from typing import Any

import numpy as np

from vml_course.errors import FrameRangeError, InputError
from vml_course.model.frame import Frame
from vml_course.model.track import Seed, Sighting, Track
from vml_course.track.assembly import Entry, assemble
from vml_course.track.places import Places
from vml_course.track.prefetch import prefetched
from vml_course.track.sweep import Glimpse, sweep
from vml_course.track.tracker import Tracker

OnFrame = Callable[[Frame, Sighting], None]


def run(
    tracker: Tracker[Any],
    frames: Iterable[Frame],
    seeds: Sequence[Seed],
    *,
    fps: float | None = None,
    on_frame: OnFrame | None = None,
) -> Track:
    """Track points from the first picture to the last; pictures are taken in a thread of their own.

    Parameters
    ----------
    tracker : Tracker
    frames : iterable of Frame
        In the order of presentation; taken once, and only a few are held at a time.
    seeds : sequence of Seed
        Where the points are in the first picture.
    fps : float, optional
        True rate of the recording, pictures per second: times are then counted from the frame numbers.
        None takes each picture's own time stamp.
    on_frame : callable, optional
        Called after each picture, such as to show progress; an error that it raises stops the tracking.

    Returns
    -------
    Track
        `time_s` is 0 at the first picture. Its sigmas cover the scatter in time of the whole clip, so they are
        larger than those that `on_frame` is shown on the way; see `scatter`.

    Raises
    ------
    SeedError
        Under the point's own name.
    FrameRangeError
        When there is not a single picture.
    InputError
        When there is no seed, a name comes twice, or `fps` is not positive.
    """
    return run_both_ways(tracker, frames, (), Places(tuple(seeds)), fps=fps, on_frame=on_frame)


def run_both_ways(
    tracker: Tracker[Any],
    onwards: Iterable[Frame],
    back: Iterable[Frame],
    places: Places,
    *,
    fps: float | None = None,
    on_frame: OnFrame | None = None,
) -> Track:
    """Track points from where they were placed, on to the last picture and back to the first.

    Parameters
    ----------
    tracker : Tracker
    onwards : iterable of Frame
        From the first picture in which a point is placed, on.
    back : iterable of Frame
        In reverse, from the last picture in which a point is placed to the first of the clip; none are needed when all
        are placed in the first.
    places : Places
        Seeds, and marks through which the track goes: see `sweep`.
    fps, on_frame
        As in `run`.

    Raises
    ------
    SeedError, FrameRangeError, InputError
        As `run`; FrameRangeError also when a place's frame is not among the pictures.
    """
    if fps is not None and not (np.isfinite(fps) and fps > 0.0):
        raise InputError("fps", "a positive number of pictures per second", fps)
    forwards = [_entry(glimpse) for glimpse in _shown(tracker, onwards, places, on_frame)]
    if not forwards:
        raise FrameRangeError("frames", "at least one picture to track in", "none")
    backwards: list[Entry] = []
    if not places.is_first_only:
        placed = places.from_frame(forwards[0].frame)
        backwards = [_entry(glimpse) for glimpse in _shown(tracker, back, placed, on_frame)]
    places.check_frames({entry.frame for entry in chain(forwards, backwards)})
    return assemble(tracker.settings, places.names, forwards, backwards, fps)


def _shown(
    tracker: Tracker[Any], frames: Iterable[Frame], places: Places, on_frame: OnFrame | None
) -> Iterator[Glimpse]:
    with prefetched(frames) as pictures:
        for glimpse in sweep(tracker, pictures, places):
            yield glimpse
            if on_frame is not None:
                on_frame(glimpse.frame, glimpse.sighting)


def _entry(glimpse: Glimpse) -> Entry:
    return Entry(glimpse.frame.index, glimpse.frame.time_s, glimpse.sighting, glimpse.reference)

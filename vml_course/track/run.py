"""Following points through a whole clip."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from vml_course.errors import FrameRangeError, InputError, SeedError
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Frame
from vml_course.model.track import Seed, Sighting, Track
from vml_course.track.prefetch import prefetched
from vml_course.track.scatter import vouched
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
    _check(seeds, fps)
    seen: list[Sighting] = []
    shown: list[tuple[int, float]] = []
    with prefetched(frames) as pictures:
        for frame, sighting in _sightings(tracker, pictures, seeds):
            shown.append((frame.index, frame.time_s))
            seen.append(sighting)
            if on_frame is not None:
                on_frame(frame, sighting)
    if not seen:
        raise FrameRangeError("frames", "at least one picture to track in", "none")
    index, stamp_s = np.array([i for i, _ in shown]), np.array([t for _, t in shown])
    time_s = stamp_s - stamp_s[0] if fps is None else (index - index[0]) / fps
    return vouched(_assemble(tracker, tuple(seed.name for seed in seeds), index, time_s, seen))


def _sightings(
    tracker: Tracker[Any], frames: Iterator[Frame], seeds: Sequence[Seed]
) -> Iterator[tuple[Frame, Sighting]]:
    state = None
    for frame in frames:
        if state is None:
            state, sighting = _start(tracker, frame, seeds)
        else:
            state, sighting = tracker.step(state, frame.luma)
        yield frame, sighting


def _start(tracker: Tracker[Any], frame: Frame, seeds: Sequence[Seed]) -> tuple[Any, Sighting]:
    points = np.array([(seed.x_px, seed.y_px) for seed in seeds], dtype=np.float64)
    try:
        return tracker.start(frame.luma, points)
    except SeedError as error:
        names = {f"seed {k}": seed.name for k, seed in enumerate(seeds, start=1)}
        raise SeedError(names.get(error.name, error.name), error.expected, error.got, error.hint) from None


def _check(seeds: Sequence[Seed], fps: float | None) -> None:
    names = [seed.name for seed in seeds]
    if not names:
        raise InputError("seeds", "at least one point", "none")
    twice = [name for k, name in enumerate(names) if name in names[:k]]
    if twice:
        raise InputError("seeds", "every point's name once", f"{twice[0]!r} twice")
    if fps is not None and not (np.isfinite(fps) and fps > 0.0):
        raise InputError("fps", "a positive number of pictures per second", fps)


def _assemble(
    tracker: Tracker[Any], points: tuple[str, ...], index: object, time_s: FloatArray, seen: list[Sighting]
) -> Track:
    fields = ("xy_px", "sigma_px", "zncc", "iterations", "status", "gradient", "drift_px")
    columns: dict[str, Any] = {name: np.stack([getattr(sighting, name) for sighting in seen]) for name in fields}
    return Track(points, np.asarray(index), time_s, settings=dict(tracker.settings), **columns)

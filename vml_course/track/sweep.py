"""One pass over pictures, forwards or backwards: points join where they were placed, and obey the marks on the way."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from vml_course.errors import SeedError
from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.frame import Frame
from vml_course.model.track import Seed, Sighting, Status
from vml_course.track.places import Group, Places
from vml_course.track.placing import manual_sighting
from vml_course.track.tracker import Tracker, is_placeable

FIELDS = ("xy_px", "sigma_px", "zncc", "iterations", "status", "gradient", "drift_px")


class Glimpse(NamedTuple):
    """All points in one picture; those that have not joined yet are lost.

    Attributes
    ----------
    reference : int array, shape (p,)
        Number of the picture whose block each point is compared with; -1 before it has joined.
    """

    frame: Frame
    sighting: Sighting
    reference: IntArray


class _Course(NamedTuple):
    """How far a group has come: its state, what was seen last and in which frame; references and drifts, shape (p,)."""

    state: Any
    sighting: Sighting
    frame: int
    reference: IntArray
    drift_px: FloatArray


def sweep(tracker: Tracker[Any], frames: Iterable[Frame], places: Places) -> Iterator[Glimpse]:
    """Track points through pictures in the order in which they come.

    A point starts in the picture of its seed; what comes earlier is passed over. In the picture of a mark it is where
    the mark says (status `manual`), and it is tracked on from there: with its reference block when that is seen there,
    else with the block at the mark, which becomes the reference. A mark on a blank spot, where no block can be learned,
    leaves the reference as it is.

    Parameters
    ----------
    tracker : Tracker
    frames : iterable of Frame
    places : Places

    Raises
    ------
    SeedError
        Under the point's own name.
    """
    groups = tuple(places.groups())
    courses: list[_Course | None] = [None] * len(groups)
    for number, frame in enumerate(frames):
        courses = [_next(tracker, group, course, frame, number) for group, course in zip(groups, courses, strict=True)]
        yield _together(frame, groups, courses, len(places.seeds))


def _next(tracker: Tracker[Any], group: Group, course: _Course | None, frame: Frame, number: int) -> _Course | None:
    if course is None:
        is_here = number == 0 if group.frame is None else frame.index == group.frame
        if not is_here:
            return None
        count = len(group.seeds)
        started = start_at(tracker, frame, group.seeds)
        return _Course(*started, frame.index, np.full(count, frame.index), np.zeros(count))
    if frame.index in group.marks:
        return _place(tracker, course, frame, group.marks[frame.index])
    state, seen = tracker.step(course.state, frame.luma)
    # a block is cut anew at the end of a step; the first match with it is the next one
    is_new = seen.drift_px > course.drift_px
    reference = np.where(is_new, course.frame, course.reference)
    return _Course(state, seen, frame.index, reference, np.fmax(course.drift_px, seen.drift_px))


def start_at(tracker: Tracker[Any], frame: Frame, seeds: Sequence[Seed]) -> tuple[Any, Sighting]:
    """Start a tracker in a picture, where the seeds are.

    Raises
    ------
    SeedError
        Under the point's own name.
    """
    points = np.array([(seed.x_px, seed.y_px) for seed in seeds], dtype=np.float64)
    try:
        return tracker.start(frame.luma, points)
    except SeedError as error:
        names = {f"seed {k}": seed.name for k, seed in enumerate(seeds, start=1)}
        raise SeedError(names.get(error.name, error.name), error.expected, error.got, error.hint) from None


def _place(tracker: Tracker[Any], course: _Course, frame: Frame, mark: Seed) -> _Course:
    here = np.array([[mark.x_px, mark.y_px]])
    state, sighting = course.state, manual_sighting(here, (None,))
    if is_placeable(tracker):
        state, sighting = tracker.place(course.state, frame.luma, here)
        if np.isfinite(sighting.zncc).all():
            return course._replace(state=state, sighting=sighting, frame=frame.index)
    try:
        anew, _ = tracker.start(frame.luma, here)
    except SeedError:
        return course._replace(state=state, sighting=sighting, frame=frame.index)
    return _Course(anew, sighting, frame.index, np.array([frame.index]), np.zeros(1))


def _together(frame: Frame, groups: Sequence[Group], courses: Sequence[_Course | None], count: int) -> Glimpse:
    reference = np.full(count, -1, np.int64)
    if len(groups) == 1 and courses[0] is not None:
        reference[:] = courses[0].reference
        return Glimpse(frame, courses[0].sighting, reference)
    rows = blank_rows(count)
    for group, course in zip(groups, courses, strict=True):
        if course is not None:
            columns = list(group.columns)
            reference[columns] = course.reference
            for name in FIELDS:
                rows[name][columns] = getattr(course.sighting, name)
    return Glimpse(frame, Sighting(**rows), reference)


def blank_rows(*shape: int) -> dict[str, Any]:
    """Return the fields of a sighting, writable, for points that are all lost."""

    def nan(*more: int) -> FloatArray:
        return np.full((*shape, *more), np.nan)

    return {
        "xy_px": nan(2),
        "sigma_px": nan(),
        "zncc": nan(),
        "iterations": np.zeros(shape, np.int64),
        "status": np.full(shape, Status.LOST, np.int8),
        "gradient": nan(4),
        "drift_px": nan(),
    }

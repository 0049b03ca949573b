"""Track one point again from a frame on, and leave the rest of the track alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import islice, takewhile
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from vml_course.errors import InputError, UnknownNameError
from vml_course.model.frame import Frame
from vml_course.model.track import Seed, Status, Track
from vml_course.track.places import Places, seed_at
from vml_course.track.prefetch import prefetched
from vml_course.track.repair import Until, is_settled, marks_of, row_of, with_glimpses
from vml_course.track.sweep import Glimpse, sweep
from vml_course.track.tracker import Tracker, make_tracker
from vml_course.track.virtual import VirtualPoint, with_virtual
from vml_course.usecases.reel import Reel, open_reel

if TYPE_CHECKING:
    from vml_course.usecases.track_clip import TrackRequest

Direction = Literal["forward", "backward"]


class Stretch(NamedTuple):
    """What is tracked again: from a frame, in which direction, and where it ends."""

    frame: int
    direction: Direction
    until: Until

    def rows(self, row: int, count: int) -> range:
        """Return the rows after `row` of a track of `count` rows, in the order in which they are tracked."""
        return range(row + 1, count) if self.direction == "forward" else range(row - 1, -1, -1)


def retrack(
    request: TrackRequest,
    track: Track,
    point: str,
    frame: int,
    *,
    direction: Direction = "forward",
    until: Until = Until.END,
) -> Track:
    """Track a point again from where it is in a frame: its entry there is the anchor, and stays.

    Places given by hand on the way are anchors, too, and are never overwritten. The reference is the block of the
    point's seed; where that is not seen at an anchor, the block at the anchor takes its place (see `Track.reference`).
    Virtual points are reckoned anew.

    Parameters
    ----------
    request : TrackRequest
        As it was tracked.
    track : Track
        Its track, as it is now; to place a point by hand first, see `repair.with_mark`.
    point : str
    frame : int
        As in `track.frame`.
    direction : "forward" or "backward"
    until : Until
        Where to end.

    Raises
    ------
    UnknownNameError, FrameRangeError
        When the track has no such point or frame.
    InputError
        When the point is lost in that frame, or is not tracked but reckoned from others.
    VmlError
        As `track_clip` does.
    """
    seeds = {seed.name: seed for seed in request.seeds}
    if point not in seeds:
        raise UnknownNameError("point", point, seeds)
    tracker = make_tracker(request.method, **_settings(request, track))
    again = retrack_in(open_reel(request), tracker, seeds[point], track, Stretch(frame, direction, until))
    return with_virtuals(request, again)


def _settings(request: TrackRequest, track: Track) -> Mapping[str, float]:
    """Return a request's settings, with the shutter that was found when it was tracked."""
    found = track.settings.get("shutter") if request.finds_shutter else None
    return request.settings if found is None else {**request.settings, "shutter": float(found)}


def retrack_in(reel: Reel, tracker: Tracker[Any], seed: Seed, track: Track, stretch: Stretch) -> Track:
    """Do what `retrack` does, with pictures that are open already."""
    frame, column = stretch.frame, track.point_index(seed.name)
    row = row_of(track, frame)
    if track.status[row, column] == Status.LOST:
        raise InputError(f"{seed.name} in frame {frame}", "a place to track from", "a lost point", "Mark it there.")
    home = reel.first_frame if seed.frame is None else seed.frame
    anchors = {mark.frame: mark for mark in marks_of(track, seed.name)}
    placed = anchors.pop(home, seed_at(seed.name, (seed.x_px, seed.y_px), home))
    if frame != home:
        anchors.setdefault(frame, seed_at(seed.name, track.xy_px[row, column], frame))
    settled = is_settled(track, column, stretch.until)
    count = len(list(takewhile(lambda k: not settled[k], stretch.rows(row, len(track.frame)))))
    with prefetched(_pictures(reel, home, stretch)) as pictures:
        glimpses = _after(frame, sweep(tracker, pictures, Places((placed,), tuple(anchors.values()))))
        seen = (glimpse for glimpse in islice(glimpses, count) if glimpse.frame.index != home)
        return with_glimpses(track, seed.name, seen)


def fill_before_marks(reel: Reel, tracker: Tracker[Any], places: Places, track: Track) -> Track:
    """Track back from each mark towards its point's seed as long as the point is lost there."""
    seeds = {seed.name: seed for seed in places.from_frame(reel.first_frame).seeds}
    for mark in places.marks:
        if mark.frame is None:
            continue
        seed, row = seeds[mark.name], row_of(track, mark.frame)
        is_later = mark.frame > (seed.frame or 0)
        beside = row - 1 if is_later else row + 1
        if track.status[beside, track.point_index(mark.name)] == Status.LOST:
            direction: Direction = "backward" if is_later else "forward"
            track = retrack_in(reel, tracker, seed, track, Stretch(mark.frame, direction, Until.FOUND))
    return track


def with_virtuals(request: TrackRequest, track: Track) -> Track:
    """Return the track with all virtual points of a request, reckoned from what it holds now.

    Raises
    ------
    InputError
        When a virtual point's carriers are not seen in the frame in which it was placed.
    """
    for virtual in request.virtuals:
        track = with_virtual(track, seen_at(request, virtual))
    return track


def seen_at(request: TrackRequest, virtual: VirtualPoint) -> VirtualPoint:
    """Return a virtual point with its frame: where its first carrier was placed, when none was given."""
    if virtual.frame is not None or not virtual.of:
        return virtual
    return replace(virtual, frame={seed.name: seed.frame for seed in request.seeds}.get(virtual.of[0]))


def _pictures(reel: Reel, home: int, stretch: Stretch) -> Iterator[Frame]:
    """Yield the picture of the reference, then those to be tracked."""
    if home != stretch.frame:
        yield reel.picture(reel.row("seed", home))
    row = reel.row("frame", stretch.frame)
    yield from reel.onwards(row) if stretch.direction == "forward" else reel.backwards(row)


def _after(frame: int, glimpses: Iterator[Glimpse]) -> Iterator[Glimpse]:
    """Pass over what comes up to a frame."""
    for glimpse in glimpses:
        if glimpse.frame.index == frame:
            yield from glimpses

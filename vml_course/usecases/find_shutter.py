"""The open share of the shutter, found in the clip that is to be tracked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from vml_course.model.frame import Frame
from vml_course.model.track import Seed, Track
from vml_course.track.shutter import ShutterEstimate, estimate_shutter
from vml_course.track.trackers.dic import Dic
from vml_course.usecases.reel import Reel

if TYPE_CHECKING:
    from vml_course.usecases.track_clip import TrackRequest

SHUTTER, SHUTTER_SD = "shutter", "shutter_sd"  # among a track's settings


def find_shutter(request: TrackRequest, reel: Reel) -> ShutterEstimate:
    """Return what the clip tells of its shutter, from the first picture with a point on, or from the last one back.

    Raises
    ------
    SeedError
        Under the point's own name.
    """
    tracker = Dic(**{name: value for name, value in request.settings.items() if name != SHUTTER})
    frames, seeds = _pilot(request, reel)
    return estimate_shutter(tracker, frames, seeds)


def settled(request: TrackRequest, found: ShutterEstimate | None) -> Mapping[str, float]:
    """Return a request's settings, with the shutter that was found."""
    return request.settings if found is None else {**request.settings, SHUTTER: found.shutter}


def noted(track: Track, found: ShutterEstimate | None) -> Track:
    """Return the track with the shutter's standard deviation among its settings: that it was found, and how well."""
    if found is None or not found.is_told:
        return track
    return replace(track, settings={**track.settings, SHUTTER_SD: found.sigma})


def _pilot(request: TrackRequest, reel: Reel) -> tuple[Callable[[], Iterator[Frame]], list[Seed]]:
    way = reel.way(request.seeds)
    placed = [reel.first_frame if seed.frame is None else seed.frame for seed in request.seeds]
    is_onwards = way.onwards_count >= way.back_count
    start = min(placed) if is_onwards else max(placed)
    seeds = [seed for seed, frame in zip(request.seeds, placed, strict=True) if frame == start]
    row = reel.row("shutter", start)
    return (lambda: reel.onwards(row) if is_onwards else reel.backwards(row)), seeds

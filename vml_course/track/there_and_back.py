"""A trial before tracking: a few pictures on and back again; what does not return to its start cannot be followed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from vml_course.errors import SeedError
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.places import seed_at
from vml_course.track.tracker import Tracker


def there_and_back(tracker: Tracker[Any], frames: Sequence[Frame], seeds: Sequence[Seed]) -> FloatArray:
    """Return how far from its start each point ends, px, shape (p,); NaN where it is lost on the way.

    It is tracked through the pictures with its block in the first one, and back with its block in the last one, so the
    way back knows nothing of the way there (the forward-backward error of Kalal, Mikolajczyk and Matas, "Forward-
    backward error: automatic detection of tracking failures", ICPR 2010).

    Parameters
    ----------
    tracker : Tracker
    frames : sequence of Frame
        In either direction.
    seeds : sequence of Seed
        Where the points are in the first of these pictures; their own frames do not matter.

    Raises
    ------
    SeedError
        When a point cannot be followed from where it was placed.
    """
    return np.array([_returns(tracker, frames, seed) for seed in seeds])


def _returns(tracker: Tracker[Any], frames: Sequence[Frame], seed: Seed) -> float:
    there = _last_place(tracker, frames, seed)
    if not np.isfinite(there).all():
        return float("nan")
    try:
        back = _last_place(tracker, frames[::-1], seed_at(seed.name, there))
    except SeedError:  # it has left the picture, or what can be held
        return float("nan")
    return float(np.hypot(back[0] - seed.x_px, back[1] - seed.y_px))


def _last_place(tracker: Tracker[Any], frames: Sequence[Frame], seed: Seed) -> FloatArray:
    state, sighting = tracker.start(frames[0].luma, np.array([[seed.x_px, seed.y_px]]))
    for frame in frames[1:]:
        state, sighting = tracker.step(state, frame.luma)
    return np.asarray(sighting.xy_px[0])

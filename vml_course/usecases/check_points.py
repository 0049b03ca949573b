"""Judge the points to be tracked before they are: texture, edges, look-alikes, and a trial of a few pictures."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from vml_course.errors import SeedError
from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.blocks import check_block_fits
from vml_course.track.plain_words import sentence
from vml_course.track.there_and_back import there_and_back
from vml_course.track.trackability import Trackability, Verdict, noise_between, trackability
from vml_course.track.tracker import Tracker, make_tracker
from vml_course.usecases.reel import Reel, open_reel
from vml_course.usecases.track_clip import TrackRequest, check_request

PILOT_FRAMES = 5  # on, and as many back


@dataclass(frozen=True, slots=True)
class PointCheck:
    """One point's verdict, and the sentence that says it.

    Attributes
    ----------
    seed : Seed
    found : Trackability
    returns_px : float
        How far from its start it ends when it is tracked five pictures on and back; NaN when it is lost on the way or
        refused.
    text : str
    """

    seed: Seed
    found: Trackability
    returns_px: float
    text: str

    @property
    def is_poor(self) -> bool:
        """Whether the point should not be tracked at all."""
        return self.found.verdict is Verdict.POOR


def check_points(request: TrackRequest) -> list[PointCheck]:
    """Judge every point of a request in the picture in which it is placed, with the noise that two pictures show.

    Raises
    ------
    VmlError
        As `track_clip` does; SeedError under the point's own name when its block leaves the picture.
    """
    check_request(request)
    reel = open_reel(request)
    reel.way(request.seeds)  # refuses frames that are not there
    tracker = make_tracker(request.method, **request.settings)
    pilots: dict[int | None, list[Frame]] = {}
    for seed in request.seeds:
        if seed.frame not in pilots:
            pilots[seed.frame] = _pilot(reel, seed)
    return [_check(tracker, pilots[seed.frame], seed) for seed in request.seeds]


def _pilot(reel: Reel, seed: Seed) -> list[Frame]:
    """Return the picture of a seed and the next five, or those before it when they are more."""
    row = reel.rows[0] if seed.frame is None else reel.row(seed.name, seed.frame)
    place = reel.rows.index(row)
    left = len(reel.rows) - 1 - place
    frames = reel.onwards(row) if left >= min(PILOT_FRAMES, place) else reel.backwards(row)
    return list(islice(frames, PILOT_FRAMES + 1))


def _check(tracker: Tracker[Any], pilot: list[Frame], seed: Seed) -> PointCheck:
    block, search = (int(tracker.settings.get(*one)) for one in (("block", 60), ("search_radius", 40)))
    luma, point = pilot[0].luma, (seed.x_px, seed.y_px)
    check_block_fits(luma.shape, seed.name, point, block)
    noise = noise_between(luma, pilot[1].luma) if len(pilot) > 1 else None
    found = trackability(luma, point, block, search_px=search, noise=noise)
    if len(pilot) == 1:
        return PointCheck(seed, found, float("nan"), sentence(found))
    try:
        returns_px = float(there_and_back(tracker, pilot, [seed])[0])
    except SeedError:  # the verdict says why
        return PointCheck(seed, found, float("nan"), sentence(found))
    return PointCheck(seed, found, returns_px, f"{sentence(found)} {_trial(returns_px, len(pilot) - 1)}")


def _trial(returns_px: float, count: int) -> str:
    trial = f"Tracked {count} frame{'s' if count > 1 else ''} on and back it"
    return f"{trial} returns to {returns_px:.2g} px." if np.isfinite(returns_px) else f"{trial} is lost."

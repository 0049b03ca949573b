"""Judge the points to be tracked before they are: texture, edges, look-alikes."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice

from vml_course.io.source import open_source
from vml_course.model.frame import Luma
from vml_course.model.track import Seed
from vml_course.track.blocks import check_block_fits
from vml_course.track.plain_words import sentence
from vml_course.track.trackability import Trackability, Verdict, noise_between, trackability
from vml_course.track.tracker import make_tracker
from vml_course.usecases.track_clip import TrackRequest, check_request, clock


@dataclass(frozen=True, slots=True)
class PointCheck:
    """One point's verdict, and the sentence that says it."""

    seed: Seed
    found: Trackability
    text: str

    @property
    def is_poor(self) -> bool:
        """Whether the point should not be tracked at all."""
        return self.found.verdict is Verdict.POOR


def check_points(request: TrackRequest) -> list[PointCheck]:
    """Judge every point of a request in its first picture, with the noise that the first two pictures show.

    Raises
    ------
    VmlError
        As `track_clip` does; SeedError under the point's own name when its block leaves the picture.
    """
    check_request(request)
    pictures = [frame.luma for frame in islice(clock(request, open_source(request.video))[1], 2)]
    settings = make_tracker(request.method, **request.settings).settings
    block, search = int(settings["block"]), int(settings.get("search_radius", 40))
    noise = noise_between(pictures[0], pictures[1]) if len(pictures) > 1 else None
    return [_check(pictures[0], seed, block, search, noise) for seed in request.seeds]


def _check(luma: Luma, seed: Seed, block: int, search: int, noise: float | None) -> PointCheck:
    point = (seed.x_px, seed.y_px)
    check_block_fits(luma, seed.name, point, block)
    found = trackability(luma, point, block, search_px=search, noise=noise)
    return PointCheck(seed, found, sentence(found))

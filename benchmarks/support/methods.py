"""Every method under one signature: (pictures, seeds (p, 2)) -> places (n, p, 2) and sigma (n, p) or None."""

from __future__ import annotations

from support.clips import BLOCK
from support.evolving import evolving
from support.peers import ecc_affine, lucas_kanade, match_template

from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker, tracker_names

PEERS = {
    "OpenCV Lucas-Kanade": lucas_kanade,
    "matchTemplate + parabola": match_template,
    "findTransformECC affine": ecc_affine,
    "evolving template": evolving,
}


def methods(fps: float, settings: dict[str, dict[str, float]]):
    """Return all methods by name; ours first."""
    ours = {f"vml {name}": _ours(name, fps, settings.get(name, {})) for name in tracker_names()}
    return ours | {name: _peer(function) for name, function in PEERS.items()}


def _ours(name, fps, settings):
    tracker = make_tracker(name, block=BLOCK, **settings)

    def follow(pictures, seeds):
        frames = [Frame(k, k / fps, picture) for k, picture in enumerate(pictures)]
        track = run(tracker, frames, [Seed(f"p{k}", float(x), float(y)) for k, (x, y) in enumerate(seeds)])
        return track.xy_px, track.sigma_px

    return follow


def _peer(function):
    return lambda pictures, seeds: (function(pictures, seeds, BLOCK | 1), None)

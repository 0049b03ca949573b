"""Every scene with other numbers, rendered, tracked by `dic`, solved by its own model: how far off, and how sure."""

from __future__ import annotations

import numpy as np

from vml_course.errors import VmlError
from vml_course.io.truth import read_truth_json
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model, model_names
from vml_course.model.motion import Calibration, Motion
from vml_course.model.quantity import quantities_of
from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.scene import scene_class, scene_names
from vml_course.usecases.make_video import make_video
from vml_course.usecases.track_clip import TrackRequest, track_clip

RECORDING = Recording(crf=18, noise_grey=2.0)
SPREAD = 0.2  # of each number with a symbol, about its default
TRIES = 50


def draw(name, rng):
    """Return a scene with all its physical numbers drawn up to a fifth about their defaults, within their ranges."""
    kind, values = scene_class(name), {"impact_phase": rng.uniform(0.05, 0.95)}
    usual = kind()
    for field, known in quantities_of(kind).items():
        if known.symbol:
            value = getattr(usual, field) * rng.uniform(1 - SPREAD, 1 + SPREAD)
            values[field] = float(np.clip(value, known.low, known.high))
    return kind(**values)


def tracked(name, number, folder):
    """Return truth and motion of one variant, rendered and tracked unless the folder has it."""
    place = folder / name / f"{number:03d}"
    if not (place / "track.npz").exists():
        made = _made(name, number, place)
        points = made.truth.points
        seeds = tuple(Seed(point, *made.truth.point_px(point)) for point in points)
        track = track_clip(TrackRequest(made.video, seeds, method="dic")).track
        np.savez(place / "track.npz", xy=track.xy_px, sigma=track.sigma_px, time=track.time_s, frame=track.frame)
        made.video.unlink()
    kept, truth = np.load(place / "track.npz"), read_truth_json(place / "truth.json")
    camera = truth.camera
    scale = Calibration(camera.px_per_m, (camera.origin_x_px, camera.origin_y_px))
    sigma = kept["sigma"] / camera.px_per_m
    return truth, Motion(truth.points, kept["frame"], kept["time"], scale.to_m(kept["xy"]), sigma, camera.px_per_m)


def _made(name, number, place):
    rng = np.random.default_rng([21, number])
    for _ in range(TRIES):
        try:
            return make_video(draw(name, rng), scene_class(name).default_camera, RECORDING, number, place)
        except VmlError:
            continue
    raise RuntimeError(f"{name}: no variant can be filmed")


def print_scenes(count, folder):
    """Print errors of each unknown of each scene, alone and as a part of the told sd."""
    print(f"\n### Scenes, {count} variants each, rendered (H.264 crf 18, noise 2), tracked by dic\n")
    print("| scene | asked | bias | sd | worst | told sd | of noise alone | worst error / told sd | within 1.96 |")
    print("|---|---|" + "---:|" * 7)
    for name in scene_names():
        if scene_class(name).model in model_names():
            _print_scene(name, [tracked(name, number, folder) for number in range(count)])


def _print_scene(name, clips):
    rows = {}
    for number, (truth, motion) in enumerate(clips):
        options = ImpactOptions(**truth.declared)
        try:
            found = impact_model(truth.model).solve(motion, truth.given, options)
        except VmlError as error:
            print(f"{name} {number}: {error}")
            continue
        for symbol in truth.impact.unknowns:
            true, said = truth.impact.unknown(symbol), found.estimates[symbol]
            told = np.array([said.value - true, said.sd, found.figures[f"{symbol}_sd_random"]]) / true
            rows.setdefault(symbol, []).append([*100 * told, (said.value - true) / said.sd])
    for symbol, values in rows.items():
        off, told, noise, share = np.array(values).T
        print(
            f"| `{name}` | {symbol} | {off.mean():+.2f} % | {off.std(ddof=1):.2f} % | {np.abs(off).max():.2f} % | "
            f"{np.median(told):.2f} % | {np.median(noise):.2f} % | {np.abs(share).max():.1f} | "
            f"{np.sum(np.abs(share) < 1.96)} of {len(share)} |"
        )

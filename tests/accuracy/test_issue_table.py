"""What the tracker must reach, beside what it reaches: rendered, stored, read back, tracked, compared with the truth.

`make accuracy` prints the table: what is asked, what is found. Where a figure is not reached yet, the test holds
what is (`held_px`, a fifth above the measurement); it goes down freely, and up only with a line in CHANGELOG.md.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from vml_course.correlate.template import cut_patch, projected_hessian, solving_matrix
from vml_course.io.video import read_frames, write_video
from vml_course.model.camera import Camera
from vml_course.model.frame import Frame, Picture
from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.render import render
from vml_course.synth.scenes.soccer_kick import SoccerKick
from vml_course.synth.simulate import simulate
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker

pytestmark = pytest.mark.accuracy

POINTS = ("foot", "knee", "shin", "ball")
SEEDS = (1, 2, 3)
MANY_SEEDS = tuple(range(1, 13))
CRAMER_RAO_RATIO = 1.2
SHARP_PX = 0.02
POOR_PX = 0.10
BLURRED_BALL_PX, BLURRED_FOOT_PX = 0.10, 0.04
COVERAGE_PCT = (90.0, 98.0)
SPIN_RAD_S = 25.0
PHONE_FPS = 30.0  # what the files of slow-motion phones claim; x264 gives each picture bits by that rate
STARVED_FPS = 480.0  # the same pictures get a fifth of the bits (15 instead of 78 kB)
SLOW = SoccerKick(
    omega_before_rad_s=14.3, time_before_s=0.1, time_after_s=0.08
)  # 24 px of blur on the ball, 15 on foot


@dataclass(frozen=True)
class Case:
    """How a clip is filmed, what is asked of it, and what is held until that is reached."""

    required_px: dict[str, float]
    held_px: dict[str, float]
    camera: Camera = field(default_factory=Camera)
    recording: Recording = field(default_factory=lambda: Recording(crf=18, noise_grey=2.0))
    file_fps: float = PHONE_FPS
    scene: SoccerKick = field(default_factory=SoccerKick)
    contrast: float = 1.0
    drift: float = 0.0
    settings: dict[str, float] = field(default_factory=dict)
    starts_sharp: bool = False


def every(limit_px):
    return dict.fromkeys(POINTS, limit_px)


SHARP = Case(every(SHARP_PX), every(SHARP_PX))
POOR = Case(every(POOR_PX), every(POOR_PX), recording=Recording(crf=23, noise_grey=3.0), contrast=0.25)
DRIFTING = Case(every(SHARP_PX), {**every(SHARP_PX), "ball": 0.032}, drift=0.3)  # at +30 % a white ball burns out

CASES = {
    "480, H.264 crf 18, noise 2, ball spins": SHARP,
    "quarter contrast, noise 3, crf 23": POOR,
    "240, shutter 0.9": Case(
        {"foot": BLURRED_FOOT_PX, "ball": BLURRED_BALL_PX},
        {"foot": 0.115, "ball": BLURRED_BALL_PX},
        camera=Camera(fps=240, shutter=0.9),
        scene=SLOW,
        settings={"shutter": 0.9},
        file_fps=240.0,
    ),
    "240, shutter 0.9, the first picture sharp": Case(
        {"foot": BLURRED_FOOT_PX, "ball": BLURRED_BALL_PX},
        {"foot": 0.05, "ball": BLURRED_BALL_PX},
        camera=Camera(fps=240, shutter=0.9),
        scene=SLOW,
        settings={"shutter": 0.9},
        starts_sharp=True,
    ),
    "brightness drifts by 30 %": DRIFTING,
    "480 in the file, too": replace(SHARP, held_px=every(0.027), file_fps=STARVED_FPS),
    "quarter contrast, 480 in the file, too": replace(POOR, held_px=every(0.155), file_fps=STARVED_FPS),
}


def spun(truth):
    """The same truth with a ball that spins after the impact."""
    pose = truth.pose.copy()
    pose[:, truth.bodies.index("ball"), 2] += SPIN_RAD_S * np.maximum(truth.time_s - truth.impact.time_s, 0.0)
    return replace(truth, pose=pose)


def lit(picture, case, way):
    """The picture with less contrast, and light that drifts (way from -1 to 1)."""
    if case.contrast == 1.0 and not case.drift:
        return picture
    grey = (128.0 + case.contrast * (picture.luma - 128.0)) * (1.0 + case.drift * way)
    return Picture(np.clip(np.rint(grey), 0, 255).astype(np.uint8), picture.blue, picture.red)


def noise_before_light(case):
    """The noise that the renderer adds, so that it is what the case says once the contrast is reduced."""
    return replace(case.recording, noise_grey=min(case.recording.noise_grey / case.contrast, 20.0))


def shown(case, truth, seed):
    """The pictures; the first one by a flash where the points are said to be still at first."""
    pictures = render(truth, noise_before_light(case))
    if case.starts_sharp:
        next(pictures)
        flash = simulate(case.scene, replace(case.camera, shutter=0.0), seed)
        yield next(render(flash, noise_before_light(case)))
    yield from pictures


def film(case, seed, folder):
    truth = simulate(case.scene, case.camera, seed)
    truth = truth if case.camera.shutter else spun(truth)
    n = len(truth.time_s)
    pictures = (lit(p, case, 2 * k / (n - 1) - 1) for k, p in enumerate(shown(case, truth, seed)))
    write_video(folder / "clip.mp4", pictures, case.file_fps, int(case.recording.crf))
    return truth, list(read_frames(folder / "clip.mp4"))


def follow(truth, frames, settings):
    seeds = [Seed(name, *truth.point_px(name)) for name in POINTS]
    track = run(make_tracker("dic", **settings), frames, seeds)
    columns = [truth.point_index(name) for name in POINTS]
    return track.xy_px - truth.xy_px[:, columns], track


def figures(truth, error, track):
    """Per point and side: RMS px, share of covered coordinates, lost pictures; the seed's own picture left out."""
    last, rows = truth.impact.frame_before, {}
    for k, point in enumerate(POINTS):
        for side, part in (("before", slice(1, last + 1)), ("after", slice(last + 1, None))):
            e, sigma = error[part, k], track.sigma_px[part, k]
            rms = float(np.sqrt(np.nanmean((e**2).sum(axis=1))))
            rows[point, side] = rms, np.abs(e) <= 1.96 * sigma[:, None], int(np.isnan(e[:, 0]).sum())
    return rows


@pytest.fixture(scope="module", params=CASES)
def measured(request, tmp_path_factory):
    """RMS over several textures, coverage over all that move, pictures lost."""
    case, found = CASES[request.param], []
    for seed in SEEDS:
        truth, frames = film(case, seed, tmp_path_factory.mktemp("case"))
        error, track = follow(truth, frames, case.settings)
        found.append(figures(truth, error, track))
    rms = {key: float(np.sqrt(np.mean([rows[key][0] ** 2 for rows in found]))) for key in found[0]}
    moving = [key for key in found[0] if key != ("ball", "before")]
    coverage = 100.0 * float(np.mean(np.concatenate([rows[key][1].ravel() for rows in found for key in moving])))
    lost = sum(rows[key][2] for rows in found for key in rows)
    show(request.param, case, rms, coverage, lost)
    return case, rms, coverage, lost


def show(name, case, rms, coverage, lost):
    print(f"\n{name}: covered {coverage:.0f} % (90 to 98), lost {lost}")  # noqa: T201
    for point in POINTS:
        asked = case.required_px.get(point)
        limit = "     -" if asked is None else f"{asked:6.3f}"
        short = "" if asked is None or max(rms[point, "before"], rms[point, "after"]) <= asked else "  short"
        print(f"  {point:5} required {limit}  found {rms[point, 'before']:.4f} / {rms[point, 'after']:.4f} px{short}")  # noqa: T201


# With 480 1/s in the file, a reference without noise does no better, neither at full nor at quarter contrast: the codec
# is the limit there. On the smeared foot it is the reference, which is smeared itself.
def test_every_point_is_as_near_as_is_held(measured):
    case, rms, _, _ = measured
    over = {key: value for key, value in rms.items() if not value <= case.held_px.get(key[0], np.inf)}
    assert over == {}


def test_nothing_is_lost(measured):
    assert measured[3] == 0


def test_the_95_percent_interval_covers_the_truth(measured):
    assert COVERAGE_PCT[0] <= measured[2] <= COVERAGE_PCT[1]


def test_without_a_codec_the_noise_is_the_limit():
    """Within 1.2 times the Cramer-Rao bound, noise of both pictures and of rounding counted.

    The noise of the first picture shifts all that follow alike, so that only many textures together tell.
    """
    noise, ratios = np.sqrt(1.0 + 1.0 / 12.0), {}
    for seed in MANY_SEEDS:
        truth = spun(simulate(SoccerKick(), Camera(), seed))
        pictures = render(truth, Recording(noise_grey=1.0))
        frames = [Frame(k, k / 480.0, picture.luma) for k, picture in enumerate(pictures)]
        rows = figures(truth, *follow(truth, frames, {}))
        for (name, side), (rms, _, _) in rows.items():
            hessian = projected_hessian(cut_patch(frames[0].luma, truth.point_px(name), 60))
            bound = noise * np.sqrt(2.0 * np.trace(solving_matrix(hessian, "affine")[:2, :2]))
            ratios.setdefault((name, side), []).append((rms, bound))
    print(f"\nlossless, noise 1, {len(MANY_SEEDS)} textures: RMS px, bound")  # noqa: T201
    over = {}
    for key, pairs in ratios.items():
        rms, bound = np.sqrt(np.mean(np.square(pairs), axis=0))
        print(f"  {key[0]:5} {key[1]:6} bound {bound:.4f}  found {rms:.4f} px  ratio {rms / bound:.2f}")  # noqa: T201
        if not rms <= CRAMER_RAO_RATIO * bound:
            over[key] = float(rms / bound)
    assert over == {}

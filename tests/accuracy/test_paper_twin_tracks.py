"""The paper twin, rendered, compressed, read back and tracked, against what really happened in it."""

import numpy as np
import pytest

from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.scene import scene_class
from vml_course.usecases.make_video import make_video
from vml_course.usecases.track_clip import TrackRequest, track_clip

POINTS = ("knee", "shin", "foot", "ball")
WORST_PX = 0.05


@pytest.fixture(scope="module")
def errors_px(tmp_path_factory):
    """Distance of each tracked point from its true place, (n, 4), and the last frame before the impact."""
    scene = scene_class("soccer_kick")
    folder = tmp_path_factory.mktemp("twin")
    made = make_video(scene(), scene.default_camera, Recording(crf=18, noise_grey=1.0), 1, folder)
    seeds = tuple(Seed(name, *made.truth.point_px(name)) for name in POINTS)
    track = track_clip(TrackRequest(made.video, seeds, fps=scene.default_camera.fps)).track
    columns = [made.truth.point_index(name) for name in POINTS]
    error = np.hypot(*np.moveaxis(track.xy_px - made.truth.xy_px[:, columns], -1, 0))
    return error, made.truth.impact.frame_before


@pytest.mark.parametrize("point", POINTS)
@pytest.mark.parametrize("side", ["before", "after"])
def test_every_point_is_found_to_a_twentieth_of_a_pixel(errors_px, point, side):
    error, last = errors_px
    part = error[: last + 1] if side == "before" else error[last + 1 :]
    rms = np.sqrt(np.mean(part[:, POINTS.index(point)] ** 2))  # NaN, and so a failure, when a frame is lost
    assert rms <= WORST_PX

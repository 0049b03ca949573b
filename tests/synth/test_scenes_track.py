"""A short and small clip of every scene, drawn and tracked in memory, loses nothing."""

from dataclasses import replace

import numpy as np
import pytest

from vml_course.model.frame import Frame
from vml_course.model.quantity import quantities_of
from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.render import render
from vml_course.synth.scene import scene_class, scene_names
from vml_course.synth.simulate import simulate
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker

SHARE = 0.75  # of the default camera's size
RMS_PX = 0.1


def smaller(camera):
    """The same view with fewer pixels."""
    width, height = (2 * round(SHARE * size / 2) for size in camera.size_px)
    scaled = {name: SHARE * getattr(camera, name) for name in ("px_per_m", "origin_x_px", "origin_y_px")}
    return replace(camera, width_px=width, height_px=height, **scaled)


@pytest.mark.parametrize("name", scene_names())
def test_nothing_is_lost(name):
    kind = scene_class(name)
    short = {field: 0.04 for field in quantities_of(kind) if field in ("time_before_s", "time_after_s")}
    truth = simulate(kind(**short), smaller(kind.default_camera), 5)
    pictures = render(truth, Recording(noise_grey=1.0))
    frames = [Frame(k, k / truth.camera.fps, picture.luma) for k, picture in enumerate(pictures)]
    seeds = [Seed(point, *truth.point_px(point)) for point in truth.points]
    track = run(make_tracker("dic", block=46), frames, seeds)
    assert int(track.is_lost.sum()) == 0
    error = np.hypot(*np.moveaxis(track.xy_px - truth.xy_px, -1, 0))
    assert np.sqrt(np.mean(error**2, axis=0)).max() < RMS_PX

"""Every scene as it comes, rendered, compressed, read back and tracked from the true places in its first picture."""

import numpy as np
import pytest

from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.scene import scene_class, scene_names
from vml_course.usecases.make_video import make_video
from vml_course.usecases.track_clip import TrackRequest, track_clip

RMS_PX = 0.05
SETTINGS = {"plate_with_hole": {"block": 31}}  # beside the hole the strain changes within a block: it must be small


@pytest.mark.accuracy
@pytest.mark.parametrize("name", scene_names())
def test_nothing_is_lost_and_every_point_is_found(name, tmp_path):
    kind = scene_class(name)
    made = make_video(kind(), kind.default_camera, Recording(crf=18, noise_grey=2.0), 20, tmp_path)
    truth = made.truth
    seeds = tuple(Seed(point, *truth.point_px(point)) for point in truth.points)
    track = track_clip(TrackRequest(made.video, seeds, settings=SETTINGS.get(name, {}))).track
    assert int(track.is_lost.sum()) == 0
    error = np.hypot(*np.moveaxis(track.xy_px - truth.xy_px, -1, 0))
    rms = dict(zip(truth.points, np.sqrt(np.mean(error**2, axis=0)), strict=True))
    assert {point: value for point, value in rms.items() if not value <= RMS_PX} == {}

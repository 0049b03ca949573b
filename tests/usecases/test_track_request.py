import numpy as np
import pytest

from vml_course.errors import InputError
from vml_course.io.video import write_video
from vml_course.model.frame import Picture
from vml_course.model.track import Seed
from vml_course.usecases.track_clip import TrackRequest, track_clip


@pytest.fixture(scope="module")
def video(tmp_path_factory):
    rng = np.random.default_rng(1)
    luma = rng.integers(0, 255, (120, 160), dtype=np.uint8)
    grey = np.full((60, 80), 128, np.uint8)
    path = tmp_path_factory.mktemp("still") / "still.mp4"
    write_video(path, [Picture(luma, grey, grey)] * 6, 30.0)
    return path


@pytest.mark.parametrize("stick", [(10, 10, 500, 10), (-5, 10, 100, 10), (10, 10, 100, 130)])
def test_a_scale_clicked_outside_the_picture_is_refused(video, stick):
    request = TrackRequest(video, (Seed("a", 80, 60),), stick_px=stick, length_m=1.0)
    with pytest.raises(InputError, match=r"scale: expected two points in the picture \(160 x 120 px\)"):
        track_clip(request)


@pytest.mark.parametrize("angle", [float("nan"), float("inf")])
def test_an_axis_angle_that_is_no_number_is_refused(video, angle):
    with pytest.raises(InputError, match="axis angle: expected a number of degrees"):
        track_clip(TrackRequest(video, (Seed("a", 80, 60),), axis_angle_rad=angle))

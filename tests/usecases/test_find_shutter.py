"""`--shutter auto`: found in the clip, used, said; on rendered kicks at 240 frames a second."""

import pytest

from vml_course.errors import InputError
from vml_course.io.video import read_frames, write_video
from vml_course.model.camera import Camera
from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.render import render
from vml_course.synth.scenes.soccer_kick import SoccerKick
from vml_course.synth.simulate import simulate
from vml_course.track.shutter import estimate_shutter
from vml_course.track.trackers.dic import Dic
from vml_course.usecases.export_track import export_track
from vml_course.usecases.track_clip import TrackRequest, track_clip

WITHIN = 0.1
POINTS = ("foot", "knee", "shin", "ball")
SLOW = SoccerKick(omega_before_rad_s=14.3, time_before_s=0.1, time_after_s=0.08)
SHORT = SoccerKick(time_before_s=0.04, time_after_s=0.05)


def film(scene, shutter, path, seed=1):
    truth = simulate(scene, Camera(fps=240, shutter=shutter), seed)
    write_video(path, render(truth, Recording(crf=18, noise_grey=2.0)), 240, 18)
    return tuple(Seed(name, *truth.point_px(name)) for name in POINTS)


@pytest.mark.accuracy
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("shutter", [0.0, 0.3, 0.5, 0.9])
@pytest.mark.parametrize("scene", [SLOW, SoccerKick()], ids=["slow", "fast"])
def test_the_shutter_of_a_rendered_kick_is_found_to_a_tenth(tmp_path, scene, shutter, seed):
    path = tmp_path / "kick.mp4"
    seeds = film(scene, shutter, path, seed)
    found = estimate_shutter(Dic(), lambda: read_frames(path), seeds)
    print(f"\nshutter {shutter}: found {found.shutter:.3f} ± {found.sigma:.3f} from {found.samples}")  # noqa: T201
    assert found.is_told
    assert abs(found.shutter - shutter) < WITHIN


@pytest.fixture(scope="module")
def kick(tmp_path_factory):
    path = tmp_path_factory.mktemp("shutter") / "kick.mp4"
    return path, film(SHORT, 0.5, path)


def test_what_is_found_is_used_and_written_down(kick, tmp_path):
    path, seeds = kick
    tracked = track_clip(TrackRequest(path, seeds, finds_shutter=True))
    assert abs(float(tracked.track.settings["shutter"]) - 0.5) < WITHIN
    assert 0.0 < float(tracked.track.settings["shutter_sd"]) < WITHIN
    assert not any("shutter" in warning for warning in tracked.warnings)
    export_track(tracked, [tmp_path / "track.xlsx"])


def test_a_clip_that_does_not_tell_says_so(kick):
    path, seeds = kick
    tracked = track_clip(
        TrackRequest(path, seeds, end=8, finds_shutter=True)
    )  # the ball still lies, the leg moved at once
    assert tracked.track.settings["shutter"] == 0.0
    assert tracked.warnings[0].startswith("shutter: the clip does not tell")


def test_methods_that_know_no_blur_are_refused(tmp_path):
    request = TrackRequest(tmp_path / "kick.mp4", (Seed("a", 1.0, 2.0),), method="flow", finds_shutter=True)
    with pytest.raises(InputError, match="shutter: expected method dic, which alone knows of motion blur, got flow"):
        track_clip(request)

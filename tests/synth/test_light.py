"""Light, contrast and noise are what the recording says, each by itself."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from vml_course.model.recording import Recording
from vml_course.synth.render import draw_frames, render
from vml_course.synth.scene import scene_class
from vml_course.synth.sensor import CHROMA_NOISE, NOISE_SPAN_PX
from vml_course.synth.simulate import simulate
from vml_course.synth.texture import choose, normals

SoccerKick = scene_class("soccer_kick")
SMALL = replace(
    SoccerKick.default_camera,
    fps=240,
    width_px=640,
    height_px=360,
    px_per_m=250.0,
    origin_x_px=210.0,
    origin_y_px=100.0,
)
ROUNDING = 0.5 + 1e-4  # 8 bits, and float32 on the way


@pytest.fixture(scope="module")
def truth():
    return simulate(SoccerKick(), SMALL, 3)


@pytest.fixture(scope="module")
def drawn(truth):
    return [planes.copy() for planes in draw_frames(truth)]


def quiet(**how):
    return Recording(noise_grey=0.0, **how)


def bytes_of(plane):
    return np.clip(np.rint(plane), 0, 255)


def test_a_plain_recording_is_drawing_and_noise(truth, drawn):
    shape = (360 + NOISE_SPAN_PX, 640 + NOISE_SPAN_PX)
    field = normals(truth.seed, "sensor", shape) * np.float32(1.5)
    place = choose(truth.seed, "sensor frames", len(drawn) + 1, NOISE_SPAN_PX**2)
    for frame, picture in enumerate(render(truth, Recording(noise_grey=1.5))):
        seen = zip((0, 0, 1), (1.0, CHROMA_NOISE, CHROMA_NOISE), (picture.luma, picture.blue, picture.red), strict=True)
        planes = (drawn[frame].luma, *np.moveaxis(drawn[frame].chroma, -1, 0))
        for (late, strength, stored), clean in zip(seen, planes, strict=True):
            down, right = divmod(int(place[frame + late]), NOISE_SPAN_PX)
            noise = field[down : down + clean.shape[0], right : right + clean.shape[1]]
            assert np.array_equal(stored, bytes_of(clean + strength * noise))


@pytest.mark.parametrize("contrast", [0.25, 0.6])
def test_contrast_shrinks_the_picture_towards_mid_grey(truth, drawn, contrast):
    picture = next(render(truth, quiet(contrast=contrast)))
    assert np.abs(picture.luma - (128 + contrast * (drawn[0].luma - 128))).max() < ROUNDING
    for plane, stored in enumerate((picture.blue, picture.red)):
        assert np.abs(stored - (128 + contrast * (drawn[0].chroma[..., plane] - 128))).max() < ROUNDING


@pytest.mark.parametrize("drift", [-0.3, 0.3])
def test_drift_changes_the_light_in_proportion_to_time(truth, drawn, drift):
    last = len(drawn) - 1
    for frame, picture in enumerate(render(truth, quiet(brightness_drift=drift))):
        light = 1 + drift * frame / last
        assert np.abs(picture.luma - np.clip(light * drawn[frame].luma, 0, 255)).max() < ROUNDING
        assert np.abs(picture.blue - (128 + light * (drawn[frame].chroma[..., 0] - 128))).max() < ROUNDING


def test_drift_acts_on_the_picture_of_less_contrast(truth, drawn):
    *_, picture = render(truth, quiet(brightness_drift=0.2, contrast=0.25))
    assert np.abs(picture.luma - 1.2 * (128 + 0.25 * (drawn[-1].luma - 128))).max() < ROUNDING


def test_flicker_is_a_cosine_of_time(truth, drawn):
    for frame, picture in enumerate(render(truth, quiet(flicker=0.1, flicker_hz=100.0))):
        light = 1 + 0.1 * np.cos(2 * np.pi * 100 * truth.time_s[frame])
        assert np.abs(picture.luma - np.clip(light * drawn[frame].luma, 0, 255)).max() < ROUNDING


def test_an_exposure_of_one_period_sees_no_flicker():
    truth = simulate(SoccerKick(time_after_s=0.04), replace(SMALL, fps=100, shutter=1.0), 3)
    still, flickering = (next(render(truth, quiet(flicker=depth))).luma for depth in (0.0, 0.5))
    assert np.array_equal(still, flickering)


def test_vignetting_takes_its_part_of_the_light_in_the_corners_and_nothing_in_the_middle(truth, drawn):
    picture, clean = next(render(truth, quiet(vignetting=0.4))), drawn[0].luma
    assert picture.luma[0, 0] == round(0.6 * clean[0, 0])
    assert np.abs(picture.luma[178:182, 318:322] - clean[178:182, 318:322]).max() < 0.51
    edge = 1 - 0.4 * 639**2 / (639**2 + 359**2)
    assert picture.luma[180, 0] == pytest.approx(edge * clean[180, 0], abs=0.51)


def test_the_variance_of_shot_noise_is_proportional_to_the_light(truth, drawn):
    pictures = list(islice(render(truth, Recording(noise_grey=2.0, shot_noise_grey=8.0)), 12))
    noise = np.array([p.luma - d.luma for p, d in zip(pictures, drawn, strict=False)])
    light = np.array([d.luma for d in drawn[:12]])
    for low, high in ((35, 60), (140, 160), (215, 235)):
        inside = (light > low) & (light < high)
        expected = 2.0**2 + 8.0**2 * light[inside].mean() / 255 + 1 / 12
        assert noise[inside].var() == pytest.approx(expected, rel=0.06)
        assert abs(noise[inside].mean()) < 0.15

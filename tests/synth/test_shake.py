"""A camera held by hand moves the picture and its truth alike."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.special import erf

from vml_course.io.truth import read_truth_json, write_truth_json
from vml_course.synth.render import draw_frames
from vml_course.synth.scene import scene_class
from vml_course.synth.shake import shifted, wander
from vml_course.synth.simulate import simulate
from vml_course.synth.sprite import Planes

SoccerKick = scene_class("soccer_kick")
SHAKY = replace(SoccerKick.default_camera, shake_px=3.0)
PLACE_PX = 0.01


@pytest.fixture(scope="module")
def kick():
    truth = simulate(SoccerKick(), SHAKY, seed=5)
    return truth, [planes.luma.astype(np.float64) for planes in draw_frames(truth)]


def test_the_hand_wanders_smoothly_by_the_declared_amount_from_nothing():
    time_s = np.arange(0, 60, 0.002)
    way = wander(1, 3.0, time_s)
    assert way[0] == pytest.approx([0, 0])
    assert way.std(axis=0) == pytest.approx([3.0, 3.0], rel=0.05)
    assert np.abs(np.diff(way, axis=0)).max() < 1.0
    assert np.abs(np.corrcoef(way.T)[0, 1]) < 0.1
    assert not np.allclose(way, wander(2, 3.0, time_s))


@pytest.mark.parametrize("offset", [(0.5, 0.25), (-0.31, 2.68), (3.0, -4.0)])
def test_a_shifted_picture_is_the_picture_drawn_elsewhere(offset):
    y, x = np.mgrid[:80, :96].astype(np.float64)

    def waves(x, y):
        return (100 + 20 * np.sin(0.9 * x + 0.4 * y) + 9 * np.cos(1.7 * y - 0.3 * x)).astype(np.float32)

    planes = Planes(waves(x, y), np.dstack([waves(2 * x, 2 * y)[:40, :48]] * 2))
    moved = shifted(planes, np.array(offset))
    inner = slice(14, -14)
    assert np.abs(moved.luma - waves(x - offset[0], y - offset[1]))[inner, inner].max() < 0.05


def test_targets_lie_where_the_truth_says_though_the_camera_shakes(kick):
    truth, frames = kick
    assert np.ptp(truth.offset_px, axis=0).max() > 1.0
    errors = []
    for frame in range(0, len(frames), 6):
        for name in ("foot", "knee", "shin"):
            true, turn = truth.point_px(name, frame), truth.pose[frame, 0, 2]
            x0, y0 = np.round(true).astype(int)
            y, x = np.mgrid[y0 - 7 : y0 + 8, x0 - 7 : x0 + 8]
            inside = np.hypot(x - true[0], y - true[1]) < 6
            x, y = x[inside], y[inside]

            def residual(p, x=x, y=y, luma=frames[frame]):
                c, s = np.cos(p[2]), np.sin(p[2])
                along, up = c * (x - p[0]) - s * (y - p[1]), -s * (x - p[0]) - c * (y - p[1])
                return p[4] + p[3] * erf(along / p[5]) * erf(up / p[5]) - luma[y, x]

            errors.append(least_squares(residual, [*true, turn, -100.0, 130.0, 1.0]).x[:2] - true)
    assert np.abs(errors).max() < PLACE_PX


def test_the_scale_bar_moves_with_the_camera(kick):
    """The way of each end's tick from its place in frame 0, by least squares on the picture's own slope."""
    truth, frames = kick
    for mark in ("bar_left", "bar_right"):
        x, y = np.round(truth.mark_px(mark)).astype(int)
        block = np.s_[y - 24 : y + 25, x - 24 : x + 25]
        for frame in range(0, len(frames), 7):
            way = np.array(truth.mark_px(mark, frame)) - truth.mark_px(mark)

            def residual(p, frame=frame, block=block):
                planes = Planes(frames[frame].astype(np.float32), np.zeros((360, 640, 2), np.float32))
                return (shifted(planes, -p).luma - frames[0])[block].ravel().astype(np.float64)

            found = least_squares(residual, way + 0.05, diff_step=1e-2, max_nfev=8).x
            assert np.abs(found - way).max() < PLACE_PX


def test_the_file_of_the_truth_keeps_the_way_of_the_camera(kick, tmp_path):
    truth, _ = kick
    write_truth_json(tmp_path / "truth.json", truth)
    back = read_truth_json(tmp_path / "truth.json")
    assert np.array_equal(back.offset_px, truth.offset_px)
    assert np.array_equal(back.xy_px, truth.xy_px)


def test_a_still_camera_has_no_way():
    truth = simulate(SoccerKick(), SoccerKick.default_camera, seed=5)
    assert not truth.offset_px.any()
    assert np.array_equal(truth.xy_px, truth.camera.to_px(truth.xy_m))


def test_shake_smears_what_stands_still_while_the_shutter_is_open():
    """The mean of the shifted pictures, far from the bodies."""
    truth = simulate(SoccerKick(), replace(SHAKY, fps=60, shutter=0.9, shake_px=6.0), seed=5)
    flash = simulate(SoccerKick(), replace(SHAKY, fps=60, shutter=0.0, shake_px=0.0), seed=5)
    still = next(draw_frames(flash)).copy()
    blurred = next(draw_frames(truth)).luma
    times = np.linspace(-0.5, 0.5, 41)[:-1] + 1 / 80
    ways = wander(5, 6.0, times * truth.camera.exposure_s)
    mean = np.mean([shifted(still, way).luma for way in ways], axis=0)
    assert np.abs(mean - blurred)[430:680, 640:1200].max() < 0.2
    assert np.abs(still.luma - blurred)[430:680, 640:1200].max() > 3

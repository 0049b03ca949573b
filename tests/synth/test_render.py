"""Is what is drawn where the truth says? Found by fitting, with models that share nothing with the drawing code."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import map_coordinates, spline_filter
from scipy.optimize import least_squares
from scipy.special import erf

from vml_course.model.recording import Recording
from vml_course.synth.look import look_of
from vml_course.synth.render import draw_frames, render
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate
from vml_course.synth.sprite import Planes

PLACE_PX = 0.01  # where a drawn point may lie from its truth
TURN_DEG = 0.05
SoccerKick = scene_class("soccer_kick")
CAMERA = replace(SoccerKick.default_camera, origin_x_px=420.37, origin_y_px=200.71)
CLEAN = Recording(noise_grey=0.0)


@pytest.fixture(scope="module")
def kick():
    truth = simulate(SoccerKick(impact_phase=0.3), CAMERA, seed=5)
    return truth, [planes.luma.astype(np.float64) for planes in draw_frames(truth)]


def offsets(centre, radius):
    """Whole pixels within a radius of a sub-pixel centre."""
    x0, y0 = np.round(centre).astype(int)
    y, x = np.mgrid[y0 - radius - 1 : y0 + radius + 2, x0 - radius - 1 : x0 + radius + 2]
    inside = np.hypot(x - centre[0], y - centre[1]) < radius
    return x[inside], y[inside]


def fit_target(luma, guess, radius=6):
    """Fit crossed edges blurred by a Gaussian: offset + gain erf(u) erf(v); return centre and angle."""
    x, y = offsets(guess, radius)

    def residual(p):
        cx, cy, turn, gain, offset, width = p
        c, s = np.cos(turn), np.sin(turn)
        along, up = c * (x - cx) - s * (y - cy), -s * (x - cx) - c * (y - cy)
        return offset + gain * erf(along / width) * erf(up / width) - luma[y, x]

    start = [*guess, 0.0, 100.0, 130.0, 1.0]
    return residual, start


def test_targets_lie_where_the_truth_says(kick):
    truth, frames = kick
    errors, turns = [], []
    for frame in range(0, len(frames), 4):
        for name in ("foot", "knee", "shin"):
            true = truth.point_px(name, frame)
            residual, start = fit_target(frames[frame], true)
            turn = truth.pose[frame, 0, 2]
            start[2] = turn
            start[3] = -100.0  # the quarters ahead-above and behind-below are black
            found = least_squares(residual, start).x
            errors.append(found[:2] - true)
            turns.append(np.degrees(found[2] - turn))
    assert np.abs(errors).max() < PLACE_PX
    assert np.abs(turns).max() < TURN_DEG * 3


@pytest.mark.parametrize("name", ["foot", "knee", "shin", "ball"])
def test_texture_moves_and_turns_as_the_truth_says(kick, name):
    """Register each frame's block to the first with a free rigid motion, by quintic splines."""
    truth, frames = kick
    body = 1 if name == "ball" else 0
    coefficients = {frame: spline_filter(frames[frame], order=5) for frame in (0, 13, 22, 26, 31, 40)}
    x, y = offsets(truth.point_px(name, 0), 24)
    start = np.array(truth.point_px(name, 0))
    for frame, spline in coefficients.items():
        true, turn = np.array(truth.point_px(name, frame)), truth.pose[frame, body, 2] - truth.pose[0, body, 2]

        def residual(p, spline=spline, true=true, turn=turn):
            c, s = np.cos(turn + p[2]), np.sin(turn + p[2])
            u, v = x - start[0], y - start[1]
            column, row = true[0] + p[0] + c * u + s * v, true[1] + p[1] - s * u + c * v
            seen = map_coordinates(spline, [row, column], order=5, prefilter=False)
            return seen - frames[0][y, x]

        found = least_squares(residual, [0.0, 0.0, 0.0], x_scale=[1, 1, 0.02]).x
        assert np.hypot(*found[:2]) < PLACE_PX
        assert abs(np.degrees(found[2])) < TURN_DEG


def test_the_balls_outline_is_a_circle_about_its_true_centre(kick):
    """The picture less the empty room, seen by the difference of two frames; edges found along rays."""
    truth, frames = kick
    frame = truth.impact.frame_before + 12
    room = np.median([frames[0], frames[frame + 10], frames[frame + 11]], axis=0)
    centre, radius = np.array(truth.point_px("ball", frame)), 0.11 * truth.camera.px_per_m
    picture = np.abs(spline_filter(frames[frame] - room, order=3))
    assert picture.max() > 0
    rays = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    reach = np.linspace(radius - 5, radius + 5, 101)
    columns = centre[0] + np.outer(reach, np.cos(rays))
    rows = centre[1] + np.outer(reach, np.sin(rays))
    difference = map_coordinates(np.abs(frames[frame] - room), [rows, columns], order=1)
    outside = difference < 1.0
    edge = reach[np.argmax(outside, axis=0)]  # the first sample where the room is untouched
    design = np.column_stack([np.ones_like(rays), np.cos(rays), np.sin(rays)])
    fitted = np.linalg.lstsq(design, edge, rcond=None)[0]
    assert np.hypot(*fitted[1:]) < 0.1
    assert fitted[0] - radius == pytest.approx(1.5, abs=0.7)  # the blur's tail


def test_the_scale_bar_ends_where_its_marks_are(kick):
    """The ticks at both ends are 6 mm wide: a pair of blurred edges about the mark."""
    truth, frames = kick
    for mark in ("bar_left", "bar_right"):
        x, y = truth.camera.to_px(np.array(truth.marks_m[mark]))
        rows = np.round(y).astype(int) + np.array([-17, -16, -15, -14, 14, 15, 16, 17])
        columns = np.arange(round(x) - 7, round(x) + 8)
        profile, half = frames[0][np.ix_(rows, columns)].mean(axis=0), 0.003 * truth.camera.px_per_m

        def residual(p, columns=columns, profile=profile, half=half):
            edges = erf((columns - p[0] + half) / p[1]) - erf((columns - p[0] - half) / p[1])
            return p[2] + p[3] * columns - p[4] * edges - profile

        found = least_squares(residual, [x + 0.4, 1.0, 150.0, 0.0, 60.0], x_scale=[1, 1, 100, 1, 50]).x
        assert found[0] == pytest.approx(x, abs=0.05)


def test_pictures_are_full_planes_of_bytes():
    truth = simulate(SoccerKick(), CAMERA, seed=5)
    picture = next(render(truth, Recording()))
    assert picture.luma.shape == (720, 1280)
    assert picture.blue.shape == picture.red.shape == (360, 640)
    assert {plane.dtype for plane in (picture.luma, picture.blue, picture.red)} == {np.dtype(np.uint8)}


def test_noise_has_the_declared_strength_and_is_fresh_in_every_frame():
    truth = simulate(SoccerKick(), CAMERA, seed=5)
    clean, noisy = (
        [picture.luma[40:400, 800:1200].astype(float) for picture, _ in zip(render(truth, how), range(4), strict=False)]
        for how in (CLEAN, Recording(noise_grey=3.0))
    )
    noise = [loud - quiet for loud, quiet in zip(noisy, clean, strict=True)]
    assert np.std(noise) == pytest.approx(3.0, rel=0.05)
    assert abs(np.mean(noise)) < 0.05
    assert abs(np.corrcoef(noise[0].ravel(), noise[1].ravel())[0, 1]) < 0.02


def test_the_same_seed_draws_the_same_pictures_and_another_seed_others():
    first, same, other = (
        next(render(simulate(SoccerKick(), CAMERA, seed=seed), Recording())).luma for seed in (5, 5, 6)
    )
    assert np.array_equal(first, same)
    assert not np.array_equal(first, other)


@pytest.mark.parametrize("name", ["foot", "knee", "shin", "ball"])
def test_blocks_of_60_pixels_have_enough_texture_to_be_tracked(kick, name):
    truth, frames = kick
    x, y = np.round(truth.point_px(name, 0)).astype(int)
    block = frames[0][y - 30 : y + 31, x - 30 : x + 31]
    assert block.std() > 15.0
    # Cramer-Rao: one grey level of noise moves the block by 1 / sqrt(sum of squared gradients).
    for gradient in np.gradient(block):
        assert 1.0 / np.sqrt((gradient**2).sum()) < 0.004


def test_the_leg_never_enters_the_ball():
    """Drawn alone, the leg covers nothing of the ball's disc around the impact."""
    for kick in (SoccerKick(), SoccerKick(normal_tilt_deg=-5.0), SoccerKick(normal_tilt_deg=5.0, ball_diameter_m=0.3)):
        truth = simulate(kick, CAMERA, seed=5)
        leg, radius = look_of(kick, CAMERA, 5).sprites["leg"], kick.ball_diameter_m / 2 * CAMERA.px_per_m
        y, x = np.mgrid[:720, :1280]
        for frame in range(truth.impact.frame_before - 6, truth.impact.frame_before + 4):
            blank = Planes(np.zeros((720, 1280), np.float32), np.zeros((360, 640, 2), np.float32))
            leg.lay(blank, truth.point_px("knee", frame), float(truth.pose[frame, 0, 2]))
            cx, cy = truth.point_px("ball", frame)
            assert blank.luma[np.hypot(x - cx, y - cy) < radius - 3.0].max() < 1.0

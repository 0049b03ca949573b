"""Through a lens, askew, row by row: what is drawn lies where the truth says."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.special import erf

from vml_course.errors import SceneRefusedError
from vml_course.io.truth import read_truth_json, write_truth_json
from vml_course.synth.exposure import Swept, count_instants, expose
from vml_course.synth.look import look_of
from vml_course.synth.path import fine_path
from vml_course.synth.render import draw_frames, scene_of, to_picture
from vml_course.synth.rows import with_rows
from vml_course.synth.scene import scene_class
from vml_course.synth.shake import wander
from vml_course.synth.simulate import simulate
from vml_course.synth.sprite import make_planes

SoccerKick = scene_class("soccer_kick")
PLACE_PX = 0.01  # where a drawn point may lie from its truth, at any frame
MEAN_PX = 0.004
BAR_PX = 0.05  # the bar's ticks are drawn at the picture's scale, and short
SAME_PX = 1e-9
VIEWS = {
    "barrel": {"distortion": -0.12},
    "pincushion": {"distortion": 0.1},
    "askew": {"roll_deg": 4.0, "pan_deg": 8.0, "tilt_deg": -6.0, "distance_m": 2.5},
    "everything": {"roll_deg": -3.0, "pan_deg": -5.0, "tilt_deg": 4.0, "distortion": -0.08, "rolling_shutter": 0.8},
    "rolling": {"rolling_shutter": 1.0, "fps": 240.0},
    "rolling by hand": {"rolling_shutter": 0.7, "shake_px": 3.0, "distortion": -0.1},
}


def film(seed=5, **how):
    return simulate(SoccerKick(), replace(SoccerKick.default_camera, **how), seed)


def fit_target(luma, truth, frame, name):
    """Fit crossed edges, drawn flat in the world and seen through the camera, moved by some pixels."""
    true, path = np.array(truth.point_px(name, frame)), fine_path(scene_of(truth), truth.camera.fps)
    column = truth.point_index(name)
    turn = path.at(truth.seen_s[frame, column : column + 1])[0, 0, 2]
    x0, y0 = np.round(true).astype(int)
    y, x = np.mgrid[y0 - 7 : y0 + 8, x0 - 7 : x0 + 8]
    inside = np.hypot(x - true[0], y - true[1]) < 5.5
    x, y = x[inside], y[inside]
    shift = truth.offset_px[frame]
    centre = truth.camera.to_m(true - shift)

    def residual(p):
        local = truth.camera.to_m(np.stack([x - p[0], y - p[1]], axis=-1) - shift) - centre
        u, v = local.T * truth.camera.px_per_m
        c, s = np.cos(turn + p[2]), np.sin(turn + p[2])
        along, up = c * u + s * v, -s * u + c * v
        return p[4] + p[3] * erf(along / p[5]) * erf(up / p[5]) - luma[y, x]

    found = least_squares(residual, [0.0, 0.0, 0.0, -100.0, 130.0, 1.0])
    assert found.cost / len(x) < 60  # it is a target that was fitted
    return found.x[:2]


@pytest.mark.parametrize("name", VIEWS)
def test_targets_lie_where_the_truth_says(name):
    truth = film(**VIEWS[name])
    errors = [
        fit_target(planes.luma.astype(np.float64), truth, frame, point)
        for frame, planes in enumerate(draw_frames(truth))
        if frame % 6 == 0
        for point in ("foot", "knee", "shin")
    ]
    assert np.abs(errors).max() < PLACE_PX
    assert np.abs(np.mean(errors, axis=0)).max() < MEAN_PX


@pytest.mark.parametrize("name", ["barrel", "pincushion", "askew"])
def test_the_scale_bar_ends_where_its_marks_are(name):
    """Its ticks are 6 mm wide and 8 cm high: a pair of blurred edges, flat in the world, above and below the pole."""
    truth = film(**VIEWS[name])
    luma = next(draw_frames(truth)).luma.astype(np.float64)
    for mark in ("bar_left", "bar_right"):
        x0, y0 = np.round(truth.mark_px(mark)).astype(int)
        y, x = np.mgrid[y0 - 24 : y0 + 25, x0 - 12 : x0 + 13]
        u, v = np.moveaxis(truth.camera.to_m(np.stack([x, y], axis=-1)) - np.array(truth.marks_m[mark]), -1, 0)
        u, v = u * truth.camera.px_per_m, np.abs(v)
        inside = (v > 0.026) & (v < 0.033) & (np.abs(u) < 7)
        u, seen, side = u[inside], luma[y, x][inside], (y < y0)[inside]

        def residual(p, u=u, seen=seen, side=side):
            edges = erf((u - p[0] + 1.5) / p[1]) - erf((u - p[0] - 1.5) / p[1])
            return np.where(side, p[2], p[5]) + p[3] * u - np.where(side, p[4], p[6]) * edges - seen

        found = least_squares(residual, [0.1, 1.0, 150.0, 0.0, 60.0, 150.0, 60.0]).x
        assert abs(found[0]) < BAR_PX


def test_a_point_is_seen_when_its_row_is_exposed():
    truth = film(**VIEWS["rolling by hand"])
    camera, path = truth.camera, fine_path(scene_of(truth), truth.camera.fps)
    for column, (body, local) in enumerate([(0, (0.0, -0.56)), (0, (0.0, 0.0)), (0, (0.0, -0.28)), (1, (0.0, 0.0))]):
        time_s = truth.seen_s[:, column]
        x, y, angle = path.at(time_s)[:, body].T
        c, s = np.cos(angle), np.sin(angle)
        there = np.stack([x + c * local[0] - s * local[1], y + s * local[0] + c * local[1]], axis=-1)
        seen = camera.to_px(there) + wander(truth.seed, camera.shake_px, time_s)
        assert np.abs(seen - truth.xy_px[:, column]).max() < SAME_PX
        row_s = truth.time_s + camera.rolling_shutter / camera.fps * (seen[:, 1] - 359.5) / 720
        assert np.abs(row_s - time_s).max() < 1e-11


def test_a_rolling_shutter_shows_the_foot_ahead_below_the_middle_and_behind_above():
    rolled, still = film(rolling_shutter=1.0, fps=240.0), film(fps=240.0)
    before = slice(0, still.impact.frame_before - 1)
    ahead = (rolled.xy_px - still.xy_px)[before, 0, 0]
    assert np.array_equal(np.sign(ahead), np.sign(rolled.xy_px[before, 0, 1] - 359.5))
    assert ahead.max() > 4
    assert np.abs(rolled.xy_px - still.xy_px)[before, 1].max() < SAME_PX  # the knee does not move


@pytest.mark.parametrize("shutter", [0.0, 0.9])
def test_each_row_is_that_of_a_picture_taken_all_at_once_at_the_rows_time(shutter):
    truth = film(rolling_shutter=1.0, fps=240.0, shutter=shutter)
    camera, path, frame = truth.camera, fine_path(scene_of(truth), 240.0), truth.impact.frame_before
    look = look_of(scene_of(truth), camera, truth.seed)
    rolled = next(islice(draw_frames(truth), frame, None)).luma
    still = make_planes(look.background)
    sprites = [look.sprites[body] for body in truth.bodies]
    rough = path.at(truth.time_s[frame] + camera.exposure_s * np.linspace(-0.5, 0.5, 17))
    count = count_instants(sprites, to_picture(camera, rough, np.zeros((17, 2)))) if shutter else 1
    for row in (180, 330, 480, 530):
        row_s = truth.time_s[frame] + 1.0 / 240.0 * (row - 359.5) / 720
        times = row_s + camera.exposure_s * ((np.arange(count) + 0.5) / count - 0.5)
        pose_px = to_picture(camera, path.at(times), np.zeros((count, 2)))
        planes = still.copy()
        expose(planes, [Swept(sprite, pose_px[:, k]) for k, sprite in enumerate(sprites)])
        difference = np.abs(planes.luma[row] - rolled[row])
        assert difference.max() < 0.05
        assert np.abs(still.luma[row] - rolled[row]).max() > 20


def test_points_that_outrun_the_shutter_are_refused():
    truth = film()
    slow = replace(truth.camera, rolling_shutter=1.0, fps=24.0, height_px=64)
    with pytest.raises(SceneRefusedError, match="speed of a point over that of the rolling shutter"):
        with_rows(replace(truth, camera=slow), scene_of(truth))


def test_the_file_of_the_truth_keeps_rows_and_lens(tmp_path):
    truth = film(**VIEWS["rolling by hand"])
    write_truth_json(tmp_path / "truth.json", truth)
    back = read_truth_json(tmp_path / "truth.json")
    assert back.camera == truth.camera
    for name in ("xy_px", "seen_s", "row_marks_px"):
        assert np.array_equal(getattr(back, name), getattr(truth, name))
    assert back.mark_px("bar_left", 7) == truth.mark_px("bar_left", 7)

"""An open shutter averages, and the truth is the middle of what it sees."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from vml_course.synth.exposure import FEWEST_INSTANTS, STEP_PX, Swept, count_instants, expose
from vml_course.synth.look import look_of
from vml_course.synth.path import fine_path
from vml_course.synth.render import draw_frames, exposures, scene_of
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate
from vml_course.synth.sprite import OPTICS_PX, OVERSAMPLE, Planes, Sprite
from vml_course.synth.texture import grain

SoccerKick = scene_class("soccer_kick")
MEAN_GREY = 0.02  # a mean over instants against the integral
PLACE_PX = 0.01
SAME_M = 1e-9


def camera(fps, shutter):
    return replace(SoccerKick.default_camera, fps=fps, shutter=shutter)


def sprite(seed, rows=80, columns=100):
    """A speckled sheet with soft edges, blurred as lenses do, with `OVERSAMPLE` samples a pixel."""
    y, x = np.mgrid[:rows, :columns]
    edge = np.minimum.reduce([x, y, columns - 1 - x, rows - 1 - y])
    opacity = np.clip((edge - 10) / 8, 0, 1).astype(np.float32)
    luma = (128 + 30 * grain(seed, "sheet", (rows, columns), OVERSAMPLE)) * opacity
    chroma = np.repeat(opacity[::2, ::2, None], 3, axis=2) * np.array([120, 140, 1], np.float32)
    sharp = np.dstack([luma, opacity]).astype(np.float32)
    return Sprite(cv2.GaussianBlur(sharp, (0, 0), OPTICS_PX * OVERSAMPLE), chroma, (columns / 2, rows / 2))


def room(rows=80, columns=140):
    y, x = np.mgrid[:rows, :columns].astype(np.float32)
    return Planes(60 + 0.4 * x + 0.2 * y, np.full((rows // 2, columns // 2, 2), 128, np.float32))


def straight(start, way, count):
    middles = (np.arange(count) + 0.5) / count
    return np.column_stack([start[0] + way[0] * middles, start[1] + way[1] * middles, np.zeros(count)])


def integral(plane, row, columns, way):
    """Mean of a row, read by quadratic splines, from each column back by `way` samples: by its antiderivative."""
    fine = np.linspace(0, plane.shape[1] - 1, 64 * (plane.shape[1] - 1) + 1)
    values = map_coordinates(plane.astype(np.float64), [np.full_like(fine, row), fine], order=2, prefilter=False)
    total = np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) / 2 / 64)])
    return (np.interp(columns, fine, total) - np.interp(columns - way, fine, total)) / way


def test_a_sheet_in_uniform_motion_is_the_integral_over_its_way():
    sheet, planes, still, way = sprite(3), room(), room(), 21.3
    count = count_instants([sheet], straight((50.0, 40.0), (way, 0.0), 17)[:, None])
    expose(planes, [Swept(sheet, straight((50.2, 40.0), (way, 0.0), count))])
    columns = (np.arange(140) - 50.2) * OVERSAMPLE + sheet.origin[0]
    for row in (30, 40, 47):
        line = (row - 40) * OVERSAMPLE + sheet.origin[1]
        colour, opacity = (integral(sheet.luma[..., k], line, columns, way * OVERSAMPLE) for k in (0, 1))
        seen = still.luma[row] * (1 - opacity) + colour
        assert np.abs(planes.luma[row] - seen).max() < MEAN_GREY * 5
        assert np.sqrt(np.mean((planes.luma[row] - seen) ** 2)) < MEAN_GREY


def test_bodies_that_hide_one_another_are_averaged_as_whole_pictures():
    under, over, count = sprite(3), sprite(4), 23
    bodies = [Swept(under, straight((40, 40), (14, 3), count)), Swept(over, straight((70, 45), (-9, 2), count))]
    planes, mean = room(), np.zeros((80, 140))
    expose(planes, bodies)
    for instant in range(count):
        sheet = room()
        for body in bodies:
            x, y, turn = body.pose_px[instant]
            body.sprite.lay(sheet, (x, y), turn)
        mean += sheet.luma / count
    assert np.abs(planes.luma - mean).max() < MEAN_GREY * 5


@pytest.mark.parametrize(("fps", "shutter"), [(480, 0.17), (240, 0.9), (60, 0.5)])
def test_instants_are_closer_together_than_a_pixel(fps, shutter):
    truth = simulate(SoccerKick(), camera(fps, shutter), 1)
    look = look_of(scene_of(truth), truth.camera, truth.seed)
    for pose_px, _ in exposures(truth, [look.sprites[body] for body in truth.bodies]):
        assert len(pose_px) >= FEWEST_INSTANTS
        assert np.hypot(*np.diff(pose_px[:, 1, :2], axis=0).T).max() < STEP_PX


def test_the_path_passes_through_the_frames_and_turns_sharply_at_the_impact():
    kick = SoccerKick(impact_phase=0.37)
    truth = simulate(kick, camera(240, 0.9), 1)
    path, impact = fine_path(kick, 240), truth.impact
    assert np.abs(path.at(truth.time_s) - truth.pose).max() < SAME_M
    late = np.array([1e-6, 1e-5, 1e-4])
    before, after = path.at(impact.time_s - late), path.at(impact.time_s + late)
    assert np.abs(before[:, 1] - truth.pose[0, 1]).max() < SAME_M
    flown = (after[:, 1, :2] - truth.pose[0, 1, :2]) / late[:, None]
    assert flown == pytest.approx(np.tile(impact.struck_after_m_s, (3, 1)), abs=0.01)
    turned = (after[:, 0, 2] - before[:, 0, 2]) / late
    assert turned == pytest.approx(impact.omega_before_rad_s + impact.omega_after_rad_s, rel=1e-4)


def test_an_exposure_with_the_impact_shows_the_ball_at_rest_and_in_flight():
    truth = simulate(SoccerKick(impact_phase=0.37), camera(240, 0.9), 1)
    look = look_of(scene_of(truth), truth.camera, truth.seed)
    poses = [pose for pose, _ in exposures(truth, [look.sprites[body] for body in truth.bodies])]
    middle, impact = truth.impact.frame_before, truth.impact.time_s
    x = poses[middle][:, 1, 0]
    resting = int(np.sum(x < x[0] + 1e-6))
    opened = truth.time_s[middle] - truth.camera.exposure_s / 2
    assert resting / len(x) == pytest.approx((impact - opened) / truth.camera.exposure_s, abs=1 / len(x))
    assert x[-1] > x[0] + 3


def test_the_centre_of_a_blurred_ball_is_the_truth():
    sharp, blurred = (simulate(SoccerKick(), camera(240, shutter), 1) for shutter in (0.0, 0.9))
    frame = sharp.impact.frame_before + 4
    centres = []
    for truth in (sharp, blurred):
        look = look_of(scene_of(truth), truth.camera, truth.seed)
        ball, pose = look.sprites["ball"], list(exposures(truth, [look.sprites["leg"], look.sprites["ball"]]))[frame][0]
        planes = Planes(np.zeros((720, 1280), np.float32), np.zeros((360, 640, 2), np.float32))
        expose(planes, [Swept(ball, pose[:, 1])])
        light = planes.luma.astype(np.float64)
        y, x = np.mgrid[:720, :1280]
        centres.append(np.array([(x * light).sum(), (y * light).sum()]) / light.sum())
    # Free fall bends the way: its mean lies g exposure² / 24 below the middle.
    sag = 9.81 * blurred.camera.exposure_s**2 / 24 * blurred.camera.px_per_m
    assert centres[1] - centres[0] == pytest.approx([0.0, sag], abs=PLACE_PX)


def test_what_does_not_move_is_the_same_with_an_open_shutter():
    flash, blurred = (next(draw_frames(simulate(SoccerKick(), camera(480, s), 1))).luma.copy() for s in (0.0, 0.4))
    assert np.array_equal(flash[:, 620:], blurred[:, 620:])
    assert np.array_equal(flash[400:, 460:], blurred[400:, 460:])  # the ball on its tee
    assert np.abs(flash - blurred).max() > 20

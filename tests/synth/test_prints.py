"""What is printed on bodies and drawn behind them: how well it can be tracked, and where it traps."""

import cv2
import numpy as np
import pytest

from vml_course.errors import UnknownNameError
from vml_course.io.truth import read_truth_json, write_truth_json
from vml_course.synth.props.backgrounds import BACKGROUNDS
from vml_course.synth.render import draw_frames
from vml_course.synth.scene import scene_class
from vml_course.synth.settings import read_settings
from vml_course.synth.simulate import simulate
from vml_course.synth.views import PRINTS

SoccerKick = scene_class("soccer_kick")
BLOCK = 20  # px about a point, inside the shin's outline


def film(**how):
    truth = simulate(SoccerKick(**how), SoccerKick.default_camera, seed=5)
    return truth, next(draw_frames(truth)).luma.astype(np.float64)


def block(truth, luma, point, angle_rad=None, reach=BLOCK):
    """The leg's block about a point, turned so that the leg hangs down."""
    x, y = truth.point_px(point)
    turn = np.degrees(truth.pose[0, 0, 2] if angle_rad is None else angle_rad)
    matrix = cv2.getRotationMatrix2D((x, y), -turn, 1.0)
    hanging = cv2.warpAffine(luma, matrix, luma.shape[::-1], flags=cv2.INTER_CUBIC)
    return hanging[round(y) - reach : round(y) + reach + 1, round(x) - reach : round(x) + reach + 1]


def fine(picture):
    """What is left without slow shades."""
    return (picture - cv2.GaussianBlur(picture, (0, 0), 3.0))[9:-9, 9:-9]


def test_a_plain_knee_has_nothing_to_track_while_the_rest_has():
    truth, luma = film(knee="plain")
    marked = film()
    assert fine(block(truth, luma, "knee")).std() < 0.3
    assert fine(block(*marked, "knee")).std() > 15
    assert np.abs(block(truth, luma, "shin") - block(*marked, "shin")).max() < 1e-6


def test_a_plain_leg_and_ball_have_only_outlines_and_panels():
    truth, luma = film(texture="plain")
    for point in ("knee", "shin"):
        assert fine(block(truth, luma, point)).std() < 0.3


def test_stripes_look_the_same_along_themselves_and_after_one_period():
    truth, luma = film(texture="stripes")
    wide = block(truth, luma, "shin")
    across, along = np.gradient(wide)
    assert np.sqrt((across**2).mean()) > 15 * np.sqrt((along**2).mean())
    period = round(0.036 * truth.camera.px_per_m)
    assert np.abs(wide[period:] - wide[:-period]).mean() < 0.1 * np.abs(wide - wide.mean()).mean()


def test_a_logo_can_be_tracked_in_both_directions():
    for gradient in np.gradient(block(*film(texture="logo"), "shin", reach=25)):
        assert 1.0 / np.sqrt((gradient**2).sum()) < 0.004  # Cramer-Rao at one grey level of noise


def test_contrast_scales_the_speckle_and_size_coarsens_it():
    blank = block(*film(speckle=0.0), "shin", reach=30)
    usual, double, coarse = (
        block(*film(**how), "shin", reach=30) - blank for how in ({}, {"speckle": 2.0}, {"speckle_px": 3.0})
    )
    assert double.std() == pytest.approx(2 * usual.std(), rel=0.01)
    assert coarse.std() == pytest.approx(usual.std(), rel=0.5)
    slope = [np.hypot(*np.gradient(part)).mean() / part.std() for part in (usual, coarse)]
    assert slope[1] < 0.5 * slope[0]


def test_every_background_fills_the_picture_and_differs_from_the_others():
    rooms = [film(background=kind)[1] for kind in BACKGROUNDS]
    for room in rooms:
        assert room[:, 900:].min() > 20
        assert room[:, 900:].max() < 256
    for k, room in enumerate(rooms):
        assert all(np.abs(room - other)[:, 900:].mean() > 3 for other in rooms[k + 1 :])


def test_a_ball_to_calibrate_with_is_marked_at_its_own_edges():
    truth, luma = film(scale="ball", background="grid", texture="plain")
    left, right = (np.array(truth.mark_px(name)) for name in ("ball_left", "ball_right"))
    assert right - left == pytest.approx([0.22 * 500, 0.0])
    line = luma[round(left[1])]
    for mark, outwards in ((left[0], -1), (right[0], 1)):
        near = np.round(mark + outwards * np.array([3, -1])).astype(int)
        assert line[near[0]] - line[near[1]] > 30  # the cloth is bright, the ball's rim dark


@pytest.mark.parametrize("word", ["texture=tartan", "background=beach", "knee=sore", "scale=inch"])
def test_an_unknown_word_names_the_known_ones(word):
    name, _ = word.split("=")
    with pytest.raises(UnknownNameError, match=f"{name}: expected one of"):
        read_settings("soccer_kick", [word])


@pytest.mark.parametrize("texture", PRINTS)
def test_words_are_part_of_the_truth(texture, tmp_path):
    truth, luma = film(texture=texture, background="grass")
    write_truth_json(tmp_path / "truth.json", truth)
    again = next(draw_frames(read_truth_json(tmp_path / "truth.json"))).luma
    assert np.array_equal(again.astype(np.float64), luma)


def test_prints_do_not_change_the_motion():
    plain, speckled = (simulate(SoccerKick(texture=t), SoccerKick.default_camera, 5) for t in ("plain", "speckle"))
    assert np.array_equal(plain.pose, speckled.pose)

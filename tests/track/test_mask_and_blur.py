"""Pixels that do not move with the block stop counting; a smeared block is matched as it is smeared."""

import numpy as np
import pytest

from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.blur import Motion, hit_at, instants, left_open, motion_at, smear_px
from vml_course.track.mask import MASKED, weight_of
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker

SHARP_PX = 0.02
BLURRED_PX = 0.05
POINT = np.array([118.4, 112.7])


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.fixture(scope="module")
def ball_clip(speckle, camera_of):
    """A textured disc of 50 px that flies over a textured wall; frames and centres."""
    wall = np.roll(speckle.picture(), (37, 61), (0, 1))
    x, y = np.meshgrid(np.arange(speckle.width_px), np.arange(speckle.height_px))
    centres = np.array([[80.0 + 3.3 * k, 90.0 + 1.7 * k] for k in range(20)])
    frames = []
    for k, (cx, cy) in enumerate(centres):
        cover = np.clip(25.5 - np.hypot(x - cx, y - cy), 0.0, 1.0)
        picture = cover * speckle.picture(None, (cx - 120, cy - 110)) + (1 - cover) * wall
        frames.append(Frame(k, k / 480, camera_of(picture, 1.0, k)))
    return frames, centres


def test_the_wall_behind_a_ball_smaller_than_its_block_pulls_it_only_until_it_is_masked(ball_clip):
    frames, centres = ball_clip
    track = run(make_tracker("dic"), frames, [Seed("ball", *centres[0])])
    error = np.hypot(*(track.xy_px[:, 0] - centres).T)
    assert rms(error[5:]) < SHARP_PX
    assert track.zncc[1, 0] < 0.9 < track.zncc[-1, 0]


def test_weights_of_mere_noise_are_equal_and_what_does_not_fit_is_masked():
    rng = np.random.default_rng(3)
    squares = rng.normal(0.0, 2.0, (8, 60, 60)).astype(np.float32) ** 2
    assert weight_of(tuple(squares)).std() < 0.1
    squares[:, :12, :12] += 900.0
    weight = weight_of(tuple(squares))
    assert (weight[:8, :8] == MASKED).all()
    assert weight[20:, 20:].mean() > 0.9
    squares[:, :50] += 900.0
    assert weight_of(tuple(squares)) is None or weight_of(tuple(squares))[:45].min() > 0.5


def exposed(speckle, pose_at, frame, shutter):
    times = frame + shutter * ((np.arange(60) + 0.5) / 60 - 0.5)
    return np.mean([speckle.picture(*pose_at(t)) for t in times], axis=0)


@pytest.mark.parametrize("turn_deg", [0.0, 4.0])
def test_a_block_smeared_over_16_px_is_found_to_a_twentieth_of_a_pixel(speckle, rotated, camera_of, error_of, turn_deg):
    shutter = 0.8

    def pose_at(t):
        moved = max(t - 1.5, 0.0)
        return rotated(turn_deg * moved), np.array([20.0 * moved - 45, 4.0 * moved - 8 + 0.3 * moved**2])

    poses = [pose_at(k) for k in range(7)]
    frames = [Frame(k, k / 240, camera_of(exposed(speckle, pose_at, k, shutter), 1.0, k)) for k in range(7)]
    start = speckle.moved(POINT, *poses[0])
    track = run(make_tracker("dic", shutter=shutter), frames, [Seed("ball", *start)])
    assert not track.is_lost.any()
    error = error_of(track, poses, [POINT])[:, 0]
    assert rms(error[4:]) < BLURRED_PX
    assert error.max() < 0.3  # the picture just after the hit tells less of the motion


def test_a_reference_that_is_smeared_alike_needs_no_smear(speckle, camera_of, error_of):
    def pose_at(t):
        return np.eye(2), np.array([12.0 * t - 30, 0.0])

    poses = [pose_at(k) for k in range(5)]
    frames = [Frame(k, k / 240, camera_of(exposed(speckle, pose_at, k, 0.8), 1.0, k)) for k in range(5)]
    track = run(make_tracker("dic", shutter=0.8), frames, [Seed("foot", *speckle.moved(POINT, *poses[0]))])
    assert rms(error_of(track, poses, [POINT])) < SHARP_PX
    assert track.zncc.min() > 0.98


def pose(x, y, linear=None):
    return np.concatenate([[x, y], (np.eye(2) if linear is None else linear).ravel()])


def test_three_steady_poses_make_a_parabola():
    motion = motion_at(pose(9.0, 0.0), (pose(4.0, 0.0), pose(1.0, 0.0)), steady=2)
    assert motion.velocity == pytest.approx([6.0, 0.0])
    assert motion.acceleration == pytest.approx([2.0, 0.0])


def test_what_was_hit_on_the_way_is_faster_than_its_mean():
    motion = hit_at(pose(16.0, 0.0), (pose(10.0, 0.0), pose(10.0, 0.0)), since=-0.5)
    assert motion.velocity == pytest.approx([12.0, 0.0])
    warps = instants(motion._replace(since=0.0), pose(16.0, 0.0), shutter=1.0, count=4)
    assert warps[:2, 0] == pytest.approx([0.0, 0.0])  # still until the hit
    assert warps[2:, 0] == pytest.approx([-1.5, -4.5])


def test_smears_the_same_way_leave_the_root_of_the_difference():
    still = Motion(np.array([10.0, 0.0]), np.zeros(2), np.zeros((2, 2)))
    smear = smear_px(still, pose(0.0, 0.0), 0.5)
    assert smear == pytest.approx([5.0, 0.0])
    assert left_open(np.array([3.0, 0.0]), smear) == pytest.approx(0.8)
    assert left_open(np.array([0.0, 3.0]), smear) == 1.0
    assert left_open(np.array([6.0, 0.0]), smear) == 0.0

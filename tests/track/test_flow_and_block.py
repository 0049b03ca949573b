"""The two simple methods: what they are good for, and that they say where they are not."""

import numpy as np
import pytest

from vml_course.model.track import Seed
from vml_course.track.blocks import shift_variance, zncc
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker
from vml_course.track.trackers.block import vertex

POINT = np.array([118.4, 112.7])
SEED = [Seed("mark", float(POINT[0]), float(POINT[1]))]
SHIFT_PX = 0.05
SIMPLE = ("flow", "block")

simple = pytest.mark.parametrize("method", SIMPLE)


def coverage(track, errors):
    """Share of pictures in which the 95 % interval of the radial error holds."""
    return float(np.mean(errors[1:, 0] < 2.45 * track.sigma_px[1:, 0]))


@simple
@pytest.mark.parametrize("noise", [0.0, 1.0, 3.0])
def test_a_pure_shift_is_followed_to_a_twentieth_of_a_pixel(method, noise, clip_of, error_of):
    poses = [(np.eye(2), (1.37 * k - 15, 0.61 * k)) for k in range(25)]
    track = run(make_tracker(method), clip_of(poses, noise), [Seed("mark", POINT[0] - 15, POINT[1])])
    assert not track.is_lost.any()
    assert error_of(track, poses, [POINT]).max() < SHIFT_PX + 0.02 * noise


@simple
def test_a_turning_block_drifts_and_sigma_says_so(method, rotated, clip_of, error_of):
    poses = [(rotated(3.0 * k), (0.0, 0.0)) for k in range(31)]
    clip = clip_of(poses)
    seeds = [Seed("mark", 126.0, 117.0)]
    track = run(make_tracker(method), clip, seeds)
    errors = error_of(track, poses, [(126.0, 117.0)])
    assert not track.is_lost.any()
    assert coverage(track, errors) >= 0.9
    assert track.sigma_px[-1, 0] > 0.5
    assert track.zncc[-1, 0] < 0.5  # with the first block, not with the one before


@pytest.mark.parametrize(("method", "jump"), [("flow", (5.0, -4.0)), ("block", (24.0, 9.0))])
def test_a_jump_within_its_reach_is_no_loss(method, jump, clip_of, error_of):
    poses = [(np.eye(2), (-12.0, 0.0))] + 2 * [(np.eye(2), (jump[0] - 12.0, jump[1]))]
    track = run(make_tracker(method), clip_of(poses), [Seed("mark", POINT[0] - 12, POINT[1])])
    assert error_of(track, poses, [POINT]).max() < 2 * SHIFT_PX


@simple
def test_a_hidden_point_is_lost_then_found_where_it_stands(method, clip_of, error_of):
    poses = [(np.eye(2), (0.4 * k, 0.2 * k)) for k in range(16)]
    hidden = range(5, 12)

    def cover(k, picture):
        if k in hidden:
            picture[60:170, 40:200] = 90 + 10 * np.sin(np.arange(160) / 9)
        return picture

    track = run(make_tracker(method), clip_of(poses, retouch=cover), SEED)
    assert track.is_lost[list(hidden), 0].all()
    shown = [k for k in range(16) if k not in hidden]
    assert not track.is_lost[shown, 0].any()
    assert error_of(track, poses, [POINT])[shown].max() < 2 * SHIFT_PX


@simple
def test_a_point_that_is_given_up_stays_lost(method, clip_of):
    poses = [(np.eye(2), (0.0, 0.0))] * 7
    track = run(
        make_tracker(method, give_up_frames=2),
        clip_of(poses, retouch=lambda k, picture: np.full_like(picture, 128.0) if k in (2, 3, 4) else picture),
        SEED,
    )
    assert track.is_lost[:, 0].tolist() == [False, False, True, True, True, True, True]


@simple
def test_what_a_shift_cannot_see_is_not_measured(method, clip_of):
    track = run(make_tracker(method), clip_of([(np.eye(2), (k, 0.0)) for k in range(3)]), SEED)
    assert (track.gradient[0] == 0.0).all()
    assert np.isnan(track.gradient[1:]).all()


@simple
def test_a_point_that_leaves_the_picture_is_lost_not_stuck_at_the_rim(method, clip_of):
    poses = [(np.eye(2), (14.0 * k, 0.0)) for k in range(12)]
    track = run(make_tracker(method, block=31), clip_of(poses), SEED)
    seen = ~track.is_lost[:, 0]
    assert not seen[-1]
    assert np.allclose(track.xy_px[seen, 0, 0], POINT[0] + 14.0 * np.flatnonzero(seen), atol=1.0)


def test_a_thing_that_only_shifts_keeps_its_first_template(clip_of, error_of):
    poses = [(np.eye(2), (0.31 * k, 0.0)) for k in range(40)]
    track = run(make_tracker("block"), clip_of(poses, 2.0), SEED)
    assert track.sigma_px[-1, 0] == pytest.approx(track.sigma_px[1, 0], rel=0.2)


def test_the_quadratic_fit_keeps_within_its_pixel():
    assert np.abs(vertex(np.array([[9.0, 8, 9], [1, 0.9, 1], [9, 8, 9.0]]))).max() <= 1.0
    assert (vertex(np.ones((3, 3))) == 0.0).all()


def test_likeness_and_spread_of_blank_blocks_are_no_accident():
    blank = np.full((20, 20), 7.0)
    assert zncc(blank, blank) == 0.0
    assert shift_variance(blank, blank).white == np.inf

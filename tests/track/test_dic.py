"""Digital image correlation follows what a kick does to a block."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vml_course.errors import SeedError
from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker
from vml_course.track.trackers.dic import choose_warp

SHARP_PX = 0.02
POINT = np.array([118.4, 112.7])
SEED = [Seed("mark", float(POINT[0]), float(POINT[1]))]


def dic(**options):
    return make_tracker("dic", **options)


def rms(values):
    return float(np.sqrt(np.nanmean(np.square(values))))


def test_more_than_half_a_turn_is_followed(rotated, clip_of, error_of):
    poses = [(rotated(7.0 * k), (0.3 * k, 0.2 * k)) for k in range(30)]
    track = run(dic(), clip_of(poses), SEED)
    assert not track.is_lost.any()
    assert rms(error_of(track, poses, [POINT])) < SHARP_PX
    turned = np.unwrap(np.arctan2(track.gradient[:, 0, 2], 1 + track.gradient[:, 0, 0]))
    assert np.degrees(turned[-1]) == pytest.approx(203, abs=0.1)


def test_a_point_that_moves_fast_at_once_is_found_without_a_past(rotated, clip_of, error_of):
    poses = [(rotated(3.2 * k), (31.0 * k - 30, 0.0)) for k in range(3)]
    seeds = [Seed("foot", POINT[0] - 30, POINT[1])]
    track = run(dic(), clip_of(poses), seeds)
    assert not track.is_lost.any()
    assert error_of(track, poses, [POINT]).max() < 2 * SHARP_PX


def test_a_ball_that_is_hit_and_a_foot_that_stops_are_found_again(rotated, clip_of, error_of):
    still, flying = [(np.eye(2), (-25.0, 0.0))] * 4, [(rotated(2.0 * k), (25.0 * k - 40, 3.0 * k)) for k in range(4)]
    seeds = [Seed("ball", POINT[0] - 25, POINT[1])]
    for poses in (still + flying, still + flying + [flying[-1]] * 4):
        track = run(dic(), clip_of(poses), seeds)
        assert not track.is_lost.any()
        assert error_of(track, poses, [POINT]).max() < 2 * SHARP_PX


@pytest.mark.parametrize("direction_deg", [0.0, 37.0, 90.0, 200.0])
def test_a_jump_of_50_px_and_20_degrees_is_no_loss(rotated, clip_of, error_of, direction_deg):
    jump = rotated(direction_deg) @ np.array([50.0, 0.0])
    poses = [(np.eye(2), -jump / 2)] * 3 + [(rotated(20.0), jump / 2)] * 3
    track = run(dic(), clip_of(poses), [Seed("mark", *(POINT - jump / 2))])
    assert not track.is_lost.any()
    assert error_of(track, poses, [POINT]).max() < 2 * SHARP_PX


def test_a_hidden_point_is_lost_then_found_without_drift(rotated, clip_of, error_of):
    poses = [(rotated(1.5 * k), (2.0 * k - 20, 0.5 * k)) for k in range(24)]
    hidden = range(6, 16)

    def cover(k, picture):
        if k in hidden:
            picture[60:170, 40:200] = 90 + 10 * np.sin(np.arange(160) / 9)
        return picture

    track = run(dic(), clip_of(poses, retouch=cover), [Seed("mark", *(POINT - [20.0, 0.0]))])
    assert track.is_lost[list(hidden), 0].all()
    assert np.isnan(track.xy_px[list(hidden), 0]).all()
    shown = [k for k in range(24) if k not in hidden]
    assert not track.is_lost[shown, 0].any()
    assert rms(error_of(track, poses, [POINT])[16:]) < SHARP_PX


def test_a_point_stays_lost_when_it_is_given_up(clip_of):
    poses = [(np.eye(2), (0.0, 0.0))] * 8
    blanked = clip_of(poses, retouch=lambda k, picture: np.full_like(picture, 128.0) if 2 <= k < 6 else picture)
    assert run(dic(give_up_frames=3), blanked, SEED).is_lost[:, 0].tolist() == [False] * 2 + [True] * 6
    assert run(dic(give_up_frames=9), blanked, SEED).is_lost[:, 0].tolist() == [False] * 2 + [True] * 4 + [False] * 2


def test_a_drift_of_the_light_by_30_percent_moves_nothing(clip_of, error_of):
    poses = [(np.eye(2), (0.4 * k, 0.1 * k)) for k in range(16)]

    def dim(k, picture):
        return picture * (1 - 0.3 * k / 15)

    track = run(dic(), clip_of(poses, retouch=dim), SEED)
    assert rms(error_of(track, poses, [POINT])) < SHARP_PX


@settings(max_examples=8, deadline=None)
@given(dx=st.integers(-12, 12), dy=st.integers(-12, 12))
def test_shifting_all_pixels_shifts_the_track(clip_of, dx, dy):
    clip = clip_of([(np.eye(2), (1.3 * k, 0.4 * k)) for k in range(4)])
    rolled = [Frame(f.index, f.time_s, np.roll(f.luma, (dy, dx), (0, 1))) for f in clip]
    here = run(dic(block=31), clip, SEED)
    there = run(dic(block=31), rolled, [Seed("mark", POINT[0] + dx, POINT[1] + dy)])
    assert np.allclose(there.xy_px, here.xy_px + np.array([dx, dy]), atol=2e-4)
    assert np.allclose(there.zncc, here.zncc, atol=1e-5)


@pytest.fixture(scope="module")
def dot_clip(camera_of):
    """A round dot of 8 px on a plain ground that circles, with noise 1; frames and centres."""
    x, y = np.meshgrid(np.arange(200.0), np.arange(200.0))
    angles = 0.12 * np.arange(40)
    centres = 100 + 40 * np.column_stack([np.cos(angles), np.sin(angles)])
    frames = []
    for k, (cx, cy) in enumerate(centres):
        picture = 60 + 150 / (1 + np.exp((np.hypot(x - cx, y - cy) - 4) / 0.5))
        frames.append(Frame(k, k / 240, camera_of(picture, 1.0, k)))
    return frames, centres


@pytest.mark.parametrize("block", [25, 60])
def test_a_round_dot_is_followed_by_translation_alone(dot_clip, block):
    frames, centres = dot_clip
    track = run(dic(block=block), frames, [Seed("dot", *centres[0])])
    assert not track.is_lost.any()
    assert rms(track.xy_px[:, 0] - centres) < 0.03
    assert np.abs(track.gradient).max() < 0.7  # never torn


def test_a_straight_edge_is_refused(camera_of):
    picture = np.tile(np.where(np.arange(200) < 100, 70.0, 170.0), (200, 1))
    with pytest.raises(SeedError, match="got only an edge, along which it slides"):
        dic().start(camera_of(picture, 2.0), np.array([[100.0, 100.0]]))


def test_a_block_that_holds_nothing_gets_the_smallest_warp():
    assert choose_warp(np.zeros((6, 6)), 1.0, 30.0) == "translation"
    assert choose_warp(np.diag([1e6] * 2 + [1e9] * 4), 1.0, 30.0) == "affine"

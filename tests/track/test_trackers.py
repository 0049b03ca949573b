"""What every tracker keeps; a new file in track/trackers is tested by being there."""

import numpy as np
import pytest

from vml_course.errors import OutOfRangeError, SeedError, UnknownNameError
from vml_course.model.track import Seed, Status
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker, tracker_names

POINTS = np.array([[112.3, 104.8], [130.0, 118.5]])
SEEDS = [Seed(f"p{k}", float(x), float(y)) for k, (x, y) in enumerate(POINTS)]
POSES = [(np.eye(2), (1.7 * k, -0.6 * k)) for k in range(6)]


@pytest.fixture(params=tracker_names())
def tracker(request):
    return make_tracker(request.param, block=41)


@pytest.fixture(scope="module")
def clip(clip_of):
    return clip_of(POSES)


def test_the_default_method_comes_first():
    assert tracker_names()[0] == "dic"


def test_a_slow_shift_is_followed(tracker, clip, error_of):
    track = run(tracker, clip, SEEDS)
    assert error_of(track, POSES, POINTS).max() < 0.1
    assert not track.is_lost.any()


def test_the_first_sighting_is_the_seeds(tracker, clip):
    _, sighting = tracker.start(clip[0].luma, POINTS)
    assert np.array_equal(sighting.xy_px, POINTS)
    assert (sighting.status == Status.AUTO).all()
    assert np.isfinite(sighting.sigma_px).all()


def test_the_same_pictures_give_the_same_numbers(tracker, clip):
    first, second = run(tracker, clip, SEEDS), run(tracker, clip, SEEDS)
    assert np.array_equal(first.xy_px, second.xy_px)
    assert np.array_equal(first.sigma_px, second.sigma_px)


def test_a_state_can_be_used_again(tracker, clip):
    state, _ = tracker.start(clip[0].luma, POINTS)
    once, twice = tracker.step(state, clip[1].luma)[1], tracker.step(state, clip[1].luma)[1]
    assert np.array_equal(once.xy_px, twice.xy_px)


def test_points_do_not_know_of_one_another(tracker, clip):
    together, alone = run(tracker, clip, SEEDS), run(tracker, clip, SEEDS[1:])
    assert np.array_equal(together.xy_px[:, 1], alone.xy_px[:, 0])


def test_a_point_that_is_not_there_is_lost_and_nan(tracker, clip, camera_of):
    state, _ = tracker.start(clip[0].luma, POINTS)
    _, sighting = tracker.step(state, camera_of(np.full((220, 240), 128.0), 2.0))
    assert (sighting.status == Status.LOST).all()
    assert np.isnan(sighting.xy_px).all()
    assert np.isnan(sighting.sigma_px).all()
    assert np.isnan(sighting.zncc).all()


def test_a_blank_block_is_refused(tracker, camera_of):
    with pytest.raises(SeedError, match=r"^seed 1: expected .*, got a blank one \(no texture\)"):
        tracker.start(camera_of(np.full((220, 240), 128.0), 2.0), POINTS)


def test_a_block_that_leaves_the_picture_is_refused(tracker, clip):
    with pytest.raises(
        SeedError, match=r"^seed 2: expected a point from \(20, 20\) to \(219, 199\) px, got \(8, 100\)"
    ):
        tracker.start(clip[0].luma, np.array([[100.0, 100.0], [8.0, 100.0]]))
    with pytest.raises(SeedError):
        tracker.start(clip[0].luma, np.array([[np.nan, 100.0]]))


def test_settings_are_written_down(tracker):
    assert tracker.settings["method"] == tracker.name
    assert tracker.settings["block"] == 41
    assert tracker.title


def test_unknown_names_and_sizes_are_refused():
    with pytest.raises(UnknownNameError, match="method: expected one of dic"):
        make_tracker("magic")
    with pytest.raises(UnknownNameError, match="setting: expected one of block"):
        make_tracker("dic", blok=60)
    with pytest.raises(OutOfRangeError):
        make_tracker("dic", block=10)

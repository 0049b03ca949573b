"""Points placed in any picture are followed both ways, and tracks go through places given by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vml_course.errors import FrameRangeError, InputError, SeedError
from vml_course.model.track import Seed, Status
from vml_course.track.places import Places, seed_at
from vml_course.track.placing import CLICK_SD_PX
from vml_course.track.run import run, run_both_ways
from vml_course.track.tracker import make_tracker, tracker_names

ACCURATE_PX = 0.05  # speckle, noise of 1 grey level, blocks of 31 px
START = np.array([112.3, 104.8])
COUNT = 13


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


POSES = [(turned(np.radians(4.0 * k)), (1.9 * k, -0.8 * k)) for k in range(COUNT)]


@pytest.fixture
def tracker():
    return make_tracker("dic", block=31)


@pytest.fixture(scope="module")
def clip(clip_of):
    return clip_of(POSES)


@pytest.fixture(scope="module")
def hidden_clip(clip_of):
    """A plain board hides the body in frames 5 to 8."""

    def cover(k, picture):
        return np.full_like(picture, 120.0) if 5 <= k <= 8 else picture

    return clip_of(POSES, retouch=cover)


@pytest.fixture(scope="module")
def place(speckle):
    return lambda k, name="a": seed_at(name, speckle.moved(START, *POSES[k]), k)


def both_ways(tracker, clip, places):
    frames = [seed.frame or 0 for seed in places.seeds]
    return run_both_ways(tracker, clip[min(frames) :], clip[max(frames) :: -1], places)


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, COUNT - 1))
def test_a_point_placed_in_any_picture_is_followed_both_ways(clip, error_of, place, seed):
    track = both_ways(make_tracker("dic", block=31), clip, Places((place(seed),)))
    assert track.frame.tolist() == list(range(COUNT))
    assert error_of(track, POSES, [START]).max() < ACCURATE_PX
    assert (track.reference == seed).all()
    assert not track.gradient[seed].any()


@pytest.mark.parametrize("method", tracker_names())
def test_every_method_goes_both_ways(clip_of, speckle, error_of, method):
    poses = [(np.eye(2), (1.7 * k, -0.6 * k)) for k in range(6)]
    seed = seed_at("a", speckle.moved(START, *poses[3]), 3)
    track = both_ways(make_tracker(method, block=41), clip_of(poses), Places((seed,)))
    assert error_of(track, poses, [START]).max() < 0.1


@pytest.mark.parametrize("method", tracker_names())
def test_every_method_goes_on_from_a_mark(clip_of, speckle, error_of, method):
    poses = [(np.eye(2), (1.7 * k, -0.6 * k)) for k in range(6)]
    places = Places((Seed("a", *START),), (seed_at("a", speckle.moved(START, *poses[3]), 3),))
    track = run_both_ways(make_tracker(method, block=41), clip_of(poses), (), places)
    assert track.status[3, 0] == Status.MANUAL
    assert error_of(track, poses, [START]).max() < 0.1


def test_points_placed_in_different_pictures_share_a_track(tracker, clip, error_of, place):
    track = both_ways(tracker, clip, Places((place(9, "late"), place(2, "early"), Seed("first", *START))))
    assert track.points == ("late", "early", "first")
    assert error_of(track, POSES, [START] * 3).max() < ACCURATE_PX
    assert track.reference[0].tolist() == [9, 2, 0]


def test_a_point_in_the_first_picture_is_tracked_as_ever(tracker, clip, place):
    once, again = run(tracker, clip, [Seed("a", *START)]), both_ways(tracker, clip, Places((place(0),)))
    assert np.array_equal(once.xy_px, again.xy_px)
    assert np.array_equal(once.sigma_px, again.sigma_px)


def test_a_mark_stays_where_it_was_put(tracker, clip, place):
    off = seed_at("a", [place(6).x_px + 1.5, place(6).y_px - 2.0], 6)
    track = run_both_ways(tracker, clip, (), Places((Seed("a", *START),), (off,)))
    assert track.xy_px[6, 0].tolist() == [off.x_px, off.y_px]
    assert track.status[:, 0].tolist() == [Status.AUTO] * 6 + [Status.MANUAL] + [Status.AUTO] * 6
    assert track.sigma_px[6, 0] == CLICK_SD_PX


def test_a_rough_mark_does_not_move_the_point_that_is_tracked(tracker, clip, error_of, place):
    off = seed_at("a", [place(6).x_px + 1.5, place(6).y_px - 2.0], 6)
    track = run_both_ways(tracker, clip, (), Places((Seed("a", *START),), (off,)))
    error = error_of(track, POSES, [START])[:, 0]
    assert np.delete(error, 6).max() < ACCURATE_PX
    assert (track.reference == 0).all()


def test_a_mark_does_not_spoil_the_sigma_of_its_neighbours(tracker, clip, place):
    off = seed_at("a", [place(6).x_px + 3.0, place(6).y_px], 6)
    plain = run(tracker, clip, [Seed("a", *START)])
    marked = run_both_ways(tracker, clip, (), Places((Seed("a", *START),), (off,)))
    assert np.delete(marked.sigma_px, 6).max() < 2.0 * plain.sigma_px.max()


def test_a_mark_finds_a_point_that_came_back_elsewhere_and_turned(clip_of, speckle, error_of):
    away = [(np.eye(2), (0.0, 0.0))] * 3 + [(turned(2.4), (18.0, -14.0))] * 4
    clip = clip_of(away)
    tracker = make_tracker("dic", block=31, search_radius=5)
    seed = Seed("a", *START)
    alone = run(tracker, clip, [seed])
    mark = seed_at("a", speckle.moved(START, *away[3]) + 0.8, 3)
    helped = run_both_ways(tracker, clip, (), Places((seed,), (mark,)))
    assert (alone.status[3:] == Status.LOST).all()
    assert error_of(helped, away, [START])[4:].max() < ACCURATE_PX
    assert (helped.reference == 0).all()


def test_a_changed_pattern_is_followed_by_its_block_at_the_mark(clip_of, speckle, error_of):
    poses = [(np.eye(2), (1.0 * k, 0.0)) for k in range(9)]
    other = type(speckle)(seed=77)
    clip = clip_of(poses, retouch=lambda k, picture: other.picture(*poses[k]) if k > 4 else picture)
    mark = seed_at("a", speckle.moved(START, *poses[5]), 5)
    track = run_both_ways(make_tracker("dic", block=31), clip, (), Places((Seed("a", *START),), (mark,)))
    assert error_of(track, poses, [START]).max() < ACCURATE_PX
    assert track.reference[:, 0].tolist() == [0] * 5 + [5] * 4


def test_a_mark_on_a_blank_spot_keeps_the_reference(tracker, hidden_clip, error_of, place):
    marks = tuple(place(k) for k in (5, 6, 7, 8))
    track = run_both_ways(tracker, hidden_clip, (), Places((Seed("a", *START),), marks))
    assert (track.status[5:9] == Status.MANUAL).all()
    assert np.isnan(track.zncc[5:9]).all()
    assert error_of(track, POSES, [START])[9:].max() < ACCURATE_PX
    assert (track.reference == 0).all()


def test_marks_before_the_seed_count_on_the_way_back(tracker, clip, place):
    track = both_ways(tracker, clip, Places((place(8),), (place(3), place(11))))
    assert track.status[:, 0].tolist().count(Status.MANUAL) == 2
    assert track.status[3, 0] == track.status[11, 0] == Status.MANUAL


def test_places_that_contradict_one_another_are_refused(place):
    with pytest.raises(InputError, match=r"^a: expected one place in a frame, got 2 in frame 4\.$"):
        Places((place(0),), (place(4), place(4)))
    with pytest.raises(InputError, match=r"^mark b: expected one of the points a, got 'b'\.$"):
        Places((place(0),), (place(4, "b"),))
    with pytest.raises(InputError, match=r"^mark a: expected the frame that it is in, got none\.$"):
        Places((place(0),), (Seed("a", 1.0, 2.0),))
    with pytest.raises(InputError, match=r"^mark a: expected a place in px"):
        Places((place(0),), (Seed("a", float("nan"), 2.0, 3),))


def test_a_frame_that_is_not_there_is_named(tracker, clip):
    with pytest.raises(FrameRangeError, match="a: expected a frame of the clip, 0 to 12, got 99"):
        run_both_ways(tracker, clip, (), Places((Seed("a", *START),), (Seed("a", 1.0, 2.0, 99),)))


def test_a_seed_that_cannot_be_followed_is_refused_by_name(tracker, clip):
    with pytest.raises(SeedError, match="late: expected a point from"):
        both_ways(tracker, clip, Places((Seed("late", 1.0, 1.0, 7), Seed("a", *START))))

"""Seeds in any picture, marks, and tracking again: on a video of a speckle that turns and is hidden for a while."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from vml_course.errors import FrameRangeError, InputError, UnknownNameError
from vml_course.io.video import write_video
from vml_course.model.frame import Picture
from vml_course.model.track import Seed, Status
from vml_course.track.places import seed_at
from vml_course.track.repair import Until, with_mark
from vml_course.track.virtual import VirtualPoint
from vml_course.usecases.check_points import check_points
from vml_course.usecases.cut_clip import cut_clip
from vml_course.usecases.estimate_track import estimate_track
from vml_course.usecases.retrack import retrack
from vml_course.usecases.track_clip import TrackRequest, check_video, track_clip

FRAMES, TURN_DEG, SHIFT_PX = 30, 3.0, (0.7, -0.4)
HIDDEN = range(10, 15)
TRACKING_PX = 0.1  # the tracker's own tests are stricter
START = np.array([[85.0, 110.0], [155.0, 110.0]])


@pytest.fixture(scope="module")
def place(speckle, rotated):
    """Where the points of START are in a frame."""
    return lambda k: np.array([speckle.moved(p, rotated(TURN_DEG * k), np.multiply(SHIFT_PX, k)) for p in START])


@pytest.fixture(scope="module")
def video(tmp_path_factory, speckle, rotated, camera_of):
    def shown(k):
        picture = speckle.picture(rotated(TURN_DEG * k), np.multiply(SHIFT_PX, k))
        return np.full_like(picture, 120.0) if k in HIDDEN else picture

    path = tmp_path_factory.mktemp("hidden") / "hidden.mp4"
    half = np.full((speckle.height_px // 2, speckle.width_px // 2), 128, np.uint8)
    write_video(path, (Picture(camera_of(shown(k), 1.0, k), half, half) for k in range(FRAMES)), 480, crf=8)
    return path


@pytest.fixture(scope="module")
def seeds():
    return (Seed("left", *START[0]), Seed("right", *START[1]))


def request(video, seeds, **changes):
    settings = {"block": 41, "give_up_frames": 2, **changes.pop("settings", {})}
    return TrackRequest(video, seeds, settings=settings, **changes)


@pytest.fixture(scope="module")
def lost(video, seeds):
    """Both points are given up while they are hidden."""
    return track_clip(request(video, seeds)).track


def seen_error(track, place, rows):
    return max(np.hypot(*(track.xy_px[k] - place(k)).T).max() for k in rows)


def others(track, column):
    """All entries but one point's."""
    arrays = [np.asarray(getattr(track, one.name)) for one in fields(track) if one.name not in {"points", "settings"}]
    return [np.delete(array, column, axis=1) if array.ndim > 1 else array for array in arrays]


def test_a_seed_in_the_middle_is_tracked_to_both_ends(video, place):
    middle = tuple(seed_at(name, xy, 7) for name, xy in zip(("left", "right"), place(7), strict=True))
    track = track_clip(request(video, middle, end=9)).track
    assert track.frame.tolist() == list(range(10))
    assert track.time_s[0] == 0.0
    assert seen_error(track, place, range(10)) < TRACKING_PX


def test_frames_keep_their_numbers_in_a_clip_of_every_second_one(video, place, tmp_path):
    clip = tmp_path / "clip.avi"
    cut_clip(video, clip, 15, 29, 2)
    late = (seed_at("left", place(21)[0], 21),)
    track = track_clip(request(clip, late)).track
    assert track.frame.tolist() == list(range(15, 30, 2))
    assert max(np.hypot(*(track.xy_px[k, 0] - place(frame)[0])) for k, frame in enumerate(track.frame)) < TRACKING_PX
    with pytest.raises(FrameRangeError, match="left: expected a frame of the clip, 15 to 29 in steps of 2, got 20"):
        check_video(request(clip, (seed_at("left", place(20)[0], 20),)))


def test_progress_counts_the_way_back_too(video, place):
    shown = []
    middle = (seed_at("left", place(6)[0], 6),)
    track_clip(request(video, middle, end=9), progress=lambda done, total: shown.append((done, total)))
    assert shown == [(k, 11) for k in range(1, 12)]  # 6 to 9, and back 6 to 0


def test_what_is_lost_before_a_mark_is_tracked_back_from_it(video, seeds, place, lost):
    assert (lost.status[10:] == Status.LOST).all()
    marked = track_clip(request(video, seeds, marks=(seed_at("left", place(22)[0] + 0.7, 22),)))
    track = marked.track
    status = track.status[:, 0]
    assert np.flatnonzero(status == Status.MANUAL).tolist() == [22]
    assert np.flatnonzero(status == Status.LOST).tolist() == list(HIDDEN)
    seen = [k for k in range(FRAMES) if status[k] == Status.AUTO]
    assert max(np.hypot(*(track.xy_px[k, 0] - place(k)[0])) for k in seen) < TRACKING_PX
    assert (track.reference == 0).all()
    assert marked.warnings[0] == "left: lost in 5 of 30 frames, first in frame 10."


def test_tracking_again_changes_one_point_from_one_frame_on(video, seeds, place, lost):
    marked = with_mark(lost, seed_at("left", place(18)[0], 18))
    track = retrack(request(video, seeds), marked, "left", 18)
    assert np.flatnonzero(track.status[:, 0] == Status.LOST).tolist() == list(range(10, 18))
    assert track.status[18, 0] == Status.MANUAL
    assert max(np.hypot(*(track.xy_px[k, 0] - place(k)[0])) for k in range(19, FRAMES)) < TRACKING_PX
    assert np.array_equal(track.xy_px[:19], marked.xy_px[:19], equal_nan=True)
    for before, after in zip(others(marked, 0), others(track, 0), strict=True):
        assert np.array_equal(before, after, equal_nan=True)


def test_tracking_back_ends_at_what_is_known(video, seeds, place, lost):
    marked = with_mark(lost, seed_at("right", place(20)[1], 20))
    track = retrack(request(video, seeds), marked, "right", 20, direction="backward", until=Until.FOUND)
    assert np.flatnonzero(track.status[:20, 1] == Status.LOST).tolist() == list(HIDDEN)
    assert np.array_equal(track.xy_px[:10], lost.xy_px[:10])
    assert (track.status[21:, 1] == Status.LOST).all()


def test_places_by_hand_are_never_overwritten(video, seeds, place, lost):
    track = lost
    for frame in (12, 17, 25):
        track = with_mark(track, seed_at("left", place(frame)[0] + 2.0, frame))
    again = retrack(request(video, seeds), track, "left", 12)
    assert np.flatnonzero(again.status[:, 0] == Status.MANUAL).tolist() == [12, 17, 25]
    assert np.array_equal(again.xy_px[[12, 17, 25], 0], track.xy_px[[12, 17, 25], 0])
    stopped = retrack(request(video, seeds), track, "left", 17, until=Until.GOOD)
    assert np.flatnonzero(stopped.status[:, 0] == Status.AUTO).tolist() == [*range(10), *range(18, 25)]


def test_virtual_points_follow_what_was_tracked_again(video, seeds, place, lost):
    knee = VirtualPoint("knee", ("left", "right"), 120.0, 60.0)
    asked = request(video, seeds, virtuals=(knee,))
    track = lost
    for number, name in enumerate(("left", "right")):
        track = with_mark(track, seed_at(name, place(20)[number], 20))
        track = retrack(request(video, seeds) if name == "left" else asked, track, name, 20)
    assert track.points == ("left", "right", "knee")
    assert (track.status[20:, 2] == Status.VIRTUAL).all()
    assert (track.status[10:20, 2] == Status.LOST).all()
    apart = np.hypot(*(track.xy_px[20:, 2] - track.xy_px[20:, 0]).T)
    assert np.ptp(apart[1:]) < 2 * TRACKING_PX


def test_the_seed_stays_when_one_tracks_back_over_it(video, place):
    middle = (seed_at("left", place(5)[0], 5),)
    track = track_clip(request(video, middle, end=9)).track
    again = retrack(request(video, middle, end=9), track, "left", 8, direction="backward")
    assert np.array_equal(again.xy_px[5], track.xy_px[5])
    assert seen_error(again, lambda k: place(k)[:1], range(10)) < TRACKING_PX


def test_tracking_again_in_vain_is_refused(video, seeds, lost):
    with pytest.raises(InputError, match=r"left in frame 20: expected a place to track from, got a lost point\. Mark"):
        retrack(request(video, seeds), lost, "left", 20)
    with pytest.raises(UnknownNameError, match="point: expected one of left, right, got 'nose'"):
        retrack(request(video, seeds), lost, "nose", 20)
    with pytest.raises(FrameRangeError, match="frame: expected a frame of the track, 0 to 29, got 30"):
        retrack(request(video, seeds), lost, "left", 30)


def test_a_check_tries_the_point_on_and_back_where_it_is_placed(video, place):
    checks = check_points(request(video, (Seed("left", *START[0]), seed_at("right", place(29)[1], 29))))
    assert all(one.returns_px < 2 * TRACKING_PX for one in checks)
    assert all("Tracked 5 frames on and back it returns to 0.0" in one.text for one in checks)


def test_a_check_says_when_the_trial_is_lost(video, place):
    (check,) = check_points(request(video, (seed_at("left", place(7)[0], 7),)))
    assert np.isnan(check.returns_px)
    assert check.text.endswith("Tracked 5 frames on and back it is lost.")


def test_an_estimate_counts_both_ways(video, place):
    middle = (seed_at("left", place(20)[0], 20), Seed("right", *START[1]))
    assert estimate_track(request(video, middle)).frames == 30 + 21


def test_gaps_are_filled_when_asked_and_say_so(video, seeds, place):
    asked = request(video, seeds, fill="quadratic", settings={"give_up_frames": 15})
    track = track_clip(asked).track
    assert np.flatnonzero(track.status[:, 0] == Status.INTERP).tolist() == list(HIDDEN)
    assert seen_error(track, place, range(FRAMES)) < TRACKING_PX
    with pytest.raises(UnknownNameError, match="fill: expected one of linear, quadratic, got 'spline'"):
        track_clip(request(video, seeds, fill="spline"))

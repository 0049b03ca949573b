"""A clip goes in, a track comes out; what the decoder says reaches the user."""

import threading

import numpy as np
import pytest

from vml_course.errors import FrameRangeError, InputError, SeedError, VideoError
from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.prefetch import prefetched
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker

SEEDS = [Seed("a", 118.0, 110.0)]


@pytest.fixture
def tracker():
    return make_tracker("dic", block=31)


@pytest.fixture(scope="module")
def clip(clip_of):
    frames = clip_of([(np.eye(2), (0.5 * k, 0.0)) for k in range(5)])
    return [Frame(100 + 2 * f.index, 7.0 + 0.03 * f.index**2, f.luma) for f in frames]


def test_time_counts_from_the_first_picture_by_the_true_rate(tracker, clip):
    track = run(tracker, clip, SEEDS, fps=480.0)
    assert track.frame.tolist() == [100, 102, 104, 106, 108]
    assert np.allclose(track.time_s, np.arange(0, 10, 2) / 480)


def test_without_a_rate_each_picture_keeps_its_own_time(tracker, clip):
    assert np.allclose(run(tracker, clip, SEEDS).time_s, 0.03 * np.arange(5) ** 2)


def test_the_track_says_how_it_was_made(tracker, clip):
    track = run(tracker, clip, SEEDS)
    assert track.points == ("a",)
    assert track.settings["method"] == "dic"
    assert track.settings["block"] == 31


def test_every_picture_is_shown_to_the_caller(tracker, clip):
    shown = []
    run(tracker, iter(clip), SEEDS, on_frame=lambda frame, sighting: shown.append((frame.index, sighting.xy_px[0, 0])))
    assert [index for index, _ in shown] == [100, 102, 104, 106, 108]
    assert np.allclose([x for _, x in shown], 118 + 0.5 * np.arange(5), atol=0.05)


def test_an_error_of_the_decoder_reaches_the_caller(tracker, clip):
    def broken():
        yield from clip[:2]
        raise VideoError("clip.mp4", "a whole video", "a broken one at frame 104")

    with pytest.raises(VideoError, match="broken one at frame 104"):
        run(tracker, broken(), SEEDS)


def test_stopping_early_closes_the_decoder_and_ends_its_thread(tracker, clip):
    closed = threading.Event()

    def endless():
        try:
            while True:
                yield from clip
        finally:
            closed.set()

    def stop(frame, sighting):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(tracker, endless(), SEEDS, on_frame=stop)
    assert closed.is_set()
    assert not [t for t in threading.enumerate() if t.name == "prefetch"]


def test_only_a_few_pictures_are_held_at_a_time():
    taken = []

    def count():
        for k in range(100):
            taken.append(k)
            yield k

    with prefetched(count(), depth=3) as items:
        for k in items:
            assert len(taken) <= k + 1 + 3 + 1  # this one, the queue, the one being put


def test_a_bad_seed_is_named_as_the_user_named_it(tracker, clip):
    with pytest.raises(SeedError, match=r"^edge: expected a point from \(15, 15\)"):
        run(tracker, clip, [*SEEDS, Seed("edge", 2.0, 2.0)])


def test_no_pictures_no_seeds_and_no_rate_are_told(tracker, clip):
    with pytest.raises(FrameRangeError):
        run(tracker, [], SEEDS)
    with pytest.raises(InputError, match="seeds: expected at least one point"):
        run(tracker, clip, [])
    with pytest.raises(InputError, match="'a' twice"):
        run(tracker, clip, SEEDS * 2)
    with pytest.raises(InputError, match="fps"):
        run(tracker, clip, SEEDS, fps=0.0)

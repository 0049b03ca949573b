"""The open share of the shutter, found in the pictures themselves."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.errors import SeedError
from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.shutter import TRIED, Sample, conclude, estimate_shutter, peak
from vml_course.track.trackers.dic import Dic

WITHIN = 0.1
POINT = np.array([80.0, 108.0])
INSTANTS = 25  # less than a pixel apart


def moved_at(t):
    """Still until 1.5 pictures, then 16 px a picture to the right and 4 px down."""
    return np.array([16.0, 4.0]) * max(t - 1.5, 0.0)


@pytest.fixture(scope="module")
def clip(speckle, camera_of):
    base = speckle.picture().astype(np.float32)

    def shown(shift):
        matrix = np.array([[1.0, 0.0, shift[0]], [0.0, 1.0, shift[1]]])
        return cv2.warpAffine(base, matrix, base.shape[::-1], flags=cv2.INTER_LANCZOS4, borderMode=cv2.BORDER_REFLECT)

    def make(shutter, count=8, way=moved_at):
        frames = []
        for k in range(count):
            times = k + shutter * ((np.arange(INSTANTS) + 0.5) / INSTANTS - 0.5)
            frames.append(Frame(k, k / 240, camera_of(np.mean([shown(way(t)) for t in times], axis=0), 1.5, k)))
        return frames

    return make


def estimate(frames, point=POINT, **settings):
    return estimate_shutter(Dic(block=41, **settings), lambda: iter(frames), [Seed("foot", *point)])


@pytest.mark.parametrize("shutter", [0.0, 0.3, 0.5, 0.9])
def test_the_open_share_is_found_to_a_tenth(clip, shutter):
    found = estimate(clip(shutter))
    assert found.is_told
    assert abs(found.shutter - shutter) < min(WITHIN, 3 * found.sigma + 0.02)
    assert found.samples >= 4


def test_it_is_the_same_backwards(clip):
    frames = clip(0.5, way=lambda t: moved_at(7.0 - t))
    assert abs(estimate(frames[::-1]).shutter - 0.5) < WITHIN


def test_a_clip_in_which_nothing_is_fast_does_not_tell(clip):
    found = estimate(clip(0.9, way=lambda t: np.array([2.0, 1.0]) * max(t - 1.5, 0.0)))
    assert not found.is_told
    assert found.shutter == 0.0
    assert np.isnan(found.sigma)


def test_a_point_that_is_fast_from_the_start_does_not_tell(clip):
    assert not estimate(clip(0.9, way=lambda t: np.array([12.0, 3.0]) * t)).is_told


def test_a_point_that_cannot_be_followed_is_refused(clip):
    with pytest.raises(SeedError, match="foot: expected a point from"):
        estimate(clip(0.5, 2), (3.0, 3.0))


@given(st.floats(0.0, 1.0), st.floats(0.1, 5.0))
def test_the_peak_of_a_parabola_is_found_between_the_tried_shares(where, steepness):
    assert peak(1.0 - steepness * (TRIED - where) ** 2) == pytest.approx(where, abs=0.051)
    if TRIED[1] < where < TRIED[-2]:
        assert peak(1.0 - steepness * (TRIED - where) ** 2) == pytest.approx(where, abs=1e-6)


def test_what_is_all_alike_or_uncertain_has_no_peak():
    assert peak(np.full(len(TRIED), 0.99)) is None
    assert peak(np.full(len(TRIED), np.nan)) is None
    beside = 1.0 - (TRIED - 0.5) ** 2
    beside[6] = np.nan
    assert peak(beside) is None


def test_few_or_scattered_answers_tell_nothing():
    assert not conclude([Sample(0.5, 10.0)] * 3).is_told
    assert not conclude([Sample(s, 10.0) for s in (0.0, 0.3, 0.7, 1.0)]).is_told
    assert conclude([Sample(s, 10.0) for s in (0.48, 0.5, 0.5, 0.52, 1.0)]).shutter == 0.5

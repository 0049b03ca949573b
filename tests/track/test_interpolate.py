"""Gaps are filled by lines and parabolas, say so, and nothing else changes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.errors import UnknownNameError
from vml_course.model.track import Status, Track
from vml_course.track.interpolate import interpolated

EXACT_PX = 1e-8
N = 20
TIME_S = np.cumsum(np.linspace(0.008, 0.012, N))  # not even


def track_of(way, lost, sigma=0.02):
    xy = np.stack([way, -2.0 * way], axis=1)[:, None]
    xy = np.concatenate([xy, xy + 5.0], axis=1)
    status = np.zeros((N, 2), np.int8)
    status[list(lost), 0], xy[list(lost), 0] = Status.LOST, np.nan
    one = np.where(status == Status.LOST, np.nan, 1.0)
    return Track(
        ("a", "b"), np.arange(N), TIME_S, xy, sigma * one, one, np.ones((N, 2)), status, np.zeros((N, 2, 4))
    )  # fmt: skip


numbers = st.floats(-1e3, 1e3)


@given(numbers, numbers, numbers, st.sets(st.integers(1, N - 2), max_size=12))
def test_a_parabola_is_filled_by_a_parabola(a, b, c, lost):
    way = a + b * TIME_S + c * TIME_S**2
    filled = interpolated(track_of(way, lost), "a", "quadratic")
    assert np.allclose(filled.xy_px[:, 0, 0], way, atol=EXACT_PX)
    assert set(np.flatnonzero(filled.status[:, 0] == Status.INTERP)) == lost


@given(numbers, numbers, st.sets(st.integers(1, N - 2)), st.sampled_from(["linear", "quadratic"]))
def test_a_line_is_filled_by_a_line(a, b, lost, way):
    line = a + b * TIME_S
    assert np.allclose(interpolated(track_of(line, lost), "a", way).xy_px[:, 0, 0], line, atol=EXACT_PX)


def test_a_line_goes_through_both_neighbours():
    way = np.where(np.arange(N) < 10, 0.0, 8.0)
    filled = interpolated(track_of(way, {8, 9, 10}), "a")
    share = (TIME_S[8:11] - TIME_S[7]) / (TIME_S[11] - TIME_S[7])
    assert np.allclose(filled.xy_px[8:11, 0, 0], 8.0 * share)


def test_ends_stay_lost_and_long_gaps_when_asked():
    track = track_of(TIME_S, {0, 1, 5, 10, 11, 12, 19})
    filled = interpolated(track, "a", longest=2)
    assert np.flatnonzero(filled.status[:, 0] == Status.INTERP).tolist() == [5]
    assert np.flatnonzero(interpolated(track, "a").status[:, 0] == Status.LOST).tolist() == [0, 1, 19]


@pytest.mark.parametrize("way", ["linear", "quadratic"])
def test_sigma_is_the_scatter_that_the_known_places_cause(way):
    rng = np.random.default_rng(2)
    lost = {8, 9, 10}
    off = []
    for _ in range(2000):
        noisy = interpolated(track_of(rng.normal(0.0, 0.02, N), lost), "a", way)
        off.append(noisy.xy_px[8:11, 0, 0])
    assert np.allclose(np.std(off, axis=0), noisy.sigma_px[8:11, 0], rtol=0.1)


def test_other_entries_and_points_are_left_alone():
    track = track_of(TIME_S**2, {8, 9})
    filled = interpolated(track, "a", "quadratic")
    rest = np.delete(np.arange(N), [8, 9])
    assert np.array_equal(filled.xy_px[rest], track.xy_px[rest])
    assert np.array_equal(filled.xy_px[:, 1], track.xy_px[:, 1])
    assert np.isnan(filled.zncc[8:10, 0]).all()


def test_an_unknown_way_is_refused():
    with pytest.raises(UnknownNameError, match="interpolation: expected one of linear, quadratic, got 'spline'"):
        interpolated(track_of(TIME_S, {8}), "a", "spline")

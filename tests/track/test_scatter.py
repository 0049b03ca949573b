"""Sigma grows to what the scatter in time shows, stretch by stretch, and never shrinks."""

import numpy as np
import pytest

from vml_course.model.track import Track
from vml_course.track.scatter import LEAST_SIGMA_PX, scatter_px, stretches, vouched


def way(n, sigma, seed=0, hit=None):
    """A turning point with scatter; after `hit` it goes another way with ten times the scatter."""
    t = np.arange(n)
    clean = np.column_stack([200 * np.cos(0.05 * t), 200 * np.sin(0.05 * t)])
    size = np.full(n, sigma)
    if hit is not None:
        clean[hit:] = clean[hit] + np.column_stack([20.0 * (t[hit:] - hit), 5.0 * (t[hit:] - hit)])
        size[hit:] *= 10
    return clean + size[:, None] * np.random.default_rng(seed).normal(size=(n, 2))


def track_of(xy, sigma):
    n = len(xy)
    flat = np.zeros((n, 1))
    return Track(
        ("a",),
        np.arange(n),
        np.arange(n) / 480,
        xy[:, None],
        np.full((n, 1), sigma),
        flat + 1,
        flat,
        flat,
        np.zeros((n, 1, 4)),
    )


@pytest.mark.parametrize("sigma", [0.003, 0.02, 0.2])
def test_the_scatter_of_a_turning_point_is_found_without_its_motion(sigma):
    found = [np.median(scatter_px(way(60, sigma, seed))) for seed in range(20)]
    assert np.mean(found) == pytest.approx(sigma, rel=0.15)


def test_each_side_of_a_hit_has_its_own_scatter():
    found = scatter_px(way(60, 0.005, hit=31))
    assert found[5] == pytest.approx(0.005, rel=0.5)
    assert found[55] == pytest.approx(0.05, rel=0.5)
    four = np.stack([np.convolve(c, [1, -4, 6, -4, 1], mode="valid") for c in way(60, 0.005, hit=31).T], axis=1)
    (cut,) = {end for _, end in stretches(four / np.sqrt(70), 0, 60)} - {60}
    assert abs(cut - 31) <= 1


def test_even_scatter_is_one_stretch():
    one = [len(stretches(np.random.default_rng(s).normal(0, 0.02, (56, 2)), 0, 60)) for s in range(20)]
    assert np.mean(np.array(one) == 1) > 0.9


def test_sigma_grows_to_the_scatter_and_never_shrinks():
    small = vouched(track_of(way(60, 0.02), 0.005)).sigma_px
    assert np.median(small) == pytest.approx(0.02, rel=0.3)
    assert np.array_equal(vouched(track_of(way(60, 0.001), 0.05)).sigma_px, np.full((60, 1), 0.05))


def test_gaps_stay_gaps_and_a_copied_block_is_not_exact():
    xy = way(40, 0.0)
    xy[10:14] = np.nan
    sigma = np.full((40, 1), 1e-6)
    sigma[10:14] = np.nan
    track = track_of(xy, 1e-6)
    object.__setattr__(track, "sigma_px", sigma)
    found = vouched(track).sigma_px
    assert np.isnan(found[10:14]).all()
    assert (found[:10] >= LEAST_SIGMA_PX).all()


def test_a_clip_of_few_pictures_keeps_its_sigmas():
    assert np.isnan(scatter_px(way(4, 0.1))).all()
    assert np.array_equal(vouched(track_of(way(4, 0.1), 0.01)).sigma_px, np.full((4, 1), 0.01))


def test_shifts_that_last_for_several_pictures_are_seen(rng_walk):
    """A codec that copies most of a block shifts it for a while; one picture to the next shows little of that."""
    found = scatter_px(rng_walk)
    assert np.nanmedian(found) > 1.5 * np.median(np.abs(np.diff(rng_walk, n=4, axis=0))) / 0.6745 / np.sqrt(70)


def test_a_fast_turn_is_not_taken_for_scatter():
    """Pictures far apart see the curve itself: their differences do not alternate, and do not count."""
    angle = 0.1 * np.arange(60)
    rng = np.random.default_rng(5)
    turning = 250 * np.column_stack([np.cos(angle), np.sin(angle)]) + rng.normal(0, 0.02, (60, 2))
    assert np.nanmax(scatter_px(turning)) < 0.03


@pytest.fixture
def rng_walk():
    """Places with errors of 0.03 px that are alike from picture to picture (AR(1), 0.8), on a parabola."""
    rng, error = np.random.default_rng(3), np.zeros((120, 2))
    for k in range(1, 120):
        error[k] = 0.8 * error[k - 1] + 0.6 * rng.normal(0, 0.03, 2)
    t = np.arange(120)[:, None]
    return error + np.hstack([1.3 * t, 0.004 * t**2])

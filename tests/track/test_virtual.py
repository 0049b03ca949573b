"""A point that others carry goes where the rigid body goes, and says how sure it is."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from vml_course.errors import FrameRangeError, InputError, UnknownNameError
from vml_course.model.track import Status, Track
from vml_course.track.interpolate import interpolated
from vml_course.track.virtual import VirtualPoint, stretch, with_virtual, without

EXACT_PX = 1e-9
AT = np.array([40.0, -25.0])
CARRIERS = np.array([[0.0, 0.0], [60.0, 10.0], [15.0, 50.0]])
angles = st.floats(-3.1, 3.1)
shifts = st.tuples(st.floats(-500, 500), st.floats(-500, 500))


def turned(points, angle, shift):
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points) @ np.array([[c, -s], [s, c]]).T + shift


def track_of(places, sigma=0.02, gradient=0.0, block=60):
    """A track of points p, q, r ... at places, shape (n, p, 2)."""
    n, p = places.shape[:2]
    lost = np.isnan(places[..., 0])
    sigmas = np.where(lost, np.nan, np.broadcast_to(sigma, (n, p)))
    return Track(
        tuple("pqrstu"[:p]), 10 + np.arange(n), np.arange(n) / 100, places, sigmas, np.where(lost, np.nan, 1.0),
        np.ones((n, p)), np.where(lost, Status.LOST, Status.AUTO), np.broadcast_to(gradient, (n, p, 4)),
        {"block": block},
    )  # fmt: skip


@given(angles, shifts, angles, shifts)
def test_it_goes_where_the_body_goes(first, at_first, later, at_later):
    poses = [(first, at_first), (later, at_later)]
    track = track_of(np.array([turned(CARRIERS, *pose) for pose in poses]))
    x, y = turned(AT, *poses[0])
    carried = with_virtual(track, VirtualPoint("knee", ("p", "q", "r"), x, y))
    assert carried.points == ("p", "q", "r", "knee")
    assert np.allclose(carried.xy_px[:, 3], [turned(AT, *pose) for pose in poses], atol=1e-8)
    assert (carried.status[:, 3] == Status.VIRTUAL).all()
    assert np.isnan(carried.zncc[:, 3]).all()


@given(st.lists(st.tuples(angles, shifts), min_size=3, max_size=3), st.integers(0, 2))
def test_the_frame_in_which_it_is_seen_does_not_matter(poses, home):
    track = track_of(np.array([turned(CARRIERS, *pose) for pose in poses]))
    x, y = turned(AT, *poses[home])
    carried = with_virtual(track, VirtualPoint("knee", ("p", "r"), x, y, 10 + home))
    assert np.allclose(carried.xy_px[:, 3], [turned(AT, *pose) for pose in poses], atol=1e-8)


@pytest.mark.parametrize("at", [AT, [200.0, 90.0], [25.0, 20.0]])
def test_sigma_is_the_scatter_that_the_carriers_scatter_causes(at):
    rng = np.random.default_rng(4)
    sigma = np.array([0.02, 0.05, 0.03])
    n = 20_000
    places = np.repeat(turned(CARRIERS, 0.7, (100.0, 50.0))[None], n, axis=0)
    places[0] = CARRIERS
    places[1:] += rng.normal(0.0, 1.0, (n - 1, 3, 2)) * sigma[:, None]
    carried = with_virtual(track_of(places, sigma), VirtualPoint("knee", ("p", "q", "r"), *at))
    off = carried.xy_px[1:, 3] - turned(at, 0.7, (100.0, 50.0))
    assert np.sqrt((off**2).mean()) == pytest.approx(carried.sigma_px[1, 3], rel=0.03)


def test_where_too_few_carriers_are_seen_it_is_lost():
    places = np.repeat(CARRIERS[None], 4, axis=0)
    places[1, 0] = places[2, :2] = np.nan
    carried = with_virtual(track_of(places), VirtualPoint("knee", ("p", "q", "r"), *AT))
    assert carried.status[:, 3].tolist() == [Status.VIRTUAL, Status.VIRTUAL, Status.LOST, Status.VIRTUAL]
    assert np.isnan(carried.xy_px[2, 3]).all()
    assert np.isnan(carried.sigma_px[2, 3])
    assert np.allclose(carried.xy_px[1, 3], AT, atol=EXACT_PX)


def test_a_place_by_hand_counts_little():
    places = np.repeat(CARRIERS[None], 2, axis=0)
    places[1, 2] += 3.0
    track = track_of(places, np.array([[0.02, 0.02, 0.02], [0.02, 0.02, 1.0]]))
    carried = with_virtual(track, VirtualPoint("knee", ("p", "q", "r"), *AT))
    assert np.hypot(*(carried.xy_px[1, 3] - AT)) < 0.05


@given(angles, shifts)
def test_one_block_carries_it_by_its_own_turn(angle, shift):
    c, s = np.cos(angle), np.sin(angle)
    gradient = np.array([[[0.0, 0.0, 0.0, 0.0]], [[c - 1.0, -s, s, c - 1.0]]])
    assume(gradient.any())
    track = track_of(np.array([CARRIERS[:1], turned(CARRIERS[:1], angle, shift)]), gradient=gradient)
    carried = with_virtual(track, VirtualPoint("knee", ("p",), *AT))
    assert np.allclose(carried.xy_px[:, 1], [AT, turned(AT, angle, shift)], atol=1e-8)


def test_by_one_block_sigma_grows_with_the_distance():
    gradient = np.array([[[0.0] * 4], [[0.0, -0.1, 0.1, 0.0]]])
    track = track_of(np.repeat(CARRIERS[None, :1], 2, axis=0), gradient=gradient)
    sigmas = [
        with_virtual(track, VirtualPoint("knee", ("p",), 60.0 * far, 0.0)).sigma_px[1, 1] / 0.02 for far in (0, 1, 2)
    ]
    assert np.allclose(sigmas, np.sqrt([1.0, 4.0, 13.0]))


def test_a_block_that_only_shifts_carries_nothing():
    places = np.repeat(CARRIERS[None, :1], 3, axis=0)
    for gradient in (0.0, np.nan):
        with pytest.raises(InputError, match="p: expected a block that shows how it turns, got one that only shifts"):
            with_virtual(track_of(places, gradient=gradient), VirtualPoint("knee", ("p",), *AT))


def test_beyond_a_new_reference_one_block_tells_nothing():
    gradient = np.array([[[0.0] * 4], [[0.0, -0.1, 0.1, 0.0]], [[0.0, -0.1, 0.1, 0.0]]])
    track = replace(track_of(np.repeat(CARRIERS[None, :1], 3, axis=0), gradient=gradient), reference=[[10], [10], [12]])
    carried = with_virtual(track, VirtualPoint("knee", ("p",), *AT))
    assert carried.status[:, 1].tolist() == [Status.VIRTUAL, Status.VIRTUAL, Status.LOST]


def test_placed_again_it_takes_its_old_place():
    track = track_of(np.repeat(CARRIERS[None], 2, axis=0))
    once = with_virtual(track, VirtualPoint("knee", ("p", "q"), 1.0, 2.0))
    again = with_virtual(once, VirtualPoint("knee", ("p", "q"), *AT))
    assert again.points == once.points
    assert np.allclose(again.xy_px[:, 3], AT)
    assert np.array_equal(without(again, "knee").xy_px, track.xy_px)


def test_what_was_filled_in_carries_nothing():
    places = np.repeat(CARRIERS[None], 4, axis=0)
    places[1, 0] = np.nan
    track = with_virtual(track_of(places), VirtualPoint("knee", ("p", "q"), *AT))
    filled = interpolated(interpolated(track, "p"), "knee")
    assert (filled.status[1, [0, 3]] == Status.INTERP).all()
    assert with_virtual(filled, VirtualPoint("knee", ("p", "q"), *AT)).status[1, 3] == Status.LOST


def test_points_that_do_not_stay_apart_show():
    places = np.repeat(CARRIERS[None], 3, axis=0)
    assert stretch(track_of(places), VirtualPoint("knee", ("p", "q", "r"), *AT)) < 1e-12
    places[1, 1] *= 1.1
    assert stretch(track_of(places), VirtualPoint("knee", ("p", "q"), *AT)) == pytest.approx(0.1)


def test_what_makes_no_sense_is_refused():
    track = track_of(np.repeat(CARRIERS[None], 2, axis=0))
    with pytest.raises(UnknownNameError, match="virtual knee: expected one of p, q, r, got 'x'"):
        with_virtual(track, VirtualPoint("knee", ("p", "x"), *AT))
    with pytest.raises(InputError, match=r"virtual knee: expected different points that carry it, got p\+p"):
        with_virtual(track, VirtualPoint("knee", ("p", "p"), *AT))
    with pytest.raises(InputError, match="virtual q: expected a name that no tracked point has, got 'q'"):
        with_virtual(track, VirtualPoint("q", ("p", "r"), *AT))
    with pytest.raises(FrameRangeError, match="expected a frame of the track, 10 to 11, got 12"):
        with_virtual(track, VirtualPoint("knee", ("p", "q"), *AT, 12))
    with pytest.raises(InputError, match="virtual knee: expected a place in px"):
        with_virtual(track, VirtualPoint("knee", ("p", "q"), np.nan, 1.0))
    together = track_of(np.repeat(CARRIERS[None, [0, 0]], 2, axis=0))
    with pytest.raises(InputError, match=r"virtual knee: expected to see p, q in frame 10, apart .*, got too few"):
        with_virtual(together, VirtualPoint("knee", ("p", "q"), *AT))

"""A camera's way from metres to pixels and back, whatever its lens and however it stands."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.model.camera import Camera
from vml_course.model.lens import STRAIGHT_FROM, bent, straightened
from vml_course.model.quantity import quantities_of

SAME_PLACE_PX = 1e-6
part = st.floats(0.0, 1.0)


def within(name):
    declared = quantities_of(Camera)[name]
    return st.floats(declared.low, declared.high)


@st.composite
def cameras(draw):
    names = ("roll_deg", "pan_deg", "tilt_deg", "distance_m", "distortion")
    return Camera(**{name: draw(within(name)) for name in names})


@given(cameras(), part, part)
def test_every_pixel_looks_at_the_point_that_is_seen_there(camera, across, down):
    seen = np.array([across, down]) * (np.array(camera.size_px) - 1)
    assert np.abs(camera.to_px(camera.to_m(seen)) - seen).max() < SAME_PLACE_PX


@given(st.floats(-0.12, 0.2), st.floats(0.0, 4.0), st.floats(0.0, 6.3))
def test_a_lens_shows_every_point_in_one_place_also_outside_the_picture(k, radius, angle):
    point = radius * np.array([np.cos(angle), np.sin(angle)])
    assert np.abs(straightened(bent(point, k), k) - point).max() < SAME_PLACE_PX / 1000


@pytest.mark.parametrize("k", [-0.12, 0.1, 0.2])
def test_distortion_is_what_the_corner_is_off_by(k):
    camera = Camera(distortion=k)
    middle = (np.array(camera.size_px) - 1) / 2
    corner = camera.seen_px(np.array([0.0, 0.0]))
    assert (middle - corner) / middle == pytest.approx([1 + k, 1 + k])
    assert bent(np.array([STRAIGHT_FROM, 0.0]), k)[0] > 1.0  # it goes on straight only outside the picture


def test_a_rolled_picture_turns_counter_clockwise_about_its_middle():
    camera = Camera(roll_deg=90 / 3)
    middle = (np.array(camera.size_px) - 1) / 2
    turned = camera.seen_px(middle + np.array([100.0, 0.0])) - middle
    assert turned == pytest.approx([100 * np.cos(np.pi / 6), -50.0])


def test_what_leans_away_is_smaller_and_the_middle_keeps_its_scale():
    camera = Camera(pan_deg=10, distance_m=3)
    middle = (np.array(camera.size_px) - 1) / 2
    left, right = (camera.seen_px(middle + np.array([side, 0.0]))[0] - middle[0] for side in (-400.0, 400.0))
    assert abs(left) > abs(right)
    up = camera.seen_px(middle + np.array([[0.0, -1.0], [0.0, 1.0]]))[:, 1]
    assert np.diff(up)[0] == pytest.approx(2.0, abs=1e-4)
    # A point 400 px to the right on a plane that leans away by 10 deg, seen from 3 m: by similar triangles.
    depth = 1 + 400 / (camera.px_per_m * 3) * np.sin(np.radians(10))
    assert right == pytest.approx(400 * np.cos(np.radians(10)) / depth)


def test_a_tilted_plane_leans_away_at_its_top():
    camera = Camera(tilt_deg=10)
    middle = (np.array(camera.size_px) - 1) / 2
    high, low = (camera.seen_px(middle + np.array([100.0, side]))[0] - middle[0] for side in (-300.0, 300.0))
    assert high < 100 < low

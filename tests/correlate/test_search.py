"""A block is found again from far away, turned or not."""

import numpy as np
import pytest

from vml_course.correlate.search import search, upright_half
from vml_course.correlate.template import cut_patch

ANGLES = np.radians([0, -10, 10, -20, 20, -30, 30])


@pytest.mark.parametrize(("angle_deg", "dx", "dy"), [(0, 31, 0), (20, -30, 40), (-27, 12, -25), (4, 0, 0)])
def test_the_best_place_is_near_the_truth(speckle, rotated, camera_of, angle_deg, dx, dy):
    patch = cut_patch(camera_of(speckle.picture()), (120.0, 110.0), 60)
    image = camera_of(speckle.picture(rotated(angle_deg), (dx, dy)))
    start = np.array([120.0, 110.0, 1.0, 0.0, 0.0, 1.0])
    best = search(image, patch.values.astype(np.float32), (patch.left, patch.top), start, 45.0, ANGLES)[0]
    assert np.abs(best.pose[:2] - [120 + dx, 110 + dy]).max() < 3
    assert abs(np.degrees(np.arctan2(best.pose[4], best.pose[2])) - angle_deg) <= 5.1


def test_a_region_outside_the_picture_has_no_candidates(speckle, camera_of):
    patch = cut_patch(camera_of(speckle.picture()), (120.0, 110.0), 60)
    start = np.array([-300.0, 110.0, 1.0, 0.0, 0.0, 1.0])
    values = patch.values.astype(np.float32)
    assert search(camera_of(speckle.picture()), values, (patch.left, patch.top), start, 40.0, ANGLES) == []


def test_the_upright_square_fits_inside_the_turned_block(rotated):
    for angle in range(0, 91, 5):
        half = upright_half(np.concatenate([[0, 0], rotated(angle).ravel()]), (-29.5, -29.5), (60, 60))
        corners = np.array([[half, half], [half, -half]]) @ rotated(angle)
        assert np.abs(corners).max() <= 29.5
        assert half >= 20

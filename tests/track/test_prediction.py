"""Where the next picture will show a point."""

import numpy as np
import pytest

from vml_course.track.prediction import predict


def pose(x, y, linear):
    return np.concatenate([[x, y], np.asarray(linear).ravel()])


def test_a_point_without_a_past_is_expected_where_it_is():
    only = pose(3.0, 4.0, np.eye(2))
    assert np.array_equal(predict((only,), 0), only)


def test_velocity_and_turning_go_on(rotated):
    past = (pose(12.0, 5.0, rotated(8.0)), pose(10.0, 6.0, rotated(5.0)))
    assert np.allclose(predict(past, 0), pose(14.0, 4.0, rotated(11.0)))
    assert np.allclose(predict(past, 0, ahead=3), pose(18.0, 2.0, rotated(17.0)))


@pytest.mark.parametrize(("steady", "expected_x"), [(0, 20.0), (1, 20.0), (2, 22.0)])
def test_acceleration_is_believed_only_when_motion_is_steady(steady, expected_x):
    past = tuple(pose(x, 0.0, np.eye(2)) for x in (14.0, 8.0, 4.0))
    assert predict(past, steady)[0] == pytest.approx(expected_x)

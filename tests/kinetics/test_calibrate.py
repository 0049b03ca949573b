import numpy as np
import pytest

from vml_course.errors import InputError
from vml_course.kinetics.calibrate import calibrate, relative_scale_sd


def test_a_ball_of_known_diameter_gives_the_scale():
    calibration = calibrate((100, 400, 100, 290), 0.22, origin_px=(50, 500), length_text="22 cm")
    assert calibration.px_per_m == pytest.approx(500.0)
    np.testing.assert_allclose(calibration.to_m(np.array([100.0, 400.0])), [0.1, 0.2])
    assert calibration.length_text == "22 cm"


def test_without_an_origin_the_first_end_is_the_origin():
    assert calibrate((100, 400, 210, 400), 0.22).origin_px == (100.0, 400.0)


def test_ends_closer_than_20_px_are_refused_with_advice():
    with pytest.raises(InputError, match=r"scale: expected ends at least 20 px apart, got 5\.0 px\. Zoom in"):
        calibrate((0, 0, 3, 4), 0.22)


@pytest.mark.parametrize("length", [0.0, -1.0, float("nan"), float("inf")])
def test_a_length_that_is_not_positive_is_refused(length):
    with pytest.raises(InputError):
        calibrate((0, 0, 100, 0), length)


def test_the_scale_is_as_sure_as_the_clicks():
    rng = np.random.default_rng(1)
    clicks = np.array([0, 0, 96.4, 0]) + rng.normal(size=(4000, 4))
    lengths = np.hypot(clicks[:, 2] - clicks[:, 0], clicks[:, 3] - clicks[:, 1])
    assert np.std(lengths) / 96.4 == pytest.approx(relative_scale_sd((0, 0, 96.4, 0)), rel=0.05)

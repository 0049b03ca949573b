import numpy as np
import pytest

from vml_course.errors import UnknownNameError
from vml_course.kinetics.differentiate import differentiate
from vml_course.model.motion import Motion


def _motion(time, xy, sigma=np.nan):
    xy = np.asarray(xy)[:, None, :]
    return Motion(("ball",), np.arange(len(time)), time, xy, np.full(xy.shape[:2], sigma))


def _bounce(n=60, fps=480.0, impact=0.0625):
    time = np.arange(n) / fps
    s = time - impact
    x = np.where(s <= 0, 2.0 * s, 24.0 * s)
    y = np.where(s <= 0, 0.0, 3.0 * s - 0.5 * 9.81 * s**2)
    return time, np.stack([x, y], axis=1)


@pytest.mark.parametrize("method", ["local-quadratic", "central"])
def test_derivatives_of_a_parabola_are_exact(method):
    time = np.sort(np.random.default_rng(2).uniform(0, 0.1, 40))
    xy = np.stack([1 + 2 * time + 3 * time**2, -4.9 * time**2], axis=1)
    found = differentiate(_motion(time, xy), method=method)
    inner = slice(1, -1)
    if method == "local-quadratic":
        np.testing.assert_allclose(found.velocity_m_s[inner, 0, 0], 2 + 6 * time[inner], rtol=1e-9)
    np.testing.assert_allclose(found.acceleration_m_s2[inner, 0], np.tile([6.0, -9.8], (38, 1)), rtol=1e-6)


def test_the_jump_of_velocity_is_kept_when_the_impact_is_told():
    time, xy = _bounce()
    found = differentiate(_motion(time, xy), contacts=[(0.0625, 0.0625)])
    np.testing.assert_allclose(found.velocity_m_s[:31, 0, 0], 2.0, rtol=1e-9)
    np.testing.assert_allclose(found.velocity_m_s[31:, 0, 0], 24.0, rtol=1e-9)
    np.testing.assert_allclose(found.velocity_m_s[31:, 0, 1], 3.0 - 9.81 * (time[31:] - 0.0625), rtol=1e-8, atol=1e-8)


def test_frames_inside_a_contact_have_no_velocity():
    time, xy = _bounce()
    found = differentiate(_motion(time, xy), contacts=[(time[28], time[33])])
    assert np.flatnonzero(np.isnan(found.velocity_m_s[:, 0, 0])).tolist() == [29, 30, 31, 32]


def test_gaps_stay_gaps_and_do_not_spread():
    time, xy = _bounce()
    xy[[5, 40, 41]] = np.nan
    found = differentiate(_motion(time, xy), contacts=[(0.0625, 0.0625)])
    assert np.flatnonzero(np.isnan(found.velocity_m_s[:, 0, 0])).tolist() == [5, 40, 41]
    np.testing.assert_allclose(found.velocity_m_s[42:, 0, 0], 24.0, rtol=1e-9)


@pytest.mark.parametrize("method", ["local-quadratic", "central"])
def test_standard_errors_are_those_of_repeated_noise(method):
    rng, (time, xy), sigma = np.random.default_rng(3), _bounce(), 2e-4
    runs = [
        differentiate(_motion(time, xy + rng.normal(scale=sigma, size=xy.shape), sigma), method=method)
        for _ in range(150)
    ]
    middle = slice(10, 20)
    for kind in ("velocity", "acceleration"):
        values = np.stack([getattr(run, f"{kind}_m_s" + "2" * (kind == "acceleration"))[middle, 0] for run in runs])
        told = getattr(runs[0], f"{kind}_sd_m_s" + "2" * (kind == "acceleration"))[middle, 0]
        assert values.std(axis=0).mean() == pytest.approx(told.mean(), rel=0.1)


def test_without_sigma_the_scatter_tells_the_error():
    rng, (time, xy) = np.random.default_rng(4), _bounce()
    found = differentiate(_motion(time[:30], xy[:30] + rng.normal(scale=2e-4, size=(30, 2))))
    known = differentiate(_motion(time[:30], xy[:30], 2e-4))
    assert np.median(found.velocity_sd_m_s) == pytest.approx(np.median(known.velocity_sd_m_s), rel=0.3)


def test_an_unknown_method_lists_the_known():
    with pytest.raises(UnknownNameError, match="local-quadratic, central"):
        differentiate(_motion(*_bounce()), method="spline")


def test_a_piece_of_two_frames_has_no_derivatives():
    time, xy = _bounce()
    assert np.isnan(differentiate(_motion(time[:2], xy[:2])).velocity_m_s).all()

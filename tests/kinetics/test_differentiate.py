import numpy as np
import pytest

from vml_course.errors import UnknownNameError
from vml_course.kinetics.differentiate import METHODS, differentiate, differentiate_angle
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


@pytest.mark.parametrize("method", sorted(set(METHODS) - {"rts"}))  # whose errors hold what it may have smoothed away
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
    with pytest.raises(UnknownNameError, match="local-quadratic, savitzky-golay, rts, central, tracker"):
        differentiate(_motion(*_bounce()), method="spline")


def test_a_piece_of_two_frames_has_no_derivatives():
    time, xy = _bounce()
    assert np.isnan(differentiate(_motion(time[:2], xy[:2])).velocity_m_s).all()


SPLIT = ["local-quadratic", "savitzky-golay", "rts"]


@pytest.mark.parametrize("method", SPLIT)
def test_split_methods_keep_the_jump_in_noise(method):
    rng, (time, xy), sigma = np.random.default_rng(5), _bounce(n=80, impact=0.083), 2e-4
    before = []
    for _ in range(20):
        motion = _motion(time, xy + rng.normal(scale=sigma, size=xy.shape), sigma)
        found = differentiate(motion, contacts=[(0.083, 0.083)], method=method)
        before.append(found.velocity_m_s[39, 0, 0])
        jump = found.velocity_m_s[40, 0, 0] - found.velocity_m_s[39, 0, 0]
        assert jump == pytest.approx(22.0, abs=8 * found.velocity_sd_m_s[39:41, 0].max())
    assert np.mean(before) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("method", METHODS)
def test_no_method_looks_across_a_contact_or_makes_up_what_is_inside(method):
    time, xy = _bounce(n=80, impact=0.083)
    cut = differentiate(_motion(time, xy, 1e-4), contacts=[(time[38], time[43])], method=method)
    assert np.isnan(cut.velocity_m_s[39:43]).all()
    moved = xy.copy()
    moved[43:] += 5.0
    again = differentiate(_motion(time, moved, 1e-4), contacts=[(time[38], time[43])], method=method)
    np.testing.assert_array_equal(cut.velocity_m_s[:39], again.velocity_m_s[:39])


def test_trackers_formulas_give_trackers_numbers():
    """By hand, from the formulas: x = 0, 1, 4, 9, 16, 26 at steps of 0.5."""
    x = np.array([0.0, 1.0, 4.0, 9.0, 16.0, 26.0])
    found = differentiate(_motion(np.arange(6) * 0.5, np.stack([x, 0 * x], axis=1), 0.1), method="tracker")
    np.testing.assert_allclose(found.velocity_m_s[:, 0, 0], [np.nan, 4.0, 8.0, 12.0, 17.0, np.nan])
    by_hand = (2 * 1 - 4 - 2 * 9 - 16 + 2 * 26) / (7 * 0.25)
    np.testing.assert_allclose(found.acceleration_m_s2[:, 0, 0], [np.nan, np.nan, 8.0, by_hand, np.nan, np.nan])
    np.testing.assert_allclose(found.velocity_sd_m_s[2, 0], 0.1 * 0.7071 / 0.5, rtol=1e-4)
    np.testing.assert_allclose(found.acceleration_sd_m_s2[2, 0], 0.1 * 0.5345 / 0.25, rtol=1e-4)


@pytest.mark.parametrize("method", ["tracker", "savitzky-golay"])
def test_a_missing_frame_ends_a_run(method):
    time, xy = _bounce(n=60, impact=1.0)
    xy[20] = np.nan
    velocity = differentiate(_motion(time, xy, 1e-4), method=method).velocity_m_s[:, 0, 0]
    lost = np.flatnonzero(np.isnan(velocity)).tolist()
    assert lost == ([0, 19, 20, 21, 59] if method == "tracker" else [20])


def test_a_smoother_does_without_sigma_and_finds_a_smooth_motion():
    rng, time = np.random.default_rng(6), np.arange(100) / 480
    truth = np.stack([np.sin(20 * time), np.cos(20 * time)], axis=1)
    noisy = truth + rng.normal(scale=2e-4, size=truth.shape)
    found = differentiate(_motion(time, noisy), method="rts")
    error = found.velocity_m_s[:, 0, 0] - 20 * np.cos(20 * time)
    assert np.sqrt(np.mean(error[10:-10] ** 2)) < 0.03
    assert np.mean(np.abs(error) < 1.96 * found.velocity_sd_m_s[:, 0]) > 0.85


@pytest.mark.parametrize("method", SPLIT)
def test_angular_velocity_and_acceleration_of_a_turning_vector(method):
    time = np.arange(60) / 480
    angle = 3.0 + 10 * time + 40 * time**2
    hand = np.stack([np.cos(angle), np.sin(angle)], axis=1) * 0.5
    motion = Motion(("knee", "foot"), np.arange(60), time, np.stack([0 * hand, hand], axis=1), np.full((60, 2), 1e-4))
    found = differentiate_angle(motion, "knee", "foot", method=method)
    np.testing.assert_allclose(found.angle_rad, angle, atol=1e-9)
    np.testing.assert_allclose(found.omega_rad_s, 10 + 80 * time, atol=1e-3)
    np.testing.assert_allclose(found.alpha_rad_s2, 80.0, atol=0.5)
    assert found.omega_sd_rad_s[30] > 0

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.errors import NoImpactError
from vml_course.kinetics.events import contact_interval, find_impact, sudden_jump_m_s

GRAVITY = np.array([0.0, -9.81])


@pytest.mark.parametrize("impact_s", [0.0800, 0.0831, 0.0843, 0.03])
def test_the_impact_of_an_exact_kick_is_found_to_a_microsecond(kick, impact_s):
    motion = kick(impact_s=impact_s)
    found = find_impact(motion.time_s, motion.of("ball"), gravity_after=GRAVITY)
    assert found.time_s == pytest.approx(impact_s, abs=1e-6)
    assert motion.time_s[found.last_before] <= impact_s + 1e-12
    assert found.first_after == found.last_before + 1
    assert np.hypot(*found.jump_m_s) == pytest.approx(23.95, abs=0.05)


def test_noise_of_half_a_pixel_moves_it_by_a_hundredth_of_a_frame(kick, with_noise):
    rng, motion = np.random.default_rng(5), kick()
    found = [
        find_impact(noisy.time_s, noisy.of("ball"), gravity_after=GRAVITY)
        for noisy in (with_noise(motion, rng, 0.5) for _ in range(60))
    ]
    errors = (np.array([impact.time_s for impact in found]) - 0.0831) * 480
    assert np.std(errors) < 0.02
    assert max(abs(impact.last_before - 39) for impact in found) <= 1


def test_gaps_about_the_impact_are_survived(kick):
    motion = kick()
    ball = motion.of("ball").copy()
    ball[[10, 37, 38, 42, 43, 60]] = np.nan
    found = find_impact(motion.time_s, ball, gravity_after=GRAVITY)
    assert found.time_s == pytest.approx(0.0831, abs=1e-6)
    assert (found.last_before, found.first_after) == (39, 40)


def test_frames_in_contact_are_between_the_clear_ones():
    time = np.arange(80) / 480
    start, duration = 0.0812, 0.0104
    push = np.clip((time - start) / duration, 0, None)
    x = np.where(push < 1, 0.5 * 24 * duration * push**2, 24 * (time - start) - 0.5 * 24 * duration)
    found = find_impact(time, np.stack([x, 0 * x], axis=1))
    assert time[found.last_before] <= start + 1e-4  # in the first 0.1 ms it moves by 10 µm only
    assert time[found.first_after] >= start + duration - 1e-4
    assert found.first_after - found.last_before <= 8
    assert found.time_s == pytest.approx(start + duration / 2, abs=1e-5)


def _still(time):
    return np.zeros((len(time), 2))


def _steady(time):
    return np.stack([3 * time, 1 - time], axis=1)


def _flight(time):
    return np.stack([3 * time, 2 * time - 4.905 * time**2], axis=1)


def _pendulum(time):
    return np.stack([np.cos(9 * time), np.sin(9 * time)], axis=1)


@pytest.mark.parametrize("path", [_still, _steady, _flight, _pendulum])
@pytest.mark.parametrize("pixels", [0.0, 0.1, 1.0])
@pytest.mark.parametrize("rho", [0.0, 0.8])
def test_a_body_that_is_not_struck_has_no_impact(path, pixels, rho):
    rng, time = np.random.default_rng(6), np.arange(90) / 480
    noise = rng.normal(size=(90, 2))
    for i in range(1, 90):
        noise[i] = rho * noise[i - 1] + np.sqrt(1 - rho**2) * noise[i]
    with pytest.raises(NoImpactError, match="ball: expected a sudden change of velocity, got none"):
        find_impact(time, path(time) + noise * pixels / 500)


@pytest.mark.parametrize("seen", [0, 1, 5])
def test_a_ball_hardly_seen_has_no_impact(seen):
    xy = np.full((40, 2), np.nan)
    xy[:seen] = 0.0
    with pytest.raises(NoImpactError):
        find_impact(np.arange(40) / 480, xy)


@pytest.mark.parametrize("duration", [0.0, 0.004, 0.010])
def test_the_contact_interval_holds_the_contact_and_little_more(duration):
    """A half-sine pulse: the velocity grows from 0 to 24 m/s within the contact."""
    time = np.arange(90) / 480
    t = np.clip((time - 0.0831) / max(duration, 1e-12), 0.0, 1.0)
    x = 12 * duration * (t - np.sin(np.pi * t) / np.pi) + 24 * np.clip(time - 0.0831 - duration, 0, None)
    noise = np.random.default_rng(4).normal(scale=4e-5, size=(90, 2))
    impact = find_impact(time, np.stack([x, 0 * x], axis=1) + noise)
    start, end = contact_interval(impact, time)
    if duration == 0:
        assert start == end == pytest.approx(0.0831, abs=1e-4)
    else:
        assert 0.0831 - 1.1 / 480 < start < 0.0831 + 0.5 / 480  # its soft start is within the noise
        assert 0.0831 + duration - 0.5 / 480 < end < 0.0831 + duration + 1.1 / 480


def test_a_path_that_was_never_measured_has_no_impact_and_no_warning(recwarn):
    with pytest.raises(NoImpactError):
        find_impact(np.zeros(0), np.zeros((0, 2)), gravity_before=GRAVITY, gravity_after=GRAVITY)
    with pytest.raises(NoImpactError):
        find_impact(np.arange(40) / 480, np.full((40, 2), np.nan), gravity_before=GRAVITY, gravity_after=GRAVITY)
    assert not recwarn.list


@given(jump=st.floats(-5.0, 5.0), steady=st.floats(-50.0, 50.0))
def test_a_sudden_jump_is_told_apart_from_steady_acceleration(jump, steady):
    time = np.arange(60) / 480
    s = time - 0.0603
    x = 0.3 + 2.0 * s + 0.5 * steady * s**2 + jump * np.clip(s, 0.0, None)
    found = sudden_jump_m_s(time, np.stack([x, 0 * x], axis=1), 0.0603)
    assert found == pytest.approx(np.array([jump, 0.0]), abs=1e-8)

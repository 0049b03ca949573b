from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from vml_course.kinetics.frame_faults import find_frame_faults
from vml_course.model.motion import Motion


def _take(motion, order, keep_time=True):
    """Show the frames in another order under the old time stamps, as a recorder does."""
    n = len(order)
    time = motion.time_s[:n] if keep_time else motion.time_s[order]
    return Motion(motion.points, motion.frame[:n], time, motion.xy_m[order], motion.sigma_m[order])


@pytest.fixture
def clip(kick, with_noise):
    return with_noise(kick(), np.random.default_rng(1), 0.1)


def test_a_clean_kick_has_no_faults(clip):
    assert find_frame_faults(clip).is_clean
    assert find_frame_faults(clip).notes == ()


def test_a_kick_with_little_noise_and_its_impact_has_no_faults(kick):
    assert find_frame_faults(kick()).is_clean


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(at=st.one_of(st.integers(8, 30), st.integers(50, 70)))
def test_a_repeated_picture_is_named(clip, at):
    order = [*range(at), at - 1, *range(at + 1, 80)]  # the picture `at` was replaced by the one before
    found = find_frame_faults(_take(clip, order))
    assert found.repeated == (400 + at,)
    assert found.dropped == ()
    assert "once more" in found.notes[0]


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(at=st.one_of(st.integers(8, 30), st.integers(50, 70)))
def test_a_dropped_picture_is_named(clip, at):
    found = find_frame_faults(_take(clip, [*range(at), *range(at + 1, 80)]))
    assert found.dropped == (400 + at,)
    assert found.repeated == ()


def test_time_stamps_that_jump_or_stand_are_named(clip):
    later = clip.time_s + (np.arange(80) >= 60) / 480
    assert find_frame_faults(replace(clip, time_s=later)).gap == (460,)
    stands = clip.time_s.copy()
    stands[20] = stands[19]
    assert find_frame_faults(replace(clip, time_s=stands)).duplicated == (420,)


def test_bodies_at_rest_tell_nothing(clip):
    still = replace(clip, xy_m=np.broadcast_to(clip.xy_m[:1], clip.xy_m.shape).copy())
    assert find_frame_faults(still).is_clean

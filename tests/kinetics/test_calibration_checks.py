from dataclasses import replace

import numpy as np
import pytest

from vml_course.kinetics.calibration_checks import apparent_gravity, check_pivot, check_rigid, gravity_cause
from vml_course.kinetics.clear_frames import Seen
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model


@pytest.mark.parametrize(("time_factor", "length_factor"), [(1, 1), (16, 1), (1, 2), (0.5, 1)])
def test_apparent_gravity_is_that_of_wrong_frame_rates_and_scales(time_factor, length_factor):
    time = np.arange(40) / 480
    xy = np.stack([3 * time, 2 * time - 0.5 * 9.81 * time**2], axis=1)
    ball = Seen(time * time_factor, xy * length_factor, np.full(40, 1e-4), np.full(40, True))
    fall = apparent_gravity(ball, np.pi / 2)
    assert fall.value == pytest.approx(9.81 * length_factor / time_factor**2, rel=1e-6)


@pytest.mark.parametrize(("slow", "fast"), [(30, 480), (30, 240), (60, 480), (240, 480)])
def test_a_typed_frame_rate_is_guessed_from_gravity(slow, fast):
    cause = gravity_cause(9.81 * (slow / fast) ** 2, 9.81)
    assert f"when {slow} frames/s were typed for {fast}" in cause or f"or {slow} for {fast}" in cause


def test_a_solution_of_a_slow_clip_says_which_rate_was_typed(kick):
    slow = replace(kick(), time_s=kick().time_s * 16)
    notes = impact_model("fixed-pivot").solve(slow, {"m": 0.5, "L": 0.56}, ImpactOptions(window_s=0.64)).notes
    assert any("30 frames/s were typed for 480" in note for note in notes)


def test_a_leg_is_rigid_and_a_rubber_band_is_not(kick, with_noise):
    motion = with_noise(kick(), np.random.default_rng(1))
    leg = check_rigid(motion, "knee", "foot")
    assert leg.is_rigid
    assert leg.length_m == pytest.approx(0.56, abs=1e-4)
    assert leg.spread_m == pytest.approx(leg.expected_m, rel=0.3)
    stretched = motion.xy_m.copy()
    stretched[:, 0] += (stretched[:, 0] - stretched[:, 1]) * np.linspace(0, 0.05, 80)[:, None]
    band = check_rigid(replace(motion, xy_m=stretched), "knee", "foot")
    assert not band.is_rigid
    assert band.trend == pytest.approx(0.045, abs=0.01)


@pytest.mark.parametrize("beside", [(0.0, 0.0), (0.02, 0.0), (-0.01, 0.1)])
def test_a_mark_beside_the_pivot_is_measured(kick, with_noise, beside):
    motion = with_noise(kick(), np.random.default_rng(2))
    xy = motion.xy_m.copy()
    xy[:, 1] += beside
    found = check_pivot(replace(motion, xy_m=xy), "foot", "knee")
    np.testing.assert_allclose(found.offset_m, beside, atol=4 * found.offset_sd_m)
    assert found.distance_m == pytest.approx(np.hypot(*beside), abs=4 * found.offset_sd_m)
    assert found.radius_m == pytest.approx(0.56, abs=4 * found.radius_sd_m)

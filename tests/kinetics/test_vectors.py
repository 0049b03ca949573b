from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vml_course.kinetics.vectors import vector_series


def spinning(rate_rad: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    angle = 0.3 + rate_rad * np.arange(count)
    return angle, 2.0 * np.column_stack([np.cos(angle), np.sin(angle)])


@given(st.floats(-3.0, 3.0), st.floats(-50, 50), st.floats(-50, 50))
def test_a_turning_vector_is_followed_over_whole_turns_wherever_it_stands(rate: float, x: float, y: float) -> None:
    angle, way = spinning(rate, 40)
    tail = np.tile([x, y], (40, 1))
    found = vector_series("v", "a", "b", tail, tail + way)
    np.testing.assert_allclose(found.angle_rad, angle, atol=1e-6)
    np.testing.assert_allclose(found.length, 2.0)
    np.testing.assert_allclose(found.change_pct, 0.0, atol=1e-9)
    np.testing.assert_allclose(np.cos(np.radians(found.angle_vml_deg)), np.cos(angle), atol=1e-9)
    assert (found.angle_vml_deg >= 0).all()
    assert (found.angle_vml_deg <= 180).all()


def test_a_gap_stays_a_gap_and_does_not_break_the_turning() -> None:
    angle, way = spinning(0.5, 20)
    way[8:11] = np.nan
    found = vector_series("v", "a", "b", np.zeros((20, 2)), way)
    assert np.isnan(found.angle_rad[8:11]).all()
    np.testing.assert_allclose(np.delete(found.angle_rad, [8, 9, 10]), np.delete(angle, [8, 9, 10]))


def test_the_change_of_length_counts_from_the_first_frame_that_was_seen() -> None:
    head = np.array([[np.nan, np.nan], [2.0, 0.0], [0.0, 3.0]])
    found = vector_series("v", "a", "b", np.zeros((3, 2)), head)
    np.testing.assert_allclose(found.change_pct, [np.nan, 0.0, 50.0])


def test_a_vector_without_length_or_never_seen_is_no_number_and_no_warning() -> None:
    for head in (np.zeros((3, 2)), np.full((3, 2), np.nan)):
        found = vector_series("v", "a", "b", np.zeros((3, 2)), head)
        assert np.isnan(found.change_pct).all()
        assert np.isnan(found.angle_vml_deg).all()

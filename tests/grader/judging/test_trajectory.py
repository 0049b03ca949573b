"""A table laid over the truth: when points are tried otherwise, and when a delay is believed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from grader import trajectory
from grader.trajectory import HOPELESS, LEAST_ROWS, _is_hopeless, _not_late, _Trial, fit_trajectory

UPRIGHT = (1.0, 1.0)


def trial(rms, lag=0.0):
    return _Trial(lag, UPRIGHT, 1.0, np.zeros(2), rms)


@pytest.fixture
def counted(monkeypatch):
    """Count how often a whole search is made."""
    searched = []

    def best(*args):
        searched.append(1)
        return real(*args)

    real = trajectory._best
    monkeypatch.setattr(trajectory, "_best", best)
    return searched


def test_a_table_that_fits_is_searched_once(kit, kick, counted):
    assert fit_trajectory(kit.table_of(kit.trajectory_m(kit.impact())), kick.key, is_far_tried=True) is not None
    assert len(counted) == 1


def test_the_rest_is_measured_by_the_longest_path_of_a_point():
    path = np.array([-1.0, 1.0] * 4)  # its standard deviation is 1
    far_apart = np.stack([np.stack([path, 0 * path], axis=1), np.full((8, 2), 400.0)], axis=1)
    assert not _is_hopeless(trial(HOPELESS), far_apart)
    assert _is_hopeless(trial(1.01 * HOPELESS), far_apart)
    assert _is_hopeless(None, far_apart)


def test_a_path_along_x_alone_is_not_called_upside_down(kick):
    key = replace(
        kick.key, points=("puck",), xy_px=np.stack([10.0 * np.arange(60) ** 1.2, np.zeros(60)], axis=1)[:, None]
    )
    table = {"frame": np.arange(60.0), "puck_x_m": key.xy_px[:, 0, 0] / 500, "puck_y_m": np.zeros(60)}
    fit = fit_trajectory(table, key)
    assert fit is not None
    assert (fit.y_down, fit.x_left) == (False, False)


def test_a_delay_that_is_known_is_not_weighed_again(kit, kick):
    fit = fit_trajectory(kit.table_of(kit.trajectory_m(kit.impact())), kick.key, 0.4)
    assert fit is not None
    assert fit.lag_frames == 0.4


def test_rows_of_one_frame_stay_in_their_order(kit, kick):
    rows = np.repeat(kit.trajectory_m(kit.impact()), 3, axis=0)
    table = kit.table_of(rows) | {"frame": np.repeat(np.arange(60.0), 3)}
    table["knee_x_m"] = table["knee_x_m"] + np.tile([0.0, 1e-3, 2e-3], 60)
    fit = fit_trajectory({name: np.roll(column, 90) for name, column in table.items()}, kick.key, 0.0)
    assert fit is not None
    assert (np.diff(fit.own_m[:, 1, 0].reshape(60, 3)) > 0).all()


# ---------------------------------------------------------------- a delay that noise can feign


def off_by(rms):
    """A path and one that is off it by so much, of 30 marks in 20 rows: of one point half the rows are empty."""
    at = np.zeros((20, 2, 2))
    at[:, :, 0] = 1e3 * np.arange(20.0)[:, None]
    at[10:, 1] = np.nan
    own = at.copy()
    own[:, :, 1] += rms * np.resize([1.0, -1.0], 20)[:, None]
    return own, at


@pytest.mark.parametrize(("ratio", "is_late"), [(1.0, False), (1.35, False), (1.4, False), (1.43, True), (2.0, True)])
@pytest.mark.parametrize("rms", [0.1, 2.0])
def test_a_delay_is_one_when_the_fit_without_it_is_worse_by_five_sd(rms, ratio, is_late):
    own, at = off_by(rms)  # 60 numbers: 1 + 25 / 60 = 1.417 times the mean square
    best = trial(rms / math.sqrt(ratio), lag=1.0)
    assert (_not_late(best, own, at) is best) is is_late


def test_a_delay_without_which_nothing_can_be_compared_stays():
    own, at = off_by(0.1)
    best = trial(0.1, lag=9.0)
    assert _not_late(best, own[: LEAST_ROWS - 1], at[: LEAST_ROWS - 1]) is best

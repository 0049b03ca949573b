"""The kernels of the joint fit: paths against integration, complex steps against differences."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from vml_course.kinetics.clear_frames import Seen
from vml_course.kinetics.joint import Held, Misfit, Problem, Watched, fit, residuals
from vml_course.kinetics.paths import flying, sliding, swinging, turning
from vml_course.kinetics.pendulum import swung

TIME = np.linspace(-0.05, 0.05, 12)
BODY = {"bx": 0.3, "by": -0.2, "b1x": 1.0, "b1y": 0.2, "b2x": 8.0, "b2y": 2.0}
SWING = {"kx": 0.1, "ky": 0.2, "r": 0.5, "theta": -1.4, "w1": 20.0, "w2": 15.0}
PATHS = {
    "flying": (BODY, flying("b", np.array([0.3, -9.8]), np.array([0.1, -9.0]))),
    "sliding": ({**BODY, "mu": 0.3}, sliding("b", 9.81)),
    "sliding to a stop": ({**BODY, "b2x": 0.05, "b2y": 0.0, "mu": 0.4}, sliding("b", 9.81)),
    "swinging": ({**SWING, "p": 12.0, "q": 30.0}, swinging(0.2)),
    "turning": (
        {**BODY, "theta": 0.4, "w1": 3.0, "w2": -40.0},
        turning(flying("b", np.zeros(2), np.zeros(2)), lambda u: 0.2 * u["b2x"], lambda u: (u["w1"], u["w2"])),
    ),
}


@pytest.mark.parametrize("name", PATHS)
@settings(deadline=None, max_examples=10)
@given(shift=st.lists(st.floats(-0.2, 0.2), min_size=14, max_size=14))
def test_complex_steps_are_the_derivatives_of_the_residuals(name, shift):
    start, path = PATHS[name]
    start = {key: value * (1 + by) for (key, value), by in zip(start.items(), shift, strict=False)} | {"t": 0.0013}
    seen = Seen(TIME, np.random.default_rng(10).normal(size=(12, 2)), np.full(12, 0.1), TIME > 0.004)
    problem = Problem(start, {"L": 0.6}, (Watched("ball", seen, path),), (Held(lambda u: u["t"] - 0.01 * u["L"], 0.5),))
    x = np.array(list(start.values()))
    found, row = Misfit(problem).slopes(x), problem.rows(x)
    for j in range(row.shape[1]):
        aside = np.zeros_like(row)
        aside[0, j] = 1e-7 * max(abs(row[0, j]), 0.01)
        slope = (residuals(problem, row + aside) - residuals(problem, row - aside))[0] / (2 * aside[0, j])
        np.testing.assert_allclose(found[:, j], slope, atol=2e-5 * max(1.0, np.abs(slope).max()))


def test_a_pendulum_that_hangs_stays_and_a_fit_that_went_astray_ends():
    one, time = np.ones((1, 1)), np.linspace(-0.3, 0.5, 9)[None]
    hangs = swung(time, time[0] > 0, 0.7 * one, (0 * one, 0 * one), (0 * one, 0 * one, 0 * one))
    assert hangs == pytest.approx(0.7, abs=1e-15)
    for rate in (np.nan, np.inf, 1e12):
        with np.errstate(all="ignore"):
            astray = swung(time, time[0] > 0, one, (0 * one, rate * one), (30 * one, 0 * one, 0 * one))
        assert astray.shape == time.shape
        assert not np.isclose(astray[0, -1], 1.0)


@settings(deadline=None, max_examples=30)
@given(
    start=st.floats(-3, 3),
    rate=st.floats(-30, 30),
    pull=st.floats(0, 40),
    drive=st.floats(-50, 50),
    tilt=st.floats(-1, 1),
)
def test_the_swing_is_that_of_an_ode(start, rate, pull, drive, tilt):
    time = np.linspace(0, 0.5, 7)
    for sign in (1.0, -1.0):
        ode = solve_ivp(
            lambda _t, y: [y[1], drive - pull * np.cos(y[0] - tilt)], (0, sign * 0.5), [start, rate],
            t_eval=sign * time, rtol=1e-12, atol=1e-12, method="DOP853",
        )  # fmt: skip
        begin, there, other, *acting = (np.full((1, 1), value) for value in (start, rate, -rate, pull, drive, tilt))
        rates = (there, other) if sign < 0 else (other, there)
        found = swung(sign * time[None], np.full(7, sign > 0), begin, rates, tuple(acting))[0]
        np.testing.assert_allclose(found, ode.y[0], rtol=1e-8, atol=1e-8)


def test_a_block_that_friction_stopped_stays_where_it_is():
    u = {key: np.full((1, 1), value) for key, value in {**BODY, "b2x": 0.1, "b2y": 0.0, "mu": 0.5}.items()}
    time = np.array([[0.0, 0.01, 0.1, 0.2]])
    found = sliding("b", 10.0)(u, time, time[0] >= 0)
    np.testing.assert_allclose(found.x[0] - 0.3, [0.0, 0.1 * 0.01 - 2.5e-4, 1e-3, 1e-3], atol=1e-12)


def test_given_numbers_and_the_scale_move_the_unknowns_as_a_new_fit_says():
    rng = np.random.default_rng(3)
    seen = Seen(
        TIME, np.stack([2 * TIME, 0 * TIME], axis=1) + rng.normal(scale=1e-3, size=(12, 2)), np.full(12, 1e-3), TIME > 0
    )
    start = {**BODY, "t": 0.0}

    def found(length, scale=1.0):
        held = (Held(lambda u: u["b2x"] - u["L"], 0.5), Held(lambda u: u["t"], 1e-3))
        where = Seen(seen.time_s, scale * seen.xy_m, seen.sigma_m, seen.is_after)
        return fit(
            Problem(start, {"L": length}, (Watched("ball", where, flying("b", np.zeros(2), np.zeros(2))),), held)
        )

    one = found(3.0)  # what is left is of second order in the change
    np.testing.assert_allclose(one.by_known[:, 0] * 1e-3, found(3.001).x - one.x, atol=1e-8)
    np.testing.assert_allclose(one.by_known[:, 1] * 1e-3, found(3.0, 1.001).x - one.x, atol=2e-6)

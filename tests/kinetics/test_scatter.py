"""What residuals tell of the errors: their size, how alike they are, and pixel locking, seen or not."""

import math

import numpy as np
import pytest

from vml_course.kinetics.arc import fit_arc
from vml_course.kinetics.clear_frames import Seen
from vml_course.kinetics.joint import Problem, Watched, fit
from vml_course.kinetics.paths import flying
from vml_course.kinetics.scatter import LEAST_LOCKING_PX

PIXEL_M, NOISE_PX, FRAMES = 1 / 500, 0.02, 40
TIME = (np.arange(FRAMES) - 19.5) / 480
STILL = np.zeros(2)


def locked(xy_m, rng, amplitude_px):
    phase = rng.uniform(0, 2 * math.pi, size=(1, 2))
    bias = amplitude_px * np.sin(2 * math.pi * xy_m / PIXEL_M + phase)
    return xy_m + PIXEL_M * (bias + rng.normal(scale=NOISE_PX, size=xy_m.shape))


def fitted(rng, amplitude_px, pixel_m=PIXEL_M):
    """A body that flies across many pixels and one that lies still, both straight through."""
    start, watched = {"t": 0.0}, []
    for body, velocity in (("a", (1.7, 0.9)), ("b", (0.0, 0.0))):
        seen = locked(np.array([0.1, 0.2]) + TIME[:, None] * np.array(velocity), rng, amplitude_px)
        sigma = np.full(FRAMES, 0.1 * PIXEL_M)
        watched.append(Watched(body, Seen(TIME, seen, sigma, TIME > 0, pixel_m), flying(body, STILL, STILL)))
        names = [f"{body}{part}{axis}" for part in ("", "1", "2") for axis in "xy"]
        start |= dict(zip(names, [0.1, 0.2, *velocity, *velocity], strict=True))
    del start["t"]
    return fit(Problem(start | {"t": 0.0}, {}, tuple(watched)))


def test_points_that_move_tell_the_locking_of_those_that_lie_still():
    rng = np.random.default_rng(1)
    fits = [fitted(rng, 0.06) for _ in range(40)]
    amplitude = np.sqrt(2 * np.mean([found.scatter.locking_px2 for found in fits]))
    assert amplitude == pytest.approx(0.06, rel=0.15)
    off = np.array([found["bx"] - 0.1 for found in fits])
    told = np.array([found.sd("bx") for found in fits])
    assert np.mean(np.abs(off) < 1.96 * told) >= 0.8
    assert np.median(told) == pytest.approx(0.06 / math.sqrt(2) * PIXEL_M, rel=0.3)


def test_without_locking_the_usual_one_is_allowed_for():
    rng = np.random.default_rng(2)
    fits = [fitted(rng, 0.0) for _ in range(40)]
    assert np.mean([found.scatter.locking_px2 for found in fits]) < LEAST_LOCKING_PX**2 / 4
    least = LEAST_LOCKING_PX / math.sqrt(2) * PIXEL_M
    assert all(found.sd("bx") >= least for found in fits)


def test_the_fitted_noise_is_what_was_added_whether_there_is_locking_or_not():
    rng = np.random.default_rng(3)
    for amplitude_px in (0.0, 0.06):
        noise = np.mean([fitted(rng, amplitude_px).scatter.noise for _ in range(40)])
        assert math.sqrt(noise) * 0.1 == pytest.approx(NOISE_PX, rel=0.12)


def test_where_pixels_are_not_known_nothing_is_allowed_for():
    found = fitted(np.random.default_rng(4), 0.0, math.nan)
    assert found.scatter.locking_px2 == 0.0
    assert found.sd("bx") < LEAST_LOCKING_PX / math.sqrt(2) * PIXEL_M


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.8])
@pytest.mark.parametrize("reach_rad", [0.25, 1.5])
def test_the_sd_of_a_radius_holds_for_errors_that_are_alike(rho, reach_rad):
    rng, angle = np.random.default_rng(5), np.linspace(0, reach_rad, FRAMES)
    circle, off = 0.6 * np.stack([np.cos(angle), np.sin(angle)], axis=1), []
    for _ in range(400):
        noise = rng.normal(size=circle.shape)
        for i in range(1, FRAMES):
            noise[i] = rho * noise[i - 1] + math.sqrt(1 - rho**2) * noise[i]
        arc = fit_arc(circle + 0.1 * PIXEL_M * noise)
        off.append((1 / arc.radius_m - 1 / 0.6) * arc.radius_m**2 / arc.radius_sd_m)
    assert 0.7 < np.std(off) < 1.25
    if rho < 0.8:  # forty points know a correlation of 0.8 so badly that 3 % of the circles are beyond
        assert np.mean(np.abs(off) > 3) < 0.02

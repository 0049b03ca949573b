"""Kicks in closed form, for tests: exact paths, then noise, gaps and mirrors on top."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from vml_course.kinetics.pinned import after_impact
from vml_course.model.motion import Motion

PIXEL_M = 1 / 500


@dataclass(frozen=True)
class Kick:
    """A kick about a fixed knee; defaults are the paper's numbers. World y up, before `turn` and `mirror`."""

    e: float = 0.73
    inertia: float = 1.88
    mass: float = 0.5
    length: float = 0.56
    speed: float = 15.0
    normal_tilt: float = 0.0
    gravity_moment: float = 9.4
    drive: float = 0.0
    gravity: float = 9.81
    fps: float = 480.0
    frames: int = 80
    impact_s: float = 0.0831
    angle: float = -np.pi / 2
    ball_velocity: tuple[float, float] = (0.0, 0.0)
    flying: bool = False
    turn: float = 0.0
    mirror: bool = False
    scale: float = 1.0
    start_s: float = 0.0


def exact(kick: Kick) -> Motion:
    """Return the exact motion of foot, knee and ball; angle from an ODE, so that no formula tests itself."""
    time = np.arange(kick.frames) / kick.fps
    arm_angle = kick.angle
    foot0 = kick.length * np.array([np.cos(arm_angle), np.sin(arm_angle)])
    n_angle = arm_angle + np.pi / 2 + kick.normal_tilt
    n = np.array([np.cos(n_angle), np.sin(n_angle)])
    arm = foot0[0] * n[1] - foot0[1] * n[0]
    v1 = np.array(kick.ball_velocity)
    w1 = kick.speed / kick.length
    after = after_impact(kick.e, kick.inertia, kick.mass, arm, w1, float(v1 @ n))
    v2 = v1 + (after.u2 - v1 @ n) * n
    angle = np.where(time <= kick.impact_s, _swing(kick, w1, time), _swing(kick, after.omega2, time))
    foot = kick.length * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ball0, s = foot0 + 0.11 * n, (time - kick.impact_s)[:, None]
    g = np.array([0.0, -kick.gravity])
    ball = np.where(s <= 0, ball0 + v1 * s + 0.5 * g * s**2 * kick.flying, ball0 + v2 * s + 0.5 * g * s**2)
    knee = np.zeros_like(foot)
    xy = np.stack([foot, knee, ball], axis=1) * kick.scale + np.array([0.8, 0.9]) * kick.scale
    if kick.mirror:
        xy = xy * np.array([-1.0, 1.0])
    c, si = np.cos(kick.turn), np.sin(kick.turn)
    xy = xy @ np.array([[c, si], [-si, c]])
    frame = np.arange(kick.frames) + 400
    return Motion(("foot", "knee", "ball"), frame, time + kick.start_s, xy, np.full((kick.frames, 3), np.nan))


def _swing(kick: Kick, omega, time):
    """Angle before or after the impact from d2a/dt2 = drive - (moment / I) cos a."""

    def rates(_t, state):
        return [state[1], kick.drive - kick.gravity_moment / kick.inertia * np.cos(state[0])]

    result = np.empty_like(time)
    for side in (time <= kick.impact_s, time > kick.impact_s):
        if not side.any():
            continue
        t = time[side] - kick.impact_s
        order = np.argsort(np.abs(t))
        ends = (0.0, float(t[order][-1]) or 1e-12)
        found = solve_ivp(rates, ends, [kick.angle, omega], t_eval=t[order], rtol=1e-11, atol=1e-12, method="DOP853")
        part = np.empty_like(t)
        part[order] = found.y[0]
        result[side] = part
    return result


def noisy(motion: Motion, rng: np.random.Generator, pixels: float = 0.1, knee: bool = True) -> Motion:
    """Return the motion with white noise of some pixels (500 px/m) on every coordinate."""
    noise = rng.normal(scale=pixels * PIXEL_M, size=motion.xy_m.shape)
    noise[:, 1] *= knee
    return replace(motion, xy_m=motion.xy_m + noise, sigma_m=np.full(motion.sigma_m.shape, pixels * PIXEL_M))


@pytest.fixture(scope="session")
def kick():
    """Make an exact kick: `kick(e=0.5, mirror=True)`."""
    return lambda **values: exact(Kick(**values))


@pytest.fixture(scope="session")
def with_noise():
    """Add white noise: `with_noise(motion, rng, pixels=0.1)`."""
    return noisy

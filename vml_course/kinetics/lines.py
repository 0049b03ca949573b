"""The student's method: straight lines through the leg's angle and the ball's path, 20 ms each side.

It trusts the mark on the knee, takes leg and ball to be in steady motion, and the impulse to be along the
foot's path. On a simulated kick that costs 0.1 % of e and nothing of I; a knee mark 20 mm beside the
pivot costs 15 % of I.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from vml_course.kinetics.clear_frames import ClearFrames, clear_frames
from vml_course.kinetics.impact_model import ImpactOptions, check_given
from vml_course.kinetics.pinned import inertia_about_pivot, restitution
from vml_course.kinetics.straight import Line, fit_line, meeting_time
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion, vector_between
from vml_course.model.solution import Estimate, ImpactSolution

WINDOW_S = 0.020
MODELS = ("fixed-pivot", "hammer-block")  # those that it can solve: a pivoted body and another one
GIVEN = {"m": "mass", "L": "length"}


def solve_by_lines(
    motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None, *, window_s: float = WINDOW_S
) -> ImpactSolution:
    """Return e and I as a student finds them with a spreadsheet.

    e = (v_b2 - w2 a) / (w1 a - v_b1),  I = m a (v_b2 - v_b1) / (w1 - w2),  a = L where it is not given,

    with rates counted positive towards the ball and ball speeds along the change of its velocity.

    Parameters
    ----------
    motion : Motion
        With points for the foot, the knee and the ball.
    given : mapping of str to float
        `m` in kg, `L` in m; `a` in m where the contact normal has another arm than L (a door).
    options : ImpactOptions, optional
    window_s : float
        Time each side.

    Raises
    ------
    InputError, NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError
    """
    options = options or ImpactOptions()
    check_given(given, GIVEN, {"a": "length"})
    frames = clear_frames(motion, options, window_s)
    leg = _leg_lines(motion, options, frames)
    ball = _ball_lines(motion, options, frames)
    jump = ball[1].slope - ball[0].slope
    n = jump / np.hypot(*jump)
    towards = _towards_ball(motion, options, frames, n)
    values = towards * leg[0].slope[0], towards * leg[1].slope[0], float(ball[0].slope @ n), float(ball[1].slope @ n)
    errors = np.array([*(line.slope_sd() for line in leg), *(line.slope_sd() for line in ball)])
    estimates = _estimates(np.array(values), errors, given, options.given_sd)
    for symbol, line in (("omega1", leg[0]), ("omega2", leg[1])):
        estimates[symbol] = Estimate(float(line.slope[0]), line.slope_sd(), "rad/s")
    found_s = frames.impact.time_s + meeting_time(*ball)
    estimates["t_impact"] = Estimate(found_s, float(np.hypot(*errors[2:]) * WINDOW_S / np.hypot(*jump)), "s")
    return ImpactSolution(
        model="fixed-pivot",
        method="lines",
        estimates=estimates,
        correlation_e_I=float("nan"),
        frame_before=int(motion.frame[frames.impact.last_before]),
        figures={
            "r": float(1.0 - values[1] / values[0]) if values[0] else float("nan"),
            "frames_before": float(leg[0].count),
            "frames_after": float(leg[1].count),
        },
    )


def _leg_lines(motion: Motion, options: ImpactOptions, frames: ClearFrames) -> tuple[Line, Line]:
    foot, knee = frames.seen(motion, options.striker), frames.seen(motion, options.knee)
    both = np.isin(foot.time_s, knee.time_s), np.isin(knee.time_s, foot.time_s)
    leg = vector_between("leg", options.knee, options.striker, knee.xy_m[both[1]], foot.xy_m[both[0]])
    time, is_after = foot.time_s[both[0]], foot.is_after[both[0]]
    return _both_sides(time, leg.angle_rad[:, None], is_after)


def _ball_lines(motion: Motion, options: ImpactOptions, frames: ClearFrames) -> tuple[Line, Line]:
    ball = frames.seen(motion, options.struck)
    return _both_sides(ball.time_s, ball.xy_m, ball.is_after)


def _both_sides(time_s: FloatArray, path: FloatArray, is_after: NDArray[np.bool_]) -> tuple[Line, Line]:
    before = ~is_after
    return fit_line(time_s[before], path[before]), fit_line(time_s[is_after], path[is_after])


def _towards_ball(motion: Motion, options: ImpactOptions, frames: ClearFrames, n: FloatArray) -> float:
    """Return +1 when a counter-clockwise rate moves the foot along n, else -1."""
    last = frames.before[-1]
    arm = motion.of(options.striker)[last] - motion.of(options.knee)[last]
    return float(np.sign(arm[0] * n[1] - arm[1] * n[0]))


def _estimates(
    rates: FloatArray, errors: FloatArray, given: Mapping[str, float], given_sd: Mapping[str, float]
) -> dict[str, Estimate]:
    """Return the derived quantities with errors propagated from (w1, w2, u1, u2), m, L and a, all independent."""
    inputs = np.array([*rates, given["m"], given["L"], given.get("a", given["L"]) / given["L"]])
    sds = np.array([*errors, given_sd.get("m", 0.0), given_sd.get("L", 0.0), given_sd.get("a", 0.0) / given["L"]])
    total = np.zeros(len(_UNITS))
    for j, sd in enumerate(sds):
        step = np.zeros_like(inputs)
        step[j] = 1e-6 * max(abs(inputs[j]), 1e-3)
        total += ((_derived(inputs + step) - _derived(inputs - step)) / (2 * step[j]) * sd) ** 2
    found = zip(_UNITS.items(), _derived(inputs), np.sqrt(total), strict=True)
    return {symbol: Estimate(float(value), float(sd), unit) for (symbol, unit), value, sd in found}


_UNITS = {
    "e": "", "I": "kg m^2", "v_f1": "m/s", "v_f2": "m/s", "v_b1": "m/s", "v_b2": "m/s", "J": "N s", "loss": "J",
}  # fmt: skip


def _derived(inputs: FloatArray) -> FloatArray:
    w1, w2, u1, u2, mass, length, share = map(float, inputs)
    arm = share * length
    e = restitution(arm, w1, w2, u1, u2)
    inertia = inertia_about_pivot(mass, arm, w1, w2, u1, u2)
    loss = 0.5 * inertia * (w1**2 - w2**2) + 0.5 * mass * (u1**2 - u2**2)
    return np.array([e, inertia, length * w1, length * w2, u1, u2, mass * (u2 - u1), loss])

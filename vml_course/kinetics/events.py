"""When was the impact? The struck body tells; the striker changes too little (physics of a heavy leg).

Measured on simulated kicks, the split of the ball's path is exact in 96 % of clips at 0.5 px noise and within
one frame always; from the leg's angle it is found in 11 %.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from vml_course.errors import NoImpactError
from vml_course.kinetics.straight import Line, fit_line, meeting_time
from vml_course.model.arrays import FloatArray, IntArray

HALF_WINDOW = 24  # frames each side that decide on a split
LEAST_SIDE = 3  # frames each side of a split
LEAST_F = 100.0  # far above what correlated noise (AR(1) with 0.8) gives, far below any real impact
CONTACT_S = 0.016  # longest half of a contact that is looked for
CLEAR_SD = 5.0  # a frame further than this from its side's line belongs to the contact


@dataclass(frozen=True, eq=False, slots=True)
class Impact:
    """A sudden change of velocity.

    Attributes
    ----------
    last_before, first_after : int
        Indices of the last frame that is clearly before, and of the first that is clearly after; frames
        between them are in contact (or show a blend of both).
    time_s : float
        When the two straight paths meet; for a contact that lasts, the centre of its impulse.
    before, after : Line
        The struck body's paths, gravity taken off.
    """

    last_before: int
    first_after: int
    time_s: float
    before: Line
    after: Line

    @property
    def jump_m_s(self) -> FloatArray:
        """Change of velocity, shape (2,)."""
        return np.asarray(self.after.slope - self.before.slope)


def contact_interval(impact: Impact, time_s: FloatArray) -> tuple[float, float]:
    """Return start and end of the contact, seconds, as `differentiate` takes it; equal when no frame shows contact.

    A contact that frames show began after the last clear frame before and ended before the first clear one after, so
    the interval is longer than the contact by up to a frame on either side.
    """
    if impact.first_after - impact.last_before < 2:
        return impact.time_s, impact.time_s
    return float(time_s[impact.last_before]), float(time_s[impact.first_after])


def find_impact(
    time_s: FloatArray,
    xy_m: FloatArray,
    *,
    gravity_before: FloatArray | None = None,
    gravity_after: FloatArray | None = None,
    name: str = "ball",
) -> Impact:
    """Find the largest sudden change of velocity of one point.

    The split is where two straight lines (24 frames each side) explain the path best against one: the
    largest F statistic. It counts as an impact only when a kink explains more than any smooth
    acceleration does, so a body at rest, in steady motion or in free flight has none.

    Parameters
    ----------
    time_s : float array, shape (n,)
    xy_m : float array, shape (n, 2)
        NaN where not measured.
    gravity_before, gravity_after : float array, shape (2,), optional
        Known acceleration of the free body on either side, m/s^2.
    name : str
        What the user calls the point.

    Raises
    ------
    NoImpactError
    """
    seen = np.flatnonzero(np.isfinite(xy_m).all(axis=1) & np.isfinite(time_s))
    if gravity_before is not None and gravity_after is not None and np.array_equal(gravity_before, gravity_after):
        # Seen by somebody who falls along, a body that always flies goes straight.
        middle_s = float(np.sum(time_s[seen])) / max(len(seen), 1)
        xy_m = xy_m - 0.5 * np.multiply.outer((time_s - middle_s) ** 2, gravity_before)
        gravity_before = gravity_after = None
    found = split_of(time_s[seen], xy_m[seen])
    if found is None:
        hint = "Choose the struck body, and a clip with frames on both sides of the impact."
        raise NoImpactError(name, "a sudden change of velocity", "none in the clip", hint)
    split, half = found
    moment = float(time_s[seen][split : split + 2].mean())
    straight = xy_m[seen].copy()
    for part, gravity in ((slice(0, split + 1), gravity_before), (slice(split + 1, None), gravity_after)):
        if gravity is not None:
            straight[part] -= 0.5 * np.multiply.outer((time_s[seen][part] - moment) ** 2, gravity)
    return _impact(time_s, straight, seen, split, half)


def _impact(time_s: FloatArray, straight: FloatArray, seen: IntArray, split: int, half: int) -> Impact:
    away_before, away_after = np.arange(split, -1, -1), np.arange(split + 1, len(seen))
    if half < HALF_WINDOW:
        away_before, away_after = away_before[:half], away_after[:half]
    times = time_s[seen]
    noise_m = 1e-6 * float(np.ptp(straight, axis=0).max())
    first = away_before[_contact_frames(times[away_before], straight[away_before], noise_m) :][:HALF_WINDOW]
    last = away_after[_contact_frames(times[away_after], straight[away_after], noise_m) :][:HALF_WINDOW]
    before, after = fit_line(times[first], straight[first]), fit_line(times[last], straight[last])
    moment = meeting_time(before, after)
    # On a curved path the split may be a frame off: frames between that lie on a side's line are that side's.
    between = np.arange(first[0] + 1, last[0])
    early, late = between[times[between] <= moment], between[times[between] > moment][::-1]
    last_before = int(first[0]) + _still_on(before, times[early], straight[early], noise_m)
    first_after = int(last[0]) - _still_on(after, times[late], straight[late], noise_m)
    return Impact(int(seen[last_before]), int(seen[first_after]), moment, before, after)


def _still_on(line: Line, time_s: FloatArray, straight: FloatArray, noise_m: float) -> int:
    """Return how many frames, one after another, lie on a line."""
    for count, (time, place) in enumerate(zip(time_s, straight, strict=True)):
        off = float(np.abs(place - line.position(float(time))).max())
        if off > CLEAR_SD * line.prediction_sd(float(time), line.residual_sd + noise_m):
            return count
    return len(time_s)


def split_of(time_s: FloatArray, xy_m: FloatArray) -> tuple[int, int] | None:
    """Return the index of the last frame before the impact and the frames a side that show it; None without impact.

    Parameters
    ----------
    time_s, xy_m : float array, shape (n,), (n, 2)
        Without NaN.
    """
    if len(time_s) < 2 * LEAST_SIDE:
        return None
    # Nearer looks, lest a second impact close by hide the first; they must show it the more clearly.
    for closer in (1, 2, 4):
        half = HALF_WINDOW // closer
        split = int(np.argmax(split_f(time_s, xy_m, half))) + LEAST_SIDE - 1
        near = slice(max(split + 1 - half, 0), split + 1 + half)
        if _is_kink(time_s[near], xy_m[near], float(time_s[split : split + 2].mean()), LEAST_F * closer):
            return split, half
    return None


def split_f(time_s: FloatArray, xy_m: FloatArray, half_window: int = HALF_WINDOW) -> FloatArray:
    """Return the F statistic of two lines against one, for each split with 3 frames a side or more.

    Both coordinates share the split: four parameters more for two lines than for one.
    """
    pad = np.full(half_window, np.nan)
    columns = [np.concatenate([pad, column, pad]) for column in (time_s, *np.asarray(xy_m).T)]
    windows = [sliding_window_view(column, half_window) for column in columns]
    splits = np.arange(LEAST_SIDE - 1, len(time_s) - LEAST_SIDE)
    sides = [[window[splits + shift] for window in windows] for shift in (1, half_window + 1)]
    both = [np.concatenate(pair, axis=1) for pair in zip(*sides, strict=True)]
    floor = 1e-18 * float(np.ptp(xy_m, axis=0).max()) ** 2 + 1e-30
    two = _scatter(*sides[0]) + _scatter(*sides[1]) + floor
    freedom = 2 * np.isfinite(both[0]).sum(axis=1) - 8
    return np.asarray((_scatter(*both) - two) / 4.0 / (two / freedom))


def _scatter(time_s: FloatArray, x_m: FloatArray, y_m: FloatArray) -> FloatArray:
    """Return the residual sum of squares about a line, for each row; NaN is padding."""
    apart = time_s - np.nanmean(time_s, axis=1, keepdims=True)
    total = np.zeros(len(time_s))
    for column in (x_m, y_m):
        rest = column - np.nanmean(column, axis=1, keepdims=True)
        slope = np.nansum(apart * rest, axis=1) / np.nansum(apart**2, axis=1)
        total += np.nansum((rest - slope[:, None] * apart) ** 2, axis=1)
    return total


def _is_kink(time_s: FloatArray, xy_m: FloatArray, moment_s: float, least_f: float) -> bool:
    """Tell a kink from a smooth acceleration: it must beat a parabola clearly, and a cubic by half."""
    t = (time_s - moment_s) / max(float(np.ptp(time_s)), 1e-12)
    parabola = np.stack([np.ones_like(t), t, t**2], axis=1)
    kink = _misfit(_kinked(t), xy_m)
    floor = len(t) * (1e-9 * float(np.abs(xy_m).max()) + 1e-12) ** 2
    if len(t) < 5:
        return False
    gain = _misfit(parabola, xy_m) - kink
    freedom = max(2 * len(t) - 8, 1)
    cubic = _misfit(np.column_stack([parabola, t**3]), xy_m)
    return gain / 2.0 > least_f * (kink + floor) / freedom and kink < 0.5 * cubic


def sudden_jump_m_s(time_s: FloatArray, xy_m: FloatArray, moment_s: float) -> FloatArray:
    """Return the change of velocity at a moment beside any steady acceleration, shape (2,).

    Of a parabola with a kink through 24 frames each side; the jump between two straight lines would hold all that a
    smooth swing does to the velocity in that time.

    Parameters
    ----------
    time_s, xy_m : float array, shape (n,), (n, 2)
        NaN where not measured.
    moment_s : float
    """
    seen = np.isfinite(xy_m).all(axis=1) & np.isfinite(time_s)
    apart, path = time_s[seen] - moment_s, xy_m[seen]
    near = np.concatenate([np.flatnonzero(apart <= 0)[-HALF_WINDOW:], np.flatnonzero(apart > 0)[:HALF_WINDOW]])
    span = max(float(np.ptp(apart[near])), 1e-12)
    return np.asarray(np.linalg.lstsq(_kinked(apart[near] / span), path[near], rcond=None)[0][-1] / span)


def _kinked(t: FloatArray) -> FloatArray:
    """Return the basis of a parabola with a kink at t = 0, the kink's column last."""
    return np.stack([np.ones_like(t), t, t**2, np.maximum(t, 0.0)], axis=1)


def _misfit(basis: FloatArray, xy_m: FloatArray) -> float:
    rest = xy_m - basis @ np.linalg.lstsq(basis, xy_m, rcond=None)[0]
    return float(np.sum(rest**2))


def _contact_frames(time_s: FloatArray, straight: FloatArray, noise_m: float) -> int:
    """Return how many frames next to the impact do not lie on their side's line.

    Walks from clear frames towards the impact (index 0) and stops at the first that the line of those
    further away does not predict.
    """
    if len(time_s) <= LEAST_SIDE:
        return 0
    steps = np.abs(np.diff(time_s[: HALF_WINDOW + 1]))
    start = min(int(np.ceil(CONTACT_S / float(np.median(steps)))), 16, max(len(time_s) - 5, 0))
    for j in range(start - 1, -1, -1):
        clear = slice(j + 1, j + 1 + HALF_WINDOW)
        line = fit_line(time_s[clear], straight[clear])
        off = float(np.abs(straight[j] - line.position(float(time_s[j]))).max())
        if off > CLEAR_SD * line.prediction_sd(float(time_s[j]), line.residual_sd + noise_m):
            return j + 1
    return 0

"""Which frames are compared with the model: clear of the contact, within the window, on either side."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vml_course.errors import NoImpactError, SeveralImpactsError, TooFewFramesError
from vml_course.kinetics.events import Impact, find_impact, sudden_jump_m_s
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.motion import Motion

LEAST_FRAMES = 5
USUAL_FRAMES = 10
SIDES = ("before", "after")
SECOND_SHARE = 0.1  # of the impact's jump of velocity, from which on another jump is a second impact


@dataclass(frozen=True, eq=False, slots=True)
class Seen:
    """Clear frames of one point.

    Time (n,), position (n, 2), sigma (n,), whether after the impact (n,), and the size of a pixel, NaN where unknown.
    """

    time_s: FloatArray
    xy_m: FloatArray
    sigma_m: FloatArray
    is_after: NDArray[np.bool_]
    pixel_m: float = math.nan

    @property
    def counts(self) -> tuple[int, int]:
        """How many frames lie before and after the impact."""
        return int(np.sum(~self.is_after)), int(np.sum(self.is_after))

    def kept(self, frames: NDArray[np.bool_]) -> Seen:
        """Return the chosen frames (n,) alone."""
        return Seen(self.time_s[frames], self.xy_m[frames], self.sigma_m[frames], self.is_after[frames], self.pixel_m)


@dataclass(frozen=True, eq=False, slots=True)
class ClearFrames:
    """An impact and the indices of clear frames on both sides of it."""

    impact: Impact
    before: IntArray
    after: IntArray

    @property
    def contact_frames(self) -> int:
        """How many frames between both sides were left out."""
        return self.impact.first_after - self.impact.last_before - 1

    def seen(self, motion: Motion, point: str, sides: tuple[str, ...] = SIDES) -> Seen:
        """Return one point's measured clear frames, time counted from the impact as it was found.

        Parameters
        ----------
        motion : Motion
        point : str
        sides : tuple of str
            Which of "before" and "after" are wanted; a pellet that is stuck in a block has no after.

        Raises
        ------
        TooFewFramesError
        """
        xy, frames = motion.of(point), np.concatenate([self.before, self.after])
        is_after = np.repeat([False, True], [len(self.before), len(self.after)])
        is_seen = np.isfinite(xy[frames]).all(axis=1) & np.isin(is_after, [side == "after" for side in sides])
        for side in sides:
            count = int(np.sum(is_seen & (is_after == (side == "after"))))
            if count < LEAST_FRAMES:
                hint = "Track more frames, or film faster."
                wish = f"at least {LEAST_FRAMES} clear frames {side} the impact"
                raise TooFewFramesError(point, wish, str(count), hint)
        frames, is_after = frames[is_seen], is_after[is_seen]
        sigma = _sigma(motion.sigma_m[frames, motion.points.index(point)])
        time_s = motion.time_s[frames] - self.impact.time_s
        return Seen(time_s, xy[frames], sigma, is_after, 1.0 / motion.px_per_m)


def _sigma(sigma_m: FloatArray) -> FloatArray:
    """Return usable weights: unknown or zero sigmas get the usual one of the point, else 1 mm."""
    is_known = np.isfinite(sigma_m) & (sigma_m > 0)
    usual = float(np.median(sigma_m[is_known])) if is_known.any() else 1e-3
    # A tracker's sigma can be far too good in single frames; no frame may rule the fit alone.
    return np.where(is_known, np.clip(sigma_m, usual / 3.0, None), usual)


def clear_frames(motion: Motion, options: ImpactOptions, window_s: float | tuple[float, float]) -> ClearFrames:
    """Find the impact by the struck body, and the clear frames of striker and struck body about it.

    The window is `window_s` each side (or a pair: before, after), but never fewer than 10 frames where there are.

    Raises
    ------
    NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError
    """
    g = np.array(options.gravity_xy_m_s2)
    gravity = g if options.flight == "always" else None, None if options.flight == "never" else g
    seen = np.isfinite([motion.of(name) for name in (options.striker, options.struck)]).all(axis=(0, 2))
    return frames_about(motion, options.struck, np.asarray(seen), gravity, window_s)


def frames_about(
    motion: Motion,
    point: str,
    is_seen: NDArray[np.bool_],
    gravity: tuple[FloatArray | None, FloatArray | None],
    window_s: float | tuple[float, float],
) -> ClearFrames:
    """Find the impact by one point, and the frames about it in which all that is needed `is_seen`, shape (n,).

    Raises
    ------
    NoImpactError, SeveralImpactsError, UnknownNameError
    """
    time, xy = motion.time_s, motion.of(point)
    impact = find_impact(time, xy, gravity_before=gravity[0], gravity_after=gravity[1], name=point)
    frames = np.arange(len(time))
    before = frames[is_seen & (frames <= impact.last_before)][::-1]
    after = frames[is_seen & (frames >= impact.first_after)]
    windows = window_s if isinstance(window_s, tuple) else (window_s, window_s)
    sides = [_near(time, side, window) for side, window in zip((before, after), windows, strict=True)]
    for side, g in zip(sides, gravity, strict=True):
        _refuse_second_impact(time[side], xy[side], g, impact, point)
    return ClearFrames(impact, sides[0][::-1], sides[1])


def _near(time_s: FloatArray, frames: IntArray, window_s: float) -> IntArray:
    """Keep the frames of one side (nearest first) that lie in the window, or the 10 nearest."""
    if not len(frames):
        return frames
    near: NDArray[np.bool_] = np.abs(time_s[frames] - time_s[frames[0]]) <= window_s * (1 + 1e-9)
    near[:USUAL_FRAMES] = True
    return frames[near]


def _refuse_second_impact(
    time_s: FloatArray, xy_m: FloatArray, gravity: FloatArray | None, impact: Impact, name: str
) -> None:
    """Refuse a side on which the struck body's velocity jumps again by more than a tenth."""
    order = np.argsort(time_s)
    try:
        second = find_impact(time_s[order], xy_m[order], gravity_before=gravity, gravity_after=gravity, name=name)
    except NoImpactError:
        return
    jump_m_s = sudden_jump_m_s(time_s[order], xy_m[order], second.time_s)
    if np.hypot(*jump_m_s) > SECOND_SHARE * np.hypot(*impact.jump_m_s):
        hint = "Cut the clip between the impacts, or choose a shorter window."
        first_s, last_s = sorted((impact.time_s, second.time_s))
        got = f"two, at {first_s:.4f} s and {last_s:.4f} s"
        raise SeveralImpactsError(name, "one sudden change of velocity in the window", got, hint)

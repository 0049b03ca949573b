"""Which frames are compared with the model: clear of the contact, within the window, on either side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vml_course.errors import NoImpactError, SeveralImpactsError, TooFewFramesError
from vml_course.kinetics.events import Impact, find_impact
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.swing import Seen
from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.motion import Motion

LEAST_FRAMES = 5
USUAL_FRAMES = 10


@dataclass(frozen=True, eq=False, slots=True)
class ClearFrames:
    """An impact and the indices of clear frames on both sides of it."""

    impact: Impact
    before: IntArray
    after: IntArray

    def seen(self, motion: Motion, point: str) -> Seen:
        """Return one point's measured clear frames, time counted from the impact as it was found.

        Raises
        ------
        TooFewFramesError
        """
        xy, frames = motion.of(point), np.concatenate([self.before, self.after])
        is_after = np.repeat([False, True], [len(self.before), len(self.after)])
        is_seen = np.isfinite(xy[frames]).all(axis=1)
        for side, wanted in (("before", ~is_after), ("after", is_after)):
            count = int(np.sum(is_seen & wanted))
            if count < LEAST_FRAMES:
                hint = "Track more frames, or film faster."
                wish = f"at least {LEAST_FRAMES} clear frames {side} the impact"
                raise TooFewFramesError(point, wish, str(count), hint)
        frames, is_after = frames[is_seen], is_after[is_seen]
        sigma = _sigma(motion.sigma_m[frames, motion.points.index(point)])
        return Seen(motion.time_s[frames] - self.impact.time_s, xy[frames], sigma, is_after)


def _sigma(sigma_m: FloatArray) -> FloatArray:
    """Return usable weights: unknown or zero sigmas get the usual one of the point, else 1 mm."""
    is_known = np.isfinite(sigma_m) & (sigma_m > 0)
    usual = float(np.median(sigma_m[is_known])) if is_known.any() else 1e-3
    # A tracker's sigma can be far too good in single frames; no frame may rule the fit alone.
    return np.where(is_known, np.clip(sigma_m, usual / 3.0, None), usual)


def clear_frames(motion: Motion, options: ImpactOptions, window_s: float) -> ClearFrames:
    """Find the impact and the clear frames about it.

    The window is `window_s` each side, but never fewer than 10 frames where there are.

    Raises
    ------
    NoImpactError, SeveralImpactsError, TooFewFramesError, UnknownNameError
    """
    gravity = np.array(options.gravity_xy_m_s2)
    before_g = gravity if options.flight == "always" else None
    after_g = None if options.flight == "never" else gravity
    time, struck = motion.time_s, motion.of(options.struck)
    impact = find_impact(time, struck, gravity_before=before_g, gravity_after=after_g, name=options.struck)
    both = np.isfinite(motion.of(options.striker)).all(axis=1) & np.isfinite(struck).all(axis=1)
    frames = np.arange(len(time))
    before = frames[both & (frames <= impact.last_before)][::-1]
    after = frames[both & (frames >= impact.first_after)]
    sides = [_near(time, side, window_s) for side in (before, after)]
    for side, g in zip(sides, (before_g, after_g), strict=True):
        _refuse_second_impact(time[side], struck[side], g, impact, options.struck)
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
    if np.hypot(*second.jump_m_s) > 0.1 * np.hypot(*impact.jump_m_s):
        hint = "Cut the clip between the impacts, or choose a shorter window."
        first_s, last_s = sorted((impact.time_s, second.time_s))
        got = f"two, at {first_s:.4f} s and {last_s:.4f} s"
        raise SeveralImpactsError(name, "one sudden change of velocity in the window", got, hint)

"""Frames that are not what a clip says: repeated, dropped, or stamped twice.

Screen recorders and converters repeat and drop pictures without telling. A repeated picture shows bodies that stop for
one frame and then jump two steps; a dropped one shows the jump alone. Every velocity there is wrong by half or double.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.motion import Motion

REACH = 4  # steps each side that tell the usual one
STOPPED, JUMPED = 0.2, (1.6, 2.6)  # of the usual step
CLEAR_SD = 8.0  # a usual step below this many sigma cannot tell
LATE = 1.5  # of the usual time between frames


@dataclass(frozen=True, slots=True)
class FrameFaults:
    """Source frame numbers at which something is wrong.

    Attributes
    ----------
    repeated : tuple of int
        Shows the same as the frame before, though things move.
    dropped : tuple of int
        Something is missing between this frame and the one before, though the time stamps do not say so.
    gap : tuple of int
        The time stamps say that frames are missing before this one.
    duplicated : tuple of int
        Has the time stamp of the frame before, or an earlier one.
    """

    repeated: tuple[int, ...] = ()
    dropped: tuple[int, ...] = ()
    gap: tuple[int, ...] = ()
    duplicated: tuple[int, ...] = ()

    @property
    def is_clean(self) -> bool:
        """Whether nothing was found."""
        return not (self.repeated or self.dropped or self.gap or self.duplicated)

    @property
    def notes(self) -> tuple[str, ...]:
        """What was found and what to do, a line each."""
        told = {
            "repeated": (self.repeated, "show the picture before once more: delete them and number the rest again"),
            "dropped": (self.dropped, "come two steps after the one before: a picture is missing"),
            "gap": (self.gap, "come late by their time stamps: pictures are missing before them"),
            "duplicated": (self.duplicated, "have the time of the frame before: delete them"),
        }
        return tuple(
            f"frames {', '.join(map(str, frames[:8]))}{' ...' if len(frames) > 8 else ''} {what}"
            for frames, what in told.values()
            if frames
        )


def find_frame_faults(motion: Motion) -> FrameFaults:
    """Look for frames that are repeated, dropped, missing or stamped twice.

    Repeated and dropped pictures are told by steps of the points against those of their neighbours on both sides; a
    point counts where its usual step is well above its noise, and all that count must agree, so that an impact, which
    changes the step for good, is neither.
    """
    steps_s = np.diff(motion.time_s)
    usual_s = float(np.median(steps_s[steps_s > 0])) if (steps_s > 0).any() else 0.0
    even = np.abs(steps_s - usual_s) < 0.5 * usual_s
    ratio = _step_ratios(motion, even)
    frame = motion.frame[1:]
    with np.errstate(invalid="ignore"):
        repeated = (ratio < STOPPED).all(axis=1) & even & np.isfinite(ratio).any(axis=1)
        jumped = ((ratio > JUMPED[0]) & (ratio < JUMPED[1])).all(axis=1) & even & np.isfinite(ratio).any(axis=1)
    after_repeat = np.concatenate([[False], repeated[:-1]])
    return FrameFaults(
        repeated=_numbers(frame[repeated]),
        dropped=_numbers(frame[jumped & ~after_repeat]),
        gap=_numbers(frame[steps_s > LATE * usual_s]),
        duplicated=_numbers(frame[steps_s <= 0]),
    )


def _step_ratios(motion: Motion, even: NDArray[np.bool_]) -> FloatArray:
    """Return each step's length by the usual one about it, shape (n - 1, points that move); 1 where nothing is told."""
    columns = []
    for k in range(len(motion.points)):
        step = np.hypot(*np.diff(motion.xy_m[:, k], axis=0).T)
        step[~even] = np.nan
        sigma = motion.sigma_m[:, k]
        floor = CLEAR_SD * float(np.nanmedian(sigma)) if np.isfinite(sigma).any() else 1e-6
        columns.append(_against_neighbours(step, floor))
    moving = np.stack(columns, axis=1)
    # Where no point tells anything, nothing is wrong; else only those that tell count.
    told = np.isfinite(moving)
    filled = np.where(told, moving, np.nan)
    first = np.where(told.any(axis=1), np.take_along_axis(filled, told.argmax(axis=1)[:, None], axis=1)[:, 0], 1.0)
    return np.where(told, filled, first[:, None])


def _against_neighbours(step: FloatArray, floor: float) -> FloatArray:
    """Return step / usual step, NaN unless both sides' usual steps are alike and above the floor."""
    ratio = np.full(len(step), np.nan)
    for i in range(2, len(step) - 2):
        left, right = step[max(i - REACH, 0) : i], step[i + 1 : i + 1 + REACH]
        if not (np.isfinite(left).sum() >= 2 and np.isfinite(right).sum() >= 2 and np.isfinite(step[i])):
            continue
        a, b = float(np.nanmedian(left)), float(np.nanmedian(right))
        if min(a, b) > floor and max(a, b) < 1.3 * min(a, b):
            ratio[i] = step[i] / (0.5 * (a + b))
    return ratio


def _numbers(frames: IntArray) -> tuple[int, ...]:
    return tuple(int(frame) for frame in frames)

"""Motion blur: the reference block, smeared as the point's own motion smears it while the shutter is open.

A point's last places say how it moves, so where it is at every instant of the exposure. The sharp reference,
averaged over these places, is what the picture shows, and is matched in place of the sharp one. The point's place
is that at mid-exposure; an acceleration a moves the mean of the exposure by a s**2 / 24 (s the open share of a frame),
which the smeared block has in it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vml_course.correlate.bspline import Float32Array
from vml_course.correlate.exposure import Surroundings, exposed_patch, instant_count
from vml_course.correlate.template import Template, build_template
from vml_course.model.arrays import FloatArray
from vml_course.track.prediction import STEADY

WORTH_PX = 0.5  # of blur at a corner: less is not worth another template
LONGEST_PX = 60.0
SAME_WAY = 0.85  # cosine
STILL = np.zeros(2)


class Motion(NamedTuple):
    """How a block moves, with the picture interval as the unit of time.

    Attributes
    ----------
    velocity, acceleration : float array, shape (2,)
        px.
    turning : float array, shape (2, 2)
        Rate of the linear part: it is (1 + t turning) times itself after t.
    since : float
        Time, from mid-exposure, since when it moves so (it was hit then); before that as `before` says.
    before : Motion or None
    """

    velocity: FloatArray
    acceleration: FloatArray
    turning: FloatArray
    since: float = -np.inf
    before: Motion | None = None


class Sharp(NamedTuple):
    """All it takes to make a template from the reference again: its surroundings, side, warp, blur and weight."""

    around: Surroundings
    size: int
    warp: str
    blur_px: float
    weight: Float32Array | None


def motion_at(pose: FloatArray, past: tuple[FloatArray, ...], steady: int, gap: int = 1) -> Motion:
    """Return the motion of a block at `pose`, in the picture after (`gap` after) the newest of its past poses.

    The motion over the last three pictures is a parabola once it is steady, else a straight line.
    """
    newest = past[0]
    step = (pose[:2] - newest[:2]) / gap
    turn = pose[2:].reshape(2, 2) @ np.linalg.inv(newest[2:].reshape(2, 2))
    turning = 0.5 * (turn - np.linalg.inv(turn)) / gap  # the sine of the angle, for a rotation
    if len(past) < 2 or steady < STEADY or gap > 1:
        return Motion(step, STILL, turning)
    acceleration = step - (newest[:2] - past[1][:2])
    return Motion(step + 0.5 * acceleration, acceleration, turning)


def hit_at(pose: FloatArray, past: tuple[FloatArray, ...], since: float) -> Motion:
    """Return the motion of a block at `pose` that was hit after the last picture, at the time `since` (-1 to 0).

    Until then it went on as before; what it moved beyond that, it moved in the time that was left.
    """
    before = motion_at(past[0], past[1:], 0) if len(past) > 1 else Motion(STILL, STILL, np.zeros((2, 2)))
    mean = motion_at(pose, past[:1], 0)
    velocity = before.velocity + (mean.velocity - before.velocity) / -since
    turning = before.turning + (mean.turning - before.turning) / -since
    return Motion(velocity, STILL, turning, since, before)


def length_px(motion: Motion, size: int, shutter: float) -> float:
    """Return how far a corner of the block moves, at most, while the shutter is open."""
    half = 0.5 * size * 2**0.5
    return float(shutter * (np.hypot(*motion.velocity) + half * np.abs(motion.turning).max()))


def smear_px(motion: Motion, pose: FloatArray, shutter: float) -> FloatArray:
    """Return the way of the block's middle during the exposure, along the block's own axes, px: shape (2,)."""
    return np.asarray(shutter * np.linalg.solve(pose[2:].reshape(2, 2), motion.velocity))


def left_open(own_px: FloatArray, smear: FloatArray) -> float:
    """Return the share of the exposure that the reference does not show already, from both ways, px.

    Variances add: when both are smeared the same way, the reference lacks the root of the difference.
    """
    own, now = float(np.hypot(*own_px)), float(np.hypot(*smear))
    if own < WORTH_PX or (now > 0.0 and float(own_px @ smear) ** 2 < (SAME_WAY * own * now) ** 2):
        return 1.0
    return float(np.sqrt(1.0 - (own / now) ** 2)) if now > own else 0.0


def instants(motion: Motion, pose: FloatArray, shutter: float, count: int) -> FloatArray:
    """Return which place of the reference is seen at each instant: shape (count, 6), as `exposed_patch` takes it."""
    linear = pose[2:].reshape(2, 2)
    warps = []
    for t in shutter * ((np.arange(count) + 0.5) / count - 0.5):
        way, turn = _moved(motion, float(t))
        back = np.linalg.inv(turn @ linear)
        warps.append(np.concatenate([-back @ way, (back @ linear).ravel()]))
    return np.array(warps)


def _moved(motion: Motion, t: float) -> tuple[FloatArray, FloatArray]:
    """Return how a block is displaced and turned at a time from mid-exposure."""
    if t < motion.since and motion.before is not None:
        way, turn = _moved(motion, motion.since)
        back = motion.before._replace(since=-np.inf)
        further, turned = _moved(back, t - motion.since)
        return way + further, turned @ turn
    turn = np.eye(2) + t * motion.turning + 0.5 * t * t * motion.turning @ motion.turning
    return t * motion.velocity + 0.5 * t * t * motion.acceleration, turn


def exposed_template(sharp: Sharp, motion: Motion, pose: FloatArray, shutter: float) -> Template | None:
    """Return the template of the smeared block; None when it is hardly smeared, or beyond what can be made."""
    longest = length_px(motion, sharp.size, shutter)
    if not WORTH_PX < longest < LONGEST_PX:
        return None
    warps = instants(motion, pose, shutter, instant_count(longest))
    patch = exposed_patch(sharp.around, warps, sharp.size)
    try:
        return build_template(patch, sharp.warp, weight=sharp.weight, blur_px=sharp.blur_px)
    except np.linalg.LinAlgError:
        return None

"""How long the shutter was open, from the clip itself: the smear that makes the sharp block most like the picture.

While a point moves fast and steadily, its places before and after say how it moved during the exposure, all but for
how long that lasted. The reference is smeared for several open shares, each is matched, and the likeliest share is
where their ZNCC peaks. The rest is statistics: many pictures, each with its own answer, and their scatter.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import NamedTuple

import numpy as np

from vml_course.correlate.icgn import Outcome, match
from vml_course.correlate.template import read_only
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Frame, Luma
from vml_course.model.track import Seed
from vml_course.track.blur import WORTH_PX, Motion, exposed_template, left_open, length_px, motion_at, smear_px
from vml_course.track.records import Past, Reference
from vml_course.track.sweep import start_at
from vml_course.track.trackers.dic import Dic

TRIED = np.linspace(0.0, 1.0, 11)
FIRST_SHUTTERS = (0.5, 0.9)  # to follow the points by at first: sharp ones, too, for the plain block is tried beside
MOST_SHUTTER = 0.9  # to follow them by: more smear than there is loses them sooner than less
ROUNDS = 2
SETTLED = 0.03
FAST_PX = 6.0  # a picture, below which little is smeared
STEADY = 0.25  # change of the velocity, as a share of it: a hit is no steady motion
SLOW_START = 0.5  # of the fast velocity, that the reference itself may have had
TELLING = 0.004  # ZNCC that separates the likeliest share from the least likely
ENOUGH, ENOUGH_EACH = 16, 8  # samples, and of one point
FEWEST = 4
MOST_FRAMES = 1000
LARGEST_SD = 0.1
LEAST_SD = 0.02  # what the samples have in common: one reference, one texture


class Sample(NamedTuple):
    """What one point in one picture says: the open share, and the length of its way to the next picture, px."""

    shutter: float
    speed_px: float


@dataclass(frozen=True, slots=True)
class ShutterEstimate:
    """The open share of the frame interval.

    Attributes
    ----------
    shutter : float
        0 to 1; 0 when the clip does not tell.
    sigma : float
        One standard deviation; NaN when the clip does not tell.
    samples : int
        How many pictures of fast points it comes from.
    """

    shutter: float
    sigma: float
    samples: int

    @property
    def is_told(self) -> bool:
        """Whether the clip tells."""
        return bool(np.isfinite(self.sigma))


FAR = np.full(2, np.inf)
NOT_TOLD = ShutterEstimate(0.0, float("nan"), 0)


def estimate_shutter(tracker: Dic, frames: Callable[[], Iterable[Frame]], seeds: Sequence[Seed]) -> ShutterEstimate:
    """Return the share of the frame interval that the shutter was open.

    The points are followed with a first guess of it, and again with what was found, until it stays: a wrong guess moves
    a smeared point a little, and that the answer.

    Parameters
    ----------
    tracker : Dic
        Its own shutter does not matter.
    frames : callable
        Returns the same consecutive pictures each time, in either direction; no more are taken than are needed.
    seeds : sequence of Seed
        Where the points are in the first of these pictures. A point that is fast already there tells nothing: its
        block is smeared itself.

    Raises
    ------
    SeedError
        Under the point's own name, when it cannot be followed from where it was placed.
    """

    def ask(guess: float) -> ShutterEstimate:
        return conclude(list(_samples(replace(tracker, shutter=guess), frames(), seeds)))

    told, change = NOT_TOLD, 0.0
    for guess in FIRST_SHUTTERS:
        if not told.is_told:
            told, change = ask(guess), 1.0
    for _ in range(ROUNDS):
        if not told.is_told or change <= SETTLED:
            break
        again = ask(min(told.shutter, MOST_SHUTTER))
        if not again.is_told:
            break
        change = abs(again.shutter - told.shutter)
        told = replace(again, sigma=float(np.hypot(again.sigma, 0.5 * change)))
    return told


def conclude(samples: Sequence[Sample]) -> ShutterEstimate:
    """Return the median of samples, the faster ones counting more, and its standard deviation by their scatter.

    The standard deviation of a median is 1.25 times that of a mean, and the scatter 1.48 times the median deviation.
    """
    if len(samples) < FEWEST:
        return NOT_TOLD
    shutter, speed = np.array(samples).T
    middle = _weighted_median(shutter, speed)
    scatter = 1.4826 * _weighted_median(np.abs(shutter - middle), speed)
    sigma = max(1.2533 * scatter / np.sqrt(len(samples)), LEAST_SD)
    return ShutterEstimate(middle, sigma, len(samples)) if sigma <= LARGEST_SD else NOT_TOLD


def _weighted_median(values: FloatArray, weights: FloatArray) -> float:
    order = np.argsort(values)
    share = np.cumsum(weights[order]) / weights.sum()
    return float(values[order][np.searchsorted(share, 0.5)])


def _samples(tracker: Dic, frames: Iterable[Frame], seeds: Sequence[Seed]) -> Iterator[Sample]:
    first, before = None, None
    starts: dict[int, FloatArray] = {}
    taken: Counter[int] = Counter()
    for frame in islice(frames, MOST_FRAMES):
        if first is None or before is None:
            first = state = start_at(tracker, frame, seeds)[0]
        else:
            state, _ = tracker.step(state, frame.luma)
            for k, (reference, past) in enumerate(zip(state.references, state.pasts, strict=True)):
                if k not in starts:
                    starts[k] = motion_at(past.poses[0], past.poses[1:], 0).velocity if not past.lost else FAR
                sample = _sample(reference, past, starts[k], before) if taken[k] < ENOUGH_EACH else None
                if sample is not None:
                    taken[k] += 1
                    yield sample
        if taken.total() >= ENOUGH:
            return
        before = frame.luma


def _sample(reference: Reference, past: Past, start_px: FloatArray, luma: Luma) -> Sample | None:
    """Ask the picture before the newest, between whose neighbours the motion is known."""
    if past.lost or len(past.poses) < 3:
        return None
    later, pose, earlier = past.poses
    motion = between(earlier, pose, later)
    speed = float(np.hypot(*motion.velocity))
    if speed < FAST_PX or float(np.hypot(*motion.acceleration)) > STEADY * speed:
        return None
    if float(np.hypot(*start_px)) > SLOW_START * speed:
        return None
    shutter = likeliest(reference, motion, pose, start_px, luma)
    return None if shutter is None else Sample(shutter, speed)


def between(earlier: FloatArray, pose: FloatArray, later: FloatArray) -> Motion:
    """Return the motion of a block at `pose` from its poses in the pictures before and after."""
    turn = later[2:].reshape(2, 2) @ np.linalg.inv(earlier[2:].reshape(2, 2))
    turning = 0.25 * (turn - np.linalg.inv(turn))
    velocity = 0.5 * (later[:2] - earlier[:2])
    return Motion(velocity, later[:2] - 2.0 * pose[:2] + earlier[:2], turning)


def likeliest(reference: Reference, motion: Motion, pose: FloatArray, start_px: FloatArray, luma: Luma) -> float | None:
    """Return the open share whose smear makes the block most like the picture; None when that is not clear.

    The reference is smeared by its own motion at the start already, and lacks only the rest: see `left_open`.
    """
    lacking = left_open(start_px, smear_px(motion, pose, 1.0))
    picture = read_only(luma)
    return peak(np.array([_likeness(reference, motion, pose, lacking * float(s), picture) for s in TRIED]))


def _likeness(reference: Reference, motion: Motion, pose: FloatArray, shutter: float, picture: Luma) -> float:
    """Return the ZNCC of the block smeared for an open share; NaN when it cannot be smeared or matched so."""
    is_plain = length_px(motion, reference.sharp.size, shutter) <= WORTH_PX
    template = reference.template if is_plain else exposed_template(reference.sharp, motion, pose, shutter)
    if template is None:
        return float("nan")
    found = match(picture, template, pose)
    return found.zncc if found.outcome is Outcome.CONVERGED else float("nan")


def peak(alike: FloatArray) -> float | None:
    """Return where the ZNCC of the tried shares peaks, by a parabola through the three highest.

    None when they are all alike, or when the highest lies beside one that could not be had (NaN).

    >>> round(peak(1.0 - (TRIED - 0.43) ** 2), 6)
    0.43
    """
    if not np.isfinite(alike).any() or np.nanmax(alike) - np.nanmin(alike) < TELLING:
        return None
    best = int(np.nanargmax(alike))
    if best in {0, len(alike) - 1}:
        return float(TRIED[best])
    low, top, high = alike[best - 1 : best + 2]
    bend, step = low - 2.0 * top + high, TRIED[1] - TRIED[0]
    if not np.isfinite(bend):
        return None
    return float(TRIED[best] + (0.5 * step * (low - high) / bend if bend < 0.0 else 0.0))

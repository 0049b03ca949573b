"""A point that a person has placed in a picture: whether its reference block is seen there, and how it lies."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vml_course.correlate.icgn import Match, Outcome, match
from vml_course.correlate.search import search
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.model.track import Sighting, Status
from vml_course.track.ladder import DETERMINANT, REFINED, USUAL_DROP
from vml_course.track.prediction import predict
from vml_course.track.records import Past, Reference, Rules

CLICK_SD_PX = 1.0  # of one coordinate, as for the scale
REACH_PX = 6.0  # from the mark: as far off as a hand may be
ALL_ROUND_RAD = np.radians(np.arange(0.0, 360.0, 10.0))  # a point may come back turned by any angle


def place(reference: Reference, past: Past, luma: Luma, rules: Rules, xy_px: FloatArray) -> tuple[Past, Match | None]:
    """Look for a block where its point is said to be; None when it is not seen there.

    Returns
    -------
    Past
        To go on from: where the block was found, or the mark itself. Its earlier motion is believed only when the
        mark is where that would have led to.
    Match or None
    """
    expected = predict(past.poses, past.steady, past.lost + 1)
    marked = np.concatenate([xy_px, expected[2:]])
    found = _best(reference, past, luma, rules, marked)
    pose = marked if found is None else found.pose
    is_expected = not past.lost and float(np.abs(pose - expected)[:2].max()) <= REACH_PX
    poses = (pose, *past.poses[:2]) if is_expected else (pose,)
    return past._replace(poses=poses, steady=0, lost=0), found


def manual_sighting(xy_px: FloatArray, found: tuple[Match | None, ...]) -> Sighting:
    """Return places given by hand, shape (p, 2), px, as a sighting; with ZNCC and gradient where a block was seen."""
    p = len(xy_px)
    zncc, gradient, iterations = np.full(p, np.nan), np.full((p, 4), np.nan), np.zeros(p, np.int64)
    for k, one in enumerate(found):
        if one is not None:
            zncc[k], gradient[k], iterations[k] = one.zncc, one.pose[2:] - [1.0, 0.0, 0.0, 1.0], one.iterations
    return Sighting(xy_px, np.full(p, CLICK_SD_PX), zncc, iterations, np.full(p, Status.MANUAL, np.int8), gradient)


def _best(reference: Reference, past: Past, luma: Luma, rules: Rules, marked: FloatArray) -> Match | None:
    best = None
    for pose in _guesses(reference, luma, marked):
        found = match(luma, reference.template, pose, max_iterations=rules.max_iterations, max_shift_px=2.0 * REACH_PX)
        if _is_there(found, marked, rules) and (best is None or found.zncc > best.zncc):
            best = found
            if best.zncc >= past.usual_zncc - USUAL_DROP:
                break
    return best


def _guesses(reference: Reference, luma: Luma, marked: FloatArray) -> Iterator[FloatArray]:
    yield marked
    offset = (reference.template.left, reference.template.top)
    for candidate in search(luma, reference.block, offset, marked, REACH_PX, ALL_ROUND_RAD)[:REFINED]:
        yield candidate.pose


def _is_there(found: Match, marked: FloatArray, rules: Rules) -> bool:
    if found.outcome is not Outcome.CONVERGED or not found.zncc >= rules.zncc_lost:
        return False
    xx, xy, yx, yy = found.pose[2:].tolist()
    near = float(np.abs(found.pose - marked)[:2].max()) <= REACH_PX
    return near and DETERMINANT[0] <= xx * yy - xy * yx <= DETERMINANT[1]

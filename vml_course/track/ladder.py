"""Finding one block in the next picture: the likely place first, then ever wider.

Rungs: (1) where its past says, (2) where it was, (3) a search of the region around the expected place with
rotations, (4) the same over twice the region. The climb ends as soon as a match is as good as this point's
matches usually are; otherwise the best acceptable one counts, and with none the point is lost. A lost point
is looked for again in the following pictures, in a region that grows, always with the reference block.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vml_course.correlate.icgn import UNKNOWN_PACE, Match, Outcome, Pace
from vml_course.correlate.search import search
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.track.near import find_near
from vml_course.track.prediction import predict
from vml_course.track.records import Guess, Past, Reference, Rules
from vml_course.track.renewal import notice

ANGLES_RAD = np.radians([0.0, -10.0, 10.0, -20.0, 20.0, -30.0, 30.0])
USUAL_DROP = 0.15  # of ZNCC below its usual value, before another place is tried as well
MEMORY = 0.7  # share of the past in the usual ZNCC
DETERMINANT = (0.6, 1.6)  # change of area that a rigid thing in perspective can show
REFINED = 3  # candidates of a search that are worth refining
RIVAL_PX, RIVAL_ZNCC = 3.0, 0.1
JUMP_PX = 1.0  # off the expected place: the motion has changed
PULL_IN_PX = 12.0  # a candidate that moves further was another place


def follow(reference: Reference, past: Past, luma: Luma, rules: Rules) -> tuple[Past, Match | None]:
    """Find a point in the next picture; None when it is lost there."""
    if past.lost >= rules.give_up_frames:
        return past, None
    expected = predict(past.poses, past.steady, past.lost + 1)
    best, rung, own = None, 0, past.own_smear_px
    seen: list[Match] = []
    for guess in guesses(reference, past, expected, luma, rules):
        found, own_smear = find_near(reference, past, luma, rules, guess)
        if is_acceptable(found, expected, guess) and (best is None or found.zncc > best.zncc):
            best, rung, own = found, guess.rung, own_smear
        if past.lost and is_acceptable(found, expected, guess):
            seen.append(found)
        elif best is not None and best.zncc >= past.usual_zncc - USUAL_DROP and not past.lost:
            break
    if best is None or any(is_rival(other, best) for other in seen):
        return _lost(past), None
    is_expected = rung == 1 and apart_px(best.pose, expected) <= JUMP_PX
    return _found(past, best, own, is_expected=is_expected), best


def guesses(reference: Reference, past: Past, expected: FloatArray, luma: Luma, rules: Rules) -> Iterator[Guess]:
    """Yield the rungs one by one; a search is only made when its rung is reached."""
    near = rules.search_radius_px
    alike = past.usual_zncc - USUAL_DROP if past.lost else 0.0  # what comes back looks as it did; less is a look-alike
    least = max(rules.zncc_lost, alike)
    yield Guess(expected, near, near, least, 1)
    if np.abs(expected - past.poses[0]).max() > 0.5:
        yield Guess(past.poses[0], near, near + np.abs(expected - past.poses[0])[:2].max(), least, 2)
    offset = (reference.template.left, reference.template.top)
    centre = expected if past.lost else np.concatenate([expected[:2], past.poses[0][2:]])
    height, width = luma.shape
    centre = np.concatenate([np.clip(centre[:2], 0.0, [width - 1.0, height - 1.0]), centre[2:]])
    for rung, radius in enumerate(search_radii(near, past.lost), start=3):
        least = max(rules.zncc_lost if radius <= near else rules.zncc_far, alike)
        reach = radius + np.abs(expected - centre)[:2].max() + PULL_IN_PX
        for candidate in search(luma, reference.block, offset, centre, radius, ANGLES_RAD)[:REFINED]:
            yield Guess(candidate.pose, PULL_IN_PX, reach, least, rung)


def is_rival(other: Match, best: Match) -> bool:
    """Whether another place looks nearly as good: then a point that was lost cannot tell which one it is."""
    return apart_px(other.pose, best.pose) > RIVAL_PX and other.zncc > best.zncc - RIVAL_ZNCC


def apart_px(one: FloatArray, other: FloatArray) -> float:
    """Return how far apart two poses are, along x or y, whichever is more."""
    return max(abs(float(one[0]) - float(other[0])), abs(float(one[1]) - float(other[1])))


def search_radii(radius_px: float, lost: int) -> tuple[float, ...]:
    """Return the half sides of the regions to search: growing with the pictures since the point was seen."""
    if lost:
        return (radius_px * min(2.0 + 0.5 * lost, 6.0),)
    return (radius_px, 2.0 * radius_px)


def is_acceptable(found: Match, expected: FloatArray, guess: Guess) -> bool:
    """Whether a match keeps the rules: converged, alike, near, not torn."""
    if found.outcome is not Outcome.CONVERGED or not found.zncc >= guess.least_zncc:
        return False
    _, _, xx, xy, yx, yy = found.pose.tolist()
    is_near = apart_px(found.pose, expected) <= guess.radius_px
    return is_near and bool(DETERMINANT[0] <= xx * yy - xy * yx <= DETERMINANT[1])


def _lost(past: Past) -> Past:
    return past._replace(lost=past.lost + 1, steady=0)


def _found(past: Past, found: Match, own_smear_px: FloatArray | None, *, is_expected: bool) -> Past:
    """Return the past with one more sighting; after a gap the velocity is the mean over it."""
    before = past.poses
    if past.lost:
        gap = past.lost + 1
        mean_move = (found.pose[:2] - before[0][:2]) / gap
        before = (np.concatenate([found.pose[:2] - mean_move, found.pose[2:]]),)
    now = past._replace(
        poses=(found.pose, *before)[:3],
        steady=past.steady + 1 if is_expected else 0,
        lost=0,
        usual_zncc=MEMORY * past.usual_zncc + (1.0 - MEMORY) * found.zncc,
        own_smear_px=own_smear_px,
        pace=_paced(past.pace, found.pace),
    )
    return notice(now, found)


def _paced(known: Pace, measured: Pace) -> Pace:
    """Return what is to be expected of the next match: a mean of stretches, and no hasty hope of shorter steps."""
    contraction = max(measured.contraction, 0.5 * (known.contraction + measured.contraction))
    if known == UNKNOWN_PACE:
        contraction = measured.contraction
    return Pace(0.5 * (known.stretch + measured.stretch), contraction)

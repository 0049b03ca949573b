"""Matching near a guess: as the reference is, or smeared as the motion smears it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vml_course.correlate.icgn import UNKNOWN_PACE, Match, Outcome, Pace, match
from vml_course.correlate.template import Template
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.track.blur import (
    STILL,
    WORTH_PX,
    Motion,
    exposed_template,
    hit_at,
    left_open,
    length_px,
    motion_at,
    smear_px,
)
from vml_course.track.prediction import predict
from vml_course.track.records import Guess, Past, Reference, Rules

HIT_STEP = 0.15  # of the interval between two pictures
HIT_AT = tuple(-1.0 + HIT_STEP * k for k in range(1, 7))
REBUILD_PX = 0.2  # change of the smear, from the guess to the match, that is worth a second template
ROUNDS = 6  # one is enough but just after a hit, when the guess is far off
UNSTEADY_PX = 1.0


def find_near(
    reference: Reference, past: Past, luma: Luma, rules: Rules, guess: Guess
) -> tuple[Match, FloatArray | None]:
    """Match a block near a guess; with it, how the reference is smeared, as far as that is known now.

    In the second picture both templates are tried: when the plain one fits better, the reference is smeared
    already, by as much as the motion between the two says.
    """
    plain = _match(luma, reference.template, guess.pose, rules, guess, past.pace)
    if not rules.shutter:
        return plain, None
    here = plain.pose if plain.outcome is Outcome.CONVERGED else guess.pose
    motion, own = motion_at(here, past.poses, past.steady, past.lost + 1), past.own_smear_px
    smear, longest = smear_px(motion, here, rules.shutter), length_px(motion, reference.sharp.size, rules.shutter)
    if longest < WORTH_PX:
        return plain, STILL if own is None else own
    share = 1.0 if own is None else left_open(own, smear)
    if share * longest < WORTH_PX:
        return plain, own
    best = _best_of(plain, reference, past, luma, rules._replace(shutter=share * rules.shutter), guess)
    if own is None:
        own = smear if best is plain else STILL
    return best, own


def _best_of(plain: Match, reference: Reference, past: Past, luma: Luma, rules: Rules, guess: Guess) -> Match:
    """Return the best match of the plain template and the smeared ones."""
    here = plain.pose if plain.outcome is Outcome.CONVERGED else guess.pose
    start = guess._replace(pose=here)

    def smooth(pose: FloatArray) -> Motion:
        return motion_at(pose, past.poses, past.steady, past.lost + 1)

    best = _better(plain, _smeared(reference, luma, rules, start, smooth))
    off = np.abs(best.pose - predict(past.poses, past.steady, past.lost + 1))[:2].max()
    if off <= UNSTEADY_PX or past.own_smear_px is None or past.lost:
        return best
    return _after_hit(best, reference, past, luma, rules, start)


def _after_hit(best: Match, reference: Reference, past: Past, luma: Luma, rules: Rules, guess: Guess) -> Match:
    """Try the times at which the block may have been hit, then between the likeliest ones."""
    tried: dict[float, float] = {}

    def attempt(since: float) -> None:
        nonlocal best
        start = guess._replace(pose=best.pose)
        found = _smeared(reference, luma, rules, start, lambda pose: hit_at(pose, past.poses, since))
        tried[since] = -1.0 if found is None else found.zncc
        best = _better(best, found)

    for since in HIT_AT:
        attempt(since)
    for step in (0.5 * HIT_STEP, 0.25 * HIT_STEP, 0.125 * HIT_STEP):
        likely = max(tried, key=lambda since: tried[since])
        for since in (likely - step, likely + step):
            attempt(float(np.clip(since, -1.0, -0.02)))
    return best


def _better(one: Match, other: Match | None) -> Match:
    if other is None or (one.outcome is Outcome.CONVERGED and one.zncc >= other.zncc):
        return one
    return other


def _smeared(
    reference: Reference, luma: Luma, rules: Rules, guess: Guess, moves: Callable[[FloatArray], Motion]
) -> Match | None:
    """Match the block smeared by the motion up to the guess, and again by that up to where it was found."""
    found, before, pose = None, None, guess.pose
    for _ in range(ROUNDS):
        motion = moves(pose)
        smear = rules.shutter * motion.velocity
        if before is not None and np.abs(smear - before).max() < REBUILD_PX:
            break
        template = exposed_template(reference.sharp, motion, pose, rules.shutter)
        again = None if template is None else _match(luma, template, pose, rules, guess)
        if again is None or again.outcome is not Outcome.CONVERGED:
            break
        found, before, pose = again, smear, again.pose
    return found


def _match(
    luma: Luma, template: Template, pose: FloatArray, rules: Rules, guess: Guess, pace: Pace = UNKNOWN_PACE
) -> Match:
    return match(luma, template, pose, max_iterations=rules.max_iterations, max_shift_px=guess.pull_px, pace=pace)

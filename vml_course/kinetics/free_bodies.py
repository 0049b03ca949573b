"""The diagram of two free bodies that collide: drawn apart, with equal and opposite impulses, and the numbers.

Both lie as they did at the impact. A rod is drawn with its centre G and struck where the struck body met it, a puck as
a disc. Along the blow means: towards the struck body.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from vml_course.chart.shapes import GREY, INK, PALE, RED, Dot, Drawing, Line, Point, Shape, Words, arrow
from vml_course.kinetics.diagram_parts import HEIGHT, WIDTH, at, headed, short, table_of, text_of
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.straight import fit_line
from vml_course.model.arrays import FloatArray
from vml_course.model.motion import Motion
from vml_course.model.solution import Estimate, ImpactSolution

MIDDLE = (WIDTH / 2, 248.0)
APART = 118.0  # from the middle to either contact
PUSH = 84.0  # length of an arrow
RADIUS, REACH = 34.0, 120.0  # of a puck; half of a rod
NAMES = {
    "J": "impulse J", "F": "mean force J / contact time", "H": "moment about G, J b", "loss": "energy lost",
    "omega1": "ω of the rod before", "omega2": "ω of the rod after", "v_g1": "v of G before, along J",
    "v_g2": "v of G after, along J", "v_a1": "v of the striker before, along J",
    "v_a2": "v of the striker after, along J", "v_b1": "v of the struck before, along J",
    "v_b2": "v of the struck after, along J",
}  # fmt: skip


def free_bodies_diagram(
    solution: ImpactSolution, forces: Mapping[str, Estimate], options: ImpactOptions, given: Mapping[str, float]
) -> Drawing:
    """Draw both bodies of an impact in which neither is held.

    Parameters
    ----------
    solution : ImpactSolution
        By the joint method, with its `fitted` points.
    forces : mapping of str to Estimate
        Of `forces_of`: J and loss, and F where it is known.
    options : ImpactOptions
        What the points are called.
    given : mapping of str to float
        `b`, the arm of the blow about the rod's centre, where there is a rod.
    """
    if solution.fitted is None:
        raise ValueError("only a joint solution holds where the bodies were")
    n = blow(solution.fitted, options.struck, solution.value("t_impact"))
    title = f"{solution.model}: free-body diagram of the impact"
    force = forces["J"]
    numbers = {**solution.estimates, **forces}
    shapes = headed(title)
    if options.striker_mark:
        rod = _rod_at_impact(solution.fitted, options, solution.value("t_impact"), n)
        # The rod's centre is put at the picture's height, wherever it was struck.
        middle = at(MIDDLE, 2 * REACH * (rod.share - 0.5) * rod.along)
        shapes += _rod(rod, options, at(middle, -APART * n), n)
        numbers["H"] = Estimate(abs(force.value) * given["b"], force.sd * given["b"], "N m s")
    else:
        middle = MIDDLE
        shapes += _disc(at(middle, -(APART + RADIUS) * n), options.striker, -n)
    shapes += _disc(at(middle, (APART + RADIUS) * n), options.struck, n)
    shapes += _push(middle, -n, f"J = {short(force)}") + _push(middle, n, f"J = {short(force)}")
    shown = {name: numbers[name] for name in NAMES if name in numbers}
    told = "; ".join(f"{NAMES[name]} = {text_of(found)}" for name, found in shown.items())
    return Drawing(WIDTH, HEIGHT, (*shapes, *table_of(shown, NAMES)), title, told)


def blow(fitted: Motion, struck: str, impact_s: float) -> FloatArray:
    """Return the unit vector along which the struck body's velocity changed, by straight lines; (2,)."""
    xy = fitted.of(struck)
    seen, before = np.isfinite(xy).all(axis=1), fitted.time_s <= impact_s
    slopes = [
        fit_line(fitted.time_s[side], xy[side]).slope if side.sum() > 1 else np.zeros(2)
        for side in (seen & before, seen & ~before)
    ]
    # What is seen before only (a pellet that is stuck) struck along its path.
    jump = slopes[1] - slopes[0] if (seen & ~before).any() else slopes[0]
    return np.asarray(jump / max(float(np.hypot(*jump)), 1e-12))


def _push(middle: Point, way: FloatArray, words: str) -> list[Shape]:
    """Return an arrow that pushes a body away from the middle, named beside it."""
    tail, head = at(middle, (APART - PUSH) * way), at(middle, APART * way)
    up = np.array([-way[1], way[0]]) * (1.0 if way[0] >= 0 else -1.0)
    place = at(middle, (APART - 0.55 * PUSH) * way + 14.0 * up)
    anchor = "middle" if abs(way[0]) > 0.9 else "start" if up[0] > 0 else "end"
    return [*arrow(tail, head, RED, 3), Dot(head, 4, INK), Words(place, words, 12, RED, anchor)]


def _disc(middle: Point, name: str, away: FloatArray) -> list[Shape]:
    words = at(middle, (RADIUS + 16) * away)
    anchor = "middle" if abs(away[1]) > 0.7 else "start" if away[0] > 0 else "end"
    return [Dot(middle, RADIUS, PALE, GREY), Dot(middle, 2.5, INK), Words(words, name, 12, GREY, anchor)]


class _Rod(NamedTuple):
    """Direction of a rod from its first mark to the second, and where it is struck as a share of that way."""

    along: FloatArray
    share: float


def _rod_at_impact(fitted: Motion, options: ImpactOptions, impact_s: float, n: FloatArray) -> _Rod:
    """Return the rod as it lay in the last fitted frame before the impact, struck where the ball's normal meets it."""
    tail, tip, ball = (fitted.of(name) for name in (options.striker, options.striker_mark, options.struck))
    seen = np.isfinite(tail + tip + ball).all(axis=1) & (fitted.time_s <= impact_s)
    last = np.flatnonzero(seen)[-1]
    way, off = tip[last] - tail[last], ball[last] - tail[last]
    length = float(np.hypot(*way))
    along = way / length
    across = np.array([-along[1], along[0]])
    share = float(off @ along - (off @ across) / (n @ across) * (n @ along)) / length
    return _Rod(along, share)


def _rod(rod: _Rod, options: ImpactOptions, contact: Point, n: FloatArray) -> list[Shape]:
    tail, tip, centre = (at(contact, 2 * REACH * (place - rod.share) * rod.along) for place in (0.0, 1.0, 0.5))
    label = at(centre, -20.0 * n)
    shapes: list[Shape] = [Line((tail, tip), PALE, 22), Line((tail, tip), GREY, 1.0, (6, 4)), Dot(centre, 3.5, INK)]
    shapes.append(Words((label[0], label[1] + 4), "G", 13, INK, "middle"))
    for end, away, name in ((tail, -rod.along, options.striker), (tip, rod.along, options.striker_mark)):
        place = at(end, 22.0 * away)
        shapes.append(Words((place[0], place[1] + 4), name, 12, GREY, "middle"))
    return shapes

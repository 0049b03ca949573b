"""A free-body diagram of the impact, with the numbers on it: both bodies cut free, every impulse as an arrow.

The striker is drawn at the angle that it had at the impact, struck at its arm. Lengths of arrows are in proportion
among the impulses of the striker, and among the velocities.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from vml_course.chart.shapes import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PALE,
    RED,
    Dot,
    Drawing,
    Line,
    Point,
    Shape,
    Words,
    arrow,
)
from vml_course.chart.svg import to_svg
from vml_course.model.arrays import FloatArray
from vml_course.model.rounding import with_uncertainty
from vml_course.model.solution import Estimate, ImpactSolution

WIDTH, HEIGHT = 860.0, 580.0
STRIKER, STRUCK = (230.0, 252.0), (590.0, 252.0)  # middles of the two pictures
REACH = 125.0  # half of the striker's length on paper
LONGEST, RADIUS = 105.0, 30.0
TABLE_TOP = 436.0
NAMES = {
    "J": "impulse J", "F": "mean force J / contact time", "H": "moment of the impulse J a", "R": "pin reaction R",
    "loss": "energy lost", "omega1": "ω before", "omega2": "ω after", "v_b1": "v before, along J",
    "v_b2": "v after, along J",
}  # fmt: skip


def free_body_diagram(solution: ImpactSolution, forces: Mapping[str, Estimate]) -> Drawing:
    """Draw both bodies of a pinned impact free of one another.

    Parameters
    ----------
    solution : ImpactSolution
        Of a pinned model, with its pivot and angle among the figures.
    forces : mapping of str to Estimate
        Of `forces_of`: J, and R, F, H, loss where they are known.
    """
    along = _unit(solution.figures["theta_impact_rad"])
    # Square to the striker: the tilt of a real normal is a few degrees.
    n = math.copysign(1.0, _towards(solution)) * np.array([-along[1], along[0]])
    pivot, foot = _at(STRIKER, -REACH * along), _at(STRIKER, REACH * along)
    share = min(solution.value("a") / solution.figures["arc_radius_m"], 1.0)
    contact = _at(pivot, 2 * REACH * share * along)
    title = f"{solution.model}: free-body diagram of the impact"
    shapes: list[Shape] = [
        Words((28, 34), title, 18, INK, is_bold=True),
        Words((28, 56), "what each body receives during the contact; the weight hardly counts beside it", 12, GREY),
    ]
    shapes += _striker(pivot, foot, contact, n, forces)
    shapes += _struck(n, solution, forces)
    numbers = {**{name: solution.estimates[name] for name in ("omega1", "omega2", "v_b1", "v_b2")}, **forces}
    shown = {name: numbers[name] for name in NAMES if name in numbers}
    shapes += _table(shown)
    told = "; ".join(f"{NAMES[name]} = {_text(found)}" for name, found in shown.items())
    return Drawing(WIDTH, HEIGHT, tuple(shapes), title, told)


def free_body_svg(solution: ImpactSolution, forces: Mapping[str, Estimate]) -> str:
    """Return `free_body_diagram` as SVG text."""
    return to_svg(free_body_diagram(solution, forces))


def _striker(pivot: Point, foot: Point, contact: Point, n: FloatArray, forces: Mapping[str, Estimate]) -> list[Shape]:
    """Return the pivoted body with -J at the contact and R at the pin."""
    size = LONGEST / max(abs(forces["J"].value), abs(forces.get("R", forces["J"]).value))
    shapes: list[Shape] = [Line((pivot, foot), PALE, 26), Line((pivot, foot), GREY, 1.0, (6, 4))]
    shapes += [Dot(pivot, 7, "#ffffff", INK), Dot(pivot, 2.5, INK), Dot(contact, 4, INK)]
    shapes += _named_arrow(contact, -n * size * forces["J"].value, f"J = {_short(forces['J'])}", RED, 3)
    if "R" in forces:
        shapes += _named_arrow(pivot, n * size * forces["R"].value, f"R = {_short(forces['R'])}", GREEN, 3)
    return shapes


def _struck(n: FloatArray, solution: ImpactSolution, forces: Mapping[str, Estimate]) -> list[Shape]:
    """Return the struck body with J, and its velocities before and after beside it."""
    shapes: list[Shape] = [Dot(STRUCK, RADIUS, PALE, GREY), Dot(STRUCK, 2.5, INK)]
    edge = _at(STRUCK, -RADIUS * n)
    tail = _at(edge, -n * LONGEST)
    shapes += [*arrow(tail, edge, RED, 3), *_label(tail, -n, f"J = {_short(forces['J'])}", RED)]
    speeds = solution.estimates["v_b1"], solution.estimates["v_b2"]
    fastest = max(abs(speed.value) for speed in speeds)
    is_level = abs(n[0]) > abs(n[1])
    for k, (speed, colour, when) in enumerate(zip(speeds, (BLUE, ORANGE), ("before", "after"), strict=True)):
        aside = np.array([0.0, -(RADIUS + 34.0 + 46.0 * k)]) if is_level else np.array([RADIUS + 30.0 + 105.0 * k, 0.0])
        words, start = f"{when}: {_short(speed)}", _at(STRUCK, aside)
        if abs(speed.value) < max(0.002 * fastest, 3.0 * speed.sd):
            words = f"{when}: at rest"
            shapes += [Dot(start, 3, colour), Words((start[0], start[1] - 8), words, 12, colour, "middle")]
        else:
            shapes += _named_arrow(start, n * 0.8 * LONGEST * speed.value / fastest, words, colour, 2)
    return shapes


def _named_arrow(tail: Point, way: FloatArray, words: str, colour: str, width: float) -> list[Shape]:
    """Return an arrow with its name: above a level one's middle, beyond the tip of an upright one."""
    head = _at(tail, way)
    if abs(way[0]) > abs(way[1]):
        middle = 0.5 * (tail[0] + head[0]) + 0.15 * (head[0] - tail[0])
        return [*arrow(tail, head, colour, width), Words((middle, tail[1] - 11), words, 12, colour, "middle")]
    return [*arrow(tail, head, colour, width), *_label(head, way, words, colour)]


def _label(at: Point, away: FloatArray, words: str, colour: str) -> list[Shape]:
    """Return words beyond a point in the direction away from the drawing, or above a level arrow's tail."""
    if abs(away[0]) > abs(away[1]):
        return [Words((at[0] - 0.5 * math.copysign(LONGEST, away[0]), at[1] - 11), words, 12, colour, "middle")]
    return [Words((at[0], at[1] + (-10 if away[1] > 0 else 18)), words, 12, colour, "middle")]


def _table(shown: Mapping[str, Estimate]) -> list[Shape]:
    """Return all numbers with their uncertainty beneath, in two columns."""
    shapes: list[Shape] = [Line(((28, TABLE_TOP), (WIDTH - 28, TABLE_TOP)), GREY, 0.8)]
    for k, (name, found) in enumerate(shown.items()):
        left, top = 28 + 420 * (k // 5), TABLE_TOP + 26 + 24 * (k % 5)
        shapes += [Words((left, top), NAMES[name], 12, GREY), Words((left + 190, top), _text(found), 12, INK)]
    return shapes


def _towards(solution: ImpactSolution) -> float:
    """Return whether a counter-clockwise rate moves the striking point towards the struck body: its sign."""
    pairs = (("v_f1", "omega1"), ("v_f2", "omega2"))
    return sum(solution.value(speed) * solution.value(rate) for speed, rate in pairs)


def _unit(angle_rad: float) -> FloatArray:
    return np.array([math.cos(angle_rad), math.sin(angle_rad)])


def _at(start: Point, way: FloatArray) -> Point:
    """Go from a place on paper (y down) by a way in the world (y up)."""
    return float(start[0] + way[0]), float(start[1] - way[1])


def _text(found: Estimate) -> str:
    return f"{with_uncertainty(found.value, found.sd)} {found.unit}".strip()


def _short(found: Estimate) -> str:
    return f"{found.value:.4g} {found.unit}".strip().replace("-", "−")

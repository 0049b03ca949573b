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
from vml_course.kinetics.diagram_parts import (
    HEIGHT,
    LONGEST,
    WIDTH,
    at,
    beside,
    headed,
    named_arrow,
    short,
    table_of,
    text_of,
    unit,
)
from vml_course.model.arrays import FloatArray
from vml_course.model.solution import Estimate, ImpactSolution

STRIKER, STRUCK = (230.0, 252.0), (590.0, 252.0)  # middles of the two pictures
REACH = 125.0  # half of the striker's length on paper
RADIUS = 30.0
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
    along = unit(solution.figures["theta_impact_rad"])
    # Square to the striker: the tilt of a real normal is a few degrees.
    n = math.copysign(1.0, _towards(solution)) * np.array([-along[1], along[0]])
    pivot, foot = at(STRIKER, -REACH * along), at(STRIKER, REACH * along)
    share = min(solution.value("a") / solution.figures["arc_radius_m"], 1.0)
    contact = at(pivot, 2 * REACH * share * along)
    title = f"{solution.model}: free-body diagram of the impact"
    shapes = headed(title)
    shapes += _striker(pivot, foot, contact, n, forces)
    shapes += _struck(n, solution, forces)
    numbers = {**{name: solution.estimates[name] for name in ("omega1", "omega2", "v_b1", "v_b2")}, **forces}
    shown = {name: numbers[name] for name in NAMES if name in numbers}
    shapes += table_of(shown, NAMES)
    told = "; ".join(f"{NAMES[name]} = {text_of(found)}" for name, found in shown.items())
    return Drawing(WIDTH, HEIGHT, tuple(shapes), title, told)


def free_body_svg(solution: ImpactSolution, forces: Mapping[str, Estimate]) -> str:
    """Return `free_body_diagram` as SVG text."""
    return to_svg(free_body_diagram(solution, forces))


def _striker(pivot: Point, foot: Point, contact: Point, n: FloatArray, forces: Mapping[str, Estimate]) -> list[Shape]:
    """Return the pivoted body with -J at the contact and R at the pin."""
    size = LONGEST / max(abs(forces["J"].value), abs(forces.get("R", forces["J"]).value))
    shapes: list[Shape] = [Line((pivot, foot), PALE, 26), Line((pivot, foot), GREY, 1.0, (6, 4))]
    shapes += [Dot(pivot, 7, "#ffffff", INK), Dot(pivot, 2.5, INK), Dot(contact, 4, INK)]
    shapes += named_arrow(contact, -n * size * forces["J"].value, f"J = {short(forces['J'])}", RED, 3)
    if "R" in forces:
        shapes += named_arrow(pivot, n * size * forces["R"].value, f"R = {short(forces['R'])}", GREEN, 3)
    return shapes


def _struck(n: FloatArray, solution: ImpactSolution, forces: Mapping[str, Estimate]) -> list[Shape]:
    """Return the struck body with J, and its velocities before and after beside it."""
    shapes: list[Shape] = [Dot(STRUCK, RADIUS, PALE, GREY), Dot(STRUCK, 2.5, INK)]
    edge = at(STRUCK, -RADIUS * n)
    tail = at(edge, -n * LONGEST)
    shapes += [*arrow(tail, edge, RED, 3), *beside(tail, -n, f"J = {short(forces['J'])}", RED)]
    speeds = solution.estimates["v_b1"], solution.estimates["v_b2"]
    fastest = max(abs(speed.value) for speed in speeds)
    is_level = abs(n[0]) > abs(n[1])
    for k, (speed, colour, when) in enumerate(zip(speeds, (BLUE, ORANGE), ("before", "after"), strict=True)):
        aside = np.array([0.0, -(RADIUS + 34.0 + 46.0 * k)]) if is_level else np.array([RADIUS + 30.0 + 105.0 * k, 0.0])
        words, start = f"{when}: {short(speed)}", at(STRUCK, aside)
        if abs(speed.value) < max(0.002 * fastest, 3.0 * speed.sd):
            words = f"{when}: at rest"
            shapes += [Dot(start, 3, colour), Words((start[0], start[1] - 8), words, 12, colour, "middle")]
        else:
            shapes += named_arrow(start, n * 0.8 * LONGEST * speed.value / fastest, words, colour, 2)
    return shapes


def _towards(solution: ImpactSolution) -> float:
    """Return whether a counter-clockwise rate moves the striking point towards the struck body: its sign."""
    pairs = (("v_f1", "omega1"), ("v_f2", "omega2"))
    return sum(solution.value(speed) * solution.value(rate) for speed, rate in pairs)

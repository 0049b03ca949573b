"""What free-body diagrams are put together from: named arrows, numbers in a table, places on paper."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from vml_course.chart.shapes import GREY, INK, Line, Point, Shape, Words, arrow
from vml_course.model.arrays import FloatArray
from vml_course.model.rounding import with_uncertainty
from vml_course.model.solution import Estimate

WIDTH, HEIGHT = 860.0, 580.0
LONGEST = 105.0  # arrow on paper
TABLE_TOP = 436.0


def headed(title: str) -> list[Shape]:
    """Return the title of a diagram, and what its arrows are."""
    words = "what each body receives during the contact; the weight hardly counts beside it"
    return [Words((28, 34), title, 18, INK, is_bold=True), Words((28, 56), words, 12, GREY)]


def named_arrow(tail: Point, way: FloatArray, words: str, colour: str, width: float) -> list[Shape]:
    """Return an arrow with its name: above a level one's middle, beyond the tip of an upright one."""
    head = at(tail, way)
    if abs(way[0]) > abs(way[1]):
        middle = 0.5 * (tail[0] + head[0]) + 0.15 * (head[0] - tail[0])
        return [*arrow(tail, head, colour, width), Words((middle, tail[1] - 11), words, 12, colour, "middle")]
    return [*arrow(tail, head, colour, width), *beside(head, way, words, colour)]


def beside(place: Point, away: FloatArray, words: str, colour: str) -> list[Shape]:
    """Return words beyond a point in the direction away from the drawing, or above a level arrow's tail."""
    if abs(away[0]) > abs(away[1]):
        return [Words((place[0] - 0.5 * math.copysign(LONGEST, away[0]), place[1] - 11), words, 12, colour, "middle")]
    return [Words((place[0], place[1] + (-10 if away[1] > 0 else 18)), words, 12, colour, "middle")]


def table_of(shown: Mapping[str, Estimate], names: Mapping[str, str]) -> list[Shape]:
    """Return all numbers with their uncertainty beneath, in two columns."""
    rows = (len(shown) + 1) // 2
    shapes: list[Shape] = [Line(((28, TABLE_TOP), (WIDTH - 28, TABLE_TOP)), GREY, 0.8)]
    for k, (name, found) in enumerate(shown.items()):
        left, top = 28 + 420 * (k // rows), TABLE_TOP + 26 + 24 * (k % rows)
        shapes += [Words((left, top), names[name], 12, GREY), Words((left + 190, top), text_of(found), 12, INK)]
    return shapes


def unit(angle_rad: float) -> FloatArray:
    """Return the unit vector at an angle."""
    return np.array([math.cos(angle_rad), math.sin(angle_rad)])


def at(start: Point, way: FloatArray) -> Point:
    """Go from a place on paper (y down) by a way in the world (y up)."""
    return float(start[0] + way[0]), float(start[1] - way[1])


def text_of(found: Estimate) -> str:
    """Return value, uncertainty and unit."""
    return f"{with_uncertainty(found.value, found.sd)} {found.unit}".strip()


def short(found: Estimate) -> str:
    """Return value and unit, for beside an arrow."""
    return f"{found.value:.4g} {found.unit}".strip().replace("-", "−")

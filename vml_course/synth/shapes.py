"""Signed distances to plain shapes, in metres: negative inside. What is drawn exactly can be measured exactly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vml_course.synth.canvas import Canvas
from vml_course.synth.texture import Plane

Point = tuple[float, float]
FAR_M = 100.0


def disc(on: Canvas, centre: Point, radius: float) -> Plane:
    """Return the distance to a disc."""
    return np.asarray(np.hypot(on.x_m - centre[0], on.y_m - centre[1]) - radius, dtype=np.float32)


def box(on: Canvas, low: Point, high: Point) -> Plane:
    """Return the distance to an upright rectangle from its lower left to its upper right corner."""
    across = np.maximum(low[0] - on.x_m, on.x_m - high[0])
    along = np.maximum(low[1] - on.y_m, on.y_m - high[1])
    return np.asarray(np.maximum(across, along), dtype=np.float32)


def tapered(on: Canvas, tail: tuple[Point, float], head: tuple[Point, float]) -> Plane:
    """Return the distance to the hull of two discs (centre, radius): a limb.

    The hull's flank leans by an angle whose sine is the difference of the radii over the distance. Only
    around the hull is the distance worked out; farther away it is only said to be `FAR_M`.
    """
    (ax, ay), ra = tail
    (bx, by), rb = head
    distance = np.full(on.opacity.shape, FAR_M, np.float32)
    near = on.near((min(ax - ra, bx - rb), min(ay - ra, by - rb)), (max(ax + ra, bx + rb), max(ay + ra, by + rb)))
    rows, columns = (round(of - part) for of, part in zip(on.origin[::-1], near.origin[::-1], strict=True))
    height, width = near.opacity.shape
    distance[rows : rows + height, columns : columns + width] = _hull(near, tail, head)
    return distance


def _hull(on: Canvas, tail: tuple[Point, float], head: tuple[Point, float]) -> Plane:
    (ax, ay), ra = tail
    (bx, by), rb = head
    length = float(np.hypot(bx - ax, by - ay))
    ux, uy = (bx - ax) / length, (by - ay) / length
    along = (on.x_m - ax) * ux + (on.y_m - ay) * uy
    across = np.abs((on.x_m - ax) * uy - (on.y_m - ay) * ux)
    sine = (ra - rb) / length
    cosine = float(np.sqrt(1.0 - sine * sine))
    slide = along - across * sine / cosine  # which disc, or the flank, is nearest
    flank = along * sine + across * cosine - ra
    ends = np.where(slide < 0, np.hypot(along, across) - ra, np.hypot(along - length, across) - rb)
    return np.asarray(np.where((slide >= 0) & (slide <= length), flank, ends), dtype=np.float32)


def polygon(on: Canvas, corners: Sequence[Point]) -> Plane:
    """Return the distance to a convex polygon, corners counter-clockwise (y up)."""
    sides = [
        ((x2 - x1) * (y1 - on.y_m) - (y2 - y1) * (x1 - on.x_m)) / np.hypot(x2 - x1, y2 - y1)
        for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]], strict=True)
    ]
    return np.asarray(np.maximum.reduce(np.broadcast_arrays(*sides)), dtype=np.float32)


def union(*distances: Plane) -> Plane:
    """Return the distance to whichever shape is nearer."""
    return np.asarray(np.minimum.reduce(distances))


def both(*distances: Plane) -> Plane:
    """Return the distance to what the shapes have in common."""
    return np.asarray(np.maximum.reduce(np.broadcast_arrays(*distances)))

"""A post that holds a pivot."""

from __future__ import annotations

from vml_course.synth.canvas import Canvas
from vml_course.synth.shapes import Point, disc, polygon, tapered

STEEL = (104.0, 110.0, 118.0)
EDGE = (70.0, 74.0, 80.0)


def draw_stand(on: Canvas, pivot_m: Point, foot_m: Point) -> None:
    """Draw a steel post from the floor to a pivot, behind everything that moves."""
    (x, y), (x0, y0) = pivot_m, foot_m
    on.fill(tapered(on, ((x0, y0 + 0.022), 0.022), ((x0, y), 0.022)), STEEL)
    on.fill(tapered(on, ((x0, y), 0.022), ((x, y), 0.022)), STEEL)
    base = [(x0 - 0.12, y0 - 0.012), (x0 + 0.12, y0 - 0.012), (x0 + 0.07, y0 + 0.02), (x0 - 0.07, y0 + 0.02)]
    on.fill(polygon(on, base), EDGE)
    on.fill(disc(on, pivot_m, 0.034), EDGE)

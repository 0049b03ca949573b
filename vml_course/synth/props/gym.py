"""What stands and hangs still around a kick: a tee under the ball, and a thigh that ends at the knee."""

from __future__ import annotations

from vml_course.synth.canvas import Canvas
from vml_course.synth.shapes import Point, box, polygon, tapered
from vml_course.synth.texture import grain

TEE = (64.0, 70.0, 78.0)
SKIN = (198.0, 150.0, 122.0)
SHORTS = (226.0, 226.0, 230.0)


def draw_tee(on: Canvas, top_m: Point, floor_m: float) -> None:
    """Draw a tee from the floor to its top."""
    x, y = top_m
    base = floor_m - 0.014
    on = on.near((x - 0.07, base - 0.02), (x + 0.07, y + 0.02))
    stem = [(x - 0.03, base), (x + 0.03, base), (x + 0.008, y + 0.004), (x - 0.008, y + 0.004)]
    on.fill(polygon(on, stem), TEE)
    on.fill(box(on, (x - 0.03, y - 0.012), (x + 0.03, y + 0.002)), TEE)
    on.fill(box(on, (x - 0.06, base - 0.008), (x + 0.06, base + 0.006)), TEE)


def draw_thigh(on: Canvas, seed: int) -> None:
    """Draw a thigh in shorts down to the knee, which is the world's origin."""
    knee, hip = ((0.0, 0.0), 0.092), ((-0.16, 0.50), 0.13)
    on = on.near((-0.5, -0.1), (0.2, 0.8))
    thigh = tapered(on, knee, hip)
    on.fill(thigh, SKIN)
    shape = (on.opacity.shape[0], on.opacity.shape[1])
    on.lighten(6.0 * grain(seed, "thigh", shape, 1.0), thigh)
    leg_of_shorts = [(-0.27, 0.19), (0.07, 0.26), (0.12, 0.8), (-0.42, 0.8)]
    on.fill(polygon(on, leg_of_shorts), SHORTS)

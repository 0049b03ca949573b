"""What to calibrate with: a ranging pole with its length written beside it."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np

from vml_course.synth.canvas import Canvas
from vml_course.synth.props import lettering
from vml_course.synth.props.target import draw_pole
from vml_course.synth.shapes import Point

INK = (30.0, 30.0, 32.0)


def draw_bar(on: Canvas, marks_m: Mapping[str, Point]) -> None:
    """Draw a pole between the marks `bar_left` and `bar_right`, its length behind its end, 22 px high."""
    left, right = marks_m["bar_left"], marks_m["bar_right"]
    draw_pole(on, left, right)
    length = round(right[0] - left[0], 6)
    text, high = (f"{length:g} m" if length >= 1 else f"{100 * length:g} cm"), 22.0 / on.samples_per_m
    lettering.write(on, text, (right[0] + 2.6 * high, left[1]), high, INK)


def draw_scale(on: Canvas, marks_m: Mapping[str, Point]) -> None:
    """Draw a pole with its length between the marks `bar_left` and `bar_right`, where there are any."""
    if "bar_left" in marks_m:
        left, right = marks_m["bar_left"], marks_m["bar_right"]
        draw_pole(on, left, right)
        _write(on, f"{right[0] - left[0]:g} m", (right[0] + 0.03, left[1] - 0.014))


def _write(on: Canvas, text: str, at_m: Point) -> None:
    """Write into the picture; letters are 4.5 cm high."""
    column = round(at_m[0] * on.samples_per_m + on.origin[0])
    row = round(on.origin[1] - at_m[1] * on.samples_per_m)
    ink = np.zeros(on.opacity.shape, np.uint8)
    size = 0.045 * on.samples_per_m / lettering.CAPITAL
    cv2.putText(ink, text, (column, row), cv2.FONT_HERSHEY_SIMPLEX, size, 255, max(1, round(2.2 * size)), cv2.LINE_AA)
    on.fill((0.5 - ink.astype(np.float32) / 255.0) / on.samples_per_m, INK)

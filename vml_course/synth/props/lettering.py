"""Printed letters and numbers."""

from __future__ import annotations

import cv2
import numpy as np

from vml_course.synth.canvas import Canvas, Colour
from vml_course.synth.shapes import Point
from vml_course.synth.texture import Plane

CAPITAL = 22.0  # height of this face's capitals, in samples, at scale 1


def write(on: Canvas, text: str, at_m: Point, height_m: float, rgb: Colour, *, inside_m: Plane | None = None) -> None:
    """Write a line whose middle is `at_m`, with capitals `height_m` high, only where a distance is negative."""
    scale = height_m * on.samples_per_m / CAPITAL
    thick = max(1, round(2.6 * scale))
    (width, height), _ = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, thick)
    column = round(on.origin[0] + at_m[0] * on.samples_per_m - width / 2)
    row = round(on.origin[1] - at_m[1] * on.samples_per_m + height / 2)
    ink = np.zeros(on.opacity.shape, np.uint8)
    cv2.putText(ink, text, (column, row), cv2.FONT_HERSHEY_SIMPLEX, scale, 255, thick, cv2.LINE_AA)
    distance = (0.5 - ink.astype(np.float32) / 255.0) / on.samples_per_m
    on.fill(np.asarray(distance if inside_m is None else np.maximum(distance, inside_m), np.float32), rgb)

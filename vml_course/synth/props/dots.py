"""Sprayed speckle, as for digital image correlation: black dots at random places on white, half of it covered."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from vml_course.synth.canvas import Canvas
from vml_course.synth.sprite import OVERSAMPLE
from vml_course.synth.texture import Plane, raw_bits

COVERED = 0.5
UNEVEN = 0.3  # how far a dot's diameter lies from the usual one, at most
DARK, LIGHT = 28.0, 232.0


def spray(on: Canvas, seed: int, inside_m: Plane, size_px: float, contrast: float) -> None:
    """Paint a surface, where a distance is negative, and spray dots on it.

    Parameters
    ----------
    size_px : float
        Usual diameter of a dot.
    contrast : float
        1 is black on white; with less, both go to the grey between.
    """
    middle, half = (LIGHT + DARK) / 2, contrast * (LIGHT - DARK) / 2
    on.fill(inside_m, (middle + half,) * 3)
    dots = _distance(seed, on.opacity.shape, size_px * OVERSAMPLE / 2) / np.float32(on.samples_per_m)
    on.fill(np.maximum(dots, inside_m), (middle - half,) * 3)


def _distance(seed: int, shape: tuple[int, ...], radius: float) -> Plane:
    """Return the distance from each sample to the nearest dot's rim, in samples, where it is small."""
    rows, columns = shape
    # Of dots at random places, a part exp(-number x area / whole) of the surface stays free.
    area = math.pi * radius**2 * (1 + UNEVEN**2 / 3)
    count = round(-math.log(1 - COVERED) * rows * columns / area)
    x, y, size = raw_bits(seed, "dots", 3 * count).reshape(3, count).astype(np.float64) / 2.0**64
    x, y, size = x * columns, y * rows, radius * (1 + UNEVEN * (2 * size - 1))
    reach = math.ceil(radius * (1 + UNEVEN)) + 1
    distance = np.full((rows, columns), reach, np.float32)
    _keep_nearest(distance, np.stack([x, y, size], axis=-1), reach)
    return distance


@njit(cache=True, nogil=True)
def _keep_nearest(distance, dots, reach):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    rows, columns = distance.shape
    for x, y, size in dots:
        for i in range(max(0, int(y) - reach), min(rows, int(y) + reach + 1)):
            for j in range(max(0, int(x) - reach), min(columns, int(x) + reach + 1)):
                distance[i, j] = min(distance[i, j], np.float32(np.sqrt((j - x) ** 2 + (i - y) ** 2) - size))

"""Reads a drawing at places that differ from pixel to pixel and in poses that differ from row to row.

This is what a bent or tilted picture and a rolling shutter need; for a square camera whose rows are all
exposed at once, `overlay` and `smear` do the same faster.
"""

from __future__ import annotations

import numpy as np
from numba import njit, uint64

from vml_course.model.arrays import FloatArray
from vml_course.synth.texture import Plane

TILE = 16
f4 = np.float32


def add_gathered(drawing: Plane, ways: FloatArray, places: FloatArray, total: Plane) -> None:
    """Add a drawing to `total`, once for each instant, bilinearly.

    Parameters
    ----------
    drawing : float32 array, shape (h, w, c)
        Its outermost samples are empty.
    ways : float array, shape (k, rows, 2, 3) or (k, 1, 2, 3)
        From places to column and row of the drawing, at each instant, for each row or for all.
    places : float array, shape (rows, columns, 2)
        What each pixel of `total` looks at.
    total : float32 array, shape (rows, columns, c)
    """
    _add_tiles(drawing, np.ascontiguousarray(ways), places, total, (0,) * drawing.shape[2])


@njit(cache=True, nogil=True, error_model="numpy")
def _add_tiles(drawing, ways, places, total, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    rows, columns = total.shape[:2]
    for top in range(0, rows, TILE):
        for left in range(0, columns, TILE):
            right = min(left + TILE, columns)
            for k in range(len(ways)):
                for y in range(top, min(top + TILE, rows)):
                    way = ways[k, y if ways.shape[1] > 1 else 0]
                    _add_row(drawing, way, places[y, left:right], total[y, left:right], colours)


@njit(cache=True, nogil=True, error_model="numpy")
def _add_row(drawing, way, places, row, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    flat, depth = drawing.ravel(), uint64(len(colours))
    stride = uint64(drawing.shape[1]) * depth
    last_u, last_v = drawing.shape[1] - 1.001, drawing.shape[0] - 1.001
    for x in range(len(row)):
        u = way[0, 0] * places[x, 0] + way[0, 1] * places[x, 1] + way[0, 2]
        v = way[1, 0] * places[x, 0] + way[1, 1] * places[x, 1] + way[1, 2]
        if not (0.0 <= u <= last_u and 0.0 <= v <= last_v):
            continue
        i, j = int(v), int(u)
        p, q = f4(u - j), f4(v - i)
        here = uint64(i) * stride + uint64(j) * depth
        for c in range(len(colours)):
            a, b = flat[here + c], flat[here + depth + c]
            d, e = flat[here + stride + c], flat[here + stride + depth + c]
            upper, lower = a + p * (b - a), d + p * (e - d)
            row[x, c] += upper + q * (lower - upper)

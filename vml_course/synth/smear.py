"""Adds up a drawing at many places: what motion blur costs its time for.

Bilinear like `sprite`, but it only visits pixels that the drawing reaches (a leaning leg fills a quarter of
the box around it), and goes by tiles: what all instants need of the drawing then stays in the cache.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit, uint64

from vml_course.model.arrays import FloatArray
from vml_course.synth.texture import Plane

TILE = 16
f4 = np.float32


def add_warps(drawing: Plane, matrices: FloatArray, total: Plane) -> None:
    """Add a drawing to `total`, once for each matrix.

    Parameters
    ----------
    drawing : float32 array, shape (h, w, c)
        Its outermost samples are empty.
    matrices : float array, shape (k, 2, 3)
        From a pixel (x, y) of `total` to column and row of the drawing.
    total : float32 array, shape (rows, columns, c)
    """
    # A tuple's length is known to the compiler, which then writes the few colours out one by one.
    _add_tiles(drawing, np.ascontiguousarray(matrices), total, (0,) * drawing.shape[2])


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _add_tiles(drawing, matrices, total, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    rows, columns = total.shape[:2]
    for top in range(0, rows, TILE):
        for left in range(0, columns, TILE):
            for k in range(len(matrices)):
                for y in range(top, min(top + TILE, rows)):
                    _add_row(drawing, matrices[k], (left, y), total[y, left : left + TILE], colours)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _add_row(drawing, matrix, first, row, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    across, down, (left, y) = matrix[0, 0], matrix[1, 0], first
    u0 = across * left + matrix[0, 1] * y + matrix[0, 2]
    v0 = down * left + matrix[1, 1] * y + matrix[1, 2]
    low, high = _narrow(0.0, row.shape[0] - 1.0, u0, across, drawing.shape[1] - 1.001)
    low, high = _narrow(low, high, v0, down, drawing.shape[0] - 1.001)
    flat, depth = drawing.ravel(), uint64(len(colours))
    stride = uint64(drawing.shape[1]) * depth
    for x in range(math.ceil(low), math.floor(high) + 1):
        u, v = u0 + across * x, v0 + down * x
        i, j = int(v), int(u)
        p, q = f4(u - j), f4(v - i)
        here = uint64(i) * stride + uint64(j) * depth
        for c in range(len(colours)):
            a, b = flat[here + c], flat[here + depth + c]
            d, e = flat[here + stride + c], flat[here + stride + depth + c]
            upper, lower = a + p * (b - a), d + p * (e - d)
            row[x, c] += upper + q * (lower - upper)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _narrow(low, high, start, step, most):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    """Return the part of low..high in which start + step x lies from 0 to `most`."""
    if abs(step) < 1e-12:
        return (low, high) if 0.0 <= start <= most else (1.0, 0.0)
    first, last = -start / step, (most - start) / step
    return max(low, min(first, last)), min(high, max(first, last))

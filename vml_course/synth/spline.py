"""Reads drawings by quadratic B-splines: the one kernel that lays, smears and gathers.

Nine samples, with weights that keep the first moment exactly (nothing is shifted) and the second constant
(nothing is sharper in one place than in another, as with bilinear reading): the spline blurs by a variance of
1/4 sample wherever it reads, and the drawing's own blur is that much less (`sprite.make_sprite`). Therefore two
samples a pixel are enough (Unser 1999, Splines: a perfect fit for signal and image processing, IEEE Signal
Processing Magazine 16).

A leaning leg fills a quarter of the box around it: only pixels that look into the drawing are visited, and of these
only those that look at a block in which something is drawn. Tiles keep what is needed of the drawing in the cache.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np
from numba import njit, uint64
from numpy.typing import NDArray

from vml_course.model.arrays import FloatArray
from vml_course.synth.texture import Plane

VARIANCE = 0.25  # of the spline, in samples
TILE = 16  # rows
WIDE = 64  # columns: long enough for what is worked out once a row
BLOCK_BITS = 3
f4 = np.float32


class Drawing(NamedTuple):
    """What is read.

    Attributes
    ----------
    samples : float32 array, shape (h, w, c)
        Colours times opacity, and last the opacity; the outermost samples are empty.
    drawn : uint8 array, shape (h / 8 + 1, w / 8 + 1)
        In which blocks of 8 x 8 samples something is drawn, in them or one sample around.
    flat : float32 array
        The samples in one row.
    """

    samples: Plane
    drawn: NDArray[np.uint8]
    flat: Plane


def make_drawing(samples: Plane) -> Drawing:
    """Note where something is drawn."""
    side = 1 << BLOCK_BITS
    wide = cv2.dilate((samples[..., -1] != 0).astype(np.uint8), np.ones((3, 3), np.uint8))
    rows, columns = (side * (length // side + 1) for length in wide.shape)
    whole = np.zeros((rows, columns), np.uint8)
    whole[: wide.shape[0], : wide.shape[1]] = wide
    drawn = whole.reshape(rows // side, side, columns // side, side).max(axis=(1, 3))
    samples = np.ascontiguousarray(samples)
    return Drawing(samples, np.ascontiguousarray(drawn), samples.ravel())


def lay_over(region: Plane, drawing: Drawing, matrix: FloatArray) -> None:
    """Lay a drawing, in colour times opacity, over a part of a picture.

    Parameters
    ----------
    region : float32 array, shape (rows, columns, c)
        Changed in place.
    drawing : Drawing
        Of c + 1 planes.
    matrix : float array, shape (2, 3)
        From a pixel (x, y) of the region to column and row of the drawing.
    """
    _lay_tiles(region, drawing, np.ascontiguousarray(matrix), (0,) * region.shape[2])


def add_warps(drawing: Drawing, matrices: FloatArray, total: Plane) -> None:
    """Add a drawing to `total`, once for each matrix: what motion blur costs its time for.

    Parameters
    ----------
    drawing : Drawing
        Of c planes.
    matrices : float array, shape (k, 2, 3)
        From a pixel (x, y) of `total` to column and row of the drawing.
    total : float32 array, shape (rows, columns, c)
    """
    # A tuple's length is known to the compiler, which then writes the few colours out one by one.
    _add_tiles(drawing, np.ascontiguousarray(matrices), total, (0,) * drawing.samples.shape[2])


def add_gathered(drawing: Drawing, ways: FloatArray, places: FloatArray, total: Plane) -> None:
    """Add a drawing, once for each instant, at places that differ from pixel to pixel, in poses from row to row.

    Parameters
    ----------
    drawing : Drawing
        Of c planes.
    ways : float array, shape (k, rows, 2, 3) or (k, 1, 2, 3)
        From places to column and row of the drawing, at each instant, for each row or for all.
    places : float array, shape (rows, columns, 2)
        What each pixel of `total` looks at.
    total : float32 array, shape (rows, columns, c)
    """
    _gather_tiles(drawing, np.ascontiguousarray(ways), places, total, (0,) * drawing.samples.shape[2])


@njit(fastmath=True, nogil=True, error_model="numpy", inline="always")
def _weights(part):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    """Return the weights of three samples, `part` (-1/2 to 1/2) beyond the middle one."""
    low, high = f4(0.5) - part, f4(0.5) + part
    return f4(0.5) * low * low, f4(0.75) - part * part, f4(0.5) * high * high


@njit(fastmath=True, nogil=True, error_model="numpy", inline="always")
def _read(flat, start, steps, across, down):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    """Return one plane at a place: `start` is its first of nine samples; weights of columns and of rows."""
    depth, stride = steps
    a, b, d = start, start + stride, start + stride + stride
    upper = across[0] * flat[a] + across[1] * flat[a + depth] + across[2] * flat[a + depth + depth]
    middle = across[0] * flat[b] + across[1] * flat[b + depth] + across[2] * flat[b + depth + depth]
    lower = across[0] * flat[d] + across[1] * flat[d + depth] + across[2] * flat[d + depth + depth]
    return down[0] * upper + down[1] * middle + down[2] * lower


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _lay_tiles(region, drawing, matrix, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    for top in range(0, region.shape[0], TILE):
        for left in range(0, region.shape[1], WIDE):
            for y in range(top, min(top + TILE, region.shape[0])):
                _lay_row(region[y, left : left + WIDE], drawing, matrix, (left, y), colours)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _lay_row(row, drawing, matrix, first, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    u0, v0, low, high = _span(matrix, first, row.shape[0], drawing[0])
    samples, drawn, flat = drawing
    depth = uint64(len(colours) + 1)
    steps = depth, uint64(samples.shape[1]) * depth
    for x in range(low, high):
        u, v = u0 + matrix[0, 0] * x, v0 + matrix[1, 0] * x
        j, i = int(u + 0.5), int(v + 0.5)
        if not drawn[uint64(i >> BLOCK_BITS), uint64(j >> BLOCK_BITS)]:
            continue
        across, down = _weights(f4(u - j)), _weights(f4(v - i))
        start = uint64(i - 1) * steps[1] + uint64(j - 1) * depth
        clear = f4(1) - _read(flat, start + uint64(len(colours)), steps, across, down)
        for c in range(len(colours)):
            row[x, c] = row[x, c] * clear + _read(flat, start + uint64(c), steps, across, down)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _add_tiles(drawing, matrices, total, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    for top in range(0, total.shape[0], TILE):
        for left in range(0, total.shape[1], WIDE):
            for k in range(len(matrices)):
                for y in range(top, min(top + TILE, total.shape[0])):
                    _add_row(drawing, matrices[k], (left, y), total[y, left : left + WIDE], colours)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _add_row(drawing, matrix, first, row, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    u0, v0, low, high = _span(matrix, first, row.shape[0], drawing[0])
    samples, drawn, flat = drawing
    depth = uint64(len(colours))
    steps = depth, uint64(samples.shape[1]) * depth
    for x in range(low, high):
        u, v = u0 + matrix[0, 0] * x, v0 + matrix[1, 0] * x
        j, i = int(u + 0.5), int(v + 0.5)
        if not drawn[uint64(i >> BLOCK_BITS), uint64(j >> BLOCK_BITS)]:
            continue
        across, down = _weights(f4(u - j)), _weights(f4(v - i))
        start = uint64(i - 1) * steps[1] + uint64(j - 1) * depth
        for c in range(len(colours)):
            row[x, c] += _read(flat, start + uint64(c), steps, across, down)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _gather_tiles(drawing, ways, places, total, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    rows, columns = total.shape[:2]
    for top in range(0, rows, TILE):
        for left in range(0, columns, WIDE):
            right = min(left + WIDE, columns)
            for k in range(len(ways)):
                for y in range(top, min(top + TILE, rows)):
                    way = ways[k, y if ways.shape[1] > 1 else 0]
                    _gather_row(drawing, way, places[y, left:right], total[y, left:right], colours)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _gather_row(drawing, way, places, row, colours):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    samples, drawn, flat = drawing
    depth = uint64(len(colours))
    steps = depth, uint64(samples.shape[1]) * depth
    last_u, last_v = samples.shape[1] - 1.501, samples.shape[0] - 1.501
    for x in range(len(row)):
        u = way[0, 0] * places[x, 0] + way[0, 1] * places[x, 1] + way[0, 2]
        v = way[1, 0] * places[x, 0] + way[1, 1] * places[x, 1] + way[1, 2]
        if not (0.501 <= u <= last_u and 0.501 <= v <= last_v):
            continue
        j, i = int(u + 0.5), int(v + 0.5)
        if not drawn[uint64(i >> BLOCK_BITS), uint64(j >> BLOCK_BITS)]:
            continue
        across, down = _weights(f4(u - j)), _weights(f4(v - i))
        start = uint64(i - 1) * steps[1] + uint64(j - 1) * depth
        for c in range(len(colours)):
            row[x, c] += _read(flat, start + uint64(c), steps, across, down)


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _span(matrix, first, length, drawing):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    """Return where a row begins in the drawing, and from and to which of its pixels it looks inside."""
    left, y = first
    u0 = matrix[0, 0] * left + matrix[0, 1] * y + matrix[0, 2]
    v0 = matrix[1, 0] * left + matrix[1, 1] * y + matrix[1, 2]
    low, high = _narrow(0.0, length - 1.0, u0, matrix[0, 0], drawing.shape[1] - 1.501)
    low, high = _narrow(low, high, v0, matrix[1, 0], drawing.shape[0] - 1.501)
    return u0, v0, math.ceil(low), math.floor(high) + 1


@njit(fastmath=True, cache=True, nogil=True, error_model="numpy")
def _narrow(low, high, start, step, most):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    """Return the part of low..high in which start + step x lies from 0.501 to `most`: nine samples are there."""
    if abs(step) < 1e-12:
        return (low, high) if 0.501 <= start <= most else (1.0, 0.0)
    first, last = (0.501 - start) / step, (most - start) / step
    return max(low, min(first, last)), min(high, max(first, last))

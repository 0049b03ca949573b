"""A camera held by hand: where the picture wanders, and a background that wanders with it.

The background is shifted by a windowed sinc, so that it stays as sharp at half a pixel as at a whole one.
Beyond its border it is mirrored; a hand reaches a few pixels.
"""

from __future__ import annotations

import cv2
import numpy as np
from numba import njit

from vml_course.model.arrays import FloatArray
from vml_course.synth.sprite import Planes
from vml_course.synth.texture import Plane, raw_bits

# Slow sway and the tremor of a hand; no frequency twice, so that the axes are not bound to one another.
TREMOR_HZ = np.array([[1.7, 2.9, 4.3, 6.1, 8.3, 10.7], [1.3, 2.3, 3.7, 5.3, 7.3, 11.3]])
REACH = 8  # taps on each side
WINDOW = 7.0  # Kaiser's beta


def wander(seed: int, shake_px: float, time_s: FloatArray) -> FloatArray:
    """Return how far the picture is shifted at some times, shape (k,) -> (k, 2), px; nothing at time 0.

    Sines of several frequencies, with phases by the seed; `shake_px` is the standard deviation along each
    axis over a long time.
    """
    phases = raw_bits(seed, "shake", TREMOR_HZ.size).astype(np.float64).reshape(TREMOR_HZ.shape) * (2 * np.pi / 2.0**64)
    angles = 2 * np.pi * np.multiply.outer(np.asarray(time_s, dtype=np.float64), TREMOR_HZ)
    sines = np.sin(angles + phases) - np.sin(phases)
    return np.asarray(shake_px * np.sqrt(2 / TREMOR_HZ.shape[1]) * sines.sum(axis=-1))


def shifted(planes: Planes, offset_px: FloatArray) -> Planes:
    """Return a picture moved by some pixels to the right and down.

    Parameters
    ----------
    planes : Planes
    offset_px : float array, shape (2,), or (h, 2) or (1, 2) when each row has a shift of its own
    """
    if offset_px.ndim == 2 and len(offset_px) == 1:
        offset_px = offset_px[0]
    if offset_px.ndim == 2:
        pairs = (offset_px[::2] + offset_px[1::2]) / 4
        return Planes(_shift_rows(planes.luma[..., None], offset_px)[..., 0], _shift_rows(planes.chroma, pairs))
    x, y = float(offset_px[0]), float(offset_px[1])
    return Planes(_shift(planes.luma, x, y), _shift(planes.chroma, x / 2, y / 2))


def _shift(plane: Plane, x: float, y: float) -> Plane:
    whole = np.array([[1.0, 0.0, np.floor(x)], [0.0, 1.0, np.floor(y)]])
    if whole[:, 2].any():
        size = plane.shape[1], plane.shape[0]
        plane = _float32(cv2.warpAffine(plane, whole, size, flags=cv2.INTER_NEAREST, borderMode=cv2.BORDER_REFLECT_101))
    across, down = sinc_taps(x - whole[0, 2]), sinc_taps(y - whole[1, 2])
    return _float32(cv2.sepFilter2D(plane, cv2.CV_32F, across, down, borderType=cv2.BORDER_REFLECT_101))


def _shift_rows(plane: Plane, offset_px: FloatArray) -> Plane:
    whole = np.floor(offset_px).astype(np.int64)
    taps = sinc_taps(offset_px - whole).astype(np.float32)
    rows, columns, colours = plane.shape
    # The mirrored border is laid on once; beyond it nothing is read as long as a hand reaches a few pixels.
    edge = REACH + int(np.abs(whole).max()) + 1
    framed = cv2.copyMakeBorder(plane, edge, edge, edge, edge, cv2.BORDER_REFLECT_101)
    moved = np.empty((rows, columns * colours), np.float32)
    _gather_rows(framed.reshape(rows + 2 * edge, -1), edge - REACH - whole, taps, (colours, moved))
    return moved.reshape(plane.shape)


@njit(cache=True, nogil=True, fastmath=True)
def _gather_rows(framed, first, taps, result):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    colours, moved = result
    line = np.empty(framed.shape[1], np.float32)
    width = moved.shape[1]
    for y in range(len(moved)):
        line[:] = 0
        for tap in range(taps.shape[2]):
            line += taps[y, 1, tap] * framed[y + first[y, 1] + tap]
        moved[y] = 0
        for tap in range(taps.shape[2]):
            start = (first[y, 0] + tap) * colours
            moved[y] += taps[y, 0, tap] * line[start : start + width]


def _float32(plane: object) -> Plane:
    return np.asarray(plane, dtype=np.float32)


def sinc_taps(part: float | FloatArray) -> FloatArray:
    """Return the taps that move samples to the right by parts of a step (0 to 1): shape (..., taps), of sum 1."""
    places = np.arange(-REACH, REACH + 1) + np.asarray(part, dtype=np.float64)[..., None]
    window = np.i0(WINDOW * np.sqrt(np.maximum(0.0, 1 - (places / (REACH + 1)) ** 2)))
    taps = np.sinc(places) * window
    return np.asarray(taps / taps.sum(axis=-1, keepdims=True))

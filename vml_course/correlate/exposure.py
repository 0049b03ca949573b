"""What a block looks like while the shutter is open: the mean of its sharp picture over the places it takes.

The sharp picture is known from the reference, in a crop wider than the block, for what lies beside the block
is smeared into it. It is averaged over instants that are close enough together (0.7 px of movement) for the
mean to be the integral.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from vml_course.correlate.bspline import (
    KERNEL,
    SLOPE,
    Float32Array,
    FloatArray,
    f4,
    gradients_at_pixels,
    prefilter_taps,
    sample_row,
    spline_crop,
    values_at_pixels,
)
from vml_course.correlate.template import Patch, first_pixel, read_only

BORDER = 4  # px around the block that its gradients need
STEP_PX = 0.7
MOST_INSTANTS = 101
REACH_PX = 40  # beyond the block's border the picture is not kept


class Surroundings(NamedTuple):
    """A block's sharp picture with what lies around it.

    Attributes
    ----------
    crop : float32 array, shape (h, w)
        Spline coefficients.
    left, top : float
        Place of the crop's first pixel as seen from the tracked point, px.
    inside_left, inside_top : float
        Place of the block's first pixel.
    """

    crop: Float32Array
    left: float
    top: float
    inside_left: float
    inside_top: float


def cut_surroundings(
    image: NDArray[np.uint8], point_px: tuple[float, float], size: int, blur_px: float = 0.0
) -> Surroundings:
    """Cut a block with `REACH_PX` around it; beyond the picture's border it is mirrored."""
    x0, y0 = first_pixel(point_px[0], size), first_pixel(point_px[1], size)
    crop = np.empty((size + 2 * REACH_PX, size + 2 * REACH_PX), np.float32)
    spline_crop(read_only(image), prefilter_taps(blur_px), x0 - REACH_PX, y0 - REACH_PX, crop)
    left, top = x0 - point_px[0], y0 - point_px[1]
    return Surroundings(read_only(crop), left - REACH_PX, top - REACH_PX, left, top)


def exposed_patch(around: Surroundings, warps: FloatArray, size: int) -> Patch:
    """Return the block as it is seen when it takes several places while the shutter is open.

    Parameters
    ----------
    around : Surroundings
    warps : float array, shape (k, 6)
        For each instant, which place of the reference is seen at offset X of the block: shift + A X, as
        shift x, y and A row by row.
    size : int
    """
    side = size + 2 * BORDER
    total = np.zeros((side, side), np.float32)
    first = around.inside_left - BORDER, around.inside_top - BORDER
    add_instants(around.crop, np.ascontiguousarray(warps), np.array([*first, around.left, around.top]), total)
    total /= len(warps)
    slope = np.convolve(_both_sides(prefilter_taps()), SLOPE)
    across = cv2.filter2D(total, cv2.CV_32F, slope[None, :], borderType=cv2.BORDER_REPLICATE)
    down = cv2.filter2D(total, cv2.CV_32F, slope[:, None], borderType=cv2.BORDER_REPLICATE)
    block = slice(BORDER, BORDER + size), slice(BORDER, BORDER + size)
    values, gx, gy = (np.asarray(plane[block], dtype=np.float64) for plane in (total, across, down))
    return Patch(values, gx, gy, around.inside_left, around.inside_top)


def block_patch(around: Surroundings, size: int) -> Patch:
    """Return the block itself out of its surroundings, as `cut_patch` cuts it."""
    part = slice(REACH_PX - 1, REACH_PX + size + 1)
    crop = around.crop[part, part]
    across, down = gradients_at_pixels(crop)
    return Patch(values_at_pixels(crop), across, down, around.inside_left, around.inside_top)


def instant_count(longest_px: float) -> int:
    """Return how many instants sample a movement of some length."""
    return int(min(max(3, np.ceil(longest_px / STEP_PX)), MOST_INSTANTS))


@njit(fastmath=True, **KERNEL)
def add_instants(crop, warps, places, total):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Add the warped crop, sampled at every pixel of the block, to `total` for each warp.

    places: left, top of the block's first pixel, then of the crop's.
    """
    n, m = total.shape
    height, width = crop.shape
    index, lanes, row = np.empty(m, np.int32), np.empty((8, m), np.float32), np.empty(m, np.float32)
    flat, stride = crop.ravel(), np.int32(width)
    for warp in warps:
        for i in range(n):
            left, down = places[0], places[1] + i
            x = warp[0] + warp[2] * left + warp[3] * down - places[2]
            y = warp[1] + warp[4] * left + warp[5] * down - places[3]
            end_x, end_y = x + warp[2] * (m - 1), y + warp[4] * (m - 1)
            # what lies outside the crop is not known: the whole row is moved to its border
            low_x, low_y = min(x, end_x), min(y, end_y)
            high_x, high_y = max(x, end_x), max(y, end_y)
            x += max(0.0, 1.0 - low_x) - max(0.0, high_x - (width - 3.01))
            y += max(0.0, 1.0 - low_y) - max(0.0, high_y - (height - 3.01))
            sample_row(flat, stride, f4(x), f4(y), f4(warp[2]), f4(warp[4]), index, lanes, row)
            for j in range(m):
                total[i, j] += row[j]


def _both_sides(half: Float32Array) -> FloatArray:
    return np.concatenate([half[:0:-1], half]).astype(np.float64)

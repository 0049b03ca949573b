"""Where in a picture a block can be tracked well: a map of the expected error, and the best places on it."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from vml_course.correlate.texture import GRADIENT_NOISE, LEAST_NOISE, noise_grey
from vml_course.errors import InputError
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.track.trackability import SIGNIFICANT, Trackability, Verdict, trackability

CANDIDATES = 8  # times the spots that are asked for, before it is known which have twins


class Spot(NamedTuple):
    """A place worth tracking, and why."""

    xy_px: tuple[float, float]
    found: Trackability


def sigma_map(luma: Luma, block: int, noise: float | None = None) -> FloatArray:
    """Return the expected standard deviation, px, of a block about every pixel, shape (height, width).

    NaN where there is no texture but noise, and where the block would leave the picture. An even block's middle lies
    between pixels; its map is read at the pixel right and below.

    Parameters
    ----------
    luma : uint8 array, shape (height, width)
    block : int
    noise : float, optional
        As in `trackability`.
    """
    grey = noise_grey(luma) if noise is None else max(noise, LEAST_NOISE)
    down, across = np.gradient(cv2.GaussianBlur(luma.astype(np.float32), (0, 0), 1.0))
    part, size = grey**2 * GRADIENT_NOISE, float(block * block)
    xx, yy, xy = (
        cv2.boxFilter(product, cv2.CV_64F, (block, block), normalize=False)
        for product in (across * across, down * down, across * down)
    )
    weakest = 0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy) - part * size
    significant = weakest > SIGNIFICANT * part * np.sqrt(2.0 * size)
    sigma = np.sqrt(2.0 / np.where(significant, weakest, np.nan)) * grey
    half, rest = block // 2, (block - 1) // 2
    inside = np.zeros(luma.shape, bool)
    inside[half : luma.shape[0] - rest, half : luma.shape[1] - rest] = True
    return np.asarray(np.where(inside, sigma, np.nan))


def good_spots(
    luma: Luma,
    block: int,
    count: int = 5,
    *,
    within: FloatArray | None = None,
    search_px: int = 40,
    noise: float | None = None,
) -> list[Spot]:
    """Return the best places to track, best first: good ones, then fair ones, never others.

    Parameters
    ----------
    luma : uint8 array, shape (height, width)
    block, count : int
        Fewer are returned when there are not so many; no two blocks overlap by more than half.
    within : bool array, shape (height, width), optional
        Where a block's middle may be, such as `inside` a drawn lasso.
    search_px, noise
        As in `trackability`.
    """
    sigma = sigma_map(luma, block, noise)
    if within is not None:
        sigma = np.where(within, sigma, np.nan)
    spots = []
    for y, x in _valleys(sigma, max(block // 2, 1), CANDIDATES * count):
        at = (x - 0.5, y - 0.5) if block % 2 == 0 else (float(x), float(y))
        found = trackability(luma, at, block, search_px=search_px, noise=noise)
        if found.verdict in {Verdict.GOOD, Verdict.FAIR}:
            spots.append(Spot(at, found))
    spots.sort(key=lambda spot: (spot.found.verdict is not Verdict.GOOD, spot.found.sigma_px))
    return spots[:count]


def inside(polygon_px: FloatArray, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Return which pixels lie inside a drawn lasso, or on it: shape (height, width).

    Parameters
    ----------
    polygon_px : float array, shape (k, 2)
        Its corners, px, at least three; the last is joined to the first. It may leave the picture.
    shape : (height, width)

    Raises
    ------
    InputError
        When it has fewer corners, or one is no number.

    >>> inside(np.array([[1, 0], [2, 0], [2, 1], [1, 1]]), (3, 4)).astype(int)
    array([[0, 1, 1, 0],
           [0, 1, 1, 0],
           [0, 0, 0, 0]])
    """
    corners = np.asarray(polygon_px, dtype=np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 or not np.isfinite(corners).all():
        raise InputError("lasso", "three or more corners x, y in px", f"an array of shape {corners.shape}")
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(np.clip(corners, -1e4, 1e5)).astype(np.int32)], 1)
    return mask.astype(bool)


def _valleys(sigma: FloatArray, apart_px: int, count: int) -> list[tuple[int, int]]:
    """Return rows and columns of the least values, each `apart_px` from all before it along x or y."""
    left = np.where(np.isfinite(sigma), sigma, np.inf)
    places: list[tuple[int, int]] = []
    while len(places) < count:
        row, column = (int(k) for k in np.unravel_index(int(np.argmin(left)), left.shape))
        if not np.isfinite(left[row, column]):
            break
        places.append((row, column))
        left[max(0, row - apart_px) : row + apart_px + 1, max(0, column - apart_px) : column + apart_px + 1] = np.inf
    return places

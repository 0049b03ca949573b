"""What the methods share: seeds that can be followed, first sightings; and likeness and sigma of unturned blocks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from vml_course.correlate.template import first_pixel
from vml_course.correlate.texture import noise_grey, texture_of
from vml_course.errors import SeedError
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.model.track import Sighting, Status

TILES = 4  # along each side of a block, whose pulls are compared


class Found(NamedTuple):
    """One point in one picture: place, standard deviation of a coordinate, ZNCC with the first block, steps."""

    xy_px: FloatArray
    sigma_px: float
    zncc: float
    iterations: int


def check_block(luma: Luma, name: str, point: tuple[float, float], size: int) -> None:
    """Refuse a point whose block does not lie inside the picture, or has nothing to hold on to.

    Raises
    ------
    SeedError
    """
    check_block_fits(luma.shape, name, point, size)
    check_texture(cut(luma, point, size), name, point)


def check_texture(block: FloatArray | Luma, name: str, point: tuple[float, float]) -> None:
    """Refuse a block that has nothing to hold on to, or only an edge.

    Raises
    ------
    SeedError
    """
    texture = texture_of(block)
    expected = f"a block with texture around ({point[0]:g}, {point[1]:g})"
    if texture.strongest <= texture.insignificant:
        raise SeedError(name, expected, "a blank one (no texture)", "Move the point to a spot with a pattern.")
    if texture.weakest <= texture.insignificant:
        raise SeedError(name, expected, "only an edge, along which it slides", "Take a corner or a larger block.")


def check_block_fits(shape: tuple[int, ...], name: str, point: tuple[float, float], size: int) -> None:
    """Refuse a point whose block does not lie inside a picture of this shape.

    Raises
    ------
    SeedError
    """
    height, width = shape
    if np.all(np.isfinite(point)):
        x0, y0 = (first_pixel(c, size) for c in point)
        if 0 <= x0 <= width - size and 0 <= y0 <= height - size:
            return
    half = 0.5 * (size - 1)
    raise SeedError(
        name,
        f"a point from ({half:g}, {half:g}) to ({width - 1 - half:g}, {height - 1 - half:g}) px",
        f"({point[0]:g}, {point[1]:g})",
        f"The block of {size} px must lie inside the picture: move the point or take a smaller block.",
    )


def cut(luma: Luma, point: tuple[float, float], size: int) -> Luma:
    """Return the size x size pixels whose middle is nearest to a point that `check_block` has passed."""
    x0, y0 = (first_pixel(c, size) for c in point)
    return np.asarray(luma[y0 : y0 + size, x0 : x0 + size])


def seen_at(luma: Luma, block: Luma, offset: FloatArray, xy_px: FloatArray) -> FloatArray:
    """Return the grey levels under an unturned block, shape (n, m), interpolated linearly.

    Parameters
    ----------
    luma : uint8 array
    block : uint8 array, shape (n, m)
    offset : float array, shape (2,)
        From the point to the block's middle, px.
    xy_px : float array, shape (2,)
        Where the point is.
    """
    x, y = (xy_px + offset).tolist()
    patch = cv2.getRectSubPix(luma, block.shape[::-1], (x, y), patchType=cv2.CV_32F)
    return np.asarray(patch, dtype=np.float64)


def middle_offset(point: tuple[float, float], size: int) -> FloatArray:
    """Return the way from a point to the middle of its block, px: less than half a pixel."""
    return np.array([first_pixel(c, size) + 0.5 * (size - 1) - c for c in point])


def zncc(a: FloatArray | Luma, b: FloatArray | Luma) -> float:
    """Return the zero-normalised cross-correlation of two blocks; 0 when one of them is blank.

    >>> zncc(np.array([[1.0, 2.0], [3.0, 5.0]]), np.array([[12.0, 14.0], [16.0, 20.0]]))
    1.0
    """
    p, q = (np.asarray(block, np.float64) - np.mean(block) for block in (a, b))
    norm = float(np.sqrt((p * p).sum() * (q * q).sum()))
    return float((p * q).sum()) / norm if norm > 0.0 else 0.0


class ShiftVariance(NamedTuple):
    """Variance of a coordinate of a shifted block (mean of x and y, px squared): by white noise, and by the rest."""

    white: float
    structured: float


def shift_variance(reference: FloatArray | Luma, seen: FloatArray | Luma) -> ShiftVariance:
    """Return how well a block lies on another that it was shifted onto, from what is left between them.

    With M the summed gradient products of the blocks' mean, blurred by 1 px, and K = M^-1 grad the influence of
    each pixel, the residual e of white noise gives var(e) tr(M^-1) / 2. A turn or another body leaves a residual
    that pulls the parts of the block different ways: G / (G - 1) times the sum over G tiles of (sum of K e)**2,
    about their mean, less the white part; a quarter of it, because pulls of a turn go round and cancel in part
    (on turning legs the error was 0.2 to 1 of that sigma). Both are infinite when the block has nothing to hold on to.
    """
    a, b = np.asarray(reference, np.float64), np.asarray(seen, np.float64)
    residual = (b - b.mean()) - (a - a.mean())
    down, across = np.gradient(cv2.GaussianBlur(0.5 * (a + b), (0, 0), 1.0))
    xx, xy, yy = (across * across).sum(), (across * down).sum(), (down * down).sum()
    determinant = xx * yy - xy * xy
    if determinant <= 0.0:
        return ShiftVariance(float("inf"), float("inf"))
    white = float(0.5 * residual.var() * (xx + yy) / determinant)
    pulls = [(yy * across - xy * down) * residual, (xx * down - xy * across) * residual]
    tiled = np.array([_tile_sums(pull) for pull in pulls]) / determinant
    count = TILES * TILES
    by_tiles = float(0.5 * count * tiled.var(axis=1, ddof=1).sum())
    return ShiftVariance(white, 0.25 * max(by_tiles - white, 0.0))


def _tile_sums(values: FloatArray) -> FloatArray:
    edges = [np.arange(TILES) * n // TILES for n in values.shape]
    return np.asarray(np.add.reduceat(np.add.reduceat(values, edges[0], axis=0), edges[1], axis=1).ravel())


def expected_variance(block: Luma) -> float:
    """Return the variance of a coordinate that the block's own noise leads one to expect of a match, px squared."""
    texture = texture_of(block)
    inverse = 0.5 * (1.0 / texture.weakest + 1.0 / texture.strongest)
    return 2.0 * noise_grey(block) ** 2 * inverse  # both pictures are noisy


def first_sighting(points: FloatArray, sigma_px: FloatArray) -> Sighting:
    """Return the seeds themselves as the first sighting; the block is not deformed against itself."""
    p = len(points)
    return Sighting(
        points, sigma_px, np.ones(p), np.zeros(p, np.int64), np.full(p, Status.AUTO, np.int8), np.zeros((p, 4))
    )


def sighting_of(found: Sequence[Found | None]) -> Sighting:
    """Return the sighting of points, None where lost; what a method that only shifts cannot see is NaN."""
    p = len(found)
    xy, sigma, likeness = np.full((p, 2), np.nan), np.full(p, np.nan), np.full(p, np.nan)
    iterations, status = np.zeros(p, np.int64), np.full(p, Status.LOST, np.int8)
    for k, one in enumerate(found):
        if one is not None:
            xy[k], sigma[k], likeness[k], iterations[k] = one
            status[k] = Status.AUTO
    return Sighting(xy, sigma, likeness, iterations, status, np.full((p, 4), np.nan))

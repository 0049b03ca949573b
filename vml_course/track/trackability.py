"""What to expect of a point before it is tracked: how sharply its block can be found, and whether it is the only one.

Arrays in, verdicts out. Two questions are asked of a block. How far does noise move the match? From the gradients,
blurred by 1 px and cleaned of the part that noise alone would give: sigma = sqrt(2) noise / sqrt(lambda_min). Without
the cleaning a blank block promises 0.1 px. And what else nearby looks like it? From its correlation with
the search region: a ridge through the block is an edge along which it slides, another hill is a twin.

The figures hold for white noise; compressed video errs 2 to 4 times more, for a codec moves whole macroblocks.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from vml_course.correlate.template import first_pixel
from vml_course.correlate.texture import GRADIENT_NOISE, LEAST_NOISE, noise_grey
from vml_course.model.frame import Luma

GOOD_PX, FAIR_PX = 0.05, 0.25
TWIN_ZNCC = 0.9
OWN_HILL_PX = 6  # nearer than this a high correlation is the block itself
SIGNIFICANT = 8.0


class Verdict(StrEnum):
    """What a block is good for, from best to worst."""

    GOOD = "good"
    FAIR = "fair"
    EDGE = "edge"
    REPEATING = "repeating"
    POOR = "poor"


class Strength(NamedTuple):
    """Gradient products summed over a block, noise removed.

    Attributes
    ----------
    weakest, strongest : float
        Eigenvalues, (grey levels / px)**2.
    slide_rad : float
        Direction along which the block is weakest, in the picture (x right, y down), from -pi/2 to pi/2.
    insignificant : float
        What an eigenvalue must exceed to be texture and not noise.
    """

    weakest: float
    strongest: float
    slide_rad: float
    insignificant: float


class Rival(NamedTuple):
    """The most similar other place in the search region.

    Attributes
    ----------
    zncc : float
        Its correlation with the block; -1 when there is no other place.
    offset_px : (float, float)
        Where it is, as seen from the block.
    is_ridge : bool
        Whether one walks there along a ridge: the block slides.
    """

    zncc: float
    offset_px: tuple[float, float]
    is_ridge: bool


@dataclass(frozen=True, slots=True)
class Trackability:
    """The verdict on one block, and the numbers behind it; `plain_words.sentence` says it to a person.

    Attributes
    ----------
    verdict : Verdict
    sigma_px : float
        Expected standard deviation of a coordinate along the weakest direction; infinite without texture.
    noise_grey : float
    strength : Strength
    rival : Rival
    """

    verdict: Verdict
    sigma_px: float
    noise_grey: float
    strength: Strength
    rival: Rival


def trackability(
    luma: Luma, point_px: tuple[float, float], block: int, *, search_px: int = 40, noise: float | None = None
) -> Trackability:
    """Judge the block about a point.

    Parameters
    ----------
    luma : uint8 array, shape (height, width)
    point_px : (float, float)
        The block must lie inside the picture.
    block : int
        Its side, px.
    search_px : int
        How far around it other places are looked at.
    noise : float, optional
        Standard deviation of the picture's noise, grey levels (see `noise_between`); from the block itself
        when left out, where fine texture raises it.
    """
    x0, y0 = (first_pixel(c, block) for c in point_px)
    pixels = luma[y0 : y0 + block, x0 : x0 + block]
    grey = noise_grey(pixels) if noise is None else max(noise, LEAST_NOISE)
    strength = strength_of(pixels, grey)
    rival = find_rival(luma, (x0, y0), block, search_px)
    sigma = float(np.sqrt(2.0 / strength.weakest) * grey) if strength.weakest > strength.insignificant else float("inf")
    return Trackability(_judge(sigma, strength, rival), sigma, grey, strength, rival)


def strength_of(block: NDArray[np.generic], noise: float) -> Strength:
    """Return the texture of a block, shape (n, m), against white noise of a standard deviation, grey levels."""
    smooth = cv2.GaussianBlur(np.asarray(block, np.float32), (0, 0), 1.0)
    down, across = np.gradient(smooth.astype(np.float64))
    part = noise**2 * GRADIENT_NOISE
    products = np.array([[(a * b).sum() for b in (across, down)] for a in (across, down)])
    values, vectors = np.linalg.eigh(products - part * smooth.size * np.eye(2))
    x, y = vectors[:, 0]
    slide = float(np.arctan2(y, x) if x > 0.0 else np.arctan2(-y, -x))
    return Strength(float(values[0]), float(values[1]), slide, SIGNIFICANT * part * float(np.sqrt(2.0 * smooth.size)))


def find_rival(luma: Luma, corner: tuple[int, int], block: int, search_px: int) -> Rival:
    """Return the place most similar to a block, outside its own hill of correlation.

    Parameters
    ----------
    luma : uint8 array, shape (height, width)
    corner : (int, int)
        x, y of the block's first pixel.
    block, search_px : int
    """
    (x, y), (height, width) = corner, luma.shape
    x0, y0 = max(0, x - search_px), max(0, y - search_px)
    region = luma[y0 : min(height, y + block + search_px), x0 : min(width, x + block + search_px)]
    scores = cv2.matchTemplate(region, luma[y : y + block, x : x + block], cv2.TM_CCOEFF_NORMED)
    scores = np.clip(np.where(np.isfinite(scores), scores, -1.0), -1.0, 1.0)
    across, down = np.arange(scores.shape[1]) - (x - x0), np.arange(scores.shape[0])[:, None] - (y - y0)
    own = (np.abs(across) <= OWN_HILL_PX) & (np.abs(down) <= OWN_HILL_PX)
    hills = cv2.connectedComponents((scores > TWIN_ZNCC).astype(np.uint8))[1]
    hill = hills == hills[y - y0, x - x0]
    is_ridge = _is_ridge(hill, own)
    rivals = np.where(own if is_ridge else own | hill, -1.0, scores)
    row, column = np.unravel_index(int(np.argmax(rivals)), rivals.shape)
    found = float(rivals[row, column])
    offset = (float(column - (x - x0)), float(row - (y - y0))) if found > -1.0 else (0.0, 0.0)
    return Rival(found, offset, bool(is_ridge and hill[row, column]))


def _is_ridge(hill: NDArray[np.bool_], own: NDArray[np.bool_]) -> bool:
    """Whether a hill leaves the block's own place, and does so along one line only."""
    rows, columns = np.nonzero(hill)
    if not (hill & ~own).any():
        return False
    narrow, wide = np.linalg.eigvalsh(np.cov(np.stack([columns, rows]).astype(np.float64)))
    return bool(wide > 4.0 * narrow)  # twice as long as broad: smooth round things have broad hills, too


def _judge(sigma_px: float, strength: Strength, rival: Rival) -> Verdict:
    if strength.strongest <= strength.insignificant:
        return Verdict.POOR
    has_twin = rival.zncc >= TWIN_ZNCC
    if strength.weakest <= strength.insignificant or (has_twin and rival.is_ridge):
        return Verdict.EDGE
    if sigma_px > FAIR_PX:
        return Verdict.POOR
    if has_twin:
        return Verdict.REPEATING
    return Verdict.GOOD if sigma_px <= GOOD_PX else Verdict.FAIR


def noise_between(first: Luma, second: Luma) -> float:
    """Return the standard deviation of the noise in one picture from two pictures in a row, grey levels.

    From the still part: half of the differences of a picture in which little moves are noise alone, and the median
    sees those only. A codec that repeats what hardly changed makes them 0; half a grey level is the least.
    """
    difference = first.astype(np.int16) - second.astype(np.int16)
    spread = float(np.median(np.abs(difference - np.median(difference)))) / 0.6745
    # Whole grey levels: the median of |difference| is 0, 1, 2 ...; the mean of the lower half is finer.
    small = np.abs(difference)[np.abs(difference) <= 3.0 * max(spread, 1.0)]
    return max(float(np.sqrt(0.5 * np.mean(small.astype(np.float64) ** 2))), LEAST_NOISE)

"""Whether a larger block would do better: what it gains in texture, and what it takes in that does not move with it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from vml_course.errors import SeedError
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Frame, Luma
from vml_course.model.track import Seed
from vml_course.track.blocks import check_block_fits
from vml_course.track.sweep import start_at
from vml_course.track.trackability import FAIR_PX, noise_between, trackability
from vml_course.track.trackers.dic import Dic

SIZES_PX = (20, 30, 40, 50, 60, 70, 80, 100, 120)
MOVED_PX = 1.0  # since the start: less parts no bodies
SMOOTH_PX = 3.0
UNLIKE = 0.25  # of the middle's variance, that is left unexplained: two bodies differ by twice that variance
NOISE = 4.0  # times what is left in the middle, which may itself be mostly noise
MOST_BACKGROUND = 0.1


class BlockSize(NamedTuple):
    """One side of a block.

    Attributes
    ----------
    block : int
        px.
    sigma_px : float
        Expected standard deviation of a coordinate; infinite without texture.
    background : float
        Share of the block that did not move with its middle in the pilot; NaN when that cannot be told: the middle
        hardly moved, or was lost.
    """

    block: int
    sigma_px: float
    background: float


def block_sizes(
    tracker: Dic, pilot: Sequence[Frame], seed: Seed, sizes_px: Iterable[int] = SIZES_PX
) -> list[BlockSize]:
    """Return what each size of block about a point promises, smallest first; those that leave the picture are left out.

    Parameters
    ----------
    tracker : Dic
        Its own block does not matter.
    pilot : sequence of Frame
        A few consecutive pictures, the first with the point where the seed says; at least one.
    seed : Seed
        Its own frame does not matter.
    sizes_px : iterable of int
    """
    luma, point = pilot[0].luma, (seed.x_px, seed.y_px)
    noise = noise_between(luma, pilot[1].luma) if len(pilot) > 1 else None
    fitting = [size for size in sorted(sizes_px) if _fits(luma, seed, size)]
    sigma = {size: trackability(luma, point, size, search_px=0, noise=noise).sigma_px for size in fitting}
    centre = next((size for size in fitting if sigma[size] <= FAIR_PX), None)
    stays = None if centre is None else _stays(replace(tracker, block=centre), pilot, seed, fitting[-1])
    return [BlockSize(size, sigma[size], float("nan") if stays is None else _share(stays, size)) for size in fitting]


def best_size(sizes: Sequence[BlockSize]) -> BlockSize | None:
    """Return the size of least sigma of which at most a tenth does not move with it; None when there is no texture.

    A share that is not known counts as none. When even the smallest has more, the smallest is best.
    """
    textured = [one for one in sizes if np.isfinite(one.sigma_px)]
    clean = [one for one in textured if not one.background > MOST_BACKGROUND]
    return min(clean, key=lambda one: one.sigma_px) if clean else next(iter(textured), None)


def _fits(luma: Luma, seed: Seed, size: int) -> bool:
    try:
        check_block_fits(luma.shape, seed.name, (seed.x_px, seed.y_px), size)
    except SeedError:
        return False
    return True


def _stays(tracker: Dic, pilot: Sequence[Frame], seed: Seed, side: int) -> NDArray[np.bool_] | None:
    """Return which pixels about a point do not go where the block in their middle goes: shape (side, side).

    None when that block cannot be followed, or hardly moves. What is left unexplained is compared with the block's own
    contrast, and with what is left in the block itself.
    """
    try:
        state, _ = start_at(tracker, pilot[0], [seed])
    except SeedError:
        return None
    start, squares = np.array([seed.x_px, seed.y_px]), []
    middle = _middle(side, int(tracker.block))
    here = _seen(pilot[0].luma, start, np.eye(2), side)
    for frame in pilot[1:]:
        state, sighting = tracker.step(state, frame.luma)
        if not np.isfinite(sighting.xy_px).all():
            return None
        if np.hypot(*(sighting.xy_px[0] - start)) >= MOVED_PX:
            there = _seen(frame.luma, sighting.xy_px[0], sighting.gradient[0].reshape(2, 2) + np.eye(2), side)
            squares.append(_unlike(here, there, middle) ** 2)
    if not squares:
        return None
    left = cv2.GaussianBlur(np.median(squares, axis=0), (0, 0), SMOOTH_PX, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(left > max(UNLIKE * here[middle].var(), NOISE * np.median(left[middle])))


def _seen(luma: Luma, at_px: FloatArray, linear: FloatArray, side: int) -> FloatArray:
    """Return the grey levels of a square as it is carried by a block, blurred by 1 px against noise."""
    half = 0.5 * (side - 1)
    matrix = np.column_stack([linear, at_px - linear @ [half, half]])
    flags = cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP
    patch = cv2.warpAffine(luma.astype(np.float32), matrix, (side, side), flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(cv2.GaussianBlur(patch, (0, 0), 1.0), dtype=np.float64)


def _unlike(here: FloatArray, there: FloatArray, middle: tuple[slice, slice]) -> FloatArray:
    """Return the difference of two squares, after the light has been made alike in their middle."""
    gain = here[middle].std() / max(there[middle].std(), 1e-6)
    return np.asarray(gain * (there - there[middle].mean()) - (here - here[middle].mean()))


def _middle(side: int, size: int) -> tuple[slice, slice]:
    first = (side - size) // 2
    return slice(first, first + size), slice(first, first + size)


def _share(stays: NDArray[np.bool_], size: int) -> float:
    return float(stays[_middle(len(stays), size)].mean())

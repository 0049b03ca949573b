"""Random numbers that are the same everywhere, and the fine grain that trackers live on.

Only raw bits of a counter-based generator are used, keyed by a hash of the seed and a name: NumPy does not
promise that its distributions stay the same from version to version. A name's numbers do not depend on
what else is drawn.
"""

from __future__ import annotations

import hashlib
from typing import cast

import cv2
import numpy as np
from numpy.typing import NDArray

Plane = NDArray[np.float32]


def raw_bits(seed: int, name: str, count: int) -> NDArray[np.uint64]:
    """Return `count` random 64-bit words of a seed and a name."""
    key = int.from_bytes(hashlib.sha256(f"{seed}/{name}".encode()).digest()[:16], "little")
    return np.asarray(np.random.Philox(key=key).random_raw(count), dtype=np.uint64)


def normals(seed: int, name: str, shape: tuple[int, int]) -> Plane:
    """Return nearly normal numbers of mean 0 and standard deviation 1.

    Each is the sum of four uniform 16-bit numbers (Irwin-Hall): whole-number arithmetic, the same on every
    machine, within 3.5 standard deviations.
    """
    quarters = raw_bits(seed, name, shape[0] * shape[1]).view(np.uint16).reshape(*shape, 4)
    total = quarters.sum(axis=-1, dtype=np.int64)
    return np.asarray((total - 2 * 65535) / (65536 * 3**-0.5), dtype=np.float32)


def choose(seed: int, name: str, count: int, below: int) -> NDArray[np.int64]:
    """Return `count` different whole numbers from 0 to `below` - 1, in random order."""
    return np.argsort(raw_bits(seed, name, below), kind="stable")[:count]


def grain(seed: int, name: str, shape: tuple[int, int], samples_per_px: float, size_px: float = 1.0) -> Plane:
    """Return band-limited speckle of standard deviation 1.

    Parameters
    ----------
    seed, name
        Which speckle.
    shape : (int, int)
        Rows and columns.
    samples_per_px : float
        How many samples lie on one pixel of the picture.
    size_px : float
        Standard deviation of the smallest spots, in pixels; spots larger than four times this are removed,
        for they would only shift the mean of a block.
    """
    coarse = (int(shape[0] / samples_per_px) + 2, int(shape[1] / samples_per_px) + 2)
    white = normals(seed, name, coarse)
    band = cv2.GaussianBlur(white, (0, 0), size_px) - cv2.GaussianBlur(white, (0, 0), 4 * size_px)
    band /= float(band.std()) or 1.0
    wide = (round(coarse[1] * samples_per_px), round(coarse[0] * samples_per_px))
    fine = cv2.resize(band, wide, interpolation=cv2.INTER_CUBIC)
    return cast(Plane, np.ascontiguousarray(fine[: shape[0], : shape[1]]))

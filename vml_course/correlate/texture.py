"""How much a block has to hold on to, before it is tracked.

The gradients' products are cleaned of the part that noise alone would give; what is left must be
significant along every direction, or the block can slide.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

GRADIENT_NOISE = 0.0397  # sum of squares of the derivative taps after a Gaussian blur of 1 px
LEAST_NOISE = 0.5  # grey levels: rounding and the codec leave as much
_LAPLACIANS = np.array([[1.0, -2.0, 1.0], [-2.0, 4.0, -2.0], [1.0, -2.0, 1.0]])  # norm 6


class Texture(NamedTuple):
    """Smallest and largest eigenvalue of the summed gradient products, noise removed, and what counts as nothing."""

    weakest: float
    strongest: float
    insignificant: float


def noise_grey(block: NDArray[np.generic]) -> float:
    """Return the standard deviation of white noise in a block, grey levels; fine texture raises it.

    References
    ----------
    Immerkaer, Comput. Vis. Image Underst. 64 (1996) 300, with the median in place of the mean.
    """
    response = cv2.filter2D(np.asarray(block, np.float32), cv2.CV_32F, _LAPLACIANS)[1:-1, 1:-1]
    return max(float(np.median(np.abs(response))) / 0.6745 / 6.0, LEAST_NOISE)


def texture_of(block: NDArray[np.generic]) -> Texture:
    """Return the texture of a block, shape (n, m), as eigenvalues in (grey levels / px)**2 summed over the block."""
    smooth = cv2.GaussianBlur(np.asarray(block, np.float32), (0, 0), 1.0)
    down, across = np.gradient(smooth.astype(np.float64))
    variance = noise_grey(block) ** 2 * GRADIENT_NOISE
    products = np.array([[(a * b).sum() for b in (across, down)] for a in (across, down)])
    weakest, strongest = np.linalg.eigvalsh(products - variance * smooth.size * np.eye(2))
    return Texture(float(weakest), float(strongest), 8.0 * variance * float(np.sqrt(2.0 * smooth.size)))

"""Finding a block again from far away: zero-normalised correlation over a region, at several rotations.

Only a first guess is asked of it (a pixel or two, a few degrees), so it works at a coarser scale where
the block allows; `icgn.match` then refines.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from vml_course.correlate.bspline import FloatArray

SMALLEST_SIDE = 16  # px of a template after shrinking; less has too many look-alikes


class Candidate(NamedTuple):
    """A place worth refining: pose (6,) as in `icgn.Match`, and the coarse ZNCC there."""

    pose: FloatArray
    score: float


def turned(pose: FloatArray, angle_rad: float) -> FloatArray:
    """Return the pose with its block turned about the point, in the picture's plane (x right, y down)."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    linear = np.array([[c, -s], [s, c]]) @ pose[2:].reshape(2, 2)
    return np.concatenate([pose[:2], linear.ravel()])


def search(
    image: NDArray[np.uint8],
    block: NDArray[np.float32],
    offset: tuple[float, float],
    centre: FloatArray,
    radius_px: float,
    angles_rad: FloatArray,
) -> list[Candidate]:
    """Look for a block around a pose; the best place and its rival at each angle, best first.

    Parameters
    ----------
    image : uint8 array, shape (height, width)
    block : float32 array, shape (n, m)
        Grey levels of the reference block.
    offset : (float, float)
        Place of the block's first pixel as seen from the point (left, top), px.
    centre : float array, shape (6,)
        Middle of the search, and the last known linear part.
    radius_px : float
        The point is looked for within +-radius along x and y.
    angles_rad : float array, shape (k,)
        Rotations to try on top of the linear part.
    """
    found = []
    for angle in angles_rad:
        pose = turned(centre, float(angle))
        half = upright_half(pose, offset, block.shape)
        if half >= 3:
            found += [
                Candidate(np.concatenate([peak[:2], pose[2:]]), float(peak[2]))
                for peak in _best_places(image, _upright(block, offset, pose, half), pose[:2], half, radius_px)
            ]
    return sorted(found, key=lambda candidate: -candidate.score)


def upright_half(pose: FloatArray, offset: tuple[float, float], shape: tuple[int, ...]) -> int:
    """Return half the side of the largest upright square about the point that the warped block covers."""
    inverse = np.abs(np.linalg.inv(pose[2:].reshape(2, 2)))
    nearest_x = min(-offset[0], shape[1] - 1 + offset[0])
    nearest_y = min(-offset[1], shape[0] - 1 + offset[1])
    return int(min(nearest_x / inverse[0].sum(), nearest_y / inverse[1].sum()))


def _upright(block: NDArray[np.float32], offset: tuple[float, float], pose: FloatArray, half: int) -> NDArray[np.uint8]:
    """Return what the picture would show in the square of side 2 half + 1 about the point."""
    inverse = np.linalg.inv(pose[2:].reshape(2, 2))
    shift = -inverse @ np.array([half, half]) - np.array(offset)
    matrix = np.column_stack([inverse, shift])
    size = (2 * half + 1, 2 * half + 1)
    view = cv2.warpAffine(
        block, matrix, size, flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP, borderMode=cv2.BORDER_REFLECT_101
    )
    return np.clip(np.rint(view), 0, 255).astype(np.uint8)


def _best_places(
    image: NDArray[np.uint8], view: NDArray[np.uint8], middle: FloatArray, half: int, radius: float
) -> list[tuple[float, float, float]]:
    """Return x, y and ZNCC of the best match and of the best one elsewhere; none when the region is too small."""
    height, width = image.shape
    x0, y0 = (max(0, int(c - radius) - half) for c in middle)
    x1, y1 = (min(s, int(c + radius) + half + 2) for c, s in zip(middle, (width, height), strict=True))
    shrink = max(1, min(view.shape[0] // SMALLEST_SIDE, 2))
    if x1 - x0 < view.shape[1] + shrink or y1 - y0 < view.shape[0] + shrink:
        return []
    region, small = _shrunk(image[y0:y1, x0:x1], shrink), _shrunk(view, shrink)
    scores = cv2.matchTemplate(region, small, cv2.TM_CCOEFF_NORMED)
    scores[~np.isfinite(scores)] = -1.0  # flat places divide by nothing
    places, apart = [], max(half // shrink // 2, 2)
    for _ in range(2):
        _, score, _, (column, row) = cv2.minMaxLoc(scores)
        places.append((x0 + column * shrink + half, y0 + row * shrink + half, min(score, 1.0)))
        scores[max(0, row - apart) : row + apart + 1, max(0, column - apart) : column + apart + 1] = -1.0
    return places


def _shrunk(image: NDArray[np.uint8], factor: int) -> NDArray[np.uint8]:
    """Return the means of factor x factor pixels; what is left over at the right and bottom is dropped."""
    if factor == 1:
        return image
    h, w = (n // factor * factor for n in image.shape)
    return np.asarray(
        cv2.resize(image[:h, :w], (w // factor, h // factor), interpolation=cv2.INTER_AREA), dtype=np.uint8
    )

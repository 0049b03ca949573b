"""What is known of a block before matching: everything that does not change from picture to picture.

The steepest-descent images are made orthogonal to {1, block} once. A gain and an offset of the light then
cannot be mistaken for a movement, a Gauss-Newton step needs eight plain sums over the new picture, and the
covariance of the result is that of a linear fit.

References
----------
Baker, Matthews, Int. J. Comput. Vis. 56 (2004) 221, sections 3.2 (inverse composition) and, in part 2, linear
appearance variation projected out; Pan, Li, Tong, Exp. Mech. 53 (2013) 1277 (ZNSSD with IC-GN).
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from vml_course.correlate.bspline import (
    SLOPE,
    SMOOTH,
    Float32Array,
    FloatArray,
    gradients_at_pixels,
    prefilter_taps,
    spline_crop,
    values_at_pixels,
)

# What a block may do, as columns over the parameters u, v, du/dx, du/dy, dv/dx, dv/dy.
WARPS: dict[str, FloatArray] = {
    "affine": np.eye(6),
    "rigid": np.array([[1.0, 0, 0, 0, 0, 0], [0, 1.0, 0, 0, 0, 0], [0, 0, 0, -1.0, 1.0, 0]]).T,
    "translation": np.eye(6)[:, :2],
}
LAGS = 2

Scalar = TypeVar("Scalar", bound=np.generic)


class Template(NamedTuple):
    """A block ready to be matched; n rows, m columns. The kernels take it as it is.

    Attributes
    ----------
    values : float32 array, shape (n, m)
        The block, its weighted mean removed.
    weight : float32 array, shape (n, m)
        Share of each pixel, 0 to 1.
    descent : float32 array, shape (n, 6, m)
        Weighted steepest-descent images, orthogonal to 1 and to the block; all six rows of pixels side by side,
        as the kernel reads them.
    solve : float array, shape (6, 6)
        From their products with a picture to the parameters, within the allowed warp.
    influence : float32 array, shape (2, n, m)
        What one grey level at a pixel adds to u and to v, at gain 1, over the root of its weight.
    pairs : float array, shape (lags, 3)
        Sums of products of the influences (uu, uv, vv) over pairs of pixels, by lag.
    taps : float32 array
        Filter that both pictures pass through.
    mean, energy, total : float
        Weighted mean, sum of weighted squares of `values`, sum of the weights.
    left, top : float
        Place of the first pixel as seen from the tracked point, px.
    rigid : bool
        Whether the linear part is held to a rotation.
    """

    values: Float32Array
    weight: Float32Array
    descent: Float32Array
    solve: FloatArray
    influence: Float32Array
    pairs: FloatArray
    taps: Float32Array
    mean: float
    energy: float
    total: float
    left: float
    top: float
    rigid: bool


class Patch(NamedTuple):
    """A block as cut from a picture; n rows, m columns.

    Attributes
    ----------
    values, across, down : float array, shape (n, m)
        Grey levels and their derivatives along x and y.
    left, top : float
        Place of the first pixel as seen from the tracked point, px.
    """

    values: FloatArray
    across: FloatArray
    down: FloatArray
    left: float
    top: float


def cut_patch(image: NDArray[np.uint8], point_px: tuple[float, float], size: int, blur_px: float = 0.0) -> Patch:
    """Cut the size x size pixels whose centre is nearest to a point.

    The pixels are taken as they are and the point keeps its place between them: were the block interpolated
    at a fraction of a pixel, its noise and the noise of its gradient would be correlated, and every match
    pulled by half the derivative of the interpolated noise's variance (measured: 0.009 px at noise 1, contrast 19).

    Parameters
    ----------
    image : uint8 array, shape (height, width)
    point_px : (float, float)
        x, y; an even block has its centre between pixels, an odd one on a pixel.
    size : int
    blur_px : float
        Gaussian blur applied before, px.
    """
    x0, y0 = first_pixel(point_px[0], size), first_pixel(point_px[1], size)
    crop = np.empty((size + 2, size + 2), np.float32)
    spline_crop(read_only(image), prefilter_taps(blur_px), x0 - 1, y0 - 1, crop)
    across, down = gradients_at_pixels(crop)
    return Patch(values_at_pixels(crop), across, down, x0 - point_px[0], y0 - point_px[1])


def first_pixel(centre: float, size: int) -> int:
    """Return the first of `size` pixels whose middle is nearest to `centre`."""
    return int(np.floor(centre - 0.5 * (size - 1) + 0.5))


def steepest_descent(patch: Patch) -> FloatArray:
    """Return the change of the block with each of the six parameters, shape (6, n, m)."""
    n, m = patch.values.shape
    x, y = patch.left + np.arange(m), patch.top + np.arange(n)[:, None]
    gx, gy = patch.across, patch.down
    return np.stack([gx, gy, gx * x, gx * y, gy * x, gy * y])


def build_template(
    patch: Patch, warp: str = "affine", *, weight: Float32Array | None = None, blur_px: float = 0.0
) -> Template:
    """Prepare a block for matching.

    Parameters
    ----------
    patch : Patch
    warp : str
        One of `WARPS`.
    weight : float32 array, shape (n, m), optional
        Share of each pixel, 0 (masked) to 1; all ones when left out.
    blur_px : float
        The blur that the patch was cut with; the picture to match passes through the same.

    Raises
    ------
    numpy.linalg.LinAlgError
        When the block cannot tell the parameters of this warp apart.
    """
    w = np.ones(patch.values.shape, np.float32) if weight is None else np.asarray(weight, np.float32)
    total = float(w.sum(dtype=np.float64))
    mean = float((w * patch.values).sum() / total)
    values = patch.values - mean
    energy = float((w * values**2).sum())
    descent = _orthogonal(steepest_descent(patch), values, w, energy)
    solve = solving_matrix(normal_matrix(descent, w), warp)
    weighted = descent * w
    influence = np.tensordot(solve[:2], descent * np.sqrt(w), 1)
    return Template(
        read_only(values.astype(np.float32)),
        read_only(w),
        read_only(weighted.transpose(1, 0, 2).astype(np.float32)),
        read_only(solve),
        read_only(influence.astype(np.float32)),
        read_only(_pairs_by_lag(influence)),
        read_only(prefilter_taps(blur_px)),
        mean,
        energy,
        total,
        patch.left,
        patch.top,
        warp == "rigid",
    )


def normal_matrix(descent: FloatArray, weight: Float32Array | FloatArray) -> FloatArray:
    """Return the Hessian of the six parameters, shape (6, 6), of steepest-descent images (6, n, m)."""
    flat = descent.reshape(6, -1)
    return np.asarray((flat * weight.ravel()) @ flat.T)


def solving_matrix(hessian: FloatArray, warp: str) -> FloatArray:
    """Return B (B' H B)^-1 B', shape (6, 6): the inverse Hessian within the allowed warp, 0 elsewhere."""
    basis = WARPS[warp]
    return np.asarray(basis @ np.linalg.inv(basis.T @ hessian @ basis) @ basis.T)


def projected_hessian(patch: Patch) -> FloatArray:
    """Return the Hessian (6, 6) of a block with every pixel counted, gain and offset projected out."""
    values = patch.values - patch.values.mean()
    ones = np.ones(values.shape, np.float32)
    return normal_matrix(_orthogonal(steepest_descent(patch), values, ones, float((values**2).sum())), ones)


def significant_hessian(patch: Patch, noise_grey: float, blur_px: float = 0.0) -> FloatArray:
    """Return the Hessian (6, 6) without what white noise adds to it, and eight times that part's own scatter.

    The gradients of noise look like texture: around a lone dot they would vouch for its rotation.
    """
    taps = prefilter_taps(blur_px).astype(np.float64)
    both = np.concatenate([taps[:0:-1], taps])
    gain = (np.convolve(both, SLOPE) ** 2).sum() * (np.convolve(both, SMOOTH) ** 2).sum()
    n, m = patch.values.shape
    one, zero = np.ones((n, m)), np.zeros((n, m))
    plain = patch._replace(across=one, down=zero), patch._replace(across=zero, down=one)
    offsets = sum(normal_matrix(steepest_descent(axis), one) for axis in plain)
    scatter = 1.0 + 8.0 * np.sqrt(2.0 / (n * m))
    return np.asarray(projected_hessian(patch) - scatter * gain * noise_grey**2 * offsets)


def corner_sigma_px(hessian: FloatArray, warp: str, noise_grey: float, half_px: float) -> float:
    """Return the standard deviation of the worst corner's place, px, for white noise in both pictures.

    Infinite when the block cannot tell the parameters of this warp apart.
    """
    basis = WARPS[warp] / np.array([1.0, 1.0, *4 * [half_px]])[:, None]  # all in px at the corner
    if np.linalg.eigvalsh(basis.T @ hessian @ basis)[0] <= 0.0:
        return float("inf")
    solve, variances = solving_matrix(hessian, warp), []
    for x, y in [(x, y) for x in (-half_px, half_px) for y in (-half_px, half_px)]:
        move = np.array([[1.0, 0, x, y, 0, 0], [0, 1.0, 0, 0, x, y]])
        variances.append(np.trace(move @ solve @ move.T) / 2)
    return float(np.sqrt(2.0 * max(variances)) * noise_grey)


def _orthogonal(descent: FloatArray, values: FloatArray, weight: Float32Array, energy: float) -> FloatArray:
    flat, w, r = descent.reshape(6, -1), weight.ravel().astype(np.float64), values.ravel()
    flat = flat - (flat @ w / w.sum())[:, None]
    along = (flat @ (w * r))[:, None] * r / energy if energy > 0.0 else 0.0
    return np.asarray(flat - along).reshape(descent.shape)


def _pairs_by_lag(influence: FloatArray) -> FloatArray:
    """Return sums of K(i) K(i + lag) for lags in a half plane, rows down first: shape (lags, 3)."""
    n, m = influence.shape[1:]
    rows = []
    for dy in range(LAGS + 1):
        for dx in range(-LAGS if dy else 0, LAGS + 1):
            a = influence[:, : n - dy, max(0, -dx) : m - max(0, dx)]
            b = influence[:, dy:, max(0, dx) : m + min(0, dx)]
            cross = np.einsum("aij,bij->ab", a, b)
            rows.append((cross[0, 0], 0.5 * (cross[0, 1] + cross[1, 0]), cross[1, 1]))
    return np.array(rows)


def read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a contiguous read-only view: one array type for every caller, so each kernel compiles once."""
    view = np.ascontiguousarray(array).view()
    view.setflags(write=False)
    return view

"""How sure a match is: its residual, ZNCC, and the standard deviation of a coordinate.

The reported sigma is that of the linear fit with residuals e that are correlated from pixel to pixel, as they
are after interpolation and in compressed video. With the influence K = M J of each pixel on u (or v), it is
the larger of two estimates of the variance of sum(K e):

    by lags    1/gain**2 * sum over lags up to 2 px of C(lag) * sum over i of K(i) K(i + lag)
    by tiles   1/gain**2 * G/(G - 3) * sum over G tiles of about 15 px of (sum over the tile of K e)**2

C is the covariance of e measured in the block; e is multiplied, and K divided, by the root of the weights, which makes
its variance everywhere the same. The first is sharp for white noise, interpolated or not
(Conley, J. Econometrics 92 (1999) 1, eq. 4.1, with stationary residuals; at lag 0 it is the usual s**2 H^-1). The
second sees what a codec does: it moves its macroblocks by fractions of a pixel, each its own way, which looks
like white noise pixel by pixel but not in the products K e (Liang, Zeger, Biometrika 73 (1986) 13, eq. 8). e
holds the noise of both pictures, so sigma does. What moves the whole block alike (a motion vector rounded to
a quarter of a pixel for all its macroblocks) no single block can see: sigma is then too small.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from vml_course.correlate.bspline import KERNEL, f4
from vml_course.correlate.template import LAGS

TILE = 15  # px; a codec moves its pieces of 8 to 16 px by fractions of a pixel, each its own way


@njit(fastmath=True, **KERNEL)
def residual_covariance(residual, dy, dx):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return the mean product of a residual (n, m) with itself, shifted by (dy, dx)."""
    n, m = residual.shape
    total = np.float64(0)
    for i in range(n - dy):
        a, b = residual[i, max(0, -dx) : m - max(0, dx)], residual[i + dy, max(0, dx) : m + min(0, dx)]
        s = f4(0)
        for j in range(a.size):
            s += a[j] * b[j]
        total += np.float64(s)
    return total / ((n - dy) * (m - abs(dx)))


@njit(**KERNEL)
def variance_by_lags(template, residual, total):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Add to total (uu, uv, vv) the variance by the residual's covariance at short lags; return its variance."""
    k, variance = 0, 0.0
    for dy in range(LAGS + 1):
        for dx in range(-LAGS if dy else 0, LAGS + 1):
            c = residual_covariance(residual, dy, dx)
            if k == 0:
                variance = c
            for q in range(3):
                total[q] += (2.0 if k else 1.0) * c * template.pairs[k, q]
            k += 1
    return variance


@njit(**KERNEL)
def tile_sums(influence, residual, top, bottom, left, right):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return what the residual of one tile of the block adds to u and v."""
    u, v = 0.0, 0.0
    for i in range(top, bottom):
        su, sv = f4(0), f4(0)
        for j in range(left, right):
            su += influence[0, i, j] * residual[i, j]
            sv += influence[1, i, j] * residual[i, j]
        u += np.float64(su)
        v += np.float64(sv)
    return u, v


@njit(**KERNEL)
def variance_by_tiles(template, residual, total):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Add to total (uu, uv, vv) the variance by tiles that err together."""
    n, m = residual.shape
    rows, columns = max(3, (n + TILE // 2) // TILE), max(3, (m + TILE // 2) // TILE)
    for i in range(rows):
        for j in range(columns):
            u, v = tile_sums(
                template.influence,
                residual,
                i * n // rows,
                (i + 1) * n // rows,
                j * m // columns,
                (j + 1) * m // columns,
            )
            total[0] += u * u
            total[1] += u * v
            total[2] += v * v
    tiles = rows * columns
    for q in range(3):
        total[q] *= tiles / (tiles - 3.0)


@njit(fastmath=True, **KERNEL)
def leave_residual(template, sampled, sums, step):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Turn what was sampled into the residual that the last step leaves, times the root of the weight."""
    n, m = sampled.shape
    mean, gain = f4(sums[0] / template.total), f4(sums[2] / template.energy)
    s = np.empty(6, np.float32)
    for k in range(6):
        s[k] = gain * f4(step[k])
    for i in range(n):
        f, w, r, d = sampled[i], template.weight[i], template.values[i], template.descent[i]
        for j in range(m):
            moved = s[0] * d[0, j] + s[1] * d[1, j] + s[2] * d[2, j] + s[3] * d[3, j] + s[4] * d[4, j] + s[5] * d[5, j]
            f[j] = np.sqrt(w[j]) * (f[j] - mean - gain * r[j] - moved / w[j])


@njit(**KERNEL)
def judge(template, sampled, sums, pose, report):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Write ZNCC, sigma, gain and residual's size of the block at its last place; see the module's formulas."""
    n, m = sampled.shape
    spread, gain = sums[1] - sums[0] * sums[0] / template.total, sums[2] / template.energy
    lags, tiles = np.zeros(3), np.zeros(3)
    spread_left = variance_by_lags(template, sampled, lags) * n * m / max(template.total - 8.0, 1.0)
    variance_by_tiles(template, sampled, tiles)
    xx, xy, yx, yy = pose[2], pose[3], pose[4], pose[5]
    a, b, c = xx * xx + yx * yx, 2.0 * (xx * xy + yx * yy), xy * xy + yy * yy
    trace = max(a * lags[0] + b * lags[1] + c * lags[2], a * tiles[0] + b * tiles[1] + c * tiles[2])
    report[1] = sums[2] / np.sqrt(template.energy * spread)
    report[2] = np.sqrt(0.5 * trace) / abs(gain)
    report[3] = gain
    report[4] = np.sqrt(spread_left)

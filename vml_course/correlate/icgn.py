"""Matching a block to a picture: inverse-compositional Gauss-Newton on the zero-normalised criterion.

One kernel call a block: cut and filter the crop, iterate, judge. The picture is modelled as
`picture(W(X)) = offset + gain * block(X)`; a step moves the block by dp = M (J' picture) / gain with M and J
from `template`, and the warp becomes W o w(dp)^-1. `judge` says how sure the place is.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from vml_course.correlate.bspline import KERNEL, f4, sample_row, spline_crop
from vml_course.correlate.judge import judge, leave_residual
from vml_course.correlate.template import Template

FloatArray = NDArray[np.float64]

MARGIN = 4  # px that a block may move before its crop is cut again
LARGEST_STEP = 6.0  # px at the corner, one iteration
SMALLEST_GAIN = 0.5  # share of the contrast ratio; a poor start must not turn into a giant step
LARGEST_STRETCH = 3.0
BLANK_VARIANCE = 0.01  # grey levels squared; float32 sums tell no less from nothing
GEOMETRIC_PX = 0.3  # at the corner: shorter steps shrink by the same share each time
LARGEST_STRETCH_OF_STEP = 1.4
SAME_WAY = 0.9  # cosine
SAFETY = 2.0  # on that share


class Outcome(IntEnum):
    """How the iterations ended."""

    CONVERGED = 0
    NOT_CONVERGED = 1
    OUTSIDE = 2
    RUNAWAY = 3
    BLANK = 4


OUTCOMES = tuple(Outcome)


class Pace(NamedTuple):
    """How the steps of a block near the end of a match shrink; learned in one picture, used in the next.

    Attributes
    ----------
    stretch : float
        What a step is to be multiplied by. Noise and a codec weaken the texture that two pictures share, so that
        Gauss-Newton steps fall short, all by the same share (1 % lossless, 20 % at crf 23).
    contraction : float
        The next step as a share of the one before, at most; 1 when it is not known.
    """

    stretch: float = 1.0
    contraction: float = 1.0


UNKNOWN_PACE = Pace()


class Match(NamedTuple):
    """Where a block was found.

    Attributes
    ----------
    pose : float array, shape (6,)
        Centre x, y (px) and A row by row (xx, xy, yx, yy): a point at offset X of the block is seen at centre + A X.
    outcome : Outcome
    iterations : int
    zncc : float
    sigma_px : float
        Standard deviation of a coordinate of the centre (root mean square of x and y).
    gain, residual_grey : float
        Contrast against the block, and the residual's standard deviation.
    residual : float32 array, shape (n, m)
        What is left of the picture under the block, grey levels times the root of the weight; meaningful when
        converged.
    pace : Pace
        As measured; as given when one step was enough.
    """

    pose: FloatArray
    outcome: Outcome
    iterations: int
    zncc: float
    sigma_px: float
    gain: float
    residual_grey: float
    residual: NDArray[np.float32]
    pace: Pace


def match(  # noqa: PLR0913 - one match is these numbers
    image: NDArray[np.uint8],
    template: Template,
    start: FloatArray,
    *,
    max_iterations: int = 40,
    tolerance_px: float = 1e-3,
    max_shift_px: float = 40.0,
    pace: Pace = UNKNOWN_PACE,
) -> Match:
    """Find the block near a first guess.

    Parameters
    ----------
    image : uint8 array, shape (height, width)
        C-contiguous and read-only, so that one compiled kernel serves every caller.
    template : Template
    start : float array, shape (6,)
        First guess of the pose.
    max_iterations : int
    tolerance_px : float
        Converged when the next step would move no corner of the block by more.
    max_shift_px : float
        The centre may not leave its first guess by more along x or y.
    pace : Pace
        What is known of the steps of this block.
    """
    report = np.full(7, np.nan)
    pose = np.array(start, dtype=np.float64)
    residual = np.empty(template.values.shape, np.float32)
    limits = np.array([max_iterations, tolerance_px, max_shift_px, *pace])
    outcome = iterate(image, template, pose, limits, report, residual)
    iterations, zncc, sigma, gain, spread, *measured = report.tolist()
    pace = pace if math.isnan(measured[0]) else Pace(*measured)
    return Match(pose, OUTCOMES[outcome], int(iterations), zncc, sigma, gain, spread, residual, pace)


@njit(fastmath=True, **KERNEL)
def sample_and_sum(crop, local, template, sampled, sums):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Sample the picture under the warped block and form the nine sums of a step, block mean removed.

    sums: w f, w f**2, w f r, then the products of f with the six steepest-descent images.
    """
    n, m = sampled.shape
    index, lanes = np.empty(m, np.int32), np.empty((8, m), np.float32)
    flat, stride = crop.ravel(), np.int32(crop.shape[1])
    left, mean = template.left, f4(template.mean)
    for k in range(9):
        sums[k] = 0.0
    for i in range(n):
        down = template.top + i
        x, y = local[0] + local[2] * left + local[3] * down, local[1] + local[4] * left + local[5] * down
        f, w, r, d = sampled[i], template.weight[i], template.values[i], template.descent[i]
        sample_row(flat, stride, f4(x), f4(y), f4(local[2]), f4(local[4]), index, lanes, f)
        s0, s1, s2 = f4(0), f4(0), f4(0)
        a, b, c, e, g, h = f4(0), f4(0), f4(0), f4(0), f4(0), f4(0)
        for j in range(m):
            fj = f[j] - mean
            f[j] = fj
            wf = w[j] * fj
            s0 += wf
            s1 += wf * fj
            s2 += wf * r[j]
            a += d[0, j] * fj
            b += d[1, j] * fj
            c += d[2, j] * fj
            e += d[3, j] * fj
            g += d[4, j] * fj
            h += d[5, j] * fj
        for k, s in enumerate((s0, s1, s2, a, b, c, e, g, h)):
            sums[k] += s


@njit(**KERNEL)
def bounds(pose, template):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return left, top, right, bottom of the upright box around the warped block, px."""
    n, m = template.values.shape
    half_x, half_y = 0.5 * (m - 1), 0.5 * (n - 1)
    middle_x, middle_y = template.left + half_x, template.top + half_y
    x = pose[0] + pose[2] * middle_x + pose[3] * middle_y
    y = pose[1] + pose[4] * middle_x + pose[5] * middle_y
    ex = abs(pose[2]) * half_x + abs(pose[3]) * half_y
    ey = abs(pose[4]) * half_x + abs(pose[5]) * half_y
    return x - ex, y - ey, x + ex, y + ey


@njit(**KERNEL)
def place(image, pose, start, max_shift, template):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return 0 when a block at this pose can be sampled, 2 when outside the image, 3 when it ran away."""
    for k in range(6):
        if not np.isfinite(pose[k]) or (k > 1 and abs(pose[k]) > LARGEST_STRETCH):
            return 3
    if abs(pose[0] - start[0]) > max_shift or abs(pose[1] - start[1]) > max_shift:
        return 3
    left, top, right, bottom = bounds(pose, template)
    if left < 0.0 or top < 0.0 or right > image.shape[1] - 1 or bottom > image.shape[0] - 1:
        return 2
    return 0


@njit(**KERNEL)
def compose(pose, step, rigid):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Replace the warp W by W o w(step)^-1; a rigid one is brought back to a rotation."""
    a, b, c, d = 1.0 + step[2], step[3], step[4], 1.0 + step[5]
    det = a * d - b * c
    xx, xy, yx, yy = pose[2], pose[3], pose[4], pose[5]
    pose[2], pose[3] = (xx * d - xy * c) / det, (xy * a - xx * b) / det
    pose[4], pose[5] = (yx * d - yy * c) / det, (yy * a - yx * b) / det
    if rigid:
        angle = np.arctan2(pose[4] - pose[3], pose[2] + pose[5])
        pose[2], pose[3], pose[4], pose[5] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
    pose[0] -= pose[2] * step[0] + pose[3] * step[1]
    pose[1] -= pose[4] * step[0] + pose[5] * step[1]


@njit(**KERNEL)
def gauss_newton_step(template, sums, step):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Write the six parameters of a step; return how far a corner moves at most, -1 for a blank picture."""
    spread = sums[1] - sums[0] * sums[0] / template.total
    if spread <= BLANK_VARIANCE * template.total:
        return -1.0
    gain = max(sums[2] / template.energy, SMALLEST_GAIN * np.sqrt(spread / template.energy))
    for k in range(6):
        step[k] = 0.0
        for q in range(6):
            step[k] += template.solve[k, q] * sums[3 + q]
        step[k] /= gain
    n, m = template.values.shape
    across, down = 0.5 * (m - 1), 0.5 * (n - 1)
    dx = abs(step[0]) + abs(step[2]) * across + abs(step[3]) * down
    dy = abs(step[1]) + abs(step[4]) * across + abs(step[5]) * down
    moved = np.sqrt(dx * dx + dy * dy)
    if moved > LARGEST_STEP:
        for k in range(6):
            step[k] *= LARGEST_STEP / moved
    return moved


@njit(**KERNEL)
def compare(template, step, last):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return the products of two steps: with each other, each with itself; in px at the edge of the block, squared."""
    n, m = template.values.shape
    scale = 0.25 * (n * n + m * m) / 2.0  # of the linear part against the place, at the edge of the block
    along, size, size_last = 0.0, 0.0, 0.0
    for k in range(6):
        weight = scale if k > 1 else 1.0
        along += weight * step[k] * last[k]
        size += weight * step[k] * step[k]
        size_last += weight * last[k] * last[k]
    return along, size, size_last


@njit(**KERNEL)
def damp(products, share, hardly_shrinks):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return the share of the steps that is taken from here on: half of it when they swing to and fro.

    Where the picture's gradients are weaker than the block's (blur, another background in its corners), the
    block's Hessian overshoots by up to twice the error, and undamped steps swing for ever.
    """
    along, size, size_last = products
    if hardly_shrinks and along < -0.5 * np.sqrt(size * size_last):
        return max(0.5 * share, 0.25)
    return share


@njit(**KERNEL)
def measure_pace(products, pull, report):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Write stretch and contraction, from a step and the one before, which was `pull` times as long as computed.

    When steps fall short by q, the second is 1 / pull - (1 - q) of the first (of what was taken of it). Only where
    both, had they not been stretched, point the same way, do all freedoms fall short alike: a block that slides along
    an edge has slow ones and fast ones, and stretching would throw the fast ones past their place.
    """
    along, size, size_last = products
    more = 1.0 - 1.0 / pull
    plain_along, plain_size = along + more * size_last, size + 2.0 * more * along + more * more * size_last
    are_alike = plain_along > SAME_WAY * np.sqrt(plain_size * size_last)
    reach = 1.0 / pull - along / size_last
    is_short = 1.0 / LARGEST_STRETCH_OF_STEP <= reach < 1.0
    report[5] = 1.0 / reach if are_alike and is_short else 1.0
    report[6] = np.sqrt(size / size_last)


@njit(**KERNEL)
def needs_crop(box, crop, x0, y0):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Whether a box, with what the spline needs around it, reaches beyond the crop at (x0, y0)."""
    left, top, right, bottom = box
    fits = left - x0 >= 1.0 and top - y0 >= 1.0
    return not (fits and right - x0 < crop.shape[1] - 2.01 and bottom - y0 < crop.shape[0] - 2.01)


@njit(**KERNEL)
def take_step(template, pose, memory, limits, report):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Move the pose by a step, damped or stretched; return whether that was the last one.

    memory: the step as computed, the last one as taken, share, pull, how far a corner moves now and moved before.
    """
    step, last, state = memory
    products, moved, before = compare(template, step, last), state[2], state[3]
    state[0] = damp(products, state[0], moved > 0.3 * before)
    if 0.0 < before < GEOMETRIC_PX:
        measure_pace(products, state[1], report)
    state[1] = state[0] * (limits[3] if moved < GEOMETRIC_PX else 1.0)
    for k in range(6):
        last[k] = state[1] * step[k]
    compose(pose, last, template.rigid)
    state[3] = state[1] * moved
    shrinks = limits[4] if np.isnan(report[6]) else report[6]
    is_small = state[3] < GEOMETRIC_PX and state[3] * min(SAFETY * shrinks, 1.0) < limits[1]
    return is_small or state[3] < limits[1]


@njit(**KERNEL)
def iterate(image, template, pose, limits, report, sampled):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Run the iterations from `pose`, which is replaced; return the outcome and fill the report.

    limits: iterations, tolerance, largest shift, stretch, contraction; report: iterations, ZNCC, sigma, gain,
    residual's standard deviation, stretch, contraction; sampled: receives the residual.
    """
    start, local = pose.copy(), pose.copy()
    sums, step = np.empty(9), np.empty(6)
    memory = step, np.zeros(6), np.array([1.0, 1.0, 0.0, 0.0])
    crop, x0, y0 = np.empty((0, 0), np.float32), 0, 0
    report[0] = 0
    while report[0] < limits[0]:
        problem = place(image, pose, start, limits[2], template)
        if problem:
            return problem
        box = bounds(pose, template)
        if needs_crop(box, crop, x0, y0):
            x0, y0 = int(box[0]) - MARGIN, int(box[1]) - MARGIN
            crop = np.empty((int(box[3]) + MARGIN + 3 - y0, int(box[2]) + MARGIN + 3 - x0), np.float32)
            spline_crop(image, template.taps, x0, y0, crop)
        local[:] = pose
        local[0], local[1] = pose[0] - x0, pose[1] - y0
        sample_and_sum(crop, local, template, sampled, sums)
        memory[2][2] = gauss_newton_step(template, sums, step)
        if memory[2][2] < 0.0:
            return 4
        report[0] += 1
        if take_step(template, pose, memory, limits, report):
            leave_residual(template, sampled, sums, step)
            judge(template, sampled, sums, pose, report)
            return 0
    return 1

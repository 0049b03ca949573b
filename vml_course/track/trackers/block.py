"""Block matching: a block is slid over a search region, and the place of least mean squared error counts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import ClassVar, final

import cv2
import numpy as np

from vml_course.correlate.template import first_pixel
from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma
from vml_course.model.quantity import check_quantities, quantity
from vml_course.model.track import Sighting
from vml_course.track.blocks import (
    Found,
    check_block,
    cut,
    expected_variance,
    first_sighting,
    middle_offset,
    seen_at,
    shift_variance,
    sighting_of,
    zncc,
)

PARABOLA_PX = 0.03  # systematic error of the quadratic fit: a sum of squares is no parabola
LARGEST_REGION = 3.0  # of the search radius, for a point that is lost
# Least squares of a + b x + c y + d x**2 + e x y + f y**2 over 3 x 3 values, row by row.
_ACROSS, _DOWN = (grid.ravel() for grid in np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]))
_QUADRATIC = np.linalg.pinv(np.stack([np.ones(9), _ACROSS, _DOWN, _ACROSS**2, _ACROSS * _DOWN, _DOWN**2], axis=1))


@dataclass(frozen=True, eq=False)
class Sliding:
    """One point: its first block, the template in use and how far off it may be cut, and where it was last seen."""

    first: Luma
    first_offset: FloatArray
    template: Luma
    offset: FloatArray
    drift_px: float
    xy_px: FloatArray
    lost: int = 0


@dataclass(frozen=True, eq=False)
class BlockState:
    """What `Block` remembers: its points."""

    points: tuple[Sliding, ...]


@final
@dataclass(frozen=True)
class Block:
    """The paper's section 3.2: full search for the least mean squared error (its equation 4), then a quadratic fit.

    The search region lies about the last place. The template is the first block as long as it fits; when its
    ZNCC sinks below `renew_below` in a match that counts, because the thing has turned, it is cut anew there, at
    whole pixels with the sub-pixel place kept. Each renewal adds its error for good, and sigma grows by it.
    So a thing that only shifts does not drift, and one that turns is followed, from renewal to renewal.

    A point is lost when the best place is unlike the template, or lies at the rim of the region.
    """

    name: ClassVar[str] = "block"
    title: ClassVar[str] = "block matching (least squares of grey levels): simple, for things that do not turn"

    block: float = quantity(60, "px", 11, 301, about="side of the block that is matched", whole=True)
    search_radius: float = quantity(40, "px", 2, 500, about="how far from its last place a point may be", whole=True)
    renew_below: float = quantity(0.9, "", 0.3, 1.0, about="correlation below which the template is cut anew")
    zncc_lost: float = quantity(0.6, "", 0.3, 0.99, about="least correlation of a match")
    give_up_frames: float = quantity(
        15, "", 1, 100000, about="pictures after which a lost point stays lost", whole=True
    )

    def __post_init__(self) -> None:
        check_quantities(self)

    @property
    def settings(self) -> Mapping[str, str | int | float]:
        """How it tracks, as written into the track's file."""
        return {"method": self.name, **asdict(self)}

    def start(self, luma: Luma, seeds_px: FloatArray) -> tuple[BlockState, Sighting]:
        """Learn the blocks about the points, shape (p, 2), px, from the first picture.

        Raises
        ------
        SeedError
            When a block does not lie inside the picture, or has no texture or only an edge.
        """
        points = np.asarray(seeds_px, dtype=np.float64).reshape(-1, 2)
        learnt = tuple(self._learn(luma, f"seed {k}", point) for k, point in enumerate(points, start=1))
        expected = np.sqrt([expected_variance(point.first) + PARABOLA_PX**2 for point in learnt])
        return BlockState(learnt), first_sighting(points, expected)

    def step(self, state: BlockState, luma: Luma) -> tuple[BlockState, Sighting]:
        """Find the points in the next picture."""
        followed = [self._follow(point, luma) for point in state.points]
        return BlockState(tuple(point for point, _ in followed)), sighting_of([found for _, found in followed])

    def _learn(self, luma: Luma, name: str, at: FloatArray) -> Sliding:
        point, size = (float(at[0]), float(at[1])), int(self.block)
        check_block(luma, name, point, size)
        first, offset = cut(luma, point, size).copy(), middle_offset(point, size)
        return Sliding(first, offset, first, offset, 0.0, at)

    def _follow(self, point: Sliding, luma: Luma) -> tuple[Sliding, Found | None]:
        if point.lost >= self.give_up_frames:
            return point, None
        radius = self.search_radius * min(1.0 + 0.25 * point.lost, LARGEST_REGION)
        middle = slide(luma, point.template, point.xy_px + point.offset, radius)
        lost = replace(point, lost=point.lost + 1), None
        if middle is None:
            return lost
        at = middle - point.offset
        seen = seen_at(luma, point.template, point.offset, at)
        likeness = zncc(point.template, seen)
        if likeness < self.zncc_lost:
            return lost
        white, structured = shift_variance(point.template, seen)
        drift = point.drift_px + float(np.sqrt(structured))
        sigma = float(np.sqrt(white + PARABOLA_PX**2 + drift**2))
        first = zncc(point.first, seen_at(luma, point.first, point.first_offset, at))
        followed = replace(point, xy_px=at, lost=0)
        if likeness < self.renew_below:
            followed = _renewed(followed, luma, sigma)
        return followed, Found(at, sigma, first, 1)


def slide(luma: Luma, template: Luma, middle: FloatArray, radius: float) -> FloatArray | None:
    """Return the middle of the best place within +-radius px, to a fraction of a pixel.

    None when the region does not hold the template, or the best place is at its rim: then the true one is beyond.
    """
    size, (height, width) = template.shape[0], luma.shape
    x0, y0 = (max(0, first_pixel(float(c) - radius, size)) for c in middle)
    x1, y1 = (
        min(n, first_pixel(float(c) + radius, size) + size + 1)
        for c, n in zip(middle, (width, height), strict=True)
    )  # fmt: skip
    if x1 - x0 < size + 2 or y1 - y0 < size + 2:
        return None
    squares = cv2.matchTemplate(luma[y0:y1, x0:x1], template, cv2.TM_SQDIFF)
    _, _, (column, row), _ = cv2.minMaxLoc(squares)
    if not (0 < row < squares.shape[0] - 1 and 0 < column < squares.shape[1] - 1):
        return None
    fraction = vertex(np.asarray(squares[row - 1 : row + 2, column - 1 : column + 2], np.float64))
    return np.asarray(np.array([x0 + column, y0 + row]) + 0.5 * (size - 1) + fraction)


def vertex(values: FloatArray) -> FloatArray:
    """Return x, y of the lowest point of the quadratic surface through 3 x 3 values, within +-1 of the middle.

    >>> x, y = np.meshgrid([-1, 0, 1], [-1, 0, 1])
    >>> vertex((x - 0.25) ** 2 + (y + 0.5) ** 2 + 0.5 * (x - 0.25) * (y + 0.5)).round(9)
    array([ 0.25, -0.5 ])
    """
    _, b, c, d, e, f = (_QUADRATIC @ values.ravel()).tolist()
    determinant = 4.0 * d * f - e * e
    if determinant <= 0.0 or d <= 0.0:
        return np.zeros(2)
    return np.asarray(np.clip([(e * c - 2.0 * f * b) / determinant, (e * b - 2.0 * d * c) / determinant], -1.0, 1.0))


def _renewed(point: Sliding, luma: Luma, sigma_px: float) -> Sliding:
    """Return the point with a template cut where it is now, when that lies inside the picture."""
    at, size = (float(point.xy_px[0]), float(point.xy_px[1])), point.template.shape[0]
    first = [first_pixel(c, size) for c in at]
    if min(first) < 0 or first[0] + size > luma.shape[1] or first[1] + size > luma.shape[0]:
        return point
    template = cut(luma, at, size).copy()
    return replace(point, template=template, offset=middle_offset(at, size), drift_px=sigma_px)


METHOD = Block

"""Optical flow: the shift of a block from one picture to the next, by pyramidal Lucas-Kanade."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import ClassVar, final

import cv2
import numpy as np

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

STEPS, SMALLEST_STEP_PX = 40, 0.001
REACH_PX = 24  # of one level of the pyramid, beyond the block
RESIDUAL_RATE_PX = 0.02  # systematic error of one step: 8-bit gradients, linear interpolation


@dataclass(frozen=True, eq=False)
class Flowing:
    """One point: its first block, and where and in which picture it was last seen."""

    first: Luma
    offset: FloatArray
    picture: Luma
    xy_px: FloatArray
    variance: float
    lost: int = 0


@dataclass(frozen=True, eq=False)
class FlowState:
    """What `Flow` remembers: its points."""

    points: tuple[Flowing, ...]


@final
@dataclass(frozen=True)
class Flow:
    """The paper's section 3.1: brightness moves unchanged, one shift for all pixels of a block.

    Each picture is compared with the one before it, so turning and slow changes of light do little harm, and
    a blurred or far step is reached through the pyramid; but the errors of the steps add up: the point drifts.
    sigma grows accordingly.

    A point is lost when it does not come back to its place on the way back, or when the block does not look like
    the one it is said to have come from. It is looked for again from the picture in which it was last seen.

    References
    ----------
    Lucas, Kanade, Proc. IJCAI 1981, 674; Bouguet, Intel 2001 (pyramids); Kalal, Mikolajczyk, Matas, Proc. ICPR
    2010, 2756 (forward-backward error).
    """

    name: ClassVar[str] = "flow"
    title: ClassVar[str] = "optical flow (Lucas-Kanade) from picture to picture: forgiving, but it drifts"

    block: float = quantity(60, "px", 11, 301, about="side of the block whose shift is found", whole=True)
    levels: float = quantity(3, "", 0, 6, about="halvings of the picture above the finest", whole=True)
    back_px: float = quantity(1.0, "px", 0.05, 10.0, about="farthest from its place that the way back may end")
    zncc_lost: float = quantity(0.6, "", 0.3, 0.99, about="least correlation with the picture before")
    give_up_frames: float = quantity(
        15, "", 1, 100000, about="pictures after which a lost point stays lost", whole=True
    )

    def __post_init__(self) -> None:
        check_quantities(self)

    @property
    def settings(self) -> Mapping[str, str | int | float]:
        """How it tracks, as written into the track's file."""
        return {"method": self.name, **asdict(self)}

    def start(self, luma: Luma, seeds_px: FloatArray) -> tuple[FlowState, Sighting]:
        """Learn the blocks about the points, shape (p, 2), px, from the first picture.

        Raises
        ------
        SeedError
            When a block does not lie inside the picture, or has no texture or only an edge.
        """
        points = np.asarray(seeds_px, dtype=np.float64).reshape(-1, 2)
        learnt = tuple(self._learn(luma, f"seed {k}", point) for k, point in enumerate(points, start=1))
        return FlowState(learnt), first_sighting(points, np.sqrt([point.variance for point in learnt]))

    def step(self, state: FlowState, luma: Luma) -> tuple[FlowState, Sighting]:
        """Find the points in the next picture."""
        followed = [self._follow(point, luma) for point in state.points]
        return FlowState(tuple(point for point, _ in followed)), sighting_of([found for _, found in followed])

    def _learn(self, luma: Luma, name: str, at: FloatArray) -> Flowing:
        point, size = (float(at[0]), float(at[1])), int(self.block)
        check_block(luma, name, point, size)
        first = cut(luma, point, size).copy()
        return Flowing(first, middle_offset(point, size), luma, at, expected_variance(first))

    def _follow(self, point: Flowing, luma: Luma) -> tuple[Flowing, Found | None]:
        if point.lost >= self.give_up_frames:
            return point, None
        moved = self._moved(point, luma)
        if moved is None:
            return replace(point, lost=point.lost + 1), None
        there, missed_px = moved
        before, now = (
            seen_at(p, point.first, point.offset, xy) for p, xy in ((point.picture, point.xy_px), (luma, there))
        )
        if zncc(before, now) < self.zncc_lost:
            return replace(point, lost=point.lost + 1), None
        added = max(shift_variance(before, now), 0.25 * missed_px**2, RESIDUAL_RATE_PX**2)
        variance = point.variance + added
        found = Found(there, float(np.sqrt(variance)), zncc(point.first, now), 0)
        return Flowing(point.first, point.offset, luma, there, variance), found

    def _moved(self, point: Flowing, luma: Luma) -> tuple[FloatArray, float] | None:
        """Return where the block went, and by how much the way back misses; None when it went nowhere."""
        window = _window(luma.shape, point.xy_px, int(self.block), int(self.levels))
        earlier, later = point.picture[window], luma[window]
        corner = np.array([window[1].start, window[0].start], np.float64)
        start = point.xy_px - corner
        there = self._shifted(earlier, later, start)
        back = None if there is None else self._shifted(later, earlier, there)
        if there is None or back is None:
            return None
        missed, at = float(np.hypot(*(back - start))), there + corner
        room = np.array(luma.shape[::-1]) - 1.0
        return (at, missed) if missed <= self.back_px and np.all((at >= 0.0) & (at <= room)) else None

    def _shifted(self, earlier: Luma, later: Luma, at: FloatArray) -> FloatArray | None:
        size, place = int(self.block), at.astype(np.float32).reshape(1, 1, 2)
        stop = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, STEPS, SMALLEST_STEP_PX)
        there, found, _ = cv2.calcOpticalFlowPyrLK(
            earlier, later, place, np.empty_like(place), winSize=(size, size), maxLevel=int(self.levels), criteria=stop
        )
        return np.asarray(there, np.float64).reshape(2) if found.item() else None


def _window(shape: tuple[int, ...], at: FloatArray, size: int, levels: int) -> tuple[slice, slice]:
    """Return the part of the picture that the pyramid needs; building it for the whole would cost most of the time."""
    reach = size // 2 + REACH_PX * 2 ** min(levels, 2)
    x, y = (slice(max(0, int(c) - reach), min(n, int(c) + reach + 2)) for c, n in zip(at, shape[::-1], strict=True))
    return y, x


METHOD = Flow

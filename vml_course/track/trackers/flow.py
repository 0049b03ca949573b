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

STOP = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 20, 0.005)  # steps, px
FROM_GUESS = cv2.OPTFLOW_USE_INITIAL_FLOW
REACH_PX = 24  # of one level of the pyramid, beyond the block
STEP_PX = 0.001  # systematic error of one step: 8-bit gradients, linear interpolation


@dataclass(frozen=True, eq=False)
class Flowing:
    """One point: its first block, where and in which picture it was last seen, and the drift that is to be feared."""

    first: Luma
    offset: FloatArray
    picture: Luma
    xy_px: FloatArray
    speed_px: FloatArray
    drift_px: float = 0.0
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
    levels: float = quantity(2, "", 0, 6, about="halvings of the picture above the finest", whole=True)
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
        return FlowState(learnt), first_sighting(points, np.sqrt([expected_variance(point.first) for point in learnt]))

    def step(self, state: FlowState, luma: Luma) -> tuple[FlowState, Sighting]:
        """Find the points in the next picture."""
        followed = [self._follow(point, luma) for point in state.points]
        return FlowState(tuple(point for point, _ in followed)), sighting_of([found for _, found in followed])

    def _learn(self, luma: Luma, name: str, at: FloatArray) -> Flowing:
        point, size = (float(at[0]), float(at[1])), int(self.block)
        check_block(luma, name, point, size)
        first = cut(luma, point, size).copy()
        return Flowing(first, middle_offset(point, size), luma, at, np.zeros(2))

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
        white, structured = shift_variance(before, now)
        # Noise does not add up: what is wrong in this picture is undone by the next. The rest goes on and on.
        drift = point.drift_px + float(np.sqrt(structured + 0.25 * missed_px**2)) + STEP_PX
        found = Found(there, float(np.hypot(np.sqrt(white), drift)), zncc(point.first, now), 0)
        return Flowing(point.first, point.offset, luma, there, (there - point.xy_px) / (point.lost + 1), drift), found

    def _moved(self, point: Flowing, luma: Luma) -> tuple[FloatArray, float] | None:
        """Return where the block went, and by how much the way back misses; None when it went nowhere.

        The first guess is that it goes on as before, the second that it stopped.
        """
        for guess in (point.xy_px + (point.lost + 1) * point.speed_px, point.xy_px):
            moved = self._moved_from(guess, point, luma) if _is_inside(guess, luma) else None
            if moved is not None:
                return moved
        return None

    def _moved_from(self, guess: FloatArray, point: Flowing, luma: Luma) -> tuple[FloatArray, float] | None:
        size, levels = int(self.block), int(self.levels)
        window = _window(luma.shape, (point.xy_px, guess), size, levels)
        earlier, later = point.picture[window], luma[window]
        corner = np.array([window[1].start, window[0].start], np.float64)
        start, onward = point.xy_px - corner, guess - point.xy_px
        there = _shifted((earlier, later), start, start + onward, (size, levels))
        back = None if there is None else _shifted((later, earlier), there, there - onward, (size, levels))
        if there is None or back is None:
            return None
        missed, at = float(np.hypot(*(back - start))), there + corner
        return (at, missed) if missed <= self.back_px and _is_inside(at, luma) else None


def _is_inside(at: FloatArray, luma: Luma) -> bool:
    return bool(np.all((at >= 0.0) & (at <= np.array(luma.shape[::-1]) - 1.0)))


def _shifted(
    pictures: tuple[Luma, Luma], at: FloatArray, guess: FloatArray, sizes: tuple[int, int]
) -> FloatArray | None:
    """Return where the block about a point of the first picture is in the second one."""
    place, start = (p.astype(np.float32).reshape(1, 1, 2) for p in (at, guess))
    there, found, _ = cv2.calcOpticalFlowPyrLK(
        *pictures, place, start, winSize=(sizes[0],) * 2, maxLevel=sizes[1], criteria=STOP, flags=FROM_GUESS
    )
    return np.asarray(there, np.float64).reshape(2) if found.item() else None


def _window(shape: tuple[int, ...], places: tuple[FloatArray, ...], size: int, levels: int) -> tuple[slice, slice]:
    """Return the part of the pictures that the pyramids need: building them for the whole costs most of the time."""
    reach = size // 2 + REACH_PX * 2 ** min(levels, 2)
    low, high = np.min(places, axis=0), np.max(places, axis=0)
    x, y = (
        slice(max(0, int(a) - reach), min(n, int(b) + reach + 2))
        for a, b, n in zip(low, high, shape[::-1], strict=True)
    )
    return y, x


METHOD = Flow

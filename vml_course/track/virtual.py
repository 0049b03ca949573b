"""Points that are not tracked but carried by others on the same rigid body: a joint on plain cloth, say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from vml_course.errors import InputError, UnknownNameError
from vml_course.model.arrays import FloatArray
from vml_course.model.track import Status, Track
from vml_course.track.repair import row_of
from vml_course.track.sweep import FIELDS, blank_rows

NEAREST_PX = 2.0  # carriers that are all closer to their mean tell no direction
SMALLEST_SIGMA_PX = 1e-3
SEEN = (Status.AUTO, Status.MANUAL)
USUAL_BLOCK_PX = 60.0


@dataclass(frozen=True, slots=True)
class VirtualPoint:
    """A point that moves with tracked points of the same body.

    Attributes
    ----------
    name : str
    of : tuple of str
        The points that carry it: two or more, or one whose block's own rotation does.
    x_px, y_px : float
        Where it is seen in frame `frame` (y down).
    frame : int or None
        None: the first frame.
    """

    name: str
    of: tuple[str, ...]
    x_px: float
    y_px: float
    frame: int | None = None


class Carried(NamedTuple):
    """Places of a carried point, shape (n, 2), px, and their standard deviations, shape (n,); NaN where not known."""

    xy_px: FloatArray
    sigma_px: FloatArray


def with_virtual(track: Track, virtual: VirtualPoint) -> Track:
    """Return the track with a carried point as its last column, status `virtual`; one of that name is replaced.

    Its ZNCC and gradients are NaN; where it cannot be told where it is, it is NaN with status `lost`.

    Raises
    ------
    UnknownNameError
        When a carrying point is none of the track's.
    FrameRangeError
        When the frame is not one of the track's.
    InputError
        When its name is that of a tracked point, a point is named twice, the place is no number, too few points
        are seen in that frame, or they lie on one place.
    """
    track = without(track, virtual.name)
    check_virtual(virtual, track.points)
    home = 0 if virtual.frame is None else row_of(track, virtual.frame)
    columns = [track.point_index(name) for name in virtual.of]
    at = np.array([virtual.x_px, virtual.y_px])
    carried = _by_turn(track, columns[0], home, at) if len(columns) == 1 else _by_points(track, columns, home, at)
    if not np.isfinite(carried.xy_px[home]).all():
        seen = f"{', '.join(virtual.of)} in frame {track.frame[home]}"
        raise InputError(f"virtual {virtual.name}", f"to see {seen}, apart from one another", "too few of them")
    return _appended(track, virtual.name, carried, int(track.frame[home]))


def without(track: Track, name: str) -> Track:
    """Return the track without a virtual point; as it is when there is none of that name.

    Raises
    ------
    InputError
        When the point is tracked.
    """
    if name not in track.points:
        return track
    column = track.point_index(name)
    if not np.isin(track.status[:, column], [Status.VIRTUAL, Status.INTERP, Status.LOST]).all():
        raise InputError(f"virtual {name}", "a name that no tracked point has", repr(name))
    arrays: dict[str, Any] = {one: np.delete(getattr(track, one), column, axis=1) for one in (*FIELDS, "reference")}
    return replace(track, points=tuple(point for point in track.points if point != name), **arrays)


def stretch(track: Track, virtual: VirtualPoint) -> float:
    """Return the largest change of a distance between two carriers, as a share: 0 on a rigid body in the plane.

    Raises
    ------
    UnknownNameError
    """
    largest = 0.0
    for one, other in combinations([track.point_index(name) for name in virtual.of], 2):
        apart = np.hypot(*(track.xy_px[:, one] - track.xy_px[:, other]).T)
        home = apart[0 if virtual.frame is None else row_of(track, virtual.frame)]
        if np.isfinite(apart).any():
            largest = max(largest, float(np.nanmax(np.abs(apart / home - 1.0))))
    return largest


def check_virtual(virtual: VirtualPoint, points: Sequence[str]) -> None:
    """Refuse a virtual point whose carriers are not among these points, or whose place is no number.

    Raises
    ------
    UnknownNameError, InputError
    """
    if len(set(virtual.of)) < len(virtual.of) or not virtual.of:
        raise InputError(f"virtual {virtual.name}", "different points that carry it", "+".join(virtual.of) or "none")
    for name in virtual.of:
        if name not in points:
            raise UnknownNameError(f"virtual {virtual.name}", name, points)
    if not np.isfinite([virtual.x_px, virtual.y_px]).all():
        raise InputError(f"virtual {virtual.name}", "a place in px", f"({virtual.x_px:g}, {virtual.y_px:g})")


def _by_points(track: Track, columns: list[int], home: int, at_px: FloatArray) -> Carried:
    """Carry a place by the rigid motion that fits its carriers best, weighted by their variances.

    With a, b the places from their weighted means at home and now, the angle of least squares is
    atan2(sum w a x b, sum w a . b): the plane case of Kabsch, "A solution for the best rotation to relate two sets of
    vectors", Acta Cryst. A32 (1976) 922. The variance of a coordinate (mean of x and y) is 1 / sum w from the mean, and
    half of lever**2 / sum w |a|**2 from the angle.
    """
    there, now = track.xy_px[home, columns], track.xy_px[:, columns]
    weight = _weights(track, columns, home)
    total = weight.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = (weight / total[:, None])[..., None]
        mean_there, mean_now = (share * np.nan_to_num(there)).sum(axis=1), (share * np.nan_to_num(now)).sum(axis=1)
        a, b = np.nan_to_num(there - mean_there[:, None]), np.nan_to_num(now - mean_now[:, None])
        across = (weight * (a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])).sum(axis=1)
        along = (weight * (a * b).sum(axis=2)).sum(axis=1)
        spread = (weight * (a**2).sum(axis=2)).sum(axis=1)
        lever = at_px - mean_there
        variance = 1.0 / total + 0.5 * (lever**2).sum(axis=1) / spread
    xy_px = mean_now + _turned(lever, np.arctan2(across, along))
    is_known = ((weight > 0.0).sum(axis=1) >= 2) & (spread > NEAREST_PX**2 * total)
    return Carried(np.where(is_known[:, None], xy_px, np.nan), np.where(is_known, np.sqrt(variance), np.nan))


def _weights(track: Track, columns: list[int], home: int) -> FloatArray:
    """Return inverse variances of the carriers' motion since home, shape (n, c); 0 where they are not seen.

    In the frame of its own reference block a point is where it is by definition.
    """
    is_reference = track.reference[home, columns] == track.frame[home]
    at_home = np.where(is_reference & (track.status[home, columns] == Status.AUTO), 0.0, track.sigma_px[home, columns])
    variance = track.sigma_px[:, columns] ** 2 + at_home**2
    is_seen = np.isfinite(variance) & np.isin(track.status[:, columns], SEEN)
    return np.where(is_seen, 1.0 / np.maximum(variance, SMALLEST_SIGMA_PX**2), 0.0)


def _by_turn(track: Track, column: int, home: int, at_px: FloatArray) -> Carried:
    """Carry a place by one block's own rotation: that of its affine part, nearest in the sense of least squares.

    The angle of the block, side b, has the variance 6 sigma**2 / b**2 when its texture is even, so a coordinate of the
    place has sigma**2 (1 + 3 lever**2 / b**2).
    """
    linear = track.gradient[:, column].reshape(-1, 2, 2) + np.eye(2)
    turn = linear @ np.linalg.inv(linear[home])
    angle = np.arctan2(turn[:, 1, 0] - turn[:, 0, 1], turn[:, 0, 0] + turn[:, 1, 1])
    lever = at_px - track.xy_px[home, column]
    xy_px = track.xy_px[:, column] + _turned(np.broadcast_to(lever, (len(angle), 2)), angle)
    side = float(track.settings.get("block", USUAL_BLOCK_PX))
    sigma_px = track.sigma_px[:, column] * np.sqrt(1.0 + 3.0 * float(lever @ lever) / side**2)
    is_known = np.isfinite(angle) & (track.reference[:, column] == track.reference[home, column])
    if not _sees_turns(track, column, home):
        point = track.points[column]
        raise InputError(point, "a block that shows how it turns", "one that only shifts", "Carry it by two points.")
    return Carried(np.where(is_known[:, None], xy_px, np.nan), np.where(is_known, sigma_px, np.nan))


def _sees_turns(track: Track, column: int, home: int) -> bool:
    """Whether the block's displacement gradients were measured; a method or a warp that only shifts has none."""
    others = np.delete(track.gradient[:, column], home, axis=0)
    return not len(others) or bool((np.nan_to_num(others) != 0.0).any())


def _turned(lever: FloatArray, angle: FloatArray) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * lever[:, 0] - s * lever[:, 1], s * lever[:, 0] + c * lever[:, 1]], axis=1)


def _appended(track: Track, name: str, carried: Carried, frame: int) -> Track:
    n = len(track.frame)
    blank = blank_rows(n, 1) | {"xy_px": carried.xy_px[:, None], "sigma_px": carried.sigma_px[:, None]}
    is_known = np.isfinite(carried.xy_px[:, :1])
    blank |= {"status": np.where(is_known, Status.VIRTUAL, Status.LOST), "reference": np.full((n, 1), frame)}
    columns: dict[str, Any] = {
        one: np.concatenate([getattr(track, one), blank[one]], axis=1) for one in (*FIELDS, "reference")
    }
    return replace(track, points=(*track.points, name), **columns)

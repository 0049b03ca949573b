"""Changing single entries of a track and leaving all others alone: places by hand, and stretches tracked again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vml_course.errors import FrameRangeError, InputError
from vml_course.model.track import Seed, Status, Track
from vml_course.track.assembly import with_scatter
from vml_course.track.places import seed_at
from vml_course.track.placing import CLICK_SD_PX
from vml_course.track.sweep import FIELDS, Glimpse

GOOD_ZNCC = 0.9


class Until(StrEnum):
    """Where tracking again ends: at the clip's end, before a good frame, or before one that is not lost.

    Good is what the tracker found with a ZNCC of at least 0.9. A place given by hand ends both of the latter.
    """

    END = "end"
    GOOD = "good"
    FOUND = "found"


def row_of(track: Track, frame: int) -> int:
    """Return the row of a frame.

    Raises
    ------
    FrameRangeError
    """
    rows = np.flatnonzero(track.frame == frame)
    if not len(rows):
        raise FrameRangeError("frame", f"a frame of the track, {track.frame[0]} to {track.frame[-1]}", frame)
    return int(rows[0])


def with_mark(track: Track, mark: Seed) -> Track:
    """Return the track with a point placed by hand in the mark's frame (status `manual`).

    Raises
    ------
    UnknownNameError, FrameRangeError
        When the track has no such point or frame.
    InputError
        When the place is no number, or there is no frame.
    """
    if mark.frame is None or not np.isfinite([mark.x_px, mark.y_px]).all():
        raise InputError(f"mark {mark.name}", "a place in px and its frame", f"({mark.x_px:g}, {mark.y_px:g})")
    row, column = row_of(track, mark.frame), track.point_index(mark.name)
    columns = _writable(track)
    _write(
        columns,
        (row, column),
        {
            "xy_px": (mark.x_px, mark.y_px),
            "sigma_px": CLICK_SD_PX,
            "zncc": np.nan,
            "iterations": 0,
            "status": Status.MANUAL,
            "gradient": np.nan,
            "drift_px": 0.0,
        },
    )
    return replace(track, **columns)


def marks_of(track: Track, point: str) -> list[Seed]:
    """Return all places of a point that were given by hand.

    Raises
    ------
    UnknownNameError
    """
    column = track.point_index(point)
    rows = np.flatnonzero(track.status[:, column] == Status.MANUAL)
    return [seed_at(point, track.xy_px[row, column], int(track.frame[row])) for row in rows]


def is_settled(track: Track, column: int, until: Until) -> NDArray[np.bool_]:
    """Return in which rows tracking a point again ends before: shape (n,)."""
    status, zncc = track.status[:, column], track.zncc[:, column]
    if until is Until.END:
        return np.zeros(len(status), bool)
    if until is Until.GOOD:
        return np.asarray((status == Status.MANUAL) | ((status == Status.AUTO) & (zncc >= GOOD_ZNCC)))
    return np.asarray((status == Status.MANUAL) | (status == Status.AUTO))


def with_glimpses(track: Track, point: str, glimpses: Iterable[Glimpse]) -> Track:
    """Return the track with one point's entries replaced by what was seen anew; places by hand stay.

    Parameters
    ----------
    track : Track
    point : str
    glimpses : iterable of Glimpse
        Of this point alone, in frames of the track.
    """
    column, columns = track.point_index(point), _writable(track)
    changed = np.zeros(track.status.shape, bool)
    for glimpse in glimpses:
        row = row_of(track, glimpse.frame.index)
        if track.status[row, column] != Status.MANUAL:
            seen = {name: getattr(glimpse.sighting, name)[0] for name in FIELDS}
            _write(columns, (row, column), seen | {"reference": glimpse.reference[0]})
            changed[row, column] = True
    anew = replace(track, **columns)
    sigma_px = np.where(changed, with_scatter(anew).sigma_px, anew.sigma_px)
    return replace(anew, sigma_px=sigma_px)


def _writable(track: Track) -> dict[str, Any]:
    return {name: np.array(getattr(track, name)) for name in (*FIELDS, "reference")}


def _write(columns: dict[str, NDArray[Any]], at: tuple[int, int], values: Mapping[str, object]) -> None:
    for name, value in values.items():
        columns[name][at] = value

"""From what was seen picture by picture to a track: both directions joined, sigmas that the whole clip vouches for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.track import Sighting, Status, Track
from vml_course.track.fading import without_fading
from vml_course.track.scatter import vouched
from vml_course.track.sweep import FIELDS


class Entry(NamedTuple):
    """All points in one picture, without its pixels: the picture's number and time, and as in `sweep.Glimpse`."""

    frame: int
    time_s: float
    sighting: Sighting
    reference: IntArray


def assemble(
    settings: Mapping[str, str | int | float],
    points: tuple[str, ...],
    forwards: Sequence[Entry],
    backwards: Sequence[Entry],
    fps: float | None,
) -> Track:
    """Return the track of points that were seen forwards, and backwards before they were placed.

    Parameters
    ----------
    settings : mapping
        As in `Track`.
    points : tuple of str
    forwards, backwards : sequence of Entry
        Each in the order in which it was seen. Where both know a point, the first counts.
    fps : float or None
        As in `run`.
    """
    rows = {entry.frame: entry for entry in forwards}
    for entry in backwards:
        known = rows.get(entry.frame)
        rows[entry.frame] = entry if known is None else _joined(known, entry)
    ordered = [rows[frame] for frame in sorted(rows)]
    frame, stamp_s = np.array([row.frame for row in ordered]), np.array([row.time_s for row in ordered])
    time_s = stamp_s - stamp_s[0] if fps is None else (frame - frame[0]) / fps
    columns = {name: np.stack([getattr(row.sighting, name) for row in ordered]) for name in FIELDS}
    reference = np.stack([row.reference for row in ordered])
    track = Track(points, frame, time_s, settings=dict(settings), reference=reference, **columns)
    return with_scatter(without_fading(track))


def with_scatter(track: Track) -> Track:
    """Return the track with sigmas that cover its scatter in time; only places that were tracked take part."""
    tracked = track.status == Status.AUTO
    sigma_px = vouched(
        replace(track, xy_px=_only(tracked, track.xy_px), sigma_px=_only(tracked, track.sigma_px))
    ).sigma_px
    return replace(track, sigma_px=np.where(tracked, sigma_px, track.sigma_px))


def _only(wanted: object, values: FloatArray) -> FloatArray:
    mask = np.asarray(wanted, bool)
    return np.where(mask.reshape(mask.shape + (1,) * (values.ndim - mask.ndim)), values, np.nan)


def _joined(known: Entry, other: Entry) -> Entry:
    missing = known.reference < 0
    if not missing.any():
        return known
    fields = {}
    for name in FIELDS:
        values = np.array(getattr(known.sighting, name))
        values[missing] = getattr(other.sighting, name)[missing]
        fields[name] = values
    return known._replace(sighting=Sighting(**fields), reference=np.where(missing, other.reference, known.reference))

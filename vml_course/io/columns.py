"""The columns of a tracked clip, said once: XLSX, CSV and the column dictionary are all made of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vml_course.io.names import identifiers
from vml_course.model.motion import VectorSeries
from vml_course.model.track import Status
from vml_course.model.tracked import Tracked

IMAGE = "picture: origin at the centre of the top-left pixel, x right, y down"
WORLD = "world: y up, origin and axes as on the sheet Calibration"
GRADIENTS = ("u_x", "u_y", "v_x", "v_y")


@dataclass(frozen=True, eq=False, slots=True)
class Column:
    """One column: `values` are numbers (NaN = missing) or texts; `display` is Excel's number format."""

    name: str
    values: NDArray[Any]
    unit: str
    meaning: str
    reference: str = ""
    source: str = "measured"
    display: str = "General"


def data_columns(tracked: Tracked) -> list[Column]:
    """Return the columns of the sheet `Data` and of the CSV file, in their order."""
    names, vectors = point_names(tracked), vector_names(tracked)
    columns = _clock_columns(tracked)
    for number, point in enumerate(tracked.track.points):
        columns += _point_columns(tracked, number, point, names[point])
    for vector in tracked.vectors:
        columns += _vector_columns(tracked, vector, vectors[vector.name])
    return columns


def quality_columns(tracked: Tracked) -> list[Column]:
    """Return the columns of the sheet `Quality`: how sure the tracker was of each point."""
    columns = _clock_columns(tracked)[:2]
    for number, point in enumerate(tracked.track.points):
        columns += _quality_of(tracked, number, point, point_names(tracked)[point])
    return columns


def point_names(tracked: Tracked) -> dict[str, str]:
    """Map the points' names to the names in the columns."""
    return identifiers(tracked.track.points)


def vector_names(tracked: Tracked) -> dict[str, str]:
    """Map the vectors' names to the names in the columns."""
    return identifiers(vector.name for vector in tracked.vectors)


def status_words(codes: NDArray[np.int8]) -> NDArray[Any]:
    """Return `auto`, `manual`, `interp`, `lost` or `virtual` for each status code."""
    return np.array([Status(int(code)).name.lower() for code in codes], dtype=object)


def _clock_columns(tracked: Tracked) -> list[Column]:
    track = tracked.track
    return [
        Column("frame", track.frame, "", "number of the frame in the source video, from 0", "", "video", "0"),
        Column("step", np.arange(len(track.frame)), "", "number in the clip, from 0", "", "video", "0"),
        Column("t_s", track.time_s, "s", "time since the clip's first frame", "", tracked.time_base, "0.000000"),
    ]


def _point_columns(tracked: Tracked, number: int, point: str, name: str) -> Iterator[Column]:
    track, motion = tracked.track, tracked.motion
    for axis, letter in enumerate("xy"):
        place = track.xy_px[:, number, axis]
        yield Column(f"{name}_{letter}_px", place, "px", f"{letter} of {point}", IMAGE, display="0.000")
    if motion is not None:
        for axis, letter in enumerate("xy"):
            place = motion.xy_m[:, number, axis]
            yield Column(f"{name}_{letter}_m", place, "m", f"{letter} of {point}", WORLD, "calibrated", "0.00000")
        spread = motion.sigma_m[:, number]
        meaning = f"one standard deviation of a coordinate of {point}, by the tracker"
        yield Column(f"{name}_sigma_m", spread, "m", meaning, WORLD, "calibrated", "0.000000")
    meaning = f"how {point} was found: auto, manual, interp, lost, virtual"
    yield Column(f"{name}_status", status_words(track.status[:, number]), "", meaning, "", "tracker")


def _vector_columns(tracked: Tracked, vector: VectorSeries, name: str) -> Iterator[Column]:
    way = f"from {vector.tail} to {vector.head}"
    angle = np.degrees(vector.angle_rad)
    meaning = f"angle of the vector {way}, signed and unwrapped, counter-clockwise from +x"
    yield Column(f"{name}_angle_deg", angle, "deg", meaning, WORLD, "vector", "0.000")
    meaning = f"angle of the vector {way} by the inner product with x: 0 to 180, no sign"
    yield Column(f"{name}_angle_vml_deg", vector.angle_vml_deg, "deg", meaning, WORLD, "vector", "0.000")
    length_px = vector.length
    if tracked.calibration is not None:
        yield Column(f"{name}_length_m", vector.length, "m", f"length {way}", WORLD, "vector", "0.00000")
        length_px = vector.length * tracked.calibration.px_per_m
    yield Column(f"{name}_length_px", length_px, "px", f"length {way}", IMAGE, "vector", "0.000")
    meaning = f"change of the length {way} since the first frame"
    yield Column(f"{name}_dlength_pct", vector.change_pct, "%", meaning, "", "vector", "0.000")


def _quality_of(tracked: Tracked, number: int, point: str, name: str) -> Iterator[Column]:
    track, source = tracked.track, "tracker"
    meaning = f"zero-normalised cross-correlation of {point} with its reference block, 1 = equal"
    yield Column(f"{name}_zncc", track.zncc[:, number], "", meaning, "", source, "0.0000")
    meaning = f"one standard deviation of a coordinate of {point}"
    yield Column(f"{name}_sigma_px", track.sigma_px[:, number], "px", meaning, IMAGE, source, "0.0000")
    meaning = f"Gauss-Newton iterations of {point}"
    yield Column(f"{name}_iterations", track.iterations[:, number], "", meaning, "", source, "0")
    meaning = f"how {point} was found: auto, manual, interp, lost, virtual"
    yield Column(f"{name}_status", status_words(track.status[:, number]), "", meaning, "", source)
    meaning = f"number of the frame whose block {point} was compared with"
    yield Column(f"{name}_reference", track.reference[:, number], "", meaning, "", source, "0")
    for place, letters in enumerate(GRADIENTS):
        meaning = f"displacement gradient d{letters[0]}/d{letters[2]} of {point}'s block"
        yield Column(f"{name}_{letters}", track.gradient[:, number, place], "", meaning, IMAGE, source, "0.00000")

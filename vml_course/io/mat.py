"""A tracked clip as a MATLAB file (level 5, compressed), ready for `plot(t, X(:, strcmp(pointNames, 'ball')))`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import savemat

from vml_course.io.about import software
from vml_course.io.columns import point_names, vector_names
from vml_course.io.files import replacing
from vml_course.model.motion import Calibration, VectorSeries
from vml_course.model.tracked import Tracked


def write_mat(path: Path, tracked: Tracked) -> None:
    """Write the variables; those in metres only with a calibration. NaN is missing."""
    with replacing(path) as temporary:
        savemat(str(temporary), variables(tracked), do_compression=True, oned_as="column", long_field_names=True)


def variables(tracked: Tracked) -> dict[str, Any]:
    """Return the variables of the file by name."""
    track, motion = tracked.track, tracked.motion
    metres = {} if motion is None else {"X": motion.xy_m[..., 0], "Y": motion.xy_m[..., 1], "sigma": motion.sigma_m}
    return {
        "frame": track.frame.astype(np.float64),
        "t": track.time_s,
        "step": np.arange(len(track.frame), dtype=np.float64),
        "pointNames": _cell([*point_names(tracked).values()]),
        **metres,
        "Xpx": track.xy_px[..., 0],
        "Ypx": track.xy_px[..., 1],
        "zncc": track.zncc,
        "status": track.status,
        "vectorNames": _cell([*vector_names(tracked).values()]),
        **_vector_variables(tracked),
        "points": _structs([_point(tracked, number) for number in range(len(track.points))]),
        "vectors": _structs([_vector(tracked, vector) for vector in tracked.vectors]),
        "cal": _calibration(tracked),
        "events": np.empty((1, 0), dtype=[("name", object), ("frame", object), ("t", object)]),
        "meta": _meta(tracked),
    }


def _cell(texts: Sequence[str]) -> NDArray[Any]:
    cell = np.empty((1, len(texts)), dtype=object)
    cell[0, :] = texts
    return cell


def _structs(records: Sequence[Mapping[str, Any]]) -> NDArray[Any]:
    """Return a 1 × n struct array."""
    fields = list(records[0]) if records else ["name"]
    array = np.empty((1, len(records)), dtype=[(field, object) for field in fields])
    for number, record in enumerate(records):
        for field in fields:
            array[field][0, number] = record[field]
    return array


def _vector_variables(tracked: Tracked) -> dict[str, Any]:
    """Return theta, thetaVML and len, N × V; `length` and `angle` would hide MATLAB's functions."""
    rows = len(tracked.track.frame)

    def side_by_side(columns: Sequence[Any]) -> NDArray[np.float64]:
        return np.column_stack(columns) if columns else np.empty((rows, 0))

    lengths = {} if tracked.motion is None else {"len": side_by_side([one.length for one in tracked.vectors])}
    return {
        "theta": side_by_side([np.degrees(one.angle_rad) for one in tracked.vectors]),
        "thetaVML": side_by_side([one.angle_vml_deg for one in tracked.vectors]),
        **lengths,
    }


def _point(tracked: Tracked, number: int) -> dict[str, Any]:
    track, motion = tracked.track, tracked.motion
    return {
        "name": point_names(tracked)[track.points[number]],
        "xy": np.empty((0, 2)) if motion is None else motion.xy_m[:, number],
        "xy_px": track.xy_px[:, number],
        "sigma": np.empty((0, 1)) if motion is None else motion.sigma_m[:, number],
        "zncc": track.zncc[:, number],
        "status": track.status[:, number],
        "grad": track.gradient[:, number],
    }


def _vector(tracked: Tracked, vector: VectorSeries) -> dict[str, Any]:
    points = point_names(tracked)
    return {
        "name": vector_names(tracked)[vector.name],
        "tail": points[vector.tail],
        "head": points[vector.head],
        "angle_deg": np.degrees(vector.angle_rad),
        "angle_vml_deg": vector.angle_vml_deg,
        "length": vector.length,
    }


def _calibration(tracked: Tracked) -> dict[str, Any]:
    clock = {"fps": tracked.fps, "t0_frame": float(tracked.track.frame[0])}
    scale = _scale(tracked.calibration) if tracked.calibration else {"unit": "px"}
    return scale | clock


def _scale(calibration: Calibration) -> dict[str, Any]:
    return {
        "m_per_px": 1 / calibration.px_per_m,
        "px_per_m": calibration.px_per_m,
        "unit": "m",
        "stick_px": np.array(calibration.stick_px or (), dtype=np.float64).reshape(1, -1),
        "true_length": np.nan if calibration.length_m is None else calibration.length_m,
        "origin_px": np.array([calibration.origin_px], dtype=np.float64),
        "axis_deg": float(np.degrees(calibration.axis_angle_rad)),
    }


def _meta(tracked: Tracked) -> dict[str, Any]:
    name, _, release = software().partition(" ")
    return {
        "software": name,
        "version": release,
        "video": tracked.video,
        "sha256": tracked.sha256,
        "assignment": "",
        "student": "",
        "created": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "index_base": 0.0,
        "missing": "NaN",
    }

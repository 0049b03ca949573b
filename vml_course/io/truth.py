"""The truth of a simulated clip as files: JSON with everything, CSV with what students compare with."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np

from vml_course.errors import TableError
from vml_course.io.files import existing, replacing
from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.recording import Recording
from vml_course.model.strained import StrainTruth
from vml_course.model.truth import Check, ImpactTruth, Realised, Truth

FORMAT = "vml-truth 2"


def write_truth_json(path: Path, truth: Truth) -> None:
    """Write everything that is known of a clip; numbers keep all their digits."""
    document = {"format": FORMAT} | {item.name: _plain(getattr(truth, item.name)) for item in fields(truth)}
    for name, record in (("impact", truth.impact), ("strain", truth.strain)):
        document[name] = record and {item.name: _plain(getattr(record, item.name)) for item in fields(record)}
    _write(path, json.dumps(document, indent=1, allow_nan=False) + "\n")


def read_truth_json(path: Path) -> Truth:
    """Read what `write_truth_json` wrote.

    Raises
    ------
    FileMissingError
        When there is no such file.
    TableError
        When it is no truth file of this format.
    """
    text = existing(path).read_text(encoding="utf-8")
    try:
        document = json.loads(text)
        return _truth(document)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise TableError(str(path), f"a truth file of format {FORMAT!r}", f"{type(error).__name__}: {error}") from error


def truth_columns(points: Iterable[str], *, angle: bool = True) -> tuple[str, ...]:
    """Return the header of truth.csv, with or without the striker's angle.

    >>> truth_columns(["ball"])
    ('frame', 't_s', 'ball_x_px', 'ball_y_px', 'ball_x_m', 'ball_y_m', 'leg_angle_deg')
    """
    places = [f"{point}_{axis}_{unit}" for point in points for unit in ("px", "m") for axis in ("x", "y")]
    return ("frame", "t_s", *places, *(["leg_angle_deg"] if angle else []))


def write_truth_csv(path: Path, truth: Truth) -> None:
    """Write one row a frame: number, time, every point in pixels (y down) and metres (y up), the leg's angle."""
    frames, has_angle = len(truth.time_s), bool(len(truth.leg_angle_rad))
    places = np.concatenate([truth.xy_px, truth.xy_m], axis=-1).reshape(frames, -1)
    values = np.column_stack([truth.time_s, places, *([truth.leg_angle_deg] if has_angle else [])])
    rows = [",".join([str(frame), *(f"{value:.9g}" for value in row)]) + "\n" for frame, row in enumerate(values)]
    _write(path, ",".join(truth_columns(truth.points, angle=has_angle)) + "\n" + "".join(rows))


def read_truth_csv(path: Path) -> dict[str, FloatArray]:
    """Read truth.csv: column name -> values, shape (n,).

    Raises
    ------
    FileMissingError, TableError
    """
    with existing(path).open(encoding="utf-8", newline="") as file:
        header, *rows = list(csv.reader(file)) or [[]]
    if header[:2] != ["frame", "t_s"]:
        raise TableError(str(path), "columns frame, t_s, ...", ", ".join(header) or "an empty file")
    try:
        table = np.array(rows, dtype=np.float64).reshape(len(rows), len(header))
    except ValueError as error:
        raise TableError(str(path), "numbers in every cell", str(error)) from error
    return {name: table[:, column] for column, name in enumerate(header)}


def _truth(document: dict[str, Any]) -> Truth:
    if document.pop("format") != FORMAT:
        raise ValueError("another format")
    document["camera"] = Camera(**document["camera"])
    if document.get("recording"):  # truths of clips that were never stored have none
        document["recording"] = Recording(**document["recording"])
    document["impact"] = _impact(document["impact"])
    if document.get("strain"):
        document["strain"] = StrainTruth(**document["strain"])
    document["checks"] = tuple(Check(**check) for check in document["checks"])
    document["marks_m"] = {name: tuple(place) for name, place in document["marks_m"].items()}
    for name in ("bodies", "points"):
        document[name] = tuple(document[name])
    return Truth(**document)


def _impact(values: dict[str, Any] | None) -> ImpactTruth | None:
    if values is None:  # a body is strained, nothing is hit
        return None
    unknowns = {symbol: Realised(**realised) for symbol, realised in values["unknowns"].items()}
    return ImpactTruth(**{**values, "unknowns": unknowns})


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Camera | Recording | Realised):
        return asdict(value)
    if isinstance(value, tuple):
        return [asdict(item) if isinstance(item, Check) else item for item in value]
    return {name: _plain(item) for name, item in value.items()} if isinstance(value, Mapping) else value


def _write(path: Path, text: str) -> None:
    with replacing(path) as unfinished:
        unfinished.write_text(text, encoding="utf-8", newline="")

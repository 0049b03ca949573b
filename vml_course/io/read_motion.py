"""From a table back to points in metres: ours, a student's, or Tracker's text."""

from __future__ import annotations

import math
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat

from vml_course.errors import MissingScaleError, TableError
from vml_course.io.files import existing
from vml_course.io.grid import TIME_NAMES, Grid, read_grid
from vml_course.model.arrays import FloatArray, IntArray
from vml_course.model.motion import Motion
from vml_course.model.units import UNITS

# Column names of x: ours with the unit as suffix, and Tracker's `xball` beside `yball`, which are metres.
_OURS = re.compile(r"(?P<point>.+)_x_(?P<unit>m|cm|mm|ft|in)")
_HINT = "Track it again with a scale (--scale), or calibrate the columns yourself."


def motion_from_grid(grid: Grid) -> Motion:
    """Return the points of a table in metres.

    Raises
    ------
    MissingScaleError
        When there are pixels only.
    TableError
        When columns are missing, times do not rise, or a cell holds text.
    """
    time_s = grid.numbers(next(name for name in TIME_NAMES if name in grid.header))
    _check_clock(grid, time_s)
    points = _points(grid)
    xy_m = np.stack(
        [np.column_stack([grid.numbers(x), grid.numbers(y)]) * factor for x, y, factor in points.values()], 1
    )
    sigma = [_optional(grid, f"{name}_sigma_m") for name in points]
    pixels = [np.column_stack([_optional(grid, f"{name}_{axis}_px") for axis in "xy"]) for name in points]
    scale = _px_per_m(np.stack(pixels, 1), xy_m)
    return Motion(tuple(points), _frames(grid), time_s, xy_m, np.column_stack(sigma), scale)


def _points(grid: Grid) -> dict[str, tuple[str, str, float]]:
    """Map each point to its columns of x and y and their factor to metres."""
    found: dict[str, tuple[str, str, float]] = {}
    for column in grid.header:
        ours = _OURS.fullmatch(column)
        if ours:
            other = f"{ours['point']}_y_{ours['unit']}"
            found.setdefault(ours["point"], (column, other, UNITS["length"][ours["unit"]]))
        elif len(column) > 1 and column.startswith("x") and f"y{column[1:]}" in grid.header:
            found.setdefault(column[1:].strip("_ ") or "point", (column, f"y{column[1:]}", 1.0))
    for x, y, _ in found.values():
        if y not in grid.header:
            raise TableError(grid.file, f"a column {y} beside {x}", "none")
    if not found:
        _refuse(grid)
    return found


def _refuse(grid: Grid) -> None:
    if any(column.endswith("_x_px") for column in grid.header):
        raise MissingScaleError(grid.file, "positions in metres (<point>_x_m, <point>_y_m)", "pixels only", _HINT)
    expected = "columns <point>_x_m and <point>_y_m"
    raise TableError(grid.file, expected, f"columns {', '.join(name for name in grid.header if name)[:200]}")


def _check_clock(grid: Grid, time_s: FloatArray) -> None:
    if not len(time_s):
        raise TableError(grid.file, "rows below the header", "none")
    bad = np.flatnonzero(~np.isfinite(time_s))
    if not len(bad):
        bad = np.flatnonzero(np.diff(time_s) <= 0) + 1
    if len(bad):
        where = f"{grid.file}, time column, row {grid.first_row + int(bad[0])}"
        raise TableError(
            where, "a time later than the one above", f"{time_s[bad[0]]:g}".replace("nan", "an empty cell")
        )


def _frames(grid: Grid) -> IntArray:
    if "frame" not in grid.header:
        return np.arange(len(grid.rows), dtype=np.int64)
    frames = grid.numbers("frame")
    bad = np.flatnonzero(~(np.isfinite(frames) & (frames == np.floor(frames))))
    if len(bad):
        where = f"{grid.file}, column frame, row {grid.first_row + int(bad[0])}"
        raise TableError(where, "a whole number", f"{frames[bad[0]]:g}".replace("nan", "an empty cell"))
    return frames.astype(np.int64)


def _optional(grid: Grid, column: str) -> FloatArray:
    return grid.numbers(column) if column in grid.header else np.full(len(grid.rows), np.nan)


def _px_per_m(xy_px: FloatArray, xy_m: FloatArray) -> float:
    """Return the scale by which the same places, shape (n, p, 2), are spread in pixels and in metres; NaN for none."""
    both = np.isfinite(xy_px).all(axis=-1) & np.isfinite(xy_m).all(axis=-1)
    if not both.any():
        return math.nan
    spread_px, spread_m = (float(np.hypot(*np.std(places[both], axis=0))) for places in (xy_px, xy_m))
    return spread_px / spread_m if spread_px > 0 and spread_m > 0 else math.nan


def motion_from_table(path: Path) -> Motion:
    """Read a CSV, text or XLSX file."""
    return motion_from_grid(read_grid(path))


def motion_from_mat(path: Path) -> Motion:
    """Read a MATLAB file that we wrote.

    Raises
    ------
    FileMissingError
    MissingScaleError
        When it holds pixels only.
    TableError
        When it is no MATLAB file or lacks a variable.
    """
    held = _held(existing(path))
    if "Xpx" in held and "X" not in held:
        raise MissingScaleError(path.name, "positions in metres (X, Y)", "pixels only", _HINT)
    missing = [name for name in ("t", "pointNames", "X", "Y") if name not in held]
    if missing:
        raise TableError(path.name, "variables t, pointNames, X and Y", f"none called {', '.join(missing)}")
    try:
        return _motion_of(held)
    except (ValueError, TypeError) as error:
        raise TableError(path.name, "t, X and Y as numbers and pointNames as cells of text", "others") from error


def _held(path: Path) -> dict[str, Any]:
    names = ["frame", "t", "pointNames", "X", "Y", "Xpx", "Ypx", "sigma"]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return loadmat(path, variable_names=names)
    except Exception as error:  # damage surfaces in scipy and zlib as almost any exception
        raise TableError(
            path.name, "a MATLAB file of level 5 (save -v7)", "something else or a damaged file"
        ) from error


def _motion_of(held: dict[str, Any]) -> Motion:
    time_s = np.asarray(held["t"], dtype=np.float64).ravel()
    xy_m = np.stack([np.asarray(held["X"], np.float64), np.asarray(held["Y"], np.float64)], axis=-1)
    names = tuple(str(np.asarray(cell).item()) for cell in held["pointNames"].ravel())
    frame = np.asarray(held.get("frame", np.arange(len(time_s)))).ravel()
    sigma_m = np.asarray(held.get("sigma", np.full(xy_m.shape[:2], np.nan)), dtype=np.float64)
    xy_px = np.stack(
        [np.asarray(held.get(name, xy_m[..., 0] * np.nan), np.float64) for name in ("Xpx", "Ypx")], axis=-1
    )
    return Motion(names, frame, time_s, xy_m, sigma_m, _px_per_m(xy_px, xy_m))

"""The accuracy that is promised: rows of limits, read from TOML; the `[default]` row fills the gaps."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, fields
from importlib.resources import files
from pathlib import Path
from typing import Any

from vml_course.errors import FileFormatError, FileMissingError

SHIPPED = "budget.toml"


@dataclass(frozen=True)
class Limits:
    """What a case may be off by at most; infinite: not asked.

    Attributes
    ----------
    worst_rms_px : float
        Root mean square distance of the worst point.
    lost_pictures : float
        Of all points together.
    coverage_least_pct : float
        Share of coordinates that must lie within 1.96 of their sigma; the only limit from below.
    worst_time_error_ms : float
    omega_error_pct, restitution_error_pct, inertia_error_pct : float
        Of the striker's angular velocity before the impact, of e and I.
    other_error_pct : float
        Of whatever else a scene's students look for, such as a coefficient of friction.
    """

    worst_rms_px: float
    lost_pictures: float
    coverage_least_pct: float
    worst_time_error_ms: float
    omega_error_pct: float
    restitution_error_pct: float
    inertia_error_pct: float
    other_error_pct: float


def read_budget(path: Path | None = None) -> dict[str, dict[str, float]]:
    """Return the rows of a budget by name; the one that is shipped when no file is given.

    Raises
    ------
    FileMissingError, FileFormatError
    """
    if path is None:
        name, text = SHIPPED, files(__package__).joinpath(SHIPPED).read_text(encoding="utf-8")
    elif path.is_file():
        name, text = path.name, path.read_text(encoding="utf-8")
    else:
        raise FileMissingError(str(path), "a budget", "no such file")
    try:
        rows = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FileFormatError(name, "a TOML file", str(error)) from error
    checked = {key: _checked(name, key, row) for key, row in rows.items()}
    for field in fields(Limits):
        if field.name not in checked.get("default", {}):
            raise FileFormatError(f"{name} [default]", "a number for every limit", f"none for {field.name}")
    return checked


def limits_of(rows: dict[str, dict[str, float]], case: str) -> Limits:
    """Return the limits of `scene/condition/method`: its row over those of `condition/method` and `method`."""
    parts = case.split("/")
    levels = ["default", *("/".join(parts[k:]) for k in range(len(parts) - 1, -1, -1))]
    return Limits(**{name: value for level in levels for name, value in rows.get(level, {}).items()})


def _checked(name: str, key: str, row: Any) -> dict[str, float]:
    known = [field.name for field in fields(Limits)]
    if not isinstance(row, dict):
        raise FileFormatError(name, "rows of limits only", f"{key} = {row!r}")
    for limit, value in row.items():
        if limit not in known:
            raise FileFormatError(f"{name} [{key}]", f"limits among {', '.join(known)}", repr(limit))
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise FileFormatError(f"{name} [{key}] {limit}", "a number", repr(value))
    return {limit: float(value) for limit, value in row.items()}

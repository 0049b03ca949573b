"""A tracked clip as CSV: the columns of the sheet Data, and a JSON file beside it with everything else."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np

from vml_course.io.about import Fact, calibration_facts, settings_facts
from vml_course.io.columns import data_columns
from vml_course.io.files import replacing
from vml_course.model.tracked import Tracked


def write_csv(path: Path, tracked: Tracked) -> None:
    """Write `path` (comma, decimal point, UTF-8 with BOM, CRLF, empty where lost) and `<name>.meta.json`."""
    columns = data_columns(tracked)
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file, lineterminator="\r\n")
        writer.writerow([column.name for column in columns])
        writer.writerows(zip(*(map(_text, column.values) for column in columns), strict=True))
    with replacing(path.with_suffix(".meta.json")) as temporary:
        text = json.dumps(_meta(tracked), indent=1, ensure_ascii=False) + "\n"
        temporary.write_text(text, encoding="utf-8", errors="replace")


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, np.integer):
        return str(int(value))
    return repr(float(value)) if np.isfinite(value) else ""


def _meta(tracked: Tracked) -> dict[str, Any]:
    return {
        "table": {one.name: {"unit": one.unit, "meaning": one.meaning} for one in data_columns(tracked)},
        "calibration": _plain(calibration_facts(tracked)),
        "settings": _plain(settings_facts(tracked)),
        "vectors": {one.name: {"tail": one.tail, "head": one.head} for one in tracked.vectors},
        "warnings": list(tracked.warnings),
    }


def _plain(facts: list[Fact]) -> dict[str, Any]:
    return {key: {"value": value, "unit": unit} if unit else value for key, value, unit in facts}

"""Gradescope: `submission_123456/lab.xlsx`; its workbook must say whose it is."""

from __future__ import annotations

import re

from grader.lms.named import Named

_FILE = re.compile(r"(?:.*/)?submission_(?P<number>\d+)/(?P<name>[^/]+)")


def recognise(path: str) -> Named | None:
    """Return which submission it is, None when Gradescope does not name files so."""
    found = _FILE.fullmatch(path)
    if found is None or found["name"].startswith("."):
        return None
    return Named("gradescope", "gradescope", found["number"], found["name"], reference=found["number"])

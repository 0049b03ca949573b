"""Blackboard: `Collision lab_jdoe_attempt_2026-05-01-23-58-10_lab.xlsx`, with a `.txt` of each attempt beside it."""

from __future__ import annotations

import datetime as dt
import re

from grader.lms.named import Named

_FILE = re.compile(r".*_(?P<login>[^_]+)_attempt_(?P<time>\d{4}(?:-\d{2}){5})_(?P<name>.+)")


def recognise(path: str) -> Named | None:
    """Return whose file it is, None when Blackboard does not name files so.

    The assignment's own name stands in front of the login and either may hold underscores; what follows the last one
    is taken for the login.
    """
    found = _FILE.fullmatch(path.rpartition("/")[2])
    if found is None:
        return None
    try:
        received = dt.datetime.strptime(found["time"], "%Y-%m-%d-%H-%M-%S")  # noqa: DTZ007 - the platform's local time
    except ValueError:
        return None
    return Named("blackboard", "login", found["login"], found["name"], received=received)

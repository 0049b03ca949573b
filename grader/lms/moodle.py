"""Moodle: `Jane Doe_48213_assignsubmission_file/lab.xlsx`; without folders `..._assignsubmission_file_lab.xlsx`.

The number is the participant's in this one assignment. The full name in front may itself hold underscores and
digits, so the number is the one right before the plug-in's name.
"""

from __future__ import annotations

import re

from grader.lms.named import Named

_FILE = re.compile(r"(?:.*/)?.*_(?P<participant>\d+)_assignsubmission_file(?:_?/|_)(?P<name>.+)")


def recognise(path: str) -> Named | None:
    """Return whose file it is, None when Moodle does not name files so."""
    found = _FILE.fullmatch(path)
    if found is None:
        return None
    return Named("moodle", "moodle_participant", found["participant"], found["name"].rpartition("/")[2])

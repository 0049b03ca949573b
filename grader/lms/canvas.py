"""Canvas: `doejane_LATE_90210_555_my lab.xlsx`; anonymous: `anon_x7Ab2_555_my lab.xlsx`.

The student's name goes first without anything that is no letter, digit or underscore, so the numbers are found from
the left: user, then file (`lib/content_zipper.rb` of canvas-lms).
"""

from __future__ import annotations

import re

from grader.lms.named import Named

_FILE = re.compile(r"(?P<who>\w+?)(?P<late>_LATE)?_(?P<user>\d+)_(?P<file>\d+)_(?P<name>.+)")
_ANONYMOUS = re.compile(r"anon(?P<late>_LATE)?_(?P<user>[A-Za-z0-9]{5})_(?P<file>\d+)_(?P<name>.+)")


def recognise(path: str) -> Named | None:
    """Return whose file it is, None when Canvas does not name files so."""
    name = path.rpartition("/")[2]
    anonymous = _ANONYMOUS.fullmatch(name)
    found = anonymous or _FILE.fullmatch(name)
    if found is None:
        return None
    kind, lead = ("canvas_anonymous", "anon_") if anonymous else ("canvas_id", "")
    reference = f"{lead}{found['user']}_{found['file']}"
    return Named("canvas", kind, found["user"], found["name"], found["late"] is not None, reference=reference)

"""What handing out cost, kept beside the handouts: the next plan reckons with it."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from assignments.release import Release
from vml_course.io.files import replacing

STAGES = ("draw", "film", "track", "solve", "write")


@dataclass(frozen=True)
class Cost:
    """What some students cost together.

    Attributes
    ----------
    students : int
    cpu_s : mapping of str to float
        Seconds of processor time by stage, rejected variants with them.
    bytes : int
        Of the files that are handed out, once.
    """

    students: int = 0
    cpu_s: Mapping[str, float] = field(default_factory=dict)
    bytes: int = 0

    def __add__(self, other: Cost) -> Cost:
        seconds = Counter(self.cpu_s)
        seconds.update(other.cpu_s)
        return Cost(self.students + other.students, dict(seconds), self.bytes + other.bytes)

    @property
    def cpu_s_each(self) -> float:
        """Seconds of processor time for one student."""
        return sum(self.cpu_s.values()) / max(1, self.students)

    @property
    def bytes_each(self) -> float:
        """Size of one student's files."""
        return self.bytes / max(1, self.students)


def cost_of(released: Release) -> Cost:
    """Return what one student cost."""
    return Cost(1, released.cpu_s, sum(map(len, released.files.values())))


def kept_cost(path: Path) -> Cost:
    """Return what earlier runs cost; nothing when there were none, or the file tells nothing."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return Cost(int(content["students"]), dict(content["cpu_s"]), int(content["bytes"]))
    except (OSError, ValueError, KeyError, TypeError):
        return Cost()


def keep_cost(path: Path, cost: Cost) -> None:
    """Add what a run cost to what earlier ones did."""
    total = kept_cost(path) + cost
    facts = {"students": total.students, "cpu_s": {stage: round(s, 3) for stage, s in total.cpu_s.items()}}
    with replacing(path) as temporary:
        temporary.write_text(json.dumps({**facts, "bytes": total.bytes}) + "\n", encoding="utf-8")

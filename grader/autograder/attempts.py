"""Earlier attempts: Gradescope hands back what the last run said, and that is where they are kept.

Limits are reckoned from when a submission was created, never from the clock: the same submission run again has the
same result.
"""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from grader.effective import Attempt

KEPT = "attempts"


@dataclass(frozen=True)
class Past:
    """An attempt as it is kept: when it came first, its points before lateness, the hash of its content."""

    received: str
    points: float
    content: str = ""

    def as_json(self) -> dict[str, str | float]:
        """Return it for `extra_data`."""
        return {"received": self.received, "points": self.points, "content": self.content}


def past_attempts(metadata: Mapping[str, Any]) -> tuple[Past, ...]:
    """Return the attempts before this one, the oldest first.

    Where no run has kept any, the scores that Gradescope itself remembers are taken; runs that failed are none.
    """
    earlier = [one for one in metadata.get("previous_submissions") or () if not one.get("autograder_error")]
    for one in reversed(earlier):
        kept = ((one.get("results") or {}).get("extra_data") or {}).get(KEPT)
        if kept is not None:
            return tuple(Past(str(p["received"]), float(p["points"]), str(p["content"])) for p in kept)
    return tuple(_of_scores(earlier))


def with_this(past: Sequence[Past], now: Past) -> tuple[tuple[Past, ...], int]:
    """Return all attempts and the number of this one; the same content again is the same attempt."""
    for number, one in enumerate(past, start=1):
        if one.content == now.content:
            newer = Past(one.received, now.points, now.content)
            return (*past[: number - 1], newer, *past[number:]), number
    return (*past, now), len(past) + 1


def counted(attempts: Sequence[Past]) -> list[Attempt]:
    """Return the attempts as the gradebook counts them."""
    return [Attempt(k, moment(one.received), one.points) for k, one in enumerate(attempts, start=1)]


def moment(text: str) -> dt.datetime:
    """Return a time stamp; one without a zone is UTC."""
    found = dt.datetime.fromisoformat(text)
    return found if found.tzinfo else found.replace(tzinfo=dt.UTC)


def _of_scores(earlier: Sequence[Mapping[str, Any]]) -> Iterator[Past]:
    for one in earlier:
        if one.get("score") is not None:
            yield Past(str(one["submission_time"]), float(one["score"]))

"""On what terms an assignment is handed in: when it is due, how often one may try, what lateness costs."""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal
from zoneinfo import ZoneInfo

Counts = Literal["newest", "best", "first", "mean"]
Rule = Literal["none", "fixed", "linear", "steps"]
TrueValues = Literal["when over", "never", "always"]


@dataclass(frozen=True)
class Late:
    """What is taken off work that comes in late, as a part of the points that it earned.

    Attributes
    ----------
    rule : str
        "none": nothing. "fixed": `share`, once. "linear": `share` for every `per_hours` begun.
        "steps": the share of the last step whose hours have passed.
    share : float
        0 to 1.
    per_hours : float
    steps : tuple of (hours, share)
        In rising order of hours.
    grace_minutes : float
        So much later still counts as in time; beyond it, lateness counts from the due date.
    cap : float
        Never more than this is taken off.
    """

    rule: Rule = "none"
    share: float = 0.0
    per_hours: float = 24.0
    steps: tuple[tuple[float, float], ...] = ()
    grace_minutes: float = 0.0
    cap: float = 1.0

    def share_off(self, late_s: float) -> float:
        """Return the part that is taken off work which came in `late_s` seconds after it was due, 0 to 1.

        >>> Late("linear", share=0.1, per_hours=24, cap=0.25).share_off(25 * 3600)
        0.2
        """
        if late_s <= 60 * self.grace_minutes or late_s <= 0:
            return 0.0
        hours = late_s / 3600
        if self.rule == "steps":
            off = max((share for after, share in self.steps if hours > after), default=0.0)
        elif self.rule == "linear":
            off = self.share * math.ceil(hours / self.per_hours)
        else:
            off = self.share if self.rule == "fixed" else 0.0
        return min(off, self.cap)


@dataclass(frozen=True)
class Extension:
    """More time or more attempts for one student, and why; one without an assignment holds for all of them."""

    student: str
    reason: str
    assignment: str = ""
    hours: float = 0.0
    attempts: int = 0


@dataclass(frozen=True)
class Terms:
    """The terms of one assignment in one course.

    Attributes
    ----------
    opens, due, closes : datetime or None
        With a zone. Work after `due` is late; after `closes` it is received, kept and not graded.
    attempts : int
        How many different contents may be handed in; 0 is as many as one likes.
    counts : str
        Which attempt counts: "newest", "best", "first" or the "mean" of all.
    late : Late
    true_values : str
        When students see them: "when over", that is when they can hand in nothing more, "never" or "always".
    """

    opens: dt.datetime | None = None
    due: dt.datetime | None = None
    closes: dt.datetime | None = None
    attempts: int = 0
    counts: Counts = "newest"
    late: Late = Late()
    true_values: TrueValues = "when over"

    def extended(self, extensions: Iterable[Extension]) -> Terms:
        """Return the terms with every extension added up."""
        extensions = tuple(extensions)
        more = dt.timedelta(hours=sum(one.hours for one in extensions))
        return replace(
            self,
            due=self.due and self.due + more,
            closes=self.closes and self.closes + more,
            attempts=self.attempts and self.attempts + sum(one.attempts for one in extensions),
        )

    def late_s(self, received: dt.datetime) -> float:
        """Return how many seconds after the due date something came in; 0 when in time."""
        return max((received - self.due).total_seconds(), 0.0) if self.due else 0.0

    def is_over(self, now: dt.datetime) -> bool:
        """Tell whether nothing can be handed in for points any more, so that answers may be shown.

        Without a last moment this is when lateness takes everything, and never where late work earns something.
        """
        if self.closes is not None:
            return now > self.closes
        return self.late.share_off(self.late_s(now)) >= 1.0

    def shows_truth(self, now: dt.datetime, attempts: int) -> bool:
        """Tell whether somebody who has handed in so many attempts may see true values."""
        if self.true_values == "when over":
            return self.is_over(now) or bool(self.attempts and attempts >= self.attempts)
        return self.true_values == "always"

    def is_closed(self, received: dt.datetime) -> bool:
        """Tell whether something came in after the last moment."""
        return self.closes is not None and received > self.closes


@dataclass(frozen=True)
class Calendar:
    """The terms of a course: those of each assignment, and who has more time.

    Attributes
    ----------
    time_zone : str
        IANA name; local times of the course file are of this zone.
    terms : mapping of str to Terms
        By assignment.
    extensions : tuple of Extension
    """

    time_zone: str = "UTC"
    terms: Mapping[str, Terms] | None = None
    extensions: tuple[Extension, ...] = ()

    @property
    def zone(self) -> ZoneInfo:
        """The zone of local times."""
        return ZoneInfo(self.time_zone)

    def terms_of(self, assignment_id: str, student: str = "") -> Terms:
        """Return the terms of an assignment, with the extensions of one student."""
        usual = (self.terms or {}).get(assignment_id, Terms())
        mine = (one for one in self.extensions if student and one.student == student)
        return usual.extended(one for one in mine if one.assignment in ("", assignment_id))

    def due_text(self, assignment_id: str, student: str = "") -> str:
        """Return the due date as students read it, "" when there is none.

        >>> due = dt.datetime(2026, 12, 1, 22, 59, tzinfo=dt.UTC)
        >>> Calendar("Europe/Berlin", {"kick": Terms(due=due)}).due_text("kick")
        'Tuesday 1 December 2026, 23:59 (Europe/Berlin)'
        """
        return moment_text(self.terms_of(assignment_id, student).due, self.time_zone)


# Not strftime's names: these follow the language of the machine.
_DAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")
_MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November",
    "December",
)  # fmt: skip


def moment_text(moment: dt.datetime | None, zone: str) -> str:
    """Return a moment as students read it, "" for none."""
    if moment is None:
        return ""
    local = moment.astimezone(ZoneInfo(zone))
    return f"{_DAYS[local.weekday()]} {local.day} {_MONTHS[local.month - 1]} {local:%Y, %H:%M} ({zone})"

"""What `course.toml` may hold: title, term, time zone, gradebook, and the terms of each assignment."""

from __future__ import annotations

import datetime as dt
from typing import Annotated
from zoneinfo import ZoneInfo

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints, field_validator, model_validator

from assignments.terms import Calendar, Counts, Extension, Late, Rule, Terms, TrueValues

Line = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x1f\x7f]{1,200}$")]
Slug = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9_-]{0,79}$")]
Share = Annotated[float, Field(ge=0, le=1)]
Hours = Annotated[float, Field(gt=0, le=24 * 366)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class LateTable(_Table):
    """`late = { rule = ..., ... }`."""

    rule: Rule
    share: Share = 0.0
    per_hours: Hours = 24.0
    steps: tuple[tuple[Annotated[float, Field(ge=0)], Share], ...] = ()
    grace_minutes: Annotated[float, Field(ge=0, le=7 * 24 * 60)] = 0.0
    cap: Share = 1.0

    @model_validator(mode="after")
    def _fits(self) -> LateTable:
        if self.rule in ("fixed", "linear") and not self.share:
            raise ValueError(f'a share above 0 for the rule "{self.rule}"')
        if (self.rule == "steps") != bool(self.steps):
            raise ValueError('steps = [[hours, share], ...] together with the rule "steps", and only then')
        return self


def _with_a_time(moment: object) -> object:
    """Refuse a date alone: as the midnight at its beginning it would be a day too early for most readers."""
    if isinstance(moment, dt.date) and not isinstance(moment, dt.datetime):
        raise ValueError(f"a date with a time, such as {moment.isoformat()}T23:59:00")  # noqa: TRY004 - pydantic's way
    return moment


Moment = Annotated[dt.datetime, BeforeValidator(_with_a_time)]


class TermsTable(_Table):
    """`[assignment.<id>]`."""

    opens: Moment | None = None
    due: Moment | None = None
    closes: Moment | None = None
    attempts: Annotated[int, Field(ge=0, le=1000)] = 0
    counts: Counts = "newest"
    late: LateTable | None = None
    true_values: TrueValues = "when over"

    @model_validator(mode="after")
    def _in_order(self) -> TermsTable:
        if (self.late or self.closes) and self.due is None:
            raise ValueError("a due date beside late or closes")
        moments = [moment.replace(tzinfo=None) for moment in (self.opens, self.due, self.closes) if moment]
        if moments != sorted(moments):
            raise ValueError("opens before due, due before closes")
        return self


class ExtensionTable(_Table):
    """`[[extension]]`."""

    student: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{1,40}$")]
    reason: Line
    assignment: Slug | None = None
    hours: Annotated[float, Field(ge=0, le=24 * 366)] = 0.0
    attempts: Annotated[int, Field(ge=0, le=1000)] = 0

    @model_validator(mode="after")
    def _gives(self) -> ExtensionTable:
        if not self.hours and not self.attempts:
            raise ValueError("hours or attempts above 0")
        return self


class CourseFile(_Table):
    """The whole file."""

    title: Line
    term: Line | None = None
    time_zone: str = "UTC"
    gradebook: str = ""
    assignment: dict[Slug, TermsTable] = {}
    extension: tuple[ExtensionTable, ...] = ()

    @field_validator("time_zone")
    @classmethod
    def _known_zone(cls, name: str) -> str:
        try:
            ZoneInfo(name)
        except (KeyError, OSError, ValueError):  # not found, a folder, no name at all
            raise ValueError('a zone such as "Europe/Berlin" or "America/New_York"') from None
        return name

    def calendar(self) -> Calendar:
        """Return the terms as this package's own frozen records."""
        zone = ZoneInfo(self.time_zone)
        return Calendar(
            time_zone=self.time_zone,
            terms={name: _terms(table, zone) for name, table in self.assignment.items()},
            extensions=tuple(
                Extension(one.student, one.reason, one.assignment or "", one.hours, one.attempts)
                for one in self.extension
            ),
        )


def _terms(table: TermsTable, zone: ZoneInfo) -> Terms:
    opens, due, closes = (
        moment.replace(tzinfo=zone) if moment is not None and moment.tzinfo is None else moment
        for moment in (table.opens, table.due, table.closes)
    )
    return Terms(opens, due, closes, table.attempts, table.counts, _late(table.late), table.true_values)


def _late(table: LateTable | None) -> Late:
    if table is None:
        return Late()
    return Late(table.rule, table.share, table.per_hours, tuple(sorted(table.steps)), table.grace_minutes, table.cap)

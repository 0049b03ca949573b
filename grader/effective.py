"""Which attempt counts and what lateness takes off: a pure function of attempts and terms.

Nothing of it is stored. A due date that is moved, an extension, another rule: the next look at the gradebook
has it, and nothing needs repair.
"""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean

from assignments.terms import Terms


@dataclass(frozen=True)
class Attempt:
    """One content that a student handed in: its number from 1 on, when it came first, what it earned."""

    number: int
    received: dt.datetime
    points: float


@dataclass(frozen=True)
class Effective:
    """What counts.

    Attributes
    ----------
    attempt : int
        The attempt that is shown: the one that counts, for the mean the newest of those that do.
    earned : float
        Before lateness.
    late_share : float
        The part that lateness took off, 0 to 1.
    points : float
    ignored : tuple of int
        Attempts that do not count: beyond the number allowed, or after the last moment.
    """

    attempt: int
    earned: float
    late_share: float
    points: float
    ignored: tuple[int, ...] = ()


def effective(attempts: Sequence[Attempt], terms: Terms) -> Effective:
    """Return what a student's attempts come to.

    Parameters
    ----------
    attempts : sequence of Attempt
        At least one.
    terms : Terms
        With the student's extensions.

    Returns
    -------
    Effective
        When no attempt counts, the newest one with no points.

    >>> when = dt.datetime(2026, 5, 1, tzinfo=dt.UTC)
    >>> effective([Attempt(1, when, 12.0), Attempt(2, when, 9.0)], Terms(counts="best")).points
    12.0
    """
    in_order = sorted(attempts, key=lambda attempt: attempt.number)
    in_time = [attempt for attempt in in_order if not terms.is_closed(attempt.received)]
    allowed = in_time[: terms.attempts] if terms.attempts else in_time
    ignored = tuple(attempt.number for attempt in in_order if attempt not in allowed)
    if not allowed:
        newest = in_order[-1]
        return Effective(newest.number, newest.points, 1.0, 0.0, ignored)
    settled = [(attempt, _after_lateness(attempt, terms)) for attempt in allowed]
    if terms.counts == "mean":
        earned, points = fmean(one.points for one, _ in settled), fmean(left for _, left in settled)
        return _result(settled[-1][0].number, earned, points, ignored)
    attempt, points = _chosen(settled, terms.counts)
    return _result(attempt.number, attempt.points, points, ignored)


def _chosen(settled: Sequence[tuple[Attempt, float]], counts: str) -> tuple[Attempt, float]:
    if counts == "first":
        return settled[0]
    if counts == "best":
        return max(settled, key=lambda pair: pair[1])  # of equal ones the earliest
    return settled[-1]


def _after_lateness(attempt: Attempt, terms: Terms) -> float:
    return attempt.points * (1.0 - terms.late.share_off(terms.late_s(attempt.received)))


def _result(number: int, earned: float, points: float, ignored: tuple[int, ...]) -> Effective:
    share = 1.0 - points / earned if earned > 0 else 0.0
    return Effective(number, round(earned, 6), round(share, 9), round(points, 6), ignored)

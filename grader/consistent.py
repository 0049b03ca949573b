"""Whether a workbook agrees with itself: its own numbers among one another and with its own table.

Nothing here knows a true value, and no answer is worked out from others with a formula that is asked for: that
two numbers disagree says that something was mistyped or measured in another unit, not which is right.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from assignments.model import Assignment
from grader.flags import FOR_STUDENT
from grader.kind import Kind
from grader.model import Submission
from grader.read.book import Book
from grader.read.locate import find_beside
from grader.read.table import other_points
from grader.stated import Stated, state
from vml_course.model.arrays import FloatArray

USUAL: Mapping[str, tuple[float, float]] = {
    "e": (0.0, 1.2),
    "mu": (0.0, 1.5),
    "inertia": (1e-6, 100.0),
    "mass": (1e-6, 100.0),
    "scale": (1.0, 1e5),
    "rate": (10.0, 1e5),
    "velocity": (-300.0, 300.0),
    "angular_velocity": (-1000.0, 1000.0),
}
"""What a quantity can be, in SI units and with its sign: by the question's id, else by its dimension."""

_ARMS = (("omega1", "v_f1", "L"), ("omega2", "v_f2", "L"))  # speed = angular velocity times length
_PIVOT, _END = "knee", "foot"
_LEAST_ROWS = 10
_RATE_APART, _SCALE_APART, _ARM_APART = 0.01, 0.02, 0.1


@dataclass(frozen=True)
class _Told:
    """What a workbook says: values in SI by question, given numbers, table."""

    values: Mapping[str, float]
    given: Mapping[str, float]
    table: Mapping[str, FloatArray]
    symbols: Mapping[str, str]


def remarks_on(book: Book, submission: Submission, assignment: Assignment) -> Iterator[str]:
    """Yield one sentence for everything that looks odd; none of it is a judgement."""
    stated = {q.id: state(submission.answer(q.id), q) for q in assignment.questions}
    values = {name: s.value for name, s in stated.items() if isinstance(s, Stated) and not s.in_pixels}
    given = {g.id: number for g in assignment.givens if (number := find_beside(book, g.label)) is not None}
    told = _Told(values, given, submission.tracking, {q.id: q.symbol for q in assignment.questions})
    yield from (FOR_STUDENT[flag] for flag in submission.flags)
    yield from _unusual(told, assignment)
    yield from _of_table(told, assignment)
    yield from _rate(told)
    yield from _scale(told)
    yield from _arms(told)
    yield from _turns(told)
    texts = [q.symbol for q in assignment.questions if submission.answer(q.id).kind is Kind.TEXT and q.id in values]
    if texts:
        yield f"Numbers written as text, which were understood: {', '.join(texts)}."


def _unusual(told: _Told, assignment: Assignment) -> Iterator[str]:
    for question in assignment.questions:
        low, high = USUAL.get(question.id, USUAL.get(question.dimension, (-np.inf, np.inf)))
        value = told.values.get(question.id, low)
        if not low <= value <= high:
            yield f"{question.symbol} = {value:.4g} {question.unit}".rstrip() + " is unusual: check sign and unit."


def _of_table(told: _Told, assignment: Assignment) -> Iterator[str]:
    if not told.table:
        return
    missing = [p for p in assignment.points if f"{p}_x_m" not in told.table]
    if missing:
        others = other_points(told.table, assignment.points)
        asked = f"; which of them is {', '.join(others)}?" if others else "."
        yield f"The table has no positions in metres called {', '.join(missing)}{asked} Name columns {missing[0]}_x_m."
    rows = len(next(iter(told.table.values())))
    if rows < _LEAST_ROWS:
        yield f"The table has {rows} rows; {_LEAST_ROWS} are the least to compare."
    if "frame" not in told.table and "t_s" not in told.table:
        yield "The table has neither frame numbers nor times."
    for name, what in (("frame", "frame numbers"), ("t_s", "times")):
        back = np.flatnonzero(np.diff(_known(told.table.get(name))) <= 0)
        if len(back):
            yield f"The {what} of the table do not rise in {len(back)} places, first after row {back[0] + 1}."


def _known(column: FloatArray | None) -> FloatArray:
    return np.empty(0) if column is None else column[np.isfinite(column)]


def _rate(told: _Told) -> Iterator[str]:
    frame, time, written = told.table.get("frame"), told.table.get("t_s"), told.values.get("fps")
    if frame is None or time is None or not written:
        return
    steps, seconds = np.diff(frame), np.diff(time)
    usable = np.isfinite(steps) & np.isfinite(seconds) & (steps > 0) & (seconds > 0)
    rate = float(np.median(steps[usable] / seconds[usable])) if usable.any() else written
    if abs(rate / written - 1) > _RATE_APART:
        yield f"The table runs at {rate:.4g} frames a second, but you wrote {written:.4g}."


def _scale(told: _Told) -> Iterator[str]:
    """Compare the written scale with that of a table that has both pixels and metres."""
    written = told.values.get("px_per_m")
    for name, metres in told.table.items():
        pixels = told.table.get(name[:-2] + "_px")
        if not written or not name.endswith("_x_m") or pixels is None:
            continue
        both = np.isfinite(metres) & np.isfinite(pixels)
        spread_m, spread_px = (float(np.ptp(c[both])) if both.any() else 0.0 for c in (metres, pixels))
        if spread_m > 0 and abs(spread_px / spread_m / written - 1) > _SCALE_APART and spread_px > 1:
            yield f"The table has {spread_px / spread_m:.4g} pixels in a metre, but you wrote {written:.4g}."
            return


def _arms(told: _Told) -> Iterator[str]:
    for turn, speed, arm in _ARMS:
        if turn in told.values and speed in told.values and arm in told.given:
            a, b = abs(told.values[turn] * told.given[arm]), abs(told.values[speed])
            if abs(a - b) > _ARM_APART * max(a, b):
                yield f"{told.symbols[speed]} is not {told.symbols[turn]} times {arm}: check both, and their units."


def _turns(told: _Told) -> Iterator[str]:
    """Compare the sign of an angular velocity with the sense in which the table's points turn."""
    names = [f"{point}_{axis}_m" for point in (_PIVOT, _END) for axis in "xy"]
    written = told.values.get("omega1")
    if not written or not set(names) <= told.table.keys():
        return
    px, py, ex, ey = (told.table[name] for name in names)
    angle = np.arctan2(ey - py, ex - px)
    angle = np.unwrap(angle[np.isfinite(angle)])
    if len(angle) >= _LEAST_ROWS and abs(angle[-1] - angle[0]) > 0.1 and (angle[-1] - angle[0]) * written < 0:
        sense = "counter-clockwise" if angle[-1] > angle[0] else "clockwise"
        yield f"In the table {_END} turns {sense} about {_PIVOT}; the sign of {told.symbols['omega1']} says otherwise."

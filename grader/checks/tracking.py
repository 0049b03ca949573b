"""Judge the tracking table against the true trajectory."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grader.flags import FOR_PERSON_OF_TABLE, FOR_STUDENT
from grader.model import Asked, Finding, Outcome
from grader.read.flags import Flag
from grader.read.table import other_points
from grader.smoothed import smoothing_of
from grader.tracked import OUR_FAILURE
from grader.trajectory import LEAST_ROWS, TrajectoryFit

GOOD_PX = 1.0  # what a careful hand reaches; correlation tracking is twenty times better
POOR_PX = 4.0
_RATE_APART = 0.02
_NO_TABLE = (
    f"There is no tracking table with {LEAST_ROWS} rows or more of your video to compare. "
    "The sheet Tracking says how to paste yours."
)
_MOST_NAMES = 5
_OF_CELLS = FOR_PERSON_OF_TABLE.keys() - {Flag.UNNAMED_POINTS}  # of the names more is said


def tracking(asked: Asked) -> tuple[Finding, ...]:
    """Lay your tracking table over the true trajectory; the remaining distance is given in pixels of the video.

    A shifted origin costs nothing.
    """
    fit = asked.table.fit
    points, at = asked.question.points, asked.question.id
    if asked.table.why_not == OUR_FAILURE and fit is None:
        return (Finding(at, "table", Outcome.UNSURE, points, points, f"Sorry, {OUR_FAILURE}; a person will."),)
    names = _names(asked)
    if fit is None:
        message = " ".join([*(names or [_NO_TABLE]), *_cells(asked)])
        unsure = points or asked.submission.tracking
        return (Finding(at, "table", Outcome.UNSURE if unsure else Outcome.PARTIAL, points, points, message),)
    slips = list(_slips(fit, asked))
    outcome = Outcome.UNSURE if names else _outcome(fit.rms_px, is_clean=not slips)
    share = {Outcome.RIGHT: 1.0, Outcome.UNSURE: 1.0, Outcome.PARTIAL: 0.5}.get(outcome, 0.0)
    numbers = {"rms_px": fit.rms_px, "scale_ratio": fit.scale_ratio, "lag_frames": fit.lag_frames}
    message = " ".join(
        [_distance(fit.rms_px, is_clean=not slips), *(words for _, words in slips), *names]
        + ([] if outcome is Outcome.RIGHT else _cells(asked))
    )
    code = slips[0][0] if len(slips) == 1 else ""
    return (Finding(at, "table", outcome, share * points, points, message, numbers, code),)


def _names(asked: Asked) -> list[str]:
    """Say which points the table calls otherwise than the assignment, and which columns are missed."""
    table, points = asked.submission.tracking, asked.key.points
    missing = [p for p in points if not {f"{p}_x_m", f"{p}_y_m"} <= table.keys()]
    others = other_points(table, points)[:_MOST_NAMES]
    if missing and others:
        called = f"The table has points called {', '.join(others)}; the assignment's are {', '.join(missing)}."
        ask = f"Call the columns {missing[0]}_x_m, {missing[0]}_y_m and so on, and hand in again."
        return [f"{called} {ask} A person will look at it."]
    if missing and f"{missing[0]}_x_px" in table:
        return [f"The table has {', '.join(missing)} in pixels only: metres are asked for. A person will look at it."]
    return []


def _cells(asked: Asked) -> list[str]:
    return [FOR_STUDENT[flag] for flag in asked.submission.flags if flag in _OF_CELLS]


def _distance(rms_px: float, *, is_clean: bool) -> str:
    once = "" if is_clean else ", once the following is put right"
    words = f"Your points lie {rms_px:.2g} px (root mean square) from the true ones{once}."
    return words if rms_px <= GOOD_PX else f"{words} A careful hand stays within {GOOD_PX:g} px."


def _outcome(rms_px: float, *, is_clean: bool) -> Outcome:
    if rms_px > POOR_PX:
        return Outcome.WRONG
    return Outcome.RIGHT if rms_px <= GOOD_PX and is_clean else Outcome.PARTIAL


def _slips(fit: TrajectoryFit, asked: Asked) -> Iterator[tuple[str, str]]:
    """Yield code and sentence of each fault; what was fitted is told only where the table then fits."""
    if fit.rms_px <= POOR_PX:
        yield from _fitted(fit, asked)
    yield from _clock(asked)
    if smoothing_of(fit, asked.key):
        yield "K14", "Its paths are rounded off at the impact: it looks smoothed across it. Fit each side by itself."


def _fitted(fit: TrajectoryFit, asked: Asked) -> Iterator[tuple[str, str]]:
    if fit.swapped:
        yield "K13", f"The columns of {' and '.join(fit.swapped)} look exchanged."
    if fit.y_down:
        yield "K10", "The y axis points down in your table; it should point up."
    if fit.x_left:
        yield "K15", "The x axis points to the left in your table; it should point to the right."
    if fit.is_off_scale:
        code = _scale_slip(fit.scale_ratio, asked.key.truth["px_per_m"])
        yield code, "Its lengths are not the true ones: check the calibration."
    if abs(fit.lag_frames) > 0.3:
        yield "K11", f"It is {abs(fit.lag_frames):.1f} frames {'late' if fit.lag_frames > 0 else 'early'}."


def _scale_slip(ratio: float, px_per_m: float) -> str:
    """Return the code of a table's wrong scale: one with a name, else K7."""
    named = (
        ("K1", px_per_m), ("K1b", px_per_m**2), ("K3", 3.28084), ("K3b", 39.3701), ("K4", 100.0), ("K4b", 1000.0),
        ("K5", 2.0), ("K5b", 0.5),
    )  # fmt: skip
    return next((code for code, factor in named if abs(ratio / factor - 1) <= 0.02), "K7")


def _clock(asked: Asked) -> Iterator[tuple[str, str]]:
    """Compare the table's times with its own frame numbers."""
    columns, fps = asked.submission.tracking, asked.key.truth["fps"]
    if not {"frame", "t_s"} <= columns.keys():
        return
    steps, seconds = np.diff(columns["frame"]), np.diff(columns["t_s"])
    usable = (steps > 0) & (seconds > 0)  # which no NaN is
    if not usable.any():
        return
    rate = float(np.median(steps[usable] / seconds[usable]))
    if abs(rate - 1) <= _RATE_APART:
        yield "K2b", "Its times are frame numbers; time is frame number divided by frame rate."
    elif abs(rate / fps - 1) > _RATE_APART:
        yield "K2", f"Its times run at {rate:.4g} frames a second; the recording has another rate."

"""Judge the tracking table against the true trajectory."""

from __future__ import annotations

from collections.abc import Iterator

from grader.model import Asked, Finding, Outcome
from grader.trajectory import TrajectoryFit, fit_trajectory

GOOD_PX = 1.0  # what a careful hand reaches; correlation tracking is twenty times better
POOR_PX = 4.0


def tracking(asked: Asked) -> tuple[Finding, ...]:
    """Lay your tracking table over the true trajectory; the remaining distance is given in pixels of the video.

    A shifted origin costs nothing.
    """
    fit = fit_trajectory(asked.submission.tracking, asked.key)
    points, at = asked.question.points, asked.question.id
    if fit is None:
        message = "There is no tracking table with ten rows or more to compare."
        return (Finding(at, "table", Outcome.UNSURE if points else Outcome.PARTIAL, points, points, message),)
    slips = list(_slips(fit, asked.key.truth["px_per_m"]))
    outcome = _outcome(fit, is_clean=not slips)
    share = {Outcome.RIGHT: 1.0, Outcome.PARTIAL: 0.5}.get(outcome, 0.0)
    numbers = {"rms_px": fit.rms_px, "scale_ratio": fit.scale_ratio, "lag_frames": fit.lag_frames}
    message = " ".join(
        [f"Your points lie {fit.rms_px:.2g} px (root mean square) from the true ones.", *(m for _, m in slips)]
    )
    code = slips[0][0] if len(slips) == 1 else ""
    return (Finding(at, "table", outcome, share * points, points, message, numbers, code),)


def _outcome(fit: TrajectoryFit, *, is_clean: bool) -> Outcome:
    if fit.rms_px > POOR_PX:
        return Outcome.WRONG
    return Outcome.RIGHT if fit.rms_px <= GOOD_PX and is_clean else Outcome.PARTIAL


def _slips(fit: TrajectoryFit, px_per_m: float) -> Iterator[tuple[str, str]]:
    if fit.y_down:
        yield "K10", "The y axis points down in your table; it should point up."
    if abs(fit.scale_ratio - 1) > 0.02:
        yield (
            _scale_slip(fit.scale_ratio, px_per_m),
            "Its lengths are not the true ones: check the calibration.",
        )
    if abs(fit.lag_frames) > 0.3:
        yield "K11", f"It is {abs(fit.lag_frames):.1f} frames {'late' if fit.lag_frames > 0 else 'early'}."


def _scale_slip(ratio: float, px_per_m: float) -> str:
    """Return the code of a table's wrong scale: one with a name, else K7."""
    named = (("K1", px_per_m), ("K3", 3.28084), ("K4", 100.0), ("K4b", 1000.0), ("K5", 2.0), ("K5b", 0.5))
    return next((code for code, factor in named if abs(ratio / factor - 1) <= 0.02), "K7")

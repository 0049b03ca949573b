"""What an instructor can do wrong, in the manner of `vml_course.errors`."""

from __future__ import annotations

from collections.abc import Iterable

from vml_course.errors import InputError, VmlError


class AssignmentFileError(VmlError):
    """An assignment's file has mistakes; `mistakes` holds each with its key."""

    def __init__(self, file: str, mistakes: Iterable[InputError]) -> None:
        self.file, self.mistakes = file, tuple(mistakes)
        super().__init__("; ".join(f"{file}, {str(mistake).rstrip('.')}" for mistake in self.mistakes) + ".")


class NoVariantError(VmlError):
    """No draw meets the assignment's rules."""

    def __init__(self, assignment: str, draws: int, reasons: Iterable[str]) -> None:
        self.assignment, self.draws, self.reasons = assignment, draws, tuple(reasons)
        super().__init__(
            f"{assignment}: expected a draw that keeps all rules, got none in {draws} draws. "
            f"Most often broken: {'; '.join(self.reasons)}. Widen the ranges or ask for less separation."
        )


class CourseError(InputError):
    """A course folder is not what it should be: no course, or its secret is not secret."""


class NotMeasuredError(VmlError):
    """The reference did not find the truth of a video within half of the student's tolerance (`allowed`, absolute)."""

    def __init__(self, symbol: str, truth: float, found: float, allowed: float) -> None:
        self.symbol, self.truth, self.found, self.allowed = symbol, truth, found, allowed
        off, unit = abs(found - truth), abs(truth)
        words = f"{allowed / unit:.2%}, got {off / unit:.2%}" if unit else f"{allowed:.3g}, got {off:.3g}"
        super().__init__(f"{symbol}: expected to be measured within {words}.")


class UnfairError(VmlError):
    """A variant cannot be measured as sharply as others, foreseen or seen in its video."""

    def __init__(self, symbol: str, sd: float, allowed: float) -> None:
        self.symbol, self.sd, self.allowed = symbol, sd, allowed
        super().__init__(
            f"{symbol}: expected to be known to a standard deviation of at most {allowed:.3g}, got {sd:.3g}."
        )

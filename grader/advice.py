"""What a student should do next: the earliest step that went wrong comes first."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from markupsafe import Markup

from assignments.model import Assignment, Question
from assignments.sheets import ANSWERS, TRACKING
from grader.model import Finding, Grade, Outcome
from grader.page import symbol

_LOST = frozenset({Outcome.WRONG, Outcome.PARTIAL})
_ADVICE = {
    "scale": Markup("Measure the known length again, end to end, in pixels, and divide by its metres: {}."),
    "rate": Markup("Take the frame rate of the recording from your handout: {}."),
    "velocity": Markup("Fit a straight line to the positions on each side of the impact, never across it: {}."),
    "angular_velocity": Markup("Fit a straight line to the angles in radians, on each side of the impact: {}."),
}
_USUAL = Markup("Measure {} again.")


@dataclass(frozen=True)
class _Lost:
    """A question and what was found of it."""

    question: Question
    findings: tuple[Finding, ...]

    def has(self, aspect: str) -> bool:
        """Whether points of this aspect were lost where the error arose."""
        return any(f.aspect == aspect and f.outcome in _LOST and not f.carried for f in self.findings)

    @property
    def is_unread(self) -> bool:
        """Whether the cell could not be read as a number."""
        return any(f.outcome is Outcome.UNSURE and not f.numbers for f in self.findings)

    @property
    def is_concluded(self) -> bool:
        """Whether it is worked out from other answers."""
        return bool(self.question.needs)


def next_steps(grade: Grade, assignment: Assignment, *, may_hand_in: bool, show_truth: bool) -> tuple[Markup, ...]:
    """Return what to do next, in order; every sentence is escaped.

    Parameters
    ----------
    grade : Grade
    assignment : Assignment
    may_hand_in : bool
        Whether another attempt would count.
    show_truth : bool
        Whether the page shows true values.
    """
    steps = [_EMPTY.format(ANSWERS)] if grade.status == "empty" else [*_repairs(grade, assignment)]
    if not steps:
        return (Markup("Everything that was judged is right: there is nothing to do."),)
    if may_hand_in:
        steps.append(Markup("Save the workbook and hand it in again."))
    elif show_truth:
        steps.append(Markup("Compare your values with the true ones below, and find the step where they part."))
    return tuple(steps)


_EMPTY = Markup("Type your values and their units into the coloured cells of the sheet {}.")


def _repairs(grade: Grade, assignment: Assignment) -> Iterator[Markup]:
    lost = [_Lost(question, grade.of(question.id)) for question in assignment.questions]
    unread = _symbols(lost, lambda item: item.is_unread)
    if unread:
        yield Markup("Type {} as plain numbers; a person looks at what you wrote.").format(unread)
    without_unit = _symbols(lost, lambda item: item.has("unit"))
    if without_unit:
        yield Markup("Choose the unit in the cell beside {}.").format(without_unit)
    yield from _measure_again(lost)
    if any(finding.outcome is not Outcome.RIGHT for finding in grade.of("tracking")):
        yield Markup("Paste your measured positions into the sheet {}, in metres, y up, all frames.").format(TRACKING)
    formula = _symbols(lost, lambda item: item.has("formula"))
    if formula:
        yield Markup("Work out {} again from the velocities that you wrote, with the formulas of your course.").format(
            formula
        )


def _measure_again(lost: list[_Lost]) -> Iterator[Markup]:
    by_dimension: dict[str, list[_Lost]] = {}
    for item in lost:
        if item.has("value") and not item.is_concluded and not item.is_unread:
            by_dimension.setdefault(item.question.dimension, []).append(item)
    for dimension, items in by_dimension.items():
        yield _ADVICE.get(dimension, _USUAL).format(_symbols(items, lambda _: True))


def _symbols(items: list[_Lost], wanted: Callable[[_Lost], bool]) -> Markup:
    return Markup(", ").join(symbol(item.question.symbol) for item in items if wanted(item))

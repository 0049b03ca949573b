"""What a student should do next: the earliest step that went wrong comes first."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
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
        settled = [finding.outcome for finding in grade.findings if finding.question_id in grade.decided]
        return (_DECIDED if set(settled) & _LOST else _RIGHT,)
    if may_hand_in:
        steps.append(Markup("Save the workbook and hand it in again."))
    elif show_truth:
        steps.append(Markup("Compare your values with the true ones below, and find the step where they part."))
    return tuple(steps)


_RIGHT = Markup("Everything that was judged is right: there is nothing to do.")
_DECIDED = Markup("A person has looked at what was not right; their words stand below.")
_EMPTY = Markup("Type your values and their units into the coloured cells of the sheet {}.")


def _repairs(grade: Grade, assignment: Assignment) -> Iterator[Markup]:
    asked = [question for question in assignment.questions if question.id not in grade.decided]
    lost = [_Lost(question, grade.of(question.id)) for question in asked]
    told = {id_ for diagnosis in grade.diagnosis for id_ in diagnosis.ids or (diagnosis.subject,)}
    if grade.diagnosis:
        cells = _symbols(lost, lambda item: item.question.id in told) or TRACKING
        yield Markup("Follow the hints under “Where to look”: {}.").format(cells)
    yield from _cells(lost)
    yield from _measure_again([item for item in lost if item.question.id not in told])
    yield from _table(grade.of("tracking"))
    formula = _symbols(lost, lambda item: item.has("formula") and item.question.id not in told)
    if formula:
        said = Markup("Work out {} again from the numbers that you wrote, with the formulas of your course.")
        yield said.format(formula)


def _cells(lost: list[_Lost]) -> Iterator[Markup]:
    unread = _symbols(lost, lambda item: item.is_unread)
    if unread:
        yield Markup("Type {} as plain numbers; a person looks at what you wrote.").format(unread)
    without_unit = _symbols(lost, lambda item: item.has("unit"))
    if without_unit:
        yield Markup("Choose the unit in the cell beside {}.").format(without_unit)


def _table(findings: Iterable[Finding]) -> Iterator[Markup]:
    for finding in findings:
        if finding.outcome is not Outcome.RIGHT and "rms_px" not in finding.numbers:
            yield Markup("Paste your measured positions into the sheet {}, in metres, y up, all frames.").format(
                TRACKING
            )
        elif finding.outcome in _LOST:
            yield Markup("Repair the tracking table: what is wrong with it stands under “Your tracking table”.")


def _measure_again(lost: list[_Lost]) -> Iterator[Markup]:
    by_dimension: dict[str, list[_Lost]] = {}
    for item in lost:
        if item.has("value") and not item.is_concluded and not item.is_unread:
            by_dimension.setdefault(item.question.dimension, []).append(item)
    for dimension, items in by_dimension.items():
        yield _ADVICE.get(dimension, _USUAL).format(_symbols(items, lambda _: True))


def _symbols(items: list[_Lost], wanted: Callable[[_Lost], bool]) -> Markup:
    return Markup(", ").join(symbol(item.question.symbol) for item in items if wanted(item))

"""What the grader does for people beside grading: settle a review, give more time, release."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from dataclasses import asdict, replace

from assignments.course import Course, add_extension
from assignments.load import known_assignments, load_assignment
from assignments.terms import Extension
from assignments.words import symbol_text
from grader.adjust import Adjustment
from grader.gradebook import Gradebook, Row
from grader.marker import Marker, Progress, Wanted, silent, write_class_page
from grader.releasing import Change, release_grades
from vml_course.errors import InputError, UnknownNameError

ON_ALL_CORES = Wanted(workers=0)


def set_points(course: Course, assignment_id: str, pid: str, adjustment: Adjustment) -> tuple[int, Row]:
    """Record what a person decided, and write the class page and the student's anew.

    Returns
    -------
    attempt : int
        The attempt that was decided about; where the best counts, another may count now.
    row : Row
        The grade that follows.

    Raises
    ------
    InputError, UnknownNameError
    """
    assignment = load_assignment(assignment_id, course.assignments)
    by_symbol = {symbol_text(question.symbol): question.id for question in assignment.questions}
    adjustment = replace(adjustment, question=by_symbol.get(adjustment.question, adjustment.question))
    with Gradebook.open(course) as gradebook:
        attempt, row = gradebook.adjust(assignment, pid, adjustment)
        write_class_page(course, gradebook, assignment)
        _rewrite_pages(course, gradebook, [row])
    return attempt, row


def _rewrite_pages(
    course: Course,
    gradebook: Gradebook,
    rows: Sequence[Row],
    progress: Progress = silent,
    wanted: Wanted = ON_ALL_CORES,
) -> None:
    with wanted.crew_for(len(rows)) as crew:
        Marker(course, gradebook, crew, wanted).rewrite_pages(rows, progress)


def release(
    course: Course,
    assignment_id: str,
    *,
    who: str,
    dry_run: bool = False,
    show_truth: bool | None = None,
    progress: Progress = silent,
) -> tuple[Change, ...]:
    """Release what counts now, and write every page anew: what students read is what was released.

    True values appear on the pages when the terms say, unless `show_truth` says otherwise.

    Raises
    ------
    UnknownNameError, NothingGradedError
    """
    changes = release_grades(course, assignment_id, who=who, dry_run=dry_run)
    if not dry_run:
        with Gradebook.open(course) as gradebook:
            _rewrite_pages(course, gradebook, gradebook.rows(assignment_id), progress, Wanted(show_truth, workers=0))
            write_class_page(course, gradebook, load_assignment(assignment_id, course.assignments))
    return changes


def truth_note(course: Course, assignment_id: str) -> str:
    """Return why pages show no true values though nobody has said so, "" where they do or somebody has."""
    terms = course.calendar.terms_of(assignment_id)
    if terms.true_values != "when over" or terms.is_over(dt.datetime.now(dt.UTC)):
        return ""
    return (
        "Pages show no true values while work can still earn points: say in course.toml when it closes, and release "
        "again after that, or show them now with --show-truth."
    )


def extend_student(course: Course, given: Extension) -> list[str]:
    """Give a student more time or attempts, in the course's settings and as an event; return what holds now, in words.

    Raises
    ------
    InputError, CourseError
    UnknownNameError
        When there is no such assignment.
    """
    if not given.hours and not given.attempts:
        raise InputError("extension", "--hours or --attempts above 0", "neither")
    known = known_assignments(course.assignments)
    if given.assignment and given.assignment not in known:
        raise UnknownNameError("assignment", given.assignment, known)
    with Gradebook.open(course) as gradebook:
        gradebook.student(given.student)
        extended = add_extension(course, given)
        gradebook.note("extended", given.student, asdict(given))
    with Gradebook.open(extended) as gradebook:
        rows = [row for row in gradebook.rows(given.assignment or None) if row.student.pid == given.student]
        _rewrite_pages(extended, gradebook, rows)
    calendar = extended.calendar
    named = [given.assignment] if given.assignment else sorted(calendar.terms or {})
    return [
        f"{given.student}  {name}: due {calendar.due_text(name, given.student) or 'at no date'}, "
        f"{calendar.terms_of(name, given.student).attempts or 'any number of'} attempts"
        for name in named
    ] or [f"{given.student}: extended; no assignment has a date yet."]

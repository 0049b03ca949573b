"""What the grader does for people beside grading: settle a review, give more time."""

from __future__ import annotations

from dataclasses import asdict, replace

from assignments.course import Course, add_extension
from assignments.load import load_assignment
from assignments.terms import Extension
from assignments.words import symbol_text
from grader.adjust import Adjustment
from grader.gradebook import Gradebook, Row
from grader.marker import USUAL, Marker, write_class_page


def set_points(course: Course, assignment_id: str, pid: str, adjustment: Adjustment) -> Row:
    """Record what a person decided, and write the class page and the student's anew; return the grade that follows.

    Raises
    ------
    InputError, UnknownNameError
    """
    assignment = load_assignment(assignment_id, course.assignments)
    by_symbol = {symbol_text(question.symbol): question.id for question in assignment.questions}
    adjustment = replace(adjustment, question=by_symbol.get(adjustment.question, adjustment.question))
    with Gradebook.open(course) as gradebook:
        row = gradebook.adjust(assignment, pid, adjustment)
        write_class_page(course, gradebook, assignment)
        receipt = gradebook.receipt_of(assignment_id, pid, row.attempt)
        if receipt is not None:
            with USUAL.crew_for(1) as crew:
                Marker(course, gradebook, crew, USUAL).rewrite_page(receipt, row.attempt)
    return row


def extend_student(course: Course, given: Extension) -> list[str]:
    """Give a student more time or attempts, in the course's settings and as an event; return what holds now, in words.

    Raises
    ------
    InputError, CourseError
    """
    with Gradebook.open(course) as gradebook:
        gradebook.student(given.student)
        extended = add_extension(course, given)
        gradebook.note("extended", given.student, asdict(given))
    calendar = extended.calendar
    named = [given.assignment] if given.assignment else sorted(calendar.terms or {})
    return [
        f"{given.student}  {name}: due {calendar.due_text(name, given.student) or 'at no date'}, "
        f"{calendar.terms_of(name, given.student).attempts or 'any number of'} attempts"
        for name in named
    ] or [f"{given.student}: extended; no assignment has a date yet."]

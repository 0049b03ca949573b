"""Comparing what a class handed in: from the kept bytes to evidence in the gradebook."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from assignments.course import Course
from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from grader.findings import Newest, add_findings, findings_of, keys_of_class, newest_files
from grader.gradebook import Gradebook
from grader.inbox import kept_name
from grader.integrity import Evidence, HandedIn, compare
from grader.read import ReadRequest, read_isolated
from grader.read.locate import find_submission
from grader.shared_files import shared_files
from grader.template import template_cells
from vml_course.errors import VmlError

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Compared:
    """What came of it.

    Attributes
    ----------
    evidence : tuple of Evidence
        All that is kept, that of earlier comparisons first.
    new : int
        How much of it was not known before.
    students : int
        Whose workbooks were compared.
    unread : tuple of str
        Students whose workbook could not be read again.
    """

    evidence: tuple[Evidence, ...]
    new: int
    students: int
    unread: tuple[str, ...] = ()


def compare_class(course: Course, assignment_id: str, progress: Progress | None = None) -> Compared:
    """Compare the newest workbooks of a class, and keep what is found; grades stay as they are.

    Raises
    ------
    UnknownNameError
        When there is no such assignment.
    DatabaseError
    """
    assignment = load_assignment(assignment_id, course.assignments)
    with Gradebook.open(course) as book:
        with book.reading() as connection:
            files, keys = newest_files(connection, assignment_id), keys_of_class(connection, assignment_id)
        found = list(shared_files(course, book, assignment_id))
        handed, unread = list[HandedIn](), list[str]()
        for done, file in enumerate(files, start=1):
            try:
                handed.append(_read(course, assignment, file, keys[file.pid]))
            except VmlError:
                unread.append(file.pid)
            if progress is not None:
                progress(done, 2 * len(files))
        later = None if progress is None else lambda done, total: progress(total + done, 2 * total)
        found += compare(handed, keys, later)
        with book.writing() as connection:
            new = add_findings(connection, assignment_id, found)
            kept = findings_of(connection, assignment_id)
    return Compared(kept, new, len(handed), tuple(unread))


def _read(course: Course, assignment: Assignment, file: Newest, key: AnswerKey) -> HandedIn:
    read = read_isolated(ReadRequest(file.name, course.shelf.read(kept_name(file.file_sha256))))
    submission = find_submission(read, assignment.questions, template_cells(assignment), assignment.points)
    return HandedIn(file.pid, submission, key)

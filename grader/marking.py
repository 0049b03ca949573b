"""What a worker does in grading: read a file, and judge what was read. No database, no course, nothing secret.

Module-level functions of one record each, so that they run here, in processes or on a cluster.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from grader.grade import grade
from grader.model import Grade, Submission
from grader.plausible import settle_readings
from grader.read import Book, ReadRequest, claims_of, find_submission, read_isolated
from grader.read.locate import Claims
from grader.template import template_cells


@dataclass(frozen=True)
class ReadOrder:
    """A file to read.

    Attributes
    ----------
    name : str
    data : bytes
    assignments : Path
        The folder of the course's own assignments.
    assignment : str
        Whose questions to look for; those of the assignment that the workbook names when "".
    told : Claims, optional
        What a person says that it is, whatever the workbook says.
    """

    name: str
    data: bytes
    assignments: Path
    assignment: str = ""
    told: Claims | None = None


@dataclass(frozen=True, eq=False)
class Understood:
    """What a file says: whose it claims to be, what was answered, and all of its cells."""

    book: Book
    claims: Claims
    submission: Submission
    assignment: Assignment


@dataclass(frozen=True, eq=False)
class MarkOrder:
    """A submission to judge."""

    submission: Submission
    key: AnswerKey
    assignment: Assignment


@dataclass(frozen=True, eq=False)
class Marked:
    """A judged submission, and the processor time that it took."""

    submission: Submission
    grade: Grade
    took_ms: int


def understand(order: ReadOrder) -> Understood:
    """Read a file in a limited process and find its answers.

    Raises
    ------
    VmlError
        When it is no workbook of ours.
    """
    book = read_isolated(ReadRequest(order.name, order.data))
    claims = order.told or claims_of(book)
    assignment = load_assignment(order.assignment or claims.assignment_id, order.assignments)
    cells = template_cells(assignment)
    submission = find_submission(book, assignment.questions, cells, assignment.points, claims)
    return Understood(book, claims, submission, assignment)


def mark(order: MarkOrder) -> Marked:
    """Judge a submission."""
    started_s = time.process_time()
    questions = {question.id: question for question in order.assignment.questions}
    submission = settle_readings(order.submission, questions, order.key.values)
    result = grade(submission, order.key, order.assignment)
    return Marked(submission, result, round(1000 * (time.process_time() - started_s)))

"""A student's own look at a workbook before handing it in: form only, nothing is compared with any truth."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from assignments.load import load_assignment
from assignments.model import Assignment
from grader.consistent import remarks_on
from grader.model import Kind, Submission
from grader.plausible import settle_readings
from grader.read import ReadRequest, claims_of, find_submission, read_workbook
from grader.read.locate import Claims
from grader.stated import Unstated, state
from grader.template import template_cells
from vml_course.io.files import existing


@dataclass(frozen=True)
class Checked:
    """One answer of a workbook, looked at for form only.

    `status` is `read`, `no unit`, `empty` or `unclear`; `says` is what was read, or why nothing was.
    """

    question_id: str
    label: str
    status: str
    says: str
    where: str


@dataclass(frozen=True)
class CheckResult:
    """What a workbook's form is like; nothing is compared with any truth.

    `remarks` are sentences about what looks odd; a complete workbook may have some.
    """

    assignment_id: str
    answers: tuple[Checked, ...]
    tracking_rows: int
    flags: tuple[str, ...]
    remarks: tuple[str, ...] = ()
    is_practice: bool = False

    @property
    def is_complete(self) -> bool:
        """Whether every answer can be read with its unit, and there is a tracking table."""
        return self.tracking_rows > 0 and all(answer.status == "read" for answer in self.answers)


def check_workbook(file: Path) -> CheckResult:
    """Look at a workbook as the grader will: format, completeness, plausibility, and whether it agrees with itself.

    The assignment is the one that the workbook's hidden sheet names; no course and no gradebook is needed.

    Raises
    ------
    FileMissingError, UnreadableError, UnknownNameError
    """
    book = read_workbook(ReadRequest(file.name, existing(file).read_bytes()))
    claims = claims_of(book)
    assignment = load_assignment(claims.assignment_id)
    submission = find_submission(book, assignment.questions, template_cells(assignment), assignment.points)
    submission = settle_readings(submission, {question.id: question for question in assignment.questions})
    rows = max((len(column) for column in submission.tracking.values()), default=0)
    remarks = (*_version_remark(claims, assignment), *remarks_on(book, submission, assignment))
    checked = tuple(_checked(submission, assignment))
    return CheckResult(assignment.id, checked, rows, submission.flags, remarks, is_practice=bool(claims.purpose))


def _version_remark(claims: Claims, assignment: Assignment) -> Iterator[str]:
    if claims.version and claims.version != assignment.version:
        yield (
            f"This workbook is of version {claims.version[:20]} of the assignment; this program knows version "
            f"{assignment.version}. Is it last year's?"
        )


_NO_UNIT = {
    False: "no unit is chosen; choose one in column D",
    True: "the unit says pixels; convert with your scale and choose a unit in column D",
}


def _checked(submission: Submission, assignment: Assignment) -> Iterable[Checked]:
    for question in assignment.questions:
        answer = submission.answer(question.id)
        stated = state(answer, question)
        if isinstance(stated, Unstated):
            status = "empty" if answer.kind is Kind.BLANK else "unclear"
            says = stated.reason
        else:
            needs_unit = question.dimension != "number" and (not stated.unit_given or stated.in_pixels)
            status, says = ("no unit" if needs_unit else "read"), stated.text
            if answer.read_as:
                says = f"{answer.text}, read as {stated.text}"
            if needs_unit:
                says += f": {_NO_UNIT[stated.in_pixels]}"
        yield Checked(question.id, question.label, status, says, answer.where)

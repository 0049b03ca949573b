"""Canvas: a zip with every student's annotated workbook, for "Upload Submissions" of an assignment.

Canvas finds student and file by two numbers in a file's name, those of the download that was collected, and shows what
comes back under the name that the student gave to the file (`content_zipper.rb`, `assignment.rb`). A page would so be
called a workbook and not open: what goes back is a workbook. No name leaves, neither the student's nor the file's.
"""

from __future__ import annotations

import re
from pathlib import Path

from assignments.bundle import zip_bytes
from grader.enrolment import Student
from grader.filling.feedback import feedback_name, held_back
from grader.filling.job import Export, Job, Line
from grader.gradebook import Gradebook
from grader.receipts import Receipt

_PLATFORM, _WORKBOOK = "canvas", ".xlsx"
_REFERENCE = re.compile(r"\d+_\d+|anon_[A-Za-z0-9]{5}_\d+")


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Write the annotated workbooks of those whose released grade is the one that they tell."""
    files, lines = dict[str, bytes](), list[Line]()
    with Gradebook.open(job.course) as book:
        for student in job.students:
            receipt = _receipt(job, book, student)
            line = held_back(job, student, _WORKBOOK) or _line(student, receipt)
            if receipt and line.status == "filled":
                files[_name(student, receipt)] = job.course.shelf.read(feedback_name(job, student, _WORKBOOK))
            lines.append(line)
    path.write_bytes(zip_bytes(files))
    return tuple(lines)


EXPORT = Export(
    write,
    ".zip",
    hint=(
        "In Canvas open the assignment and choose Upload Submissions. Do so once: every upload adds a comment with the "
        "workbook to each submission, and takes none away."
    ),
)


def _receipt(job: Job, book: Gradebook, student: Student) -> Receipt | None:
    grade = job.grade_of(student)
    return book.receipt_of(job.assignment.id, student.pid, grade.attempt, _PLATFORM) if grade else None


def _line(student: Student, receipt: Receipt | None) -> Line:
    """Say whether Canvas can take a student's workbook back."""
    why = ""
    if receipt is None or not _REFERENCE.fullmatch(receipt.arrived.lms_ref):
        why = "was not collected from a download of Canvas"
    elif not receipt.arrived.name.lower().endswith(_WORKBOOK):
        why = f"Canvas would show the workbook as {receipt.arrived.name!r}, which would not open"
    return Line(student.name, "skipped" if why else "filled", reason=why or "feedback", pid=student.pid)


def _name(student: Student, receipt: Receipt) -> str:
    lead = "" if receipt.arrived.lms_ref.startswith("anon_") else f"vml-{student.pid}_"
    return f"{lead}{receipt.arrived.lms_ref}_feedback{_WORKBOOK}"

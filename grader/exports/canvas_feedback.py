"""Canvas: a zip with every student's annotated workbook, for "Upload Submissions" of an assignment.

Canvas finds student and file by two numbers in a file's name, those of the download that was collected, and shows what
comes back under the name that the student gave to the file (`content_zipper.rb`, `assignment.rb`). A page would so be
called a workbook and not open: what goes back is a workbook. Whose it is says the pseudonym, no name leaves.
"""

from __future__ import annotations

from pathlib import Path

from assignments.bundle import zip_bytes
from grader.enrolment import Student
from grader.filling.feedback import feedback_name, held_back
from grader.filling.job import Export, Job, Line
from grader.gradebook import Gradebook

_WORKBOOK = ".xlsx"


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Write the annotated workbooks of those whose released grade is the one that they tell."""
    files, lines = dict[str, bytes](), list[Line]()
    with Gradebook.open(job.course) as book:
        for student in job.students:
            line = held_back(job, student, _WORKBOOK) or _named(job, book, student)
            if line.status == "filled":
                files[line.reason] = job.course.shelf.read(feedback_name(job, student, _WORKBOOK))
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


def _named(job: Job, book: Gradebook, student: Student) -> Line:
    """Return a line whose reason is the name under which Canvas takes a student's workbook back."""
    grade = job.grade_of(student)
    receipt = book.receipt_of(job.assignment.id, student.pid, grade.attempt) if grade else None
    if receipt is None or receipt.arrived.source != "canvas" or not receipt.arrived.lms_ref:
        return Line(student.name, "skipped", reason="was not collected from a download of Canvas", pid=student.pid)
    name, reference = receipt.arrived.name, receipt.arrived.lms_ref
    if not name.lower().endswith(_WORKBOOK):
        reason = f"Canvas would show the workbook as {name!r}, which would not open"
        return Line(student.name, "skipped", reason=reason, pid=student.pid)
    lead = "" if reference.startswith("anon_") else f"vml-{student.pid}_"
    return Line(student.name, "filled", reason=f"{lead}{reference}_{name}", pid=student.pid)

"""What a student gets back beside the points: which file it is, and whether it may leave."""

from __future__ import annotations

from grader.enrolment import Student
from grader.filling.fill import no_grade
from grader.filling.job import Job, Line
from grader.grading import FEEDBACK


def feedback_name(job: Job, student: Student, suffix: str) -> str:
    """Return where a student's page (`.html`) or annotated copy (`.xlsx`) lies on the course's shelf."""
    return f"{FEEDBACK}/{job.assignment.id}/{student.pid}{suffix}"


def held_back(job: Job, student: Student, suffix: str) -> Line | None:
    """Return why a student's feedback stays here, None when it may leave.

    One that is newer than the release would tell what was not released.
    """
    none = no_grade(job, student)
    if none is not None:
        return none
    if student.pid in job.stale:
        return Line(student.name, "skipped", reason="graded anew since the release: vml release", pid=student.pid)
    if not job.course.shelf.exists(feedback_name(job, student, suffix)):
        return Line(student.name, "skipped", reason="has no feedback file", pid=student.pid)
    return None

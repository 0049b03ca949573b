"""A plain table of the released grades, for everything else."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from grader.enrolment import Student
from grader.filling.cells import harmless
from grader.filling.fill import no_grade, open_text
from grader.filling.job import Export, Job, Line
from grader.filling.numbers import points_text

_COLUMNS = ("email", "sis_id", "login", "name", "pid", "attempt", "earned", "late_share", "points", "out_of", "state")


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Write a line for every student with a released grade.

    Names are made harmless for spreadsheets; what a platform finds a student by is written as it is. The state is
    `final`, `open` (points may become fewer: a person has to look) or `changed` (graded anew since the release).
    """
    comma, text, lines = job.decimal == "comma", io.StringIO(), []
    table = csv.writer(text, delimiter=";" if comma else ",", lineterminator="\r\n")
    table.writerow(_COLUMNS)
    for student in job.students:
        none, released = no_grade(job, student), job.grade_of(student)
        if none is not None or released is None:
            lines += [none] if none else []
            continue
        ids = student.ids or {}
        numbers = (released.earned, released.late_share, released.points, released.out_of)
        earned, late, points, out_of = (points_text(number, comma=comma) for number in numbers)
        who = (student.email, ids.get("sis_id", ""), ids.get("login", ""), harmless(student.name), student.pid)
        open_ = open_text(job, student)
        table.writerow((*who, released.attempt, earned, late, points, out_of, _state(job, student)))
        lines.append(Line(student.name, "filled", points, open_, student.pid, bool(open_)))
    path.write_bytes(text.getvalue().encode("utf-8-sig"))  # the mark tells Excel that it is UTF-8
    return tuple(lines)


def _state(job: Job, student: Student) -> str:
    if student.pid in job.stale:
        return "changed"
    return "open" if student.pid in job.unsettled else "final"


EXPORT = Export(
    write,
    ".csv",
    hint="Where a platform asks: students go by e-mail, the column with the grade is points.",
)

"""Moodle: a zip with every student's feedback page, for "Upload multiple feedback files in a zip".

Moodle finds the student by the number in a folder's name and by nothing else (`importziplib.php` of mod_assign): the
first word is a pseudonym, so that no name leaves, and no underscore in a name can shift the rest. The number is
another one in every assignment, and so the assignment's own worksheet has to say it.
"""

from __future__ import annotations

from pathlib import Path

from assignments.bundle import moodle_folder, zip_bytes
from grader.filling.feedback import feedback_name, held_back
from grader.filling.fill import missing
from grader.filling.job import Export, Job, Line, template_of
from grader.filling.moodle_worksheet import EXPECTED, worksheet
from grader.filling.people import Directory

_PAGE = "feedback.html"


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Write the pages of those whose released grade is the one that their page tells.

    Raises
    ------
    InputError, TableError
        When the worksheet is missing, or is none.
    """
    template = template_of(job, EXPECTED)
    sheet = worksheet(template.name, template.data)
    asked, files, lines = sheet.people(), dict[str, bytes](), list[Line]()
    directory, seen = Directory(job.students, asked.values()), set[str]()
    for row, one in asked.items():
        whose = directory.find(one)
        if isinstance(whose, str):
            lines.append(Line(one.name, "skipped", reason=whose))
            continue
        seen.add(whose.pid)
        line = held_back(job, whose, ".html")
        if line is None:
            folder = moodle_folder(whose.pid, sheet.participant(row))
            files[f"{folder}/{_PAGE}"] = job.course.shelf.read(feedback_name(job, whose, ".html"))
        lines.append(line or Line(whose.name, "filled", reason=_PAGE, pid=whose.pid))
    path.write_bytes(zip_bytes(files))
    return (*lines, *missing(job, seen))


EXPORT = Export(
    write,
    ".zip",
    template=EXPECTED,
    hint=(
        "Upload the worksheet with the grades first, then this with Upload multiple feedback files in a zip: every "
        "upload counts as a change of grades. The assignment needs the feedback type Feedback files."
    ),
)

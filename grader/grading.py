"""Grading a batch: files that somebody names, or those that were collected and wait.

Every file is kept and has its receipt before it is looked at, and run and receipt are written in one transaction:
a run that was killed goes on with what still waits.
"""

from __future__ import annotations

import datetime as dt
import time
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from assignments.course import Course
from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.terms import Terms
from grader.errors import UnknownVariantError
from grader.feedback import Report, class_page, feedback_page
from grader.grade import grade
from grader.gradebook import Gradebook, Row
from grader.inbox import keep, kept_name, received_bytes
from grader.model import Grade, Submission
from grader.plausible import settle_readings
from grader.read import ReadRequest, claims_of, find_submission, read_isolated
from grader.receipts import Arrived, Receipt, handed_in_at
from grader.signed import is_signed
from grader.template import template_cells
from vml_course.errors import FileMissingError, VmlError

FEEDBACK = "feedback"
FILES = "files"  # the source of what no platform sent
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Graded:
    """What became of one file.

    Attributes
    ----------
    file : Path
        As it was named.
    status : str
        `ok`, `review` (a person should look), `empty` (nothing was answered) or `unreadable` (nothing was graded).
    message : str
        Why, in one line, and whether other files of the student came with it; "" when there is nothing to say.
    is_provisional : bool
        Whether points are counted that a person has still to confirm.
    feedback : str
        Where the student's page lies, "" when there is none.
    """

    file: Path
    status: str
    message: str = ""
    pid: str = ""
    assignment_id: str = ""
    attempt: int = 0
    points: float = 0.0
    out_of: float = 0.0
    is_provisional: bool = False
    feedback: str = ""

    @property
    def needs_attention(self) -> bool:
        """Whether a person should look at it."""
        return self.status != "ok"


@dataclass(frozen=True)
class Wanted:
    """How a batch is graded.

    Attributes
    ----------
    show_truth : bool or None
        Whether the students' pages show true values and curves; None: when nobody can hand in any more.
    received : datetime or None
        When files that no platform sent were handed in; None: nobody knows, and they count as in time.
    """

    show_truth: bool | None = None
    received: dt.datetime | None = None


def grade_files(
    course: Course, files: Iterable[Path], wanted: Wanted | None = None, *, progress: Progress | None = None
) -> list[Graded]:
    """Grade files, record what they earned, write a page for each student and one for the class.

    A file that cannot be graded gets a status and a polite reason; it never stops the others. Attempts are as old as
    the first arrival of their content, and the files of one batch are taken in the order in which they were changed.

    Parameters
    ----------
    course : Course
    files : iterable of Path
        Files, or folders, of which every file is taken.
    wanted : Wanted, optional
    progress : callable, optional
        `(files done, files in all)`.

    Returns
    -------
    list of Graded
        In the order in which the files were named.

    Raises
    ------
    FileMissingError
        When none of the files exists.
    """
    listed = listed_files(files)
    with Gradebook.open(course) as book:
        marker = _Marker(course, book, wanted or Wanted())
        graded: dict[Path, Graded] = {}
        for done, file in enumerate(sorted(listed, key=_changed), start=1):
            graded[file] = marker.mark_file(file)
            if progress is not None:
                progress(done, len(listed))
        return marker.finish([graded[file] for file in listed])


def grade_collected(
    course: Course, assignment_id: str, wanted: Wanted | None = None, *, progress: Progress | None = None
) -> list[Graded]:
    """Grade what was collected for an assignment and not graded yet, in the order in which it was handed in.

    As `grade_files`.
    """
    with Gradebook.open(course) as book:
        marker = _Marker(course, book, wanted or Wanted())
        waiting, graded = book.receipts("collected", assignment_id), []
        for done, receipt in enumerate(waiting, start=1):
            graded.append(marker.mark_receipt(receipt))
            if progress is not None:
                progress(done, len(waiting))
        return marker.finish(graded)


def write_class_page(
    course: Course, gradebook: Gradebook, assignment: Assignment, unreadable: Sequence[tuple[str, str]] = ()
) -> str:
    """Write the instructor's page of an assignment from the gradebook; return where it is."""
    name = f"{FEEDBACK}/{assignment.id}/class.html"
    rows, students = gradebook.rows(assignment.id), gradebook.students()
    course.shelf.write(name, class_page(assignment, rows, unreadable, students).encode())
    return course.shelf.place(name)


def listed_files(files: Iterable[Path]) -> list[Path]:
    """Return the files that are meant, each once: folders stand for what lies in them.

    Raises
    ------
    FileMissingError
        When none of them exists.
    """
    files, listed = [Path(file) for file in files], list[Path]()
    for path in files:
        inside = (
            sorted(p for p in path.iterdir() if p.is_file() and not p.name.startswith((".", "~$")))
            if path.is_dir()
            else [path]
        )
        listed += inside
    if not any(file.exists() for file in listed):
        first = files[0] if files else Path()
        is_folder = first.is_dir()
        expected = "a folder with workbooks in it" if is_folder else "an existing file or folder"
        raise FileMissingError(str(first), expected, "an empty folder" if is_folder else "no such file")
    return list(dict.fromkeys(listed))


def _changed(file: Path) -> float:
    return file.stat().st_mtime if file.exists() else 0.0


# ---------------------------------------------------------------- one file


class _Marker:
    """Takes file after file and writes what it earned."""

    def __init__(self, course: Course, book: Gradebook, wanted: Wanted) -> None:
        self._course, self._book, self._wanted = course, book, wanted
        self._now = dt.datetime.now(dt.UTC)

    def mark_file(self, file: Path) -> Graded:
        """Keep a file that somebody named, and grade it."""
        try:
            data = received_bytes(file)
        except VmlError as error:
            return Graded(file, "unreadable", str(error))
        arrived = Arrived(keep(self._course.shelf, data), file.name, FILES, self._now.isoformat())
        return replace(self._mark(Receipt(self._book.receive(arrived), arrived), data), file=file)

    def mark_receipt(self, receipt: Receipt) -> Graded:
        """Grade a file that was collected."""
        try:
            data = self._course.shelf.read(kept_name(receipt.arrived.file_sha256))
        except VmlError as error:
            return Graded(Path(receipt.arrived.name), "unreadable", str(error), receipt.arrived.pid)
        return self._mark(receipt, data)

    def finish(self, graded: Sequence[Graded]) -> list[Graded]:
        """Write the class pages; say so where several files of one student came in together."""
        result = _with_siblings(graded)
        unreadable = [(item.file.name, item.message) for item in result if item.status == "unreadable"]
        for assignment_id in dict.fromkeys(item.assignment_id for item in result if item.assignment_id):
            write_class_page(self._course, self._book, self._load(assignment_id), unreadable)
        return result

    def _mark(self, receipt: Receipt, data: bytes) -> Graded:
        name = receipt.arrived.name
        try:
            submission, assignment, key = self._understood(ReadRequest(name, data))
        except VmlError as error:
            self._book.note_unreadable(receipt.id, receipt.arrived.file_sha256, str(error))
            return Graded(Path(name), "unreadable", str(error), receipt.arrived.pid, receipt.arrived.assignment)
        started = time.monotonic()
        submission = settle_readings(submission, {q.id: q for q in assignment.questions}, key.values)
        result = grade(submission, key, assignment)
        terms = self._course.calendar.terms_of(assignment.id, key.student)
        took_ms = round(1000 * (time.monotonic() - started))
        attempt = self._book.record_run(
            submission, result, received_at=self._received(receipt, terms), receipt=receipt.id, took_ms=took_ms
        )
        row = self._book.row(assignment.id, key.student)
        page = self._page(Report(assignment, submission, key, result, attempt), row, terms)
        return _graded(name, result, key, row, attempt, page)

    def _understood(self, request: ReadRequest) -> tuple[Submission, Assignment, AnswerKey]:
        book = read_isolated(request)
        claims = claims_of(book)
        key = self._book.key_for_code(claims.code, request.name)
        if not is_signed(self._course, key, claims):
            raise UnknownVariantError(request.name, claims.code)
        assignment = self._load(key.assignment_id)
        return (
            find_submission(book, assignment.questions, template_cells(assignment), assignment.points),
            assignment,
            key,
        )

    def _load(self, assignment_id: str) -> Assignment:
        return load_assignment(assignment_id, self._course.assignments)

    def _received(self, receipt: Receipt, terms: Terms) -> str:
        """Return when it counts as handed in; a platform's word was settled when it was collected."""
        if receipt.arrived.source != FILES:
            return receipt.arrived.received_at
        moment = dt.datetime.fromisoformat(receipt.arrived.received_at)
        return handed_in_at(terms, self._wanted.received, is_late=None, moment=moment).astimezone(dt.UTC).isoformat()

    def _page(self, report: Report, row: Row, terms: Terms) -> str:
        """Write the student's page; an old file that is graded again must not take the place of a newer one's."""
        name = f"{FEEDBACK}/{report.assignment.id}/{report.key.student}.html"
        if row.attempt == report.attempt:
            is_over = terms.is_over(self._now) or bool(terms.attempts and row.attempts >= terms.attempts)
            show = is_over if self._wanted.show_truth is None else self._wanted.show_truth
            page = feedback_page(replace(report, show_truth=show, adjustments=row.adjustments))
            self._course.shelf.write(name, page.encode())
        return self._course.shelf.place(name)


def _graded(name: str, result: Grade, key: AnswerKey, row: Row, attempt: int, page: str) -> Graded:
    said = [*result.reasons]
    if attempt in row.ignored:
        said.append("This attempt does not count: too many, or after the last moment.")
    return Graded(
        file=Path(name),
        status=result.status,
        message=" ".join(said),
        pid=key.student,
        assignment_id=key.assignment_id,
        attempt=attempt,
        points=result.points,
        out_of=result.out_of,
        is_provisional=result.is_provisional,
        feedback=page,
    )


def _with_siblings(graded: Sequence[Graded]) -> list[Graded]:
    count = Counter((item.pid, item.assignment_id) for item in graded if item.pid)
    words = {whose: f"{n} files of this student came together." for whose, n in count.items() if n > 1}
    said = [(item, words.get((item.pid, item.assignment_id), "")) for item in graded]
    return [replace(item, message=f"{item.message} {more}".strip()) if more else item for item, more in said]

"""Files become grades: workers read and judge them, one process writes what they earned, in their order."""

from __future__ import annotations

import datetime as dt
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from assignments.course import Course
from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.terms import Terms
from assignments.terms_words import closes_text
from assignments.variants import signature_of
from assignments.words import symbol_text
from grader.adjust import decided
from grader.annotated import annotated_workbook
from grader.errors import CollectError, UnknownVariantError
from grader.evidence import evidence_in
from grader.feedback import Report, class_page, feedback_page
from grader.frame import impact_frame
from grader.gradebook import Gradebook, Row
from grader.inbox import keep, kept_name, received_bytes
from grader.marking import Marked, MarkOrder, ReadOrder, Understood, mark, understand
from grader.model import Grade
from grader.read import Book
from grader.read.locate import Claims, claims_of
from grader.receipts import WAITING, Arrived, Receipt, handed_in_at
from grader.signed import is_signed
from vml_course.errors import VmlError
from vml_course.executors import Crew, each_done, open_executor

FEEDBACK = "feedback"
FILES = "files"  # the source of what no platform sent
SMALLEST_BATCH = 16
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
        Whether the students' pages show true values and curves; None: as the terms say.
    received : datetime or None
        When files that no platform sent were handed in; None: nobody knows, and they count as in time.
    workers : int
        Processes that work at the same time; 0 is one for each core where there is enough to do.
    cluster : str
        Address of a dask scheduler that does the work instead; `local:N` starts one.
    """

    show_truth: bool | None = None
    received: dt.datetime | None = None
    workers: int = 1
    cluster: str = ""

    def crew_for(self, files: int) -> Crew:
        """Return who does the work: a process costs as much to start as thirty workbooks to grade."""
        return open_executor(self.workers or min(os.cpu_count() or 1, 1 + files // 60), self.cluster)


@dataclass(frozen=True)
class Whose:
    """Whose files are, where a person says so: their codes are missing, or name another student than the platform."""

    student: str
    assignment: str
    told_by: str


USUAL = Wanted()


@dataclass(frozen=True, eq=False)
class _Known:
    """A file whose variant is known: what is to be judged, and the cells that it was found in."""

    order: MarkOrder
    book: Book


def write_class_page(
    course: Course, gradebook: Gradebook, assignment: Assignment, unreadable: Sequence[tuple[str, str]] = ()
) -> str:
    """Write the instructor's page of an assignment from the gradebook; return where it is.

    `unreadable` is what came in just now; what was collected earlier and could not be graded is listed, too.
    """
    unreadable = list(dict.fromkeys([*unreadable, *_ungraded(gradebook, assignment.id)]))
    name = f"{FEEDBACK}/{assignment.id}/class.html"
    rows, students = gradebook.rows(assignment.id), gradebook.students(active_only=True)
    page = class_page(assignment, rows, unreadable, students, evidence_in(gradebook, rows))
    course.shelf.write(name, page.encode())
    return course.shelf.place(name)


def _ungraded(gradebook: Gradebook, assignment_id: str) -> Iterator[tuple[str, str]]:
    for status in WAITING:
        for receipt in gradebook.receipts(status, assignment_id):
            whose = f" ({receipt.arrived.pid})" if receipt.arrived.pid else ""
            yield f"{receipt.arrived.name}{whose}", receipt.arrived.reason


class Marker:
    """Takes files in batches: workers read and judge them, this process writes what they earned."""

    def __init__(self, course: Course, book: Gradebook, crew: Crew, wanted: Wanted) -> None:
        self._course, self._book, self._crew, self._wanted = course, book, crew, wanted
        self._now = dt.datetime.now(dt.UTC)

    def mark_files(self, files: Sequence[Path], progress: Progress, whose: Whose | None = None) -> list[Graded]:
        """Keep the files that somebody named, and grade them; return what became of each."""
        kept = [self._keep(file, whose) for file in files]
        graded = self.mark_receipts([one for one in kept if isinstance(one, Receipt)], progress)
        done = iter(graded)
        return [
            replace(next(done), file=file) if isinstance(one, Receipt) else one
            for file, one in zip(files, kept, strict=True)
        ]

    def mark_receipts(self, receipts: Sequence[Receipt], progress: Progress) -> list[Graded]:
        """Grade files that were kept; return what became of each."""
        graded: list[Graded] = []
        size = max(SMALLEST_BATCH, 2 * self._crew.most_under_way)
        for start in range(0, len(receipts), size):
            for one in self._marked(receipts[start : start + size]):
                graded.append(one)
                progress(len(graded), len(receipts))
        return graded

    def finish(self, graded: Sequence[Graded]) -> list[Graded]:
        """Write the class pages; say so where several files of one student came in together."""
        result = _with_siblings(graded)
        unreadable = [(item.file.name, item.message) for item in result if item.status == "unreadable"]
        for assignment_id in dict.fromkeys(item.assignment_id for item in result if item.assignment_id):
            write_class_page(self._course, self._book, self._load(assignment_id), unreadable)
        return result

    def rewrite_pages(self, rows: Sequence[Row], progress: Progress) -> None:
        """Write students' pages anew, as after a decision or when the time is over; nothing is recorded."""
        size = max(SMALLEST_BATCH, 2 * self._crew.most_under_way)
        for start in range(0, len(rows), size):
            for row, one, result in self._judged(self._receipts_of(rows[start : start + size])):
                self._pages(self._report(one, result, row.attempt, row), row, one.book)
            progress(min(start + size, len(rows)), len(rows))

    def _receipts_of(self, rows: Sequence[Row]) -> Iterator[tuple[Row, ReadOrder]]:
        """Yield what each student's counting attempt was read from; bytes that are gone leave the old page."""
        for row in rows:
            receipt = self._book.receipt_of(row.assignment_id, row.student.pid, row.attempt)
            order = self._order_or_reason(receipt) if receipt is not None else None
            if isinstance(order, ReadOrder):
                yield row, order

    def _judged(self, wanted: Iterable[tuple[Row, ReadOrder]]) -> Iterator[tuple[Row, _Known, Marked]]:
        wanted = list(wanted)
        read = self._all(understand, [order for _, order in wanted])
        known = [(row, self._with_key(order, one)) for (row, order), one in zip(wanted, read, strict=True)]
        usable = [(row, one) for row, one in known if isinstance(one, _Known)]
        marked = self._all(mark, [one.order for _, one in usable])
        for (row, one), result in zip(usable, marked, strict=True):
            if isinstance(result, Marked):
                yield row, one, result

    def _keep(self, file: Path, whose: Whose | None) -> Receipt | Graded:
        try:
            data = received_bytes(file)
        except VmlError as error:
            return Graded(file, "unreadable", str(error))
        arrived = Arrived(keep(self._course.shelf, data), file.name, FILES, self._now.isoformat())
        if whose is not None:
            return self._book.claim(
                replace(arrived, assignment=whose.assignment, pid=whose.student, told_by=whose.told_by)
            )
        return Receipt(self._book.receive(arrived), arrived)

    def _marked(self, receipts: Sequence[Receipt]) -> Iterator[Graded]:
        orders = [self._order_or_reason(receipt) for receipt in receipts]
        understood = iter(self._all(understand, [order for order in orders if isinstance(order, ReadOrder)]))
        known = [self._with_key(one, next(understood)) if isinstance(one, ReadOrder) else one for one in orders]
        marked = iter(self._all(mark, [one.order for one in known if isinstance(one, _Known)]))
        for receipt, one in zip(receipts, known, strict=True):
            result = next(marked) if isinstance(one, _Known) else one
            if isinstance(one, _Known) and isinstance(result, Marked):
                yield self._record(receipt, one, result)
            else:
                yield self._refuse(receipt, str(result))

    def _order_or_reason(self, receipt: Receipt) -> ReadOrder | VmlError:
        """Return what to read, or why it cannot be: bytes that are gone stop nobody else."""
        try:
            return self._order(receipt)
        except VmlError as error:
            return error

    def _order(self, receipt: Receipt) -> ReadOrder:
        data = self._course.shelf.read(kept_name(receipt.arrived.file_sha256))
        return ReadOrder(receipt.arrived.name, data, self._course.assignments, told=self._told(receipt.arrived))

    def _told(self, arrived: Arrived) -> Claims | None:
        """Return what a person said that a file is, as the workbook itself would say it; None when nobody did."""
        if not arrived.told_by:
            return None
        code = self._book.key_of(arrived.assignment, arrived.pid).code
        return Claims(code, arrived.assignment, signature_of(self._course.secret, arrived.assignment, code))

    def _with_key(self, order: ReadOrder, read: object) -> _Known | object:
        """Add what is true to what was read; whoever's code it is, it must carry this course's signature."""
        if not isinstance(read, Understood):
            return read
        claims = read.claims
        try:
            key = self._book.key_for_code(claims.code, order.name)
            if not is_signed(self._course, key, claims):
                raise UnknownVariantError(order.name, claims.code)
            if order.told is not None:
                self._check_is_no_others(order.name, key, read.book)
            if read.assignment.id != key.assignment_id:  # the hidden sheet was changed: the key knows better
                read = understand(replace(order, assignment=key.assignment_id))
        except VmlError as error:
            return error
        return _Known(MarkOrder(read.submission, key, read.assignment), read.book)

    def _check_is_no_others(self, name: str, key: AnswerKey, book: Book) -> None:
        """Refuse to grade numbers of another video, whoever hands them in: they cannot be right for this one."""
        try:
            claims = claims_of(book)
            own = self._book.key_for_code(claims.code, name)
        except VmlError:
            return  # no code, or none of ours: a person knew better
        if own.code != key.code and is_signed(self._course, own, claims):
            expected = f"a workbook for the video of {key.student}"
            raise CollectError(name, expected, f"the workbook of {own.student} ({own.assignment_id})")

    def _all(self, work: Callable[[Any], Any], orders: Sequence[Any]) -> list[object]:
        """Return what became of each order, in their order: a result, or the error that stopped it."""
        done = {id(order): future for order, future in each_done(self._crew, work, orders)}
        errors = ((done[id(order)], done[id(order)].exception()) for order in orders)
        return [future.result() if error is None else _polite(error) for future, error in errors]

    def _record(self, receipt: Receipt, known: _Known, marked: Marked) -> Graded:
        submission, assignment, key = marked.submission, known.order.assignment, known.order.key
        terms = self._course.calendar.terms_of(assignment.id, key.student)
        received = self._received(receipt, terms)
        attempt = self._book.record_run(
            submission, marked.grade, received_at=received, receipt=receipt.id, took_ms=marked.took_ms
        )
        row = self._book.row(assignment.id, key.student)
        page = self._pages(self._report(known, marked, attempt, row), row, known.book)
        return _graded(receipt.arrived.name, marked.grade, key, row, attempt, page)

    def _report(self, known: _Known, marked: Marked, attempt: int, row: Row) -> Report:
        key, assignment = known.order.key, known.order.assignment
        terms = self._course.calendar.terms_of(assignment.id, key.student)
        return Report(assignment, marked.submission, key, marked.grade, attempt, row=row, terms=terms)

    def _refuse(self, receipt: Receipt, reason: str) -> Graded:
        arrived = receipt.arrived
        self._book.note_unreadable(receipt.id, arrived.file_sha256, reason)
        return Graded(Path(arrived.name), "unreadable", reason, arrived.pid, arrived.assignment)

    def _load(self, assignment_id: str) -> Assignment:
        return load_assignment(assignment_id, self._course.assignments)

    def _received(self, receipt: Receipt, terms: Terms) -> str:
        """Return when it counts as handed in; a platform's word was settled when it was collected."""
        if receipt.arrived.source != FILES:
            return receipt.arrived.received_at
        moment = dt.datetime.fromisoformat(receipt.arrived.received_at)
        return handed_in_at(terms, self._wanted.received, is_late=None, moment=moment).astimezone(dt.UTC).isoformat()

    def _pages(self, report: Report, row: Row, book: Book) -> str:
        """Write the student's page and the annotated copy of the workbook; return where the page lies.

        An old file that is graded again must not take the place of a newer one's.
        """
        name = f"{FEEDBACK}/{report.assignment.id}/{report.key.student}"
        if row.attempt == report.attempt:
            report = self._complete(report, row)
            self._course.shelf.write(f"{name}.html", feedback_page(report).encode())
            self._course.shelf.write(f"{name}.xlsx", annotated_workbook(report, book))
        return self._course.shelf.place(f"{name}.html")

    def _complete(self, report: Report, row: Row) -> Report:
        may_see = report.terms.shows_truth(self._now, row.attempts)
        symbols = {question.id: symbol_text(question.symbol) for question in report.assignment.questions}
        return replace(
            report,
            grade=decided(report.grade, row.decisions),
            show_truth=may_see if self._wanted.show_truth is None else self._wanted.show_truth,
            adjustments=tuple(item.told(symbols.get(item.question, "All together")) for item in row.decisions),
            due=self._course.calendar.due_text(report.assignment.id, report.key.student),
            closes=closes_text(self._course.calendar, report.assignment.id, report.key.student),
            is_over=report.terms.is_over(self._now),
            frame=impact_frame(self._course.shelf, report.key),
        )


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


def _polite(error: BaseException) -> str:
    """Say what stopped a file; what is our fault is said to be."""
    if isinstance(error, VmlError):
        return str(error)
    return (
        f"The grader failed on this file ({type(error).__name__}: {error}); it is not your fault. A person will look."
    )


def silent(_done: int, _total: int) -> None:
    """Tell nobody."""


def _with_siblings(graded: Sequence[Graded]) -> list[Graded]:
    count = Counter((item.pid, item.assignment_id) for item in graded if item.pid)
    words = {whose: f"{n} files of this student came together." for whose, n in count.items() if n > 1}
    said = [(item, words.get((item.pid, item.assignment_id), "")) for item in graded]
    return [replace(item, message=f"{item.message} {more}".strip()) if more else item for item, more in said]

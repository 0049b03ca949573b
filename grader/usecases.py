"""What the grader does for people: grade a batch of files, check one's own file, hand variants out."""

from __future__ import annotations

import hashlib
import hmac
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from assignments.course import Course, add_extension
from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.terms import Extension
from assignments.usecases import HandedOut, hand_out
from assignments.variants import signature_of
from grader.adjust import Adjustment
from grader.errors import UnknownVariantError
from grader.feedback import Report, class_page, feedback_page
from grader.grade import grade
from grader.gradebook import Gradebook, Row, Student
from grader.inbox import receive
from grader.model import Submission
from grader.plausible import settle_readings
from grader.read import ReadRequest, claims_of, find_submission, read_isolated
from grader.read.locate import Claims
from grader.template import template_cells
from vml_course.errors import FileMissingError, InputError, VmlError

FEEDBACK = "feedback"
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Graded:
    """What became of one file.

    Attributes
    ----------
    file : Path
    status : str
        `ok`, `review` (a person should look), `empty` (nothing was answered) or `unreadable` (nothing was graded).
    message : str
        Why, in one line, and whether other files of the student came with it; "" when there is nothing to say.
    is_provisional : bool
        Whether points are counted that a person has still to confirm.
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


def grade_files(
    course: Course, files: Iterable[Path], *, show_truth: bool = False, progress: Progress | None = None
) -> list[Graded]:
    """Grade files, record what they earned, write a page for each student and one for the class.

    A file that cannot be graded gets a status and a polite reason; it never stops the others. The newest attempt
    counts: attempts are as old as the first arrival of their content, and the files of one batch are taken in the
    order in which they were last changed.

    Parameters
    ----------
    course : Course
    files : iterable of Path
        Files, or folders, of which every file is taken.
    show_truth : bool
        Whether the students' pages show true values and curves, as after the due date.
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
    graded: dict[Path, Graded] = {}
    with Gradebook.open(course) as gradebook:
        for done, file in enumerate(sorted(listed, key=_changed), start=1):
            graded[file] = _grade_one(course, gradebook, file, show_truth=show_truth)
            if progress is not None:
                progress(done, len(listed))
        result = _with_siblings([graded[file] for file in listed])
        unreadable = [(item.file.name, item.message) for item in result if item.status == "unreadable"]
        for assignment_id in dict.fromkeys(item.assignment_id for item in result if item.assignment_id):
            write_class_page(course, gradebook, load_assignment(assignment_id), unreadable)
    return result


def write_class_page(
    course: Course, gradebook: Gradebook, assignment: Assignment, unreadable: Sequence[tuple[str, str]] = ()
) -> str:
    """Write the instructor's page of an assignment from the gradebook; return where it is."""
    name = f"{FEEDBACK}/{assignment.id}/class.html"
    rows, students = gradebook.rows(assignment.id), gradebook.students()
    course.shelf.write(name, class_page(assignment, rows, unreadable, students).encode())
    return course.shelf.place(name)


def _changed(file: Path) -> float:
    return file.stat().st_mtime if file.exists() else 0.0


def _with_siblings(graded: Sequence[Graded]) -> list[Graded]:
    """Say so where several files of one student came in together."""
    count = Counter((item.pid, item.assignment_id) for item in graded if item.pid)
    words = {whose: f"{n} files of this student, the newest counts." for whose, n in count.items() if n > 1}
    said = [(item, words.get((item.pid, item.assignment_id), "")) for item in graded]
    return [replace(item, message=f"{item.message} {more}".strip()) if more else item for item, more in said]


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


def _grade_one(course: Course, gradebook: Gradebook, file: Path, *, show_truth: bool) -> Graded:
    try:
        data = receive(course.shelf, file)
    except VmlError as error:
        return Graded(file, "unreadable", str(error))
    try:
        submission, assignment, key = _understood(course, gradebook, ReadRequest(file.name, data))
    except VmlError as error:
        gradebook.note_unreadable(hashlib.sha256(data).hexdigest(), str(error))
        return Graded(file, "unreadable", str(error))
    submission = settle_readings(submission, {q.id: q for q in assignment.questions}, key.values)
    result = grade(submission, key, assignment)
    attempt = gradebook.record_run(submission, result)
    page = f"{FEEDBACK}/{assignment.id}/{key.student}.html"
    row = gradebook.row(assignment.id, key.student)
    if row.attempt == attempt:  # an old file that is graded again must not take the place of a newer one's page
        report = Report(assignment, submission, key, result, attempt, show_truth, row.adjustments)
        course.shelf.write(page, feedback_page(report).encode())
    return Graded(
        file=file,
        status=result.status,
        message=" ".join(result.reasons),
        pid=key.student,
        assignment_id=assignment.id,
        attempt=attempt,
        points=result.points,
        out_of=result.out_of,
        is_provisional=result.is_provisional,
        feedback=course.shelf.place(page),
    )


def _understood(course: Course, gradebook: Gradebook, request: ReadRequest) -> tuple[Submission, Assignment, AnswerKey]:
    book = read_isolated(request)
    claims = claims_of(book)
    key = gradebook.key_for_code(claims.code, request.name)
    if not _is_signed(course, key, claims):
        raise UnknownVariantError(request.name, claims.code)
    assignment = load_assignment(key.assignment_id)
    return find_submission(book, assignment.questions, template_cells(assignment), assignment.points), assignment, key


def _is_signed(course: Course, key: AnswerKey, claims: Claims) -> bool:
    """Tell whether the course's own signature is on the code: a code typed by hand has none."""
    expected = signature_of(course.secret, key.assignment_id, claims.code)
    return hmac.compare_digest(expected.encode(), claims.signature.encode())


def set_points(course: Course, assignment_id: str, pid: str, adjustment: Adjustment) -> Row:
    """Record what a person decided, and write the class page anew; return the grade that follows.

    Raises
    ------
    InputError, UnknownNameError
    """
    assignment = load_assignment(assignment_id)
    with Gradebook.open(course) as gradebook:
        row = gradebook.adjust(assignment, pid, adjustment)
        write_class_page(course, gradebook, assignment)
    return row


def extend_student(course: Course, given: Extension) -> list[str]:
    """Give a student more time or attempts, in the course's settings and as an event; return what holds now, in words.

    Raises
    ------
    InputError, CourseError
    """
    with Gradebook.open(course) as gradebook:
        gradebook.student(given.student)
        extended = add_extension(course, given)
        gradebook.note("extended", given.student, asdict(given))
    calendar = extended.calendar
    named = [given.assignment] if given.assignment else sorted(calendar.terms or {})
    return [
        f"{given.student}  {name}: due {calendar.due_text(name, given.student) or 'at no date'}, "
        f"{calendar.terms_of(name, given.student).attempts or 'any number of'} attempts"
        for name in named
    ] or [f"{given.student}: extended; no assignment has a date yet."]


# ---------------------------------------------------------------- hand out


def hand_out_to(
    course: Course, assignment_id: str, pids: Sequence[str], *, workers: int = 1, progress: Progress | None = None
) -> tuple[list[HandedOut], dict[str, Student]]:
    """Hand an assignment to the students of the roster, or to those named by pseudonym.

    Returns
    -------
    handed : list of HandedOut
    students : dict of str to Student
        By pseudonym.

    Raises
    ------
    NoKeyError, FileMissingError, RosterError
        When a pseudonym is unknown, or there is no class list.
    """
    assignment = load_assignment(assignment_id)
    with Gradebook.open(course) as gradebook:
        gradebook.students_from_roster(course.roster)
        students = {student.pid: student for student in gradebook.students()}
        for pid in pids:
            if pid not in students:
                raise InputError("student", "a pseudonym of this course", repr(pid), "See: vml gradebook show.")
        chosen = list(pids) or list(students)
        handed = hand_out(
            course,
            assignment,
            chosen,
            keep=gradebook.keep_key,
            is_kept=lambda pid: gradebook.has_key(assignment_id, pid),
            workers=workers,
            progress=progress,
        )
    return handed, students

"""What the grader does for people: grade a batch of files, check one's own file, hand variants out."""

from __future__ import annotations

import hashlib
import hmac
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from assignments.course import Course
from assignments.load import load_assignment
from assignments.model import AnswerKey, Assignment
from assignments.usecases import HandedOut, hand_out
from assignments.variants import signature_of
from grader.errors import UnknownVariantError
from grader.feedback import Report, class_page, feedback_page
from grader.grade import grade
from grader.gradebook import Gradebook, Student
from grader.inbox import receive
from grader.model import Kind, Submission
from grader.read import ReadRequest, claims_of, find_submission, read_workbook
from grader.read.locate import Claims
from grader.stated import Unstated, state
from grader.template import template_cells
from vml_course.errors import InputError, VmlError
from vml_course.io.files import existing, replacing

FEEDBACK = "feedback"
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Graded:
    """What became of one file.

    Attributes
    ----------
    file : Path
    status : str
        `ok`, `review` (a person should look) or `unreadable` (nothing was graded).
    message : str
        Why, in one line; "" when ok.
    """

    file: Path
    status: str
    message: str = ""
    pid: str = ""
    assignment_id: str = ""
    attempt: int = 0
    points: float = 0.0
    out_of: float = 0.0
    feedback: Path | None = None

    @property
    def needs_attention(self) -> bool:
        """Whether a person should look at it."""
        return self.status != "ok"


def grade_files(
    course: Course, files: Iterable[Path], *, show_truth: bool = True, progress: Progress | None = None
) -> list[Graded]:
    """Grade files, record what they earned, write a page for each student and one for the class.

    A file that cannot be graded gets a status and a polite reason; it never stops the others.

    Parameters
    ----------
    course : Course
    files : iterable of Path
        Files, or folders, of which every file is taken.
    show_truth : bool
        Whether the students' pages show true values and curves.
    progress : callable, optional
        `(files done, files in all)`.
    """
    listed = _listed(files)
    graded: list[Graded] = []
    with Gradebook.open(course) as gradebook:
        for done, file in enumerate(listed, start=1):
            graded.append(_grade_one(course, gradebook, file, show_truth=show_truth))
            if progress is not None:
                progress(done, len(listed))
        unreadable = [(item.file.name, item.message) for item in graded if item.status == "unreadable"]
        for assignment_id in dict.fromkeys(item.assignment_id for item in graded if item.assignment_id):
            page = class_page(load_assignment(assignment_id), gradebook.rows(assignment_id), unreadable)
            _write(course.folder / FEEDBACK / assignment_id / "class.html", page)
    return graded


def _listed(files: Iterable[Path]) -> list[Path]:
    listed = []
    for path in map(Path, files):
        inside = (
            sorted(p for p in path.iterdir() if p.is_file() and not p.name.startswith((".", "~$")))
            if path.is_dir()
            else [path]
        )
        listed += inside
    return list(dict.fromkeys(listed))


def _grade_one(course: Course, gradebook: Gradebook, file: Path, *, show_truth: bool) -> Graded:
    try:
        data = receive(course.folder, file)
    except VmlError as error:
        return Graded(file, "unreadable", str(error))
    try:
        submission, assignment, key = _understood(course, gradebook, ReadRequest(file.name, data))
    except VmlError as error:
        gradebook.note_unreadable(hashlib.sha256(data).hexdigest(), str(error))
        return Graded(file, "unreadable", str(error))
    result = grade(submission, key, assignment)
    attempt = gradebook.record_run(submission, result)
    page = course.folder / FEEDBACK / assignment.id / f"{key.student}.html"
    _write(page, feedback_page(Report(assignment, submission, key, result, attempt, show_truth)))
    return Graded(
        file=file,
        status=result.status,
        message=" ".join(result.reasons),
        pid=key.student,
        assignment_id=assignment.id,
        attempt=attempt,
        points=result.points,
        out_of=result.out_of,
        feedback=page,
    )


def _understood(course: Course, gradebook: Gradebook, request: ReadRequest) -> tuple[Submission, Assignment, AnswerKey]:
    book = read_workbook(request)
    claims = claims_of(book)
    key = gradebook.key_for_code(claims.code, request.name)
    if not _is_signed(course, key, claims):
        raise UnknownVariantError(request.name, claims.code)
    assignment = load_assignment(key.assignment_id)
    return find_submission(book, assignment.questions, template_cells(assignment)), assignment, key


def _is_signed(course: Course, key: AnswerKey, claims: Claims) -> bool:
    """Tell whether the course's own signature is on the code: a code typed by hand has none."""
    expected = signature_of(course.secret, key.assignment_id, claims.code)
    return hmac.compare_digest(expected.encode(), claims.signature.encode())


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


# ---------------------------------------------------------------- a student's own check


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
    """What a workbook's form is like; nothing is compared with any truth."""

    assignment_id: str
    answers: tuple[Checked, ...]
    tracking_rows: int
    flags: tuple[str, ...]

    @property
    def is_complete(self) -> bool:
        """Whether every answer can be read with its unit, and there is a tracking table."""
        return self.tracking_rows > 0 and all(answer.status == "read" for answer in self.answers)


def check_workbook(file: Path) -> CheckResult:
    """Look at a workbook as the grader will, for format and completeness only.

    Raises
    ------
    FileMissingError, UnreadableError, UnknownNameError
    """
    book = read_workbook(ReadRequest(file.name, existing(file).read_bytes()))
    assignment = load_assignment(claims_of(book).assignment_id)
    submission = find_submission(book, assignment.questions, template_cells(assignment))
    rows = max((len(column) for column in submission.tracking.values()), default=0)
    return CheckResult(assignment.id, tuple(_checked(submission, assignment)), rows, submission.flags)


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
        yield Checked(question.id, question.label, status, says, answer.where)


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

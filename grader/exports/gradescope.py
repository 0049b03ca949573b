"""Gradescope: the zip of an autograder, with everything in it that grading needs.

Its files stand at the root of the zip, its scripts have Unix line ends and may be executed, and packages come as
wheels: images that fetch packages are slow to build, or fail. The truth of the whole class is in it: whoever has the
zip has all answers.
"""

from __future__ import annotations

import importlib.resources
import tempfile
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from assignments.course import Course
from assignments.load import assignment_folder
from assignments.variants import digest_of, signature_of
from grader.autograder.run import ASSIGNMENTS, TRUTH
from grader.autograder.truth import Held, to_bytes
from grader.autograder.wheels import download_wheels, python_version, wheels_in
from grader.enrolment import ACTIVE, Student
from grader.filling.job import Export, Job, Line
from grader.gradebook import Gradebook
from vml_course.errors import InputError

SCRIPTS = ("setup.sh", "run_autograder")
_PACKAGES = ("vml_course", "assignments", "grader")
_EXECUTABLE, _READABLE, _PRIVATE = 0o100755, 0o100644, 0o100600
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)


def write(job: Job, path: Path) -> tuple[Line, ...]:
    """Write the autograder of an assignment.

    Raises
    ------
    InputError, FileMissingError
        When wheels cannot be fetched, or one is missing in the folder that was given.
    """
    held, addresses, lines = _class(job)
    with tempfile.TemporaryDirectory() as temporary, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        folder = job.wheels or Path(temporary)
        if job.wheels is None:
            download_wheels(folder)
        for wheel in wheels_in(folder):
            _add(archive, f"wheels/{wheel.name}", wheel.read_bytes(), stored=True)
        for name, data in packed_files(job):
            _add(archive, name, data, _EXECUTABLE if name in SCRIPTS else _READABLE)
        salt = digest_of(job.course.secret, "gradescope", job.assignment.id)
        _add(archive, TRUTH, to_bytes(salt, addresses, held), _PRIVATE)
    return lines


EXPORT = Export(
    write,
    ".zip",
    from_release=False,
    hint=(
        "It holds all answers: keep it to yourself. Upload it as the autograder, on an image that has or finds Python "
        f"{python_version()} (Ubuntu 22.04 finds 3.11, Ubuntu 24.04 has 3.12), give it {{points}} autograder points, "
        "and try it with a student's account. Export it again when due dates or extensions change."
    ),
)


def packed_files(job: Job) -> Iterator[tuple[str, bytes]]:
    """Yield everything but wheels and truth, by name in the zip."""
    scripts = importlib.resources.files("grader") / "autograder" / "scripts"
    for name in SCRIPTS:
        yield name, (scripts / name).read_bytes().replace(b"\r\n", b"\n")  # a Windows checkout has other line ends
    yield "python-version", f"{python_version()}\n".encode()
    folder = assignment_folder(job.assignment.id, job.course.assignments)
    for name, data in _files_of(folder):
        yield f"{ASSIGNMENTS}/{folder.name}/{name}", data
    for package in _PACKAGES:
        for name, data in _files_of(Path(str(importlib.resources.files(package)))):
            yield f"lib/{package}/{name}", data


def _files_of(folder: Path) -> Iterator[tuple[str, bytes]]:
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            yield path.relative_to(folder).as_posix(), path.read_bytes()


def _add(archive: zipfile.ZipFile, name: str, data: bytes, mode: int = _READABLE, *, stored: bool = False) -> None:
    member = zipfile.ZipInfo(name, date_time=_ZIP_EPOCH)
    member.external_attr, member.create_system = mode << 16, 3  # as written on any system
    member.compress_type = zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED
    archive.writestr(member, data)


def _class(job: Job) -> tuple[list[Held], Mapping[str, str], tuple[Line, ...]]:
    """Return the variants of the class, whose address is whose, and what became of each student."""
    held, addresses, lines = list[Held](), dict[str, str](), list[Line]()
    with Gradebook.open(job.course) as book:
        for student in job.students:
            reason = _left_out(student, book, job)
            if reason:
                lines.append(Line(student.name, "skipped", reason=reason, pid=student.pid))
                continue
            held.append(_held(job.course, book, job.assignment.id, student.pid))
            addresses[_address(student)] = student.pid
            lines.append(Line(student.name, "filled", reason="is in it with a variant", pid=student.pid))
    if not held and lines:
        hint = "Import a class list with e-mail addresses (vml roster import), and hand out first."
        raise InputError(f"{job.assignment.id} to gradescope", "students with a variant", lines[0].reason, hint)
    return held, addresses, tuple(lines)


def _left_out(student: Student, book: Gradebook, job: Job) -> str:
    """Say why the autograder will not know a student, "" when it will."""
    if student.status != ACTIVE:
        return "dropped from the course"
    if not _address(student):
        return "has no e-mail address, the only thing that Gradescope says of a student"
    return "" if book.has_key(job.assignment.id, student.pid) else "has no variant: vml handout"


def _held(course: Course, book: Gradebook, assignment_id: str, pid: str) -> Held:
    key = book.key_of(assignment_id, pid)
    signature = signature_of(course.secret, assignment_id, key.code)
    return Held(pid, key, signature, course.calendar.terms_of(assignment_id, pid))


def _address(student: Student) -> str:
    """Return a student's address; a login is often one."""
    login = (student.ids or {}).get("login", "")
    return student.email or (login if "@" in login else "")

"""Taking in a platform's download: whose is each file, kept as it came, ready to be graded.

Who a file belongs to says first the signed code in the workbook, then the platform's number. Where they disagree
a person decides; nothing is guessed.
"""

from __future__ import annotations

import datetime as dt
import hashlib
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from assignments.course import Course
from grader.enrolment import Student
from grader.errors import CollectError, NoDownloadError, OtherAssignmentError, UnknownVariantError
from grader.gradebook import Gradebook
from grader.inbox import LARGEST_BYTES, keep
from grader.lms import AUTO, recognise
from grader.lms.named import Named
from grader.read import ReadRequest, read_isolated
from grader.read.locate import claims_of
from grader.read.sniff import kind_of
from grader.receipts import Arrived, handed_in_at
from grader.signed import is_signed
from vml_course.errors import FileMissingError, VmlError

Status = Literal["matched", "unmatched", "duplicate", "conflict", "unreadable", "too large"]
MOST_FILES = 20_000
_PARTS_OF_DOCUMENTS = frozenset({"[Content_Types].xml", "mimetype"})
"""What lies at the top of every zip that is one document: of Microsoft's programs, and of all others."""

_NOT_MEANT = ("__MACOSX/", ".DS_Store", "Thumbs.db")


@dataclass(frozen=True)
class Collected:
    """What was found out about one file of a download.

    Attributes
    ----------
    name : str
        Its path in the download.
    status : str
        `matched`, `duplicate` (the same bytes came before), `conflict` (workbook and platform name different
        students), `unmatched` (nobody knows whose it is), `unreadable`, `too large`.
    pid : str
        Whose it is, "" when nobody knows.
    platform : str
        Which platform's name it has, "" when none's.
    message : str
        Why, in one line.
    before : str
        Of a duplicate: what became of the same bytes when they came first.
    belongs_to : str
        The assignment whose workbook it is, where that is another than the one that is collected.
    """

    name: str
    status: Status
    pid: str = ""
    platform: str = ""
    message: str = ""
    before: str = ""
    belongs_to: str = ""

    @property
    def needs_attention(self) -> bool:
        """Whether a person has to say something, now or since it came first."""
        status = self.before or self.status
        return status not in {"matched", "collected", "graded", "settled"}


@dataclass(frozen=True)
class _File:
    name: str
    data: bytes | None  # None: too large to be a workbook


def collect(  # noqa: PLR0913 - what, for what, from where, since when
    course: Course,
    assignment_id: str,
    source: Path,
    *,
    platform: str = AUTO,
    received: dt.datetime | None = None,
    dry_run: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Collected, ...]:
    """Take in every file of a download.

    Parameters
    ----------
    course : Course
    assignment_id : str
    source : Path
        A zip as the platform gives it, or a folder that it was unpacked into.
    platform : str
        Whose names to expect, "auto" for any.
    received : datetime, optional
        When all of it was handed in, where the platform does not say.
    dry_run : bool
        Only look.
    progress : callable, optional
        `(files done, files in all)`.

    Raises
    ------
    FileMissingError, CollectError, UnknownNameError
    """
    number, files = _files(source)
    found = []
    with Gradebook.open(course) as book:
        desk = _Desk(course, assignment_id, book, platform, received, dry_run=dry_run)
        for done, file in enumerate(files, start=1):
            found.append(desk.take(file))
            if progress is not None:
                progress(done, number)
    return tuple(found)


class _Desk:
    """Where files are taken in, one after the other."""

    def __init__(
        self,
        course: Course,
        assignment_id: str,
        book: Gradebook,
        platform: str,
        received: dt.datetime | None,
        *,
        dry_run: bool,
    ) -> None:
        self._course, self._assignment, self._book = course, assignment_id, book
        self._platform, self._received, self._dry_run = platform, received, dry_run
        self._known = _by_identity(book.students())
        self._numbered = {(kind, pid) for (kind, _), pid in self._known.items()}
        self._seen: dict[tuple[str, str], str] = {}

    def take(self, file: _File) -> Collected:
        """Take in one file."""
        named = recognise(file.name, self._platform)
        platform = named.platform if named else ""
        if file.data is None:
            return Collected(
                file.name, "too large", "", platform, f"More than {LARGEST_BYTES // 2**20} MB: no workbook."
            )
        sha256 = hashlib.sha256(file.data).hexdigest()
        by_platform = self._known.get((named.kind, named.value.casefold()), "") if named else ""
        before = self._seen.get((sha256, by_platform)) or self._book.knows_file(sha256, self._assignment, by_platform)
        if before:
            message = f"The same bytes came in before ({before})."
            return Collected(file.name, "duplicate", by_platform, platform, message, before)
        result = self._whose(file, by_platform, named)
        self._seen[sha256, by_platform] = result.status
        if not self._dry_run:
            keep(self._course.shelf, file.data)
            self._book.receive(self._arrived(result, sha256, named))
        return result

    def _whose(self, file: _File, by_platform: str, named: Named | None) -> Collected:
        platform = named.platform if named else ""
        try:
            by_code = self._by_code(file)
        except VmlError as error:
            status: Status = "unreadable" if by_platform else "unmatched"
            other = error.assignment if isinstance(error, OtherAssignmentError) else ""
            return Collected(file.name, status, by_platform, platform, str(error), belongs_to=other)
        if by_platform and by_platform != by_code:
            message = f"The workbook is {by_code}'s, the platform says {by_platform}."
            return Collected(file.name, "conflict", by_platform, platform, message)
        if named and not by_platform and (named.kind, by_code) in self._numbered:
            message = (
                f"The workbook is {by_code}'s, whose {named.kind} is another than {named.value}: who handed it in?"
            )
            return Collected(file.name, "conflict", "", platform, message)
        return Collected(file.name, "matched", by_code, platform, self._when(named))

    def _when(self, named: Named | None) -> str:
        """Say what is taken for the moment of a late file that has none."""
        is_dated = self._told(named) is not None or self._course.calendar.terms_of(self._assignment).due is None
        if is_dated or not (named and named.is_late):
            return ""
        return f"Late; {named.platform.capitalize()} does not say when: it counts as just late (--received says when)."

    def _told(self, named: Named | None) -> dt.datetime | None:
        """Return when a file came, as the person who collects or the platform says."""
        return self._received or (named.received if named else None)

    def _by_code(self, file: _File) -> str:
        name = file.name.rpartition("/")[2]
        claims = claims_of(read_isolated(ReadRequest(name, file.data or b"")))
        key = self._book.key_for_code(claims.code, name)
        if not is_signed(self._course, key, claims):
            raise UnknownVariantError(name, claims.code)
        if key.assignment_id != self._assignment:
            raise OtherAssignmentError(name, self._assignment, key.assignment_id)
        return key.student

    def _arrived(self, result: Collected, sha256: str, named: Named | None) -> Arrived:
        terms = self._course.calendar.terms_of(self._assignment, result.pid)
        told = self._told(named)
        if told is not None and told.tzinfo is None:
            told = told.replace(tzinfo=self._course.calendar.zone)
        late = named.is_late if named else None
        received = handed_in_at(terms, told, is_late=late, moment=dt.datetime.now(dt.UTC))
        return Arrived(
            file_sha256=sha256,
            name=named.original if named else result.name.rpartition("/")[2],
            source=result.platform or "files",
            received_at=received.astimezone(dt.UTC).isoformat(),
            assignment=self._assignment,
            pid=result.pid,
            lms_ref=named.reference if named else "",
            status="collected" if result.status == "matched" else result.status,  # type: ignore[arg-type]
            reason=result.message,
        )


def _by_identity(students: tuple[Student, ...]) -> Mapping[tuple[str, str], str]:
    return {
        (kind, value.casefold()): student.pid for student in students for kind, value in (student.ids or {}).items()
    }


# ---------------------------------------------------------------- the download


def _files(source: Path) -> tuple[int, Iterator[_File]]:
    if source.is_dir():
        paths = sorted(path for path in source.rglob("*") if path.is_file())
        names = {path.relative_to(source).as_posix(): path for path in paths}
        meant = [name for name in names if _is_meant(name)]
        return _counted(source, meant), (_File(name, _bytes(names[name])) for name in meant)
    if not source.is_file():
        raise FileMissingError(str(source), "a zip or a folder", "no such file")
    try:
        with zipfile.ZipFile(source) as archive:
            _refuse_document(source, archive)
            meant = [info.filename for info in archive.infolist() if not info.is_dir() and _is_meant(info.filename)]
    except (zipfile.BadZipFile, OSError) as error:
        with source.open("rb") as file:
            head = file.read(4096)
        got = "a damaged or incomplete zip" if head.startswith(b"PK") else kind_of(head)
        raise NoDownloadError(
            str(source), got, "Download the submissions from the platform and name that file."
        ) from error
    return _counted(source, meant), _members(source, meant)


def _refuse_document(source: Path, archive: zipfile.ZipFile) -> None:
    """Refuse a workbook, or any other document that is a zip inside: its parts are no files that were handed in."""
    names = frozenset(archive.namelist())
    if _PARTS_OF_DOCUMENTS.isdisjoint(names):
        return
    is_workbook = any(name.startswith("xl/") for name in names) or source.suffix.lower() == ".ods"
    if is_workbook:
        raise NoDownloadError(str(source), "a workbook", f"Grade it by itself: vml grade {source} --course COURSE.")
    raise NoDownloadError(str(source), "a document", "Name the zip or the folder that it came in.")


def _counted(source: Path, names: list[str]) -> int:
    if not 0 < len(names) <= MOST_FILES:
        raise CollectError(str(source), f"1 to {MOST_FILES} files", len(names))
    return len(names)


def _members(source: Path, names: list[str]) -> Iterator[_File]:
    with zipfile.ZipFile(source) as archive:
        for name in names:
            yield _File(name, _inflated(archive, name))


def _inflated(archive: zipfile.ZipFile, name: str) -> bytes | None:
    """Return a member's bytes, never more of them than a workbook may have, whatever the zip promises."""
    try:
        with archive.open(name) as member:
            data = member.read(LARGEST_BYTES + 1)
    except (zipfile.BadZipFile, RuntimeError, NotImplementedError, OSError, EOFError):
        return b""  # damaged or encrypted: the reader says so of an empty file
    return data if len(data) <= LARGEST_BYTES else None


def _bytes(path: Path) -> bytes | None:
    return path.read_bytes() if path.stat().st_size <= LARGEST_BYTES else None


def _is_meant(name: str) -> bool:
    """Leave out what computers add, and the note that Blackboard lays beside each attempt."""
    last = name.rpartition("/")[2]
    is_note = last.endswith(".txt") and "_attempt_" in last
    return not (last.startswith((".", "~$")) or name.startswith(_NOT_MEANT) or last in _NOT_MEANT or is_note)

"""Files that came in under one student's name and are another's: told by receipts and signed codes, not by chance.

Only what a platform said counts: a name that a person gave to a file (`vml grade --whose`) may have been a guess.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import get_args

from assignments.course import Course
from grader.gradebook import Gradebook
from grader.inbox import kept_name
from grader.integrity import NEVER, Evidence
from grader.read import ReadRequest, read_isolated
from grader.read.locate import claims_of
from grader.receipts import Arrived, Status
from grader.signed import is_signed
from vml_course.errors import VmlError

OTHERS_WORKBOOK, TWO_NAMES = "other-student", "same-bytes"
TOLD_BY_RECEIPTS = frozenset({OTHERS_WORKBOOK, TWO_NAMES})
"""Methods whose evidence is a fact that was written down, not a measure that chance could reach."""

_HARMLESS = "Somebody who took the wrong file, or handed in for a friend, does the same."
_NOT_GRADED: frozenset[Status] = frozenset({"conflict", "settled", "unreadable"})


def shared_files(course: Course, book: Gradebook, assignment_id: str) -> tuple[Evidence, ...]:
    """Return what the receipts of an assignment say of files that are not their bringer's own."""
    receipts = [receipt for status in get_args(Status) for receipt in book.receipts(status, assignment_id)]
    receipts.sort(key=lambda receipt: (receipt.arrived.received_at, receipt.id))
    arrived = [receipt.arrived for receipt in receipts if _is_told_by_a_platform(receipt.arrived)]
    return (*_others_workbooks(course, book, arrived), *_under_two_names(arrived))


def _is_told_by_a_platform(one: Arrived) -> bool:
    return bool(one.pid) and one.source != "files" and not one.told_by


def _others_workbooks(course: Course, book: Gradebook, arrived: Sequence[Arrived]) -> Iterator[Evidence]:
    """Yield files that carry the signed code of somebody else."""
    for one in arrived:
        owner = _owner(course, book, one) if one.status in _NOT_GRADED else ""
        if owner not in ("", one.pid):
            words = f"{_told(one)}, carries the signed code of the workbook that was made for {owner}. {_HARMLESS}"
            yield Evidence(one.pid, owner, OTHERS_WORKBOOK, 1.0, NEVER, words)


def _owner(course: Course, book: Gradebook, one: Arrived) -> str:
    """Return whose code a file carries, "" where it carries none that is ours."""
    try:
        read = read_isolated(ReadRequest(one.name, course.shelf.read(kept_name(one.file_sha256))))
        claims = claims_of(read)
        key = book.key_for_code(claims.code, one.name)
    except VmlError:
        return ""
    return key.student if key.assignment_id == one.assignment and is_signed(course, key, claims) else ""


def _under_two_names(arrived: Sequence[Arrived]) -> Iterator[Evidence]:
    """Yield the same bytes from several students, each beside who was graded with them, else beside the first."""
    first = dict[str, Arrived]()
    for one in sorted(arrived, key=lambda one: one.status != "graded"):
        other = first.setdefault(one.file_sha256, one)
        if one.pid != other.pid:
            words = f"{_told(one)}, is byte by byte the file {_told(other)}. {_HARMLESS}"
            yield Evidence(one.pid, other.pid, TWO_NAMES, 1.0, NEVER, words)


def _told(one: Arrived) -> str:
    """Name a file, whose it is on its platform, and when it counts as handed in."""
    moment = one.received_at[:16].replace("T", " ")
    return f"{one.name!r}, from {one.source} under the name of {one.pid} ({moment} UTC)"

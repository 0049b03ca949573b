"""Whether the gradebook is as it was written, and every file that came in still has its bytes."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

from assignments.course import Course
from grader.gradebook import Gradebook
from grader.inbox import kept_name
from vml_course.errors import FileMissingError


@dataclass(frozen=True)
class Report:
    """What was found.

    Attributes
    ----------
    events : int
        Length of the chain.
    chain_is_whole : bool
    files : int
        Different files that the gradebook tells of.
    damaged : tuple of str
        Those whose bytes are missing or others, each with what is wrong.
    """

    events: int
    chain_is_whole: bool
    files: int
    damaged: tuple[str, ...]

    @property
    def is_whole(self) -> bool:
        """Whether nothing was found."""
        return self.chain_is_whole and not self.damaged


def verify_course(course: Course) -> Report:
    """Check the chain of events and the hash of every file in the inbox."""
    with Gradebook.open(course) as book:
        events, is_whole, hashes = book.event_count(), book.is_whole(), book.file_hashes()
    damaged = (_damage(course, sha256) for sha256 in hashes)
    return Report(events, is_whole, len(hashes), tuple(filter(None, damaged)))


def _damage(course: Course, sha256: str) -> str:
    name = kept_name(sha256)
    try:
        data = course.shelf.read(name)
    except FileMissingError:
        return f"{name}: missing"
    return "" if hashlib.sha256(data).hexdigest() == sha256 else f"{name}: changed"

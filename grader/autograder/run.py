"""Grades the submission that lies in Gradescope's container: `python -m grader.autograder.run /autograder`.

Whatever a student hands in ends in `results.json`. What fails by our own fault ends without it, so that Gradescope
calls it a failure of the autograder and counts no attempt.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from assignments.load import load_folder
from assignments.model import Assignment
from grader.autograder.attempts import KEPT, Past, counted, past_attempts, with_this
from grader.autograder.results import AFTER_DUE, VISIBLE, refused, results_of
from grader.autograder.truth import Held, Truth, from_bytes
from grader.consistent import remarks_on
from grader.effective import Effective, effective
from grader.grade import grade
from grader.model import Grade, Submission
from grader.plausible import settle_readings
from grader.read import Book, ReadRequest, UnreadableError, read_isolated
from grader.read.limits import FILE_BYTES
from grader.read.locate import claims_of, find_submission
from grader.template import template_cells
from vml_course.io.files import replacing

TRUTH, ASSIGNMENTS = "truth.json", "assignment"

_OURS = "Hand in the workbook that came with your own video."


class RefusedError(Exception):
    """A submission that cannot be graded, and what the student should do."""


@dataclass(frozen=True)
class Pack:
    """What was packed into the container."""

    assignment: Assignment
    truth: Truth


def run(root: Path) -> None:
    """Grade what was submitted and write the results, whole or not at all."""
    (folder,) = (root / "source" / ASSIGNMENTS).iterdir()
    pack = Pack(load_folder(folder), from_bytes((root / "source" / TRUTH).read_bytes()))
    metadata = json.loads((root / "submission_metadata.json").read_text(encoding="utf-8"))
    results = graded(pack, root / "submission", metadata)
    (root / "results").mkdir(exist_ok=True)
    with replacing(root / "results" / "results.json") as temporary:
        temporary.write_text(json.dumps(results, ensure_ascii=False, indent=1), encoding="utf-8")


def graded(pack: Pack, folder: Path, metadata: Mapping[str, Any]) -> dict[str, Any]:
    """Return the results of one submission; `folder` holds the student's files."""
    past = past_attempts(metadata)
    try:
        students = _students(pack.truth, metadata)
        book = _book(folder)
        whose = _whose(pack.truth, book, students)
    except (RefusedError, UnreadableError) as error:
        return refused(str(error), _extra(past))
    submission, result = _judged(pack.assignment, book, whose)
    now = Past(str(metadata["created_at"]), result.points, submission.content_sha256)
    attempts, number = with_this(past, now)
    counts = effective(counted(attempts), whose.terms)
    said = (*_about(result, counts, number, whose), *_form(book, submission, pack.assignment))
    visibility = VISIBLE if whose.terms.attempts else AFTER_DUE
    if number in counts.ignored:
        visibility = AFTER_DUE
    return results_of(result, pack.assignment, counts.points, said, _extra(attempts), visibility=visibility)


def _extra(attempts: Sequence[Past]) -> dict[str, Any]:
    return {KEPT: [one.as_json() for one in attempts]}


# ---------------------------------------------------------------- whose work it is


def _students(truth: Truth, metadata: Mapping[str, Any]) -> tuple[Held, ...]:
    """Return the variants of those who hand in; a group is several people."""
    addresses = [str(user.get("email") or "") for user in metadata.get("users") or ()]
    found = tuple(held for address in addresses if (held := truth.of_address(address)) is not None)
    if not found:
        who = ", ".join(filter(None, addresses)) or "You"
        raise RefusedError(f"{who}: this address is not on the class list. Tell your instructor, who can add it.")
    return found


def _book(folder: Path) -> Book:
    """Return the one workbook that was handed in."""
    found = (path for path in sorted(folder.rglob("*")) if path.is_file() and not path.is_symlink())
    files = [path for path in found if not path.name.startswith((".", "~$"))]
    workbooks = [path for path in files if path.suffix.casefold() == ".xlsx"] or files
    if len(workbooks) != 1:
        got = ", ".join(path.name[:40] for path in workbooks[:5]) or "no file"
        raise RefusedError(f"Expected one workbook, got {got}. {_OURS}")
    path = workbooks[0]
    with path.open("rb") as file:
        return read_isolated(ReadRequest(path.name, file.read(FILE_BYTES + 1)))


def _whose(truth: Truth, book: Book, students: Sequence[Held]) -> Held:
    """Return the student of the group whose variant the workbook is."""
    claims = claims_of(book)
    held = truth.of_code(claims.code, claims.signature)
    if held is None:
        raise RefusedError(f"{book.name}: not a workbook of this course. {_OURS}")
    if held.pid not in {student.pid for student in students}:
        raise RefusedError(f"{book.name}: it belongs to another video than yours. {_OURS}")
    return held


# ---------------------------------------------------------------- what it comes to


def _judged(assignment: Assignment, book: Book, whose: Held) -> tuple[Submission, Grade]:
    submission = find_submission(book, assignment.questions, template_cells(assignment), assignment.points)
    submission = settle_readings(submission, {q.id: q for q in assignment.questions}, whose.key.values)
    return submission, grade(submission, whose.key, assignment)


def _about(result: Grade, counts: Effective, number: int, whose: Held) -> Iterator[str]:
    """Say what the score is made of; nothing that tells right from wrong."""
    most = f" of {whose.terms.attempts}" if whose.terms.attempts else ""
    yield f"Attempt {number}{most}. The workbook was read and graded."
    if number in counts.ignored:
        yield "This attempt does not count: too many, or after the last moment."
    if counts.late_share > 0:
        yield f"{100 * counts.late_share:.3g} % is taken off because it came late."
    if result.status == "empty":
        yield result.reasons[0]
    elif result.is_provisional:
        yield "A person will look at a part of it: points may still change."


def _form(book: Book, submission: Submission, assignment: Assignment) -> Iterator[str]:
    yield from remarks_on(book, submission, assignment)


def main(arguments: Sequence[str]) -> None:
    """Grade the submission below the folder that is named."""
    run(Path(arguments[0]))


if __name__ == "__main__":
    main(sys.argv[1:])

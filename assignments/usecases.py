"""Hand out an assignment: a folder for every student, a key for the instructor.

A student's folder is made under a temporary name and takes its own only when it is complete and its key is
kept. So a run that was killed goes on where it stopped, and a second run changes nothing.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from assignments.course import Course
from assignments.model import AnswerKey, Assignment, Variant
from assignments.release import HANDOUT, WORKBOOK, Order, Release, release
from assignments.workplace import sweep, workplace_prefix
from vml_course.errors import InputError, VmlError
from vml_course.executors import open_executor

Keep = Callable[[Variant, AnswerKey], None]
IsKept = Callable[[str], bool]
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class HandedOut:
    """What became of one student's handout.

    Attributes
    ----------
    student : str
        The pseudonym.
    folder : Path
    status : str
        "made", "already" (complete from an earlier run) or "failed".
    redraws : int
        Draws that were rejected, by rule or by measurement; 0 when nothing was made.
    refused : tuple of str
        Why variants were rendered but not released.
    reason : str
        Why it failed.
    """

    student: str
    folder: Path
    status: Literal["made", "already", "failed"]
    redraws: int = 0
    refused: tuple[str, ...] = ()
    reason: str = ""


def hand_out(  # noqa: PLR0913 - four things to hand out, and how
    course: Course,
    assignment: Assignment,
    students: Sequence[str],
    keep: Keep,
    *,
    is_kept: IsKept | None = None,
    workers: int = 1,
    due: str = "",
    progress: Progress | None = None,
) -> list[HandedOut]:
    """Make video, workbook and handout for every student, and keep the keys.

    Parameters
    ----------
    course : Course
    assignment : Assignment
    students : sequence of str
        Pseudonyms: they name the folders.
    keep : callable
        Told each variant and its key before the student's folder appears; called in this process.
    is_kept : callable, optional
        Whether a student's key is kept already; a complete folder is then left alone. Without it, a
        complete folder is trusted.
    workers : int
        Processes that work at the same time.
    due : str
        Date that the handout shows.
    progress : callable, optional
        Told how many students are done, of how many.

    Returns
    -------
    list of HandedOut
        In the order of `students`; one that failed says why and stops nobody else.

    Raises
    ------
    InputError
        When a pseudonym cannot name a folder.
    """
    home = course.handouts(assignment.id)
    _check_names(students)
    home.mkdir(parents=True, exist_ok=True)
    results = {s: HandedOut(s, home / s, "already") for s in students if _is_done(home / s, s, is_kept)}
    missing = [student for student in students if student not in results]
    tell = progress or (lambda _done, _total: None)
    tell(len(results), len(students))
    # The truth lies beside the video while it is made: never inside the folder that is handed out.
    sweep(course.folder)
    with tempfile.TemporaryDirectory(prefix=workplace_prefix(), dir=course.folder) as work:
        orders = (_order(Path(work), course, assignment, student, due) for student in missing)
        for order, future in _releases(orders, workers):
            results[order.student] = _finish(future, home / order.student, Path(order.out), keep)
            tell(len(results), len(students))
    return [results[student] for student in students]


def is_complete(folder: Path) -> bool:
    """Tell whether a student's folder holds everything."""
    return all((folder / name).is_file() for name in (WORKBOOK, HANDOUT)) and any(folder.glob("video.*"))


def _releases(orders: Iterable[Order], workers: int) -> Iterator[tuple[Order, Future[Release]]]:
    """Yield each order as soon as it is done, whichever is first."""
    pending: dict[Future[Release], Order] = {}
    with open_executor(workers) as executor:
        for order in orders:
            future = executor.submit(release, order)
            if future.done():  # at once, where this process does the work
                yield order, future
            else:
                pending[future] = order
        for future in as_completed(pending):
            yield pending[future], future


def _order(work: Path, course: Course, assignment: Assignment, student: str, due: str) -> Order:
    inside, out = work / student / "work", work / student / "out"
    inside.mkdir(parents=True)
    out.mkdir()
    return Order(assignment, course.secret, student, str(inside), str(out), due)


def _finish(future: Future[Release], folder: Path, made: Path, keep: Keep) -> HandedOut:
    """Keep the key, then give the folder its name; whatever goes wrong concerns this student only."""
    try:
        released = future.result()
        keep(released.variant, released.key)
        _replace(made, folder)
    except VmlError as error:
        return HandedOut(folder.name, folder, "failed", reason=str(error))
    except Exception as error:  # noqa: BLE001 - one student's failure stops nobody else
        return HandedOut(folder.name, folder, "failed", reason=f"{type(error).__name__}: {error}")
    return HandedOut(folder.name, folder, "made", released.variant.redraws, released.refused)


def _replace(made: Path, folder: Path) -> None:
    """Put the new folder in place of what an interrupted run may have left."""
    if folder.exists():
        folder.rename(made.with_name("left-over"))
    made.rename(folder)


def _is_done(folder: Path, student: str, is_kept: IsKept | None) -> bool:
    return is_complete(folder) and (is_kept is None or is_kept(student))


def _check_names(students: Iterable[str]) -> None:
    for student in students:
        if (
            not student
            or student.startswith(".")
            or not all(c.isascii() and (c.isalnum() or c in "-_") for c in student)
        ):
            raise InputError("student", "a pseudonym of letters, digits, - and _", repr(student))

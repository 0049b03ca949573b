"""Hand out an assignment: a folder and a zip for every student, a key for the instructor.

A student's key is kept first, and the picture of the impact for later pages; then the folder takes its name, then the
zip: it says that the student has everything.
So a run that was killed goes on where it stopped, and a second run changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from assignments.costs import Cost, cost_of, keep_cost
from assignments.course import Course
from assignments.handouts import Handouts, check_pseudonyms
from assignments.impact_frame import keep_frame
from assignments.model import AnswerKey, Assignment, Variant
from assignments.release import Order, Release, release
from vml_course.errors import VmlError
from vml_course.executors import each_done, open_executor

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
    place : str
        Where the student's folder lies: a path, or a URL.
    status : str
        "made", "already" (complete from an earlier run), "failed", or "missing" (nobody tried).
    redraws : int
        Draws that were rejected, by rule or by measurement; 0 when nothing was made.
    refused : tuple of str
        Why variants that kept all rules were not released.
    reason : str
        Why it failed.
    """

    student: str
    place: str
    status: Literal["made", "already", "failed", "missing"]
    redraws: int = 0
    refused: tuple[str, ...] = ()
    reason: str = ""


def look_through(
    course: Course, assignment: Assignment, students: Sequence[str], is_kept: IsKept | None = None
) -> list[HandedOut]:
    """Tell who has something ("already") and who would get it ("missing"); nothing is written.

    Parameters
    ----------
    course : Course
    assignment : Assignment
    students : sequence of str
        Pseudonyms.
    is_kept : callable, optional
        Whether a student's key is kept already; files without their key are made anew. Without it, files are
        trusted.

    Raises
    ------
    InputError
        When a pseudonym cannot name a folder.
    """
    check_pseudonyms(students)
    handouts = handouts_of(course, assignment)
    complete = handouts.complete()

    def has(student: str) -> bool:
        return student in complete and (is_kept is None or is_kept(student))

    return [HandedOut(s, handouts.place(s), "already" if has(s) else "missing") for s in students]


def hand_out(  # noqa: PLR0913 - four things to hand out, and how
    course: Course,
    assignment: Assignment,
    students: Sequence[str],
    keep: Keep,
    *,
    is_kept: IsKept | None = None,
    workers: int = 1,
    cluster: str = "",
    terms: Mapping[str, tuple[str, ...]] | None = None,
    progress: Progress | None = None,
) -> list[HandedOut]:
    """Make video, workbook and handout for every student, and keep the keys.

    Parameters
    ----------
    course, assignment, students, is_kept
        As `look_through`.
    keep : callable
        Told each variant and its key before the student's folder appears; called in this process.
    workers : int
        Processes that work at the same time.
    cluster : str
        Address of a dask scheduler that does the work instead; `local:N` starts one.
    terms : mapping of str to tuple of str, optional
        What the handout says of date, lateness and attempts, by pseudonym.
    progress : callable, optional
        Told how many students are done, of how many.

    Returns
    -------
    list of HandedOut
        In the order of `students`; one that failed says why and stops nobody else.

    Raises
    ------
    InputError
        When a pseudonym cannot name a folder, or there are no such workers.
    """
    results = {found.student: found for found in look_through(course, assignment, students, is_kept)}
    missing = [student for student in results if results[student].status == "missing"]
    handouts, tell = handouts_of(course, assignment), progress or (lambda _done, _total: None)
    tell(len(results) - len(missing), len(results))
    if missing:
        handouts.open_bundle(missing)
        orders = (Order(assignment, course.secret, student, (terms or {}).get(student, ())) for student in missing)
        course.handouts(assignment.id).parent.mkdir(parents=True, exist_ok=True)  # of cost and log
        with open_executor(workers, cluster) as executor:
            desk = _Desk(handouts, keep, log_file(course, assignment))
            with desk.keeping_cost(cost_file(course, assignment)):
                for done, (order, future) in enumerate(each_done(executor, release, orders), start=1):
                    results[order.student] = desk.finish(order.student, future)
                    tell(len(results) - len(missing) + done, len(results))
    return [results[student] for student in students]


def handouts_of(course: Course, assignment: Assignment) -> Handouts:
    """Return an assignment's handouts on the course's shelf."""
    return Handouts(course.shelf, assignment.id)


def cost_file(course: Course, assignment: Assignment) -> Path:
    """Return where it is kept what handing out cost."""
    return course.handouts(assignment.id).with_name(f"cost-{assignment.id}.json")


def log_file(course: Course, assignment: Assignment) -> Path:
    """Return where it is kept which variants were drawn again, and why."""
    return course.handouts(assignment.id).with_name(f"redrawn-{assignment.id}.log")


@dataclass
class _Desk:
    """Where what was made is taken in, one student after the other."""

    handouts: Handouts
    keep: Keep
    log: Path
    cost: Cost = field(default_factory=Cost)

    def finish(self, student: str, future: Future[Release]) -> HandedOut:
        """Keep the key, then lay the files out; whatever goes wrong concerns this student only."""
        place = self.handouts.place(student)
        try:
            released = future.result()
            self.keep(released.variant, released.key)
            if released.impact is not None:
                keep_frame(self.handouts.shelf, released.key, released.impact)
            self.handouts.put(student, released.files)
        except VmlError as error:
            return HandedOut(student, place, "failed", reason=str(error))
        except Exception as error:  # noqa: BLE001 - one student's failure stops nobody else
            return HandedOut(student, place, "failed", reason=f"{type(error).__name__}: {error}")
        self.cost += cost_of(released)
        self._log(student, released.refused)
        return HandedOut(student, place, "made", released.variant.redraws, released.refused)

    @contextmanager
    def keeping_cost(self, path: Path) -> Iterator[None]:
        """Keep what releases cost at the end of the block, also when it is stopped by hand."""
        try:
            yield
        finally:
            if self.cost.students:
                path.parent.mkdir(exist_ok=True)
                keep_cost(path, self.cost)

    def _log(self, student: str, refused: Iterable[str]) -> None:
        lines = "".join(f"{student} {why}\n" for why in refused)
        if lines:
            self.log.parent.mkdir(exist_ok=True)
            with self.log.open("a", encoding="utf-8", newline="\n") as file:
                file.write(lines)

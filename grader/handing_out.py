"""Handing out to the class list: who gets something, what it will cost, and the one table with names."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from assignments.adopt import adopt
from assignments.bundle import moodle_folder
from assignments.costs import kept_cost
from assignments.course import Course
from assignments.load import load_assignment
from assignments.model import Assignment
from assignments.plan import Plan, make_plan, sample_cost
from assignments.terms_words import terms_text
from assignments.usecases import HandedOut, cost_file, hand_out, handouts_of, look_through
from grader.filling.cells import harmless
from grader.gradebook import Gradebook, Student, is_begun
from grader.roster import Enrolled, read_roster
from vml_course.errors import InputError
from vml_course.io.files import replacing

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Handed:
    """What became of a whole hand-out.

    Attributes
    ----------
    results : tuple of HandedOut
    students : mapping of str to Student
        By pseudonym.
    bundle : tuple of str
        Where the zips for the learning platform lie; none when there is nothing to hand out.
    table : Path
        Whose pseudonym is whose.
    """

    results: tuple[HandedOut, ...]
    students: Mapping[str, Student]
    bundle: tuple[str, ...]
    table: Path

    @property
    def failed(self) -> tuple[HandedOut, ...]:
        """Those that got nothing."""
        return tuple(item for item in self.results if item.status == "failed")


@dataclass(frozen=True)
class Expected:
    """What a run would do for one student; who is new in the class list has no pseudonym yet."""

    name: str
    pid: str
    status: Literal["already", "missing", "new"]


def hand_out_to(  # noqa: PLR0913 - to whom, and by whom
    course: Course,
    assignment_id: str,
    pids: Sequence[str] = (),
    *,
    workers: int = 1,
    cluster: str = "",
    participants: Mapping[str, str] | None = None,
    progress: Progress | None = None,
) -> Handed:
    """Hand an assignment to the students of the roster, or to those named by pseudonym.

    Parameters
    ----------
    course : Course
    assignment_id : str
    pids : sequence of str
        Pseudonyms; all students when there are none.
    workers, cluster, progress
        As `assignments.usecases.hand_out`.
    participants : mapping of str to str, optional
        The platform's number of each student, by pseudonym: Moodle finds a student's folder by it. Those of the class
        list when not given.

    Raises
    ------
    InputError, FileMissingError, RosterError
        When a pseudonym is unknown, or there is no class list.
    """
    assignment = adopt(course, assignment_id)
    with Gradebook.open(course) as gradebook:
        students = _enrolled(course, gradebook)
        results = hand_out(
            course,
            assignment,
            _chosen(pids, students),
            keep=gradebook.keep_key,
            is_kept=lambda pid: gradebook.has_key(assignment.id, pid),
            workers=workers,
            cluster=cluster,
            terms={pid: terms_text(course.calendar, assignment.id, pid) for pid in students},
            progress=progress,
        )
    numbers = _participants(students.values()) if participants is None else participants
    folders = {pid: moodle_folder(pid, numbers[pid]) if pid in numbers else pid for pid in students}
    bundle = handouts_of(course, assignment).put_bundle(folders)
    return Handed(tuple(results), students, tuple(bundle), _write_table(course, assignment, students.values()))


def expect(course: Course, assignment_id: str, pids: Sequence[str] = ()) -> list[Expected]:
    """Tell who has an assignment already and who would get it; nothing is written, nobody enrolled.

    Raises
    ------
    InputError, FileMissingError, RosterError
    """
    assignment = load_assignment(assignment_id, course.assignments)
    students, kept, newcomers = dict[str, Student](), set[str](), [Student("", p.name) for p in _listed(course)]
    if is_begun(course):
        with Gradebook.open(course) as gradebook:
            arrivals = gradebook.take_in(_listed(course), course.roster.name, dry_run=True)
            newcomers = [arrival.student for arrival in arrivals if arrival.status == "new"]
            students = {student.pid: student for student in gradebook.students(active_only=True)}
            kept = {pid for pid in students if gradebook.has_key(assignment.id, pid)}
    if not students and not newcomers:
        read_roster(course.roster)  # says what is missing
    looked = look_through(course, assignment, _chosen(pids, students), kept.__contains__)
    known = [Expected(students[item.student].name, item.student, _seen(item)) for item in looked]
    return known + ([] if pids else [Expected(person.name, "", "new") for person in newcomers])


def _listed(course: Course) -> tuple[Enrolled, ...]:
    return read_roster(course.roster) if course.roster.is_file() else ()


def plan_for(course: Course, assignment_id: str, pids: Sequence[str] = (), *, progress: Progress | None = None) -> Plan:
    """Foresee what handing out will cost and how fair it will be; students are enrolled, nothing is made.

    The cost is that of earlier runs in this course; where there were none, one variant is made to see it.

    Raises
    ------
    InputError, FileMissingError, RosterError, NoVariantError
    """
    assignment = load_assignment(assignment_id, course.assignments)
    with Gradebook.open(course) as gradebook:
        chosen = _chosen(pids, _enrolled(course, gradebook))
    cost = kept_cost(cost_file(course, assignment))
    return make_plan(assignment, course.secret, chosen, cost if cost.students else sample_cost(assignment), progress)


def table_file(course: Course, assignment: Assignment) -> Path:
    """Return where it is written whose pseudonym is whose: beside what is handed out, never in it."""
    return course.handouts(assignment.id).with_name(f"roster-{assignment.id}.csv")


def _enrolled(course: Course, gradebook: Gradebook) -> dict[str, Student]:
    """Return who is in the course: its own list is taken in first, where there is one or nobody is known yet."""
    if course.roster.is_file() or not gradebook.students():
        gradebook.students_from_roster(course.roster)
    return {student.pid: student for student in gradebook.students(active_only=True)}


def _participants(students: Iterable[Student]) -> dict[str, str]:
    known = ((student.pid, (student.ids or {}).get("moodle_participant")) for student in students)
    return {pid: number for pid, number in known if number}


def _chosen(pids: Sequence[str], students: Mapping[str, Student]) -> list[str]:
    for pid in pids:
        if pid not in students:
            raise InputError("student", "a pseudonym of this course", repr(pid), "See: vml gradebook show.")
    return list(dict.fromkeys(pids)) or list(students)


def _seen(item: HandedOut) -> Literal["already", "missing"]:
    return "already" if item.status == "already" else "missing"


def _write_table(course: Course, assignment: Assignment, students: Iterable[Student]) -> Path:
    """Write the only file with names; for its owner alone, and only where it says something new."""
    path, text = table_file(course, assignment), io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["pid", "name", "email"])
    table.writerows([student.pid, harmless(student.name), harmless(student.email)] for student in students)
    data = text.getvalue().encode("utf-8-sig")  # the mark tells Excel that it is UTF-8
    if not (path.is_file() and path.read_bytes() == data):
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as temporary:
            temporary.touch(mode=0o600)
            temporary.write_bytes(data)
    return path

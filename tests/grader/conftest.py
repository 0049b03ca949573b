"""A small course to grade: one assignment, one variant, its key, workbooks that students fill."""

from __future__ import annotations

import math
import sys
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from assignments.course import COURSE_FILE, Course, new_course, open_course
from assignments.load import load_assignment
from assignments.mistakes import ImpactNumbers
from assignments.model import AnswerKey, Assignment, Variant
from assignments.variants import signature_of
from assignments.workbook import fill_workbook, write_workbook
from grader.grade import grade
from grader.gradebook import Gradebook
from grader.model import Answer, Grade, Kind, Submission
from grader.read import ReadRequest, read_workbook
from grader.read.locate import find_submission
from grader.roster import Enrolled
from tests.impacts import numbers_of_impact

FPS, SCALE = 480.0, 500.0
POINTS = ("foot", "knee", "ball")


def impact(e: float = 0.7, inertia: float = 0.9, m: float = 0.35, length: float = 0.5, omega: float = 20.0):
    given = {"e": e, "I": inertia, "m": m, "L": length, "omega1": omega, "D": 0.22}
    return numbers_of_impact(given, px_per_m=SCALE)


def true_values(n: ImpactNumbers) -> dict[str, float]:
    return {
        "px_per_m": SCALE,
        "fps": FPS,
        "omega1": n.omega1,
        "omega2": n.omega2,
        "v_f1": n.v1,
        "v_f2": n.v2,
        "v_b1": n.u1,
        "v_b2": n.u2,
        "e": n.e,
        "I": n.I,
    }


def trajectory_m(n: ImpactNumbers, frames: int = 60, at_s: float = 0.06) -> np.ndarray:
    """Positions, shape (frames, 3, 2): a leg about a fixed knee and a ball on a straight line."""
    t = np.arange(frames) / FPS - at_s
    angle = -math.pi / 2 + np.where(t < 0, n.omega1 * t, n.omega2 * t)
    foot = np.stack([0.5 + n.L * np.cos(angle), 0.3 + n.L * np.sin(angle)], axis=1)
    flown = np.maximum(t, 0.0)  # from the tee, falling freely
    ball = np.stack([1.0 + n.u2 * flown, -0.3 - 0.5 * 9.81 * flown**2], axis=1)
    return np.stack([foot, np.tile([0.5, 0.3], (frames, 1)), ball], axis=1)


def key_of(n: ImpactNumbers, **changes) -> AnswerKey:
    xy_m = trajectory_m(n)
    facts = {
        "assignment_id": "soccer-kick",
        "student": "pupil001",
        "code": "CODE1",
        "values": true_values(n),
        "expected_sd": {},
        "measured": {},
        "given": {"m": n.m, "L": n.L, "D": n.D},
        "truth": {"px_per_m": SCALE, "fps": FPS, "t_impact_s": 0.06, "frame_before": 28.0, "R": n.D / 2},
        "video_sha256": "0" * 64,
        "versions": {},
        "points": POINTS,
        "frame": np.arange(len(xy_m)),
        "time_s": np.arange(len(xy_m)) / FPS,
        "xy_px": xy_m * np.array([SCALE, -SCALE]) + np.array([100.0, 400.0]),
    }
    return AnswerKey(**{**facts, **changes})


def table_of(xy_m: np.ndarray) -> dict[str, np.ndarray]:
    columns = {"frame": np.arange(len(xy_m)), "t_s": np.arange(len(xy_m)) / FPS}
    for p, point in enumerate(POINTS):
        columns |= {f"{point}_x_m": xy_m[:, p, 0], f"{point}_y_m": xy_m[:, p, 1]}
    return columns


def typed(value: float | str, digits: int = 4) -> str:
    return value if isinstance(value, str) else f"{value:.{digits}g}"


def submission_of(
    assignment: Assignment, values: Mapping[str, float | str], units: Mapping[str, str] | None = None, tracking=None
) -> Submission:
    """A submission made without a file: numbers become number cells, texts text cells."""
    answers = {}
    for question in assignment.questions:
        value = values.get(question.id, "")
        unit = (units or {}).get(question.id, question.unit)
        if value == "":
            answers[question.id] = Answer(unit_text=unit)
        elif isinstance(value, str):
            answers[question.id] = Answer(Kind.TEXT, None, value, unit, "Answers!C6", "name")
        else:
            answers[question.id] = Answer(Kind.NUMBER, float(value), f"{value:.15g}", unit, "Answers!C6", "name")
    return Submission("w.xlsx", assignment.id, "CODE1", answers, tracking or {})


def rounded(values: Mapping[str, float], digits: int = 4) -> dict[str, float]:
    return {name: float(f"{value:.{digits}g}") for name, value in values.items()}


@dataclass(frozen=True)
class Desk:
    """Everything for grading one student."""

    assignment: Assignment
    numbers: ImpactNumbers
    key: AnswerKey
    folder: Path
    empty: bytes = b""
    good: bytes = b""

    @property
    def truth(self) -> dict[str, float]:
        return rounded(true_values(self.numbers))

    @property
    def units(self) -> dict[str, str]:
        return {question.id: question.unit for question in self.assignment.questions if question.unit}

    @property
    def table(self) -> dict[str, np.ndarray]:
        return table_of(trajectory_m(self.numbers))

    def grade(self, changes: Mapping[str, float | str] | None = None, units=None, tracking=None) -> Grade:
        table = self.table if tracking is None else tracking
        submission = submission_of(self.assignment, {**self.truth, **(changes or {})}, units, table)
        return grade(submission, self.key, self.assignment)

    def workbook(self, changes: Mapping[str, float | str] | None = None, units=None, tracking=None) -> Path:
        empty, filled = self.folder / "empty.xlsx", self.folder / "filled.xlsx"
        if self.good and not changes and not units and tracking is None:
            filled.write_bytes(self.good)
            return filled
        empty.write_bytes(self.empty)
        columns = table_of(trajectory_m(self.numbers)) if tracking is None else tracking
        fill_workbook(empty, filled, {**self.truth, **(changes or {})}, {**self.units, **(units or {})}, columns)
        return filled

    def read(self, data: bytes, name: str = "w.xlsx") -> Submission:
        return find_submission(read_workbook(ReadRequest(name, data)), self.assignment.questions)


# Points of these tests, whatever the catalogue gives: 8 to measure, 12 to conclude.
POINTS_OF = {
    "px_per_m": 1,
    "fps": 1,
    "omega1": 1,
    "omega2": 1,
    "v_f1": 1,
    "v_f2": 1,
    "v_b1": 0.5,
    "v_b2": 1.5,
    "e": 6,
    "I": 6,
}


@pytest.fixture(scope="session")
def assignment() -> Assignment:
    loaded = load_assignment("soccer-kick")
    return replace(loaded, questions=tuple(replace(q, points=POINTS_OF[q.id]) for q in loaded.questions))


def variant_of(signature: str = "signed", code: str = "CODE1", student: str = "pupil001") -> Variant:
    return Variant("soccer-kick", student, code, {}, {}, {}, 1, 0, "1", signature=signature)


@pytest.fixture
def desk(assignment: Assignment, tmp_path: Path, empty_bytes: bytes, good_bytes: bytes) -> Desk:
    numbers = impact()
    return Desk(assignment, numbers, key_of(numbers), tmp_path, empty_bytes, good_bytes)


@pytest.fixture(scope="session")
def empty_bytes(assignment: Assignment, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("empty") / "w.xlsx"
    write_workbook(path, assignment, variant_of(), {given.id: 1.0 for given in assignment.givens})
    return path.read_bytes()


@pytest.fixture(scope="session")
def good_bytes(assignment: Assignment, empty_bytes: bytes, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    numbers = impact()
    desk = Desk(assignment, numbers, key_of(numbers), tmp_path_factory.mktemp("good"), empty_bytes)
    return desk.workbook().read_bytes()


@pytest.fixture(scope="session")
def kit() -> ModuleType:
    """The makers of this file, for tests that need many."""
    return sys.modules[__name__]


@dataclass
class Term:
    """A course whose students Canvas knows as 901, 902, 903."""

    course: Course
    kit: object
    assignment: object
    pids: tuple[str, ...]

    def say(self, toml: str) -> None:
        """Add to the settings."""
        self.course.shelf.write(COURSE_FILE, f'title = "x"\n{toml}'.encode())
        self.course = open_course(self.course.folder)

    def file(self, i: int, **changes: float) -> bytes:
        """A filled workbook of one of them."""
        numbers, folder = self.kit.impact(e=0.6 + 0.1 * i), self.course.folder
        empty, filled = folder / "empty.xlsx", folder / "filled.xlsx"
        code = f"CODE{i}"
        variant = self.kit.variant_of(signature_of(self.course.secret, "soccer-kick", code), code, self.pids[i])
        write_workbook(empty, self.assignment, variant, {g.id: 1.0 for g in self.assignment.givens})
        units = {q.id: q.unit for q in self.assignment.questions if q.unit}
        answers = {**self.kit.rounded(self.kit.true_values(numbers)), **changes}
        fill_workbook(empty, filled, answers, units, self.kit.table_of(self.kit.trajectory_m(numbers)))
        return filled.read_bytes()

    def download(self, **files: bytes) -> Path:
        """A zip with these files."""
        path = self.course.folder / "submissions.zip"
        with zipfile.ZipFile(path, "w") as archive:
            for name, data in files.items():
                archive.writestr(name, data)
        return path


@pytest.fixture
def term(tmp_path: Path, kit, assignment) -> Term:
    course = new_course(tmp_path / "course")
    with Gradebook.open(course) as book:
        people = [Enrolled(f"S{i}", f"s{i}@x.org", {"canvas_id": f"90{i + 1}"}) for i in range(3)]
        pids = tuple(arrival.student.pid for arrival in book.take_in(people))
        for i, pid in enumerate(pids):
            variant = kit.variant_of("", f"CODE{i}", pid)
            book.keep_key(variant, kit.key_of(kit.impact(e=0.6 + 0.1 * i), code=f"CODE{i}", student=pid))
    return Term(course, kit, assignment, pids)

"""A class whose grades were released, without a gradebook; files as the platforms write them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from assignments.course import Course, new_course
from assignments.load import load_assignment
from grader.enrolment import DROPPED, Student
from grader.exports import export_to
from grader.filling.job import Job, Line, Template
from grader.releasing import Released

JANE = Student("jane2345", "Jane Doe", "jane@x.edu", {"canvas_id": "90210", "sis_id": "S0012345", "login": "jdoe"})
JUERG = Student("jurg2345", "Jürg Müller", "juerg.mueller@x.edu", {"login": "jmueller", "sis_id": "S2"})
ANA = Student("anab2345", "Ana Smith", "ana.one@x.edu", {"canvas_id": "1", "login": "asmith1"})
OTHER_ANA = Student("anac2345", "Ana Smith", "ana.two@x.edu", {"canvas_id": "2", "login": "asmith2"})
GONE = Student("gone2345", "Guy Gone", "guy@x.edu", {"canvas_id": "7", "login": "ggone"}, DROPPED)
NEW = Student("newn2345", "Nora New", "nora@x.edu", {"login": "nnew"})
CLASS = (JANE, JUERG, ANA, OTHER_ANA, GONE, NEW)


def released(student: Student, points: float, out_of: float = 20.0) -> Released:
    return Released(student, 1, points, 0.0, points, out_of)


@dataclass
class Desk:
    """Runs an export on a template and looks at what became of it."""

    job: Job
    folder: Path
    lines: dict[str, Line] = field(default_factory=dict)

    def run(self, to: str, template: bytes = b"", **changes) -> bytes:
        given = Template("template.csv", template) if template else None
        job, path = replace(self.job, template=given, **changes), self.folder / f"{to}.out"
        lines = export_to(to).write(job, path)
        self.lines = {line.name: line for line in lines}
        return path.read_bytes()


def swapped(text: str, *changes: tuple[str, str]) -> str:
    """Return a text with replacements, each of which must hit once."""
    for before, after in changes:
        assert text.count(before) == 1, before
        text = text.replace(before, after)
    return text


@pytest.fixture(scope="session")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    return new_course(tmp_path_factory.mktemp("exports") / "course", "Dynamics")


@pytest.fixture
def desk(course: Course, tmp_path: Path) -> Desk:
    # of 20; nothing of Nora's
    points = ((JANE, 17.0), (JUERG, 12.345), (ANA, 20.0), (OTHER_ANA, 0.0), (GONE, 20.0))
    grades: Mapping[str, Released] = {student.pid: released(student, value) for student, value in points}
    return Desk(Job(course, load_assignment("soccer-kick"), CLASS, grades), tmp_path)


@pytest.fixture
def swap() -> Callable[..., str]:
    return swapped

"""A class on Gradescope: its autograder packed, workbooks handed in, and what Gradescope says and takes."""

from __future__ import annotations

import shutil
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from assignments.course import Course, new_course
from assignments.load import load_assignment
from assignments.terms import Terms
from assignments.variants import signature_of
from assignments.workbook import fill_workbook, write_workbook
from grader.autograder.run import Pack
from grader.autograder.truth import from_bytes
from grader.autograder.wheels import NEEDED
from grader.exports.gradescope import write
from grader.filling.job import Job
from grader.gradebook import Gradebook
from grader.roster import Enrolled

PEOPLE = (("Ana Example", "Ana@Example.org"), ("Ben Example", "ben@example.org"), ("No Address", ""))


@dataclass(frozen=True)
class Lab:
    """What the tests of one class do over and over again."""

    course: Course
    kit: Any

    @staticmethod
    def job_of(course: Course, **changes) -> Job:
        with Gradebook.open(course) as book:
            return Job(course, load_assignment("soccer-kick"), book.students(), **changes)

    def workbook_bytes(self, folder: Path, i: int = 0, signature: str = "", **changes) -> bytes:
        assignment, code = load_assignment("soccer-kick"), f"CODE{i}"
        signature = signature or signature_of(self.course.secret, "soccer-kick", code)
        empty, filled = folder / "empty.xlsx", folder / "made.xlsx"
        write_workbook(empty, assignment, self.kit.variant_of(signature, code), {g.id: 1.0 for g in assignment.givens})
        numbers = self.kit.impact(e=0.6 + 0.1 * i)
        answers = {**self.kit.rounded(self.kit.true_values(numbers)), **changes}
        units = {q.id: q.unit for q in assignment.questions if q.unit}
        fill_workbook(empty, filled, answers, units, self.kit.table_of(self.kit.trajectory_m(numbers)))
        data = filled.read_bytes()
        filled.unlink()
        empty.unlink()
        return data

    @staticmethod
    def metadata(*emails: str, previous=(), created="2026-05-01T10:00:00.000000-07:00") -> dict:
        users = [{"id": k, "email": email, "name": "Somebody"} for k, email in enumerate(emails)]
        about = {
            "id": 1,
            "course_id": 2,
            "due_date": "2026-05-02T10:00:00-07:00",
            "late_due_date": None,
            "title": "Kick",
        }
        return {
            "id": 123, "created_at": created, "assignment": {**about, "total_points": "20.0"}, "users": users,
            "submission_method": "upload", "previous_submissions": list(previous),
        }  # fmt: skip

    @staticmethod
    def submit(folder: Path, **files: bytes) -> Path:
        made = folder / "submission"
        shutil.rmtree(made, ignore_errors=True)
        made.mkdir()
        for name, data in files.items():
            (made / f"{name}.xlsx").write_bytes(data)
        return made

    @staticmethod
    def on(terms: Terms, pack: Pack) -> Pack:
        held = {pid: replace(one, terms=terms) for pid, one in pack.truth.held.items()}
        return replace(pack, truth=replace(pack.truth, held=held))

    @staticmethod
    def check_contract(results: dict) -> None:
        """Everything that Gradescope demands of a results.json, and nothing that it does not know."""
        known = {
            "score", "execution_time", "output", "output_format", "test_output_format", "test_name_format",
            "visibility", "stdout_visibility", "extra_data", "tests", "leaderboard",
        }  # fmt: skip
        of_test = {
            "score", "max_score", "status", "name", "name_format", "number", "output", "output_format", "tags",
            "visibility", "extra_data",
        }  # fmt: skip
        formats, visible = (
            {"text", "html", "simple_format", "md", "ansi"},
            {"visible", "hidden", "after_due_date", "after_published"},
        )
        assert set(results) <= known
        assert isinstance(results["score"], int | float)
        assert results["visibility"] in visible
        assert results["stdout_visibility"] == "hidden"
        assert {results[name] for name in known & set(results) if name.endswith("_format")} <= formats
        for test in results["tests"]:
            assert set(test) <= of_test
            assert test["visibility"] in visible
            assert test["output_format"] in formats
            assert test.get("status", "passed") in {"passed", "failed"}
            assert ("score" in test) == ("max_score" in test)
            assert "<script" not in test["output"]


@pytest.fixture(scope="session")
def autograder_course(tmp_path_factory, kit) -> Course:
    course = new_course(tmp_path_factory.mktemp("gradescope") / "course", "Dynamics")
    with Gradebook.open(course) as book:
        arrivals = book.take_in([Enrolled(name, email) for name, email in PEOPLE])
        for i, arrival in enumerate(arrivals):
            pid, code = arrival.student.pid, f"CODE{i}"
            variant = kit.variant_of(signature_of(course.secret, "soccer-kick", code), code, pid)
            book.keep_key(variant, kit.key_of(kit.impact(e=0.6 + 0.1 * i), code=code, student=pid))
    return course


@pytest.fixture(scope="session")
def lab(autograder_course, kit) -> Lab:
    return Lab(autograder_course, kit)


@pytest.fixture(scope="session")
def right(lab, tmp_path_factory) -> bytes:
    return lab.workbook_bytes(tmp_path_factory.mktemp("right"))


@pytest.fixture(scope="session")
def unsigned(lab, tmp_path_factory) -> bytes:
    return lab.workbook_bytes(tmp_path_factory.mktemp("unsigned"), signature="0" * 64)


@pytest.fixture(scope="session")
def wheels(tmp_path_factory) -> Path:
    """Files with the names of wheels: what is in them matters to the real run only."""
    folder = tmp_path_factory.mktemp("wheels")
    for name in NEEDED:
        (folder / f"{name.replace('-', '_')}-1.0-py3-none-any.whl").write_bytes(b"wheel")
    return folder


@pytest.fixture(scope="session")
def packed(lab, wheels, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("packed") / "autograder.zip"
    lines = write(lab.job_of(lab.course, wheels=wheels), path)
    assert [line.status for line in lines] == ["filled", "filled", "skipped"]
    assert "no e-mail address" in lines[2].reason
    return path


@pytest.fixture(scope="session")
def pack(packed) -> Pack:
    with zipfile.ZipFile(packed) as archive:
        return Pack(load_assignment("soccer-kick"), from_bytes(archive.read("truth.json")))

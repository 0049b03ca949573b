"""A grader that is killed at any moment loses nothing and leaves nothing half-done."""

from __future__ import annotations

import multiprocessing
import os
import random
import signal
import sys
import time
from multiprocessing.process import BaseProcess
from multiprocessing.synchronize import Event
from pathlib import Path

import pytest
from sqlalchemy import func, select

from assignments.course import Course, new_course, open_course
from assignments.variants import signature_of
from assignments.workbook import fill_workbook, write_workbook
from grader import tables
from grader.gradebook import Gradebook
from grader.grading import Wanted, grade_files
from grader.verify import verify_course

KILLS = int(os.environ.get("VML_KILLS", "12"))  # VML_KILLS=100 for the long run
STUDENTS = 6
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL to send")


@pytest.fixture(scope="module")
def handed_in(tmp_path_factory, kit, assignment) -> tuple[Course, list[Path]]:
    course = new_course(tmp_path_factory.mktemp("killed") / "course")
    returned = course.folder / "returned"
    returned.mkdir()
    for i in range(STUDENTS):
        code, pid = f"CODE{i}", f"pupil{i:03}"
        numbers = kit.impact(e=0.5 + 0.05 * i)
        variant = kit.variant_of(signature_of(course.secret, "soccer-kick", code), code, pid)
        with Gradebook.open(course) as book:
            book.keep_key(variant, kit.key_of(numbers, code=code, student=pid))
        empty = course.folder / "empty.xlsx"
        write_workbook(empty, assignment, variant, {g.id: 1.0 for g in assignment.givens})
        units = {q.id: q.unit for q in assignment.questions if q.unit}
        answers, table = kit.rounded(kit.true_values(numbers)), kit.table_of(kit.trajectory_m(numbers))
        fill_workbook(empty, returned / f"{i}.xlsx", answers, units, table)
    return course, [returned]


def _grade(folder: str, files: list[Path], again: int) -> None:
    for _ in range(again):
        grade_files(open_course(folder), files, Wanted())


def _grade_and_say(folder: str, files: list[Path], again: int, begins: Event) -> None:
    begins.set()
    _grade(folder, files, again)


def _begun(course: Course, files: list[Path], again: int) -> BaseProcess:
    """Return a grader that has just begun; it is forked where there are no threads, and imports this file first."""
    processes = multiprocessing.get_context("forkserver")
    processes.set_forkserver_preload(["pytest", "assignments.workbook", "grader.grading"])  # longer than grading takes
    begins = processes.Event()
    child = processes.Process(target=_grade_and_say, args=(str(course.folder), files, again, begins))
    child.start()
    assert begins.wait(120)
    return child


def test_a_grader_killed_at_random_moments_loses_nothing_and_leaves_no_half_grade(handed_in) -> None:
    course, files = handed_in
    chance, once = random.Random(7), _begun(course, files, 1)  # noqa: S311 - moments to kill at
    started = time.monotonic()
    once.join()
    once_s, before = time.monotonic() - started, _runs(course)
    for _ in range(KILLS):
        child = _begun(course, files, 3)
        time.sleep(chance.uniform(0.02, 1.5 * once_s))
        os.kill(child.pid, signal.SIGKILL)
        child.join()
        _hold(course)
    assert _runs(course) > before  # they were killed at work, not before it
    grade_files(course, files, Wanted())
    _hold(course)
    with Gradebook.open(course) as book:
        rows = book.rows("soccer-kick")
        assert [(row.attempts, row.points) for row in rows] == [(1, row.out_of) for row in rows]
        assert len(rows) == STUDENTS
        assert book.receipts("collected") == ()
    pages = {path.name for path in (course.folder / "feedback" / "soccer-kick").glob("*.html")}
    assert len(pages) == STUDENTS + 1


def _runs(course: Course) -> int:
    with Gradebook.open(course) as book, book.reading() as connection:
        return int(connection.scalar(select(func.count()).select_from(tables.grade_run)))


def _hold(course: Course) -> None:
    """Whatever the moment: the chain is whole, every file is there, every run has all of its scores."""
    assert verify_course(course).is_whole
    with Gradebook.open(course) as book, book.reading() as connection:
        runs, scores = tables.grade_run, tables.criterion_score
        each = select(func.count()).select_from(scores).group_by(scores.c.grade_run_id)
        assert len(set(connection.scalars(each))) <= 1  # all runs have equally many
        with_scores = connection.scalar(select(func.count(func.distinct(scores.c.grade_run_id))))
        assert with_scores == connection.scalar(select(func.count()).select_from(runs))

"""Earlier attempts, lateness, and the terms of each student."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from assignments.load import load_assignment
from assignments.terms import Calendar, Late, Terms
from grader.autograder.attempts import Past, past_attempts, with_this
from grader.autograder.run import graded
from grader.autograder.truth import from_bytes
from grader.exports.gradescope import packed_files, write

TOTAL = load_assignment("soccer-kick").total_points


def after(results: dict, said: dict) -> dict:
    """What Gradescope hands back of a run; the results of the latest only."""
    return {
        "submission_time": said["created_at"],
        "score": results["score"],
        "autograder_error": False,
        "results": results,
    }


@pytest.fixture(scope="session")
def worse(lab, tmp_path_factory) -> bytes:
    return lab.workbook_bytes(tmp_path_factory.mktemp("worse"), e=0.05, I=7.0)


def test_attempts_are_counted_and_the_one_that_the_course_names_counts(lab, pack, right, worse, tmp_path) -> None:
    best, newest = lab.on(Terms(attempts=2, counts="best"), pack), lab.on(Terms(attempts=2), pack)
    said = lab.metadata("ana@example.org")
    first = graded(best, lab.submit(tmp_path, lab=right), said)
    again = lab.metadata("ana@example.org", previous=[after(first, said)])
    folder = lab.submit(tmp_path, lab=worse)
    second = graded(best, folder, again)
    assert second["score"] == TOTAL
    assert "Attempt 2 of 2" in second["output"]
    assert 0 < graded(newest, folder, again)["score"] < TOTAL


def test_an_attempt_too_many_does_not_count_and_tells_nothing(lab, pack, right, worse, tmp_path) -> None:
    one, said = lab.on(Terms(attempts=1), pack), lab.metadata("ana@example.org")
    first = graded(one, lab.submit(tmp_path, lab=worse), said)
    second = graded(
        one, lab.submit(tmp_path, lab=right), lab.metadata("ana@example.org", previous=[after(first, said)])
    )
    assert second["score"] == first["score"]
    assert "does not count" in second["output"]
    assert {test["visibility"] for test in second["tests"]} == {"after_due_date"}


def test_the_same_workbook_again_uses_no_attempt(lab, pack, right, tmp_path) -> None:
    one, said = lab.on(Terms(attempts=1), pack), lab.metadata("ana@example.org")
    folder = lab.submit(tmp_path, lab=right)
    first = graded(one, folder, said)
    later = lab.metadata("ana@example.org", previous=[after(first, said)], created="2026-06-01T10:00:00+00:00")
    again = graded(one, folder, later)
    assert (again["score"], again["extra_data"]) == (first["score"], first["extra_data"])


def test_an_unreadable_file_between_uses_no_attempt_and_forgets_none(lab, pack, right, tmp_path) -> None:
    one, said = lab.on(Terms(attempts=2), pack), lab.metadata("ana@example.org")
    first = graded(one, lab.submit(tmp_path, lab=right), said)
    broken = graded(one, lab.submit(tmp_path, lab=b"x"), lab.metadata("ana@example.org", previous=[after(first, said)]))
    assert broken["extra_data"] == first["extra_data"]


def test_lateness_is_reckoned_from_the_submission_not_from_the_clock(lab, pack, right, tmp_path) -> None:
    terms = Terms(due=datetime(2026, 5, 1, 16, tzinfo=UTC), late=Late("fixed", share=0.25))
    folder = lab.submit(tmp_path, lab=right)
    late = [graded(lab.on(terms, pack), folder, lab.metadata("ana@example.org")) for _ in range(2)]
    assert late[0] == late[1]
    assert late[0]["score"] == 0.75 * TOTAL
    assert "25 % is taken off" in late[0]["output"]
    in_time = graded(lab.on(terms, pack), folder, lab.metadata("ana@example.org", created="2026-05-01T08:59:59-07:00"))
    assert in_time["score"] == TOTAL


def test_runs_that_failed_are_no_attempts_and_scores_stand_in_for_lost_results() -> None:
    earlier = [
        {"submission_time": "2026-05-01T00:00:00Z", "score": "7.0", "autograder_error": False, "results": {}},
        {"submission_time": "2026-05-02T00:00:00Z", "score": 0.0, "autograder_error": True, "results": None},
    ]
    past = past_attempts({"previous_submissions": earlier})
    assert past == (Past("2026-05-01T00:00:00Z", 7.0),)
    attempts, number = with_this(past, Past("2026-05-03T00:00:00Z", 9.0, "abc"))
    assert (len(attempts), number) == (2, 2)
    assert past_attempts({}) == ()


def test_the_terms_of_each_student_travel_along(lab, autograder_course, wheels, tmp_path) -> None:
    steps = Late("steps", steps=((1.0, 0.1), (24.0, 0.5)))
    terms = Terms(due=datetime(2026, 5, 1, tzinfo=UTC), attempts=3, counts="mean", late=steps)
    course = replace(autograder_course, calendar=Calendar(terms={"soccer-kick": terms}))
    write(lab.job_of(course, wheels=wheels), tmp_path / "a.zip")
    with zipfile.ZipFile(tmp_path / "a.zip") as archive:
        truth = from_bytes(archive.read("truth.json"))
    assert {one.terms for one in truth.held.values()} == {terms}


def test_an_assignment_of_the_course_itself_is_packed(lab, autograder_course, tmp_path) -> None:
    names = {name for name, _ in packed_files(lab.job_of(autograder_course))}
    assert {"assignment/soccer-kick/assignment.toml", "lib/grader/autograder/run.py", "python-version"} <= names
    assert not any("__pycache__" in name for name in names)


def test_scripts_of_a_windows_checkout_get_unix_line_ends(lab, autograder_course, monkeypatch) -> None:
    script, scripts, as_it_is = b"#!/usr/bin/env bash\r\nexit\r\n", {"setup.sh", "run_autograder"}, Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: script if path.name in scripts else as_it_is(path))
    names = dict(packed_files(lab.job_of(autograder_course)))
    assert names["setup.sh"] == names["run_autograder"] == b"#!/usr/bin/env bash\nexit\n"

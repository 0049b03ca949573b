"""A whole course in an object store: handing out and grading, in memory and on an S3 server."""

from __future__ import annotations

from pathlib import Path

import pytest

import assignments.usecases
from assignments.bundle import unzipped
from assignments.course import new_course, open_course
from assignments.model import AnswerKey, Variant
from assignments.release import Order, Release
from assignments.variants import draw_variant, given_values
from assignments.workbook import fill_workbook, write_workbook
from grader.grading import grade_collected
from grader.handing_out import hand_out_to
from vml_course.cli import run

KICK = "soccer-kick"


@pytest.fixture(params=["memory", "s3"])
def place(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("VML_HOME", str(tmp_path / "home"))
    root = request.getfixturevalue("bucket") if request.param == "s3" else "memory://store"
    return f"{root}/{tmp_path.name}"


def _release(order: Order, kit, folder: Path) -> Release:
    """A release whose video nobody filmed; workbook and key are real."""
    variant: Variant = draw_variant(order.assignment, order.secret, order.student)
    key: AnswerKey = kit.key_of(kit.impact(), code=variant.code, student=order.student)
    path = folder / f"{order.student}.xlsx"
    write_workbook(path, order.assignment, variant, given_values(order.assignment, variant))
    files = {
        "video.mp4": b"pictures",
        "handout.html": " ".join(order.terms).encode(),
        "workbook.xlsx": path.read_bytes(),
    }
    return Release(variant, key, (), files, {"film": 1.0})


def test_a_course_in_a_store_hands_out_takes_in_and_grades(place, tmp_path, monkeypatch, kit, capsys) -> None:
    monkeypatch.setattr(assignments.usecases, "release", lambda order: _release(order, kit, tmp_path))
    course = new_course(place, "Dynamics")
    due = b"[assignment.soccer-kick]\ndue = 2100-04-26T23:59:00\n"
    course.shelf.write("course.toml", course.shelf.read("course.toml") + due)
    assert run(["handout", KICK, "--course", place]) == 0
    course = open_course(place)
    again = hand_out_to(course, KICK)
    assert [item.status for item in again.results] == ["already"] * 3
    pid = again.results[0].student
    expected = {"zips", "bundle-moodle.zip", "bundle.json", *again.students}
    assert course.shelf.names(f"handouts/{KICK}") == expected
    assert b"Monday 26 April 2100, 23:59 (UTC)" in course.shelf.read(f"handouts/{KICK}/{pid}/handout.html")
    assert len(unzipped(course.shelf.read(f"handouts/{KICK}/bundle-moodle.zip"))) == 9

    returned = _filled(course.shelf.read(f"handouts/{KICK}/{pid}/workbook.xlsx"), tmp_path, kit)
    assert run(["collect", KICK, str(returned.parent), "--course", place]) == 0
    (graded,) = grade_collected(open_course(place), KICK)
    assert (graded.pid, graded.points) == (pid, graded.out_of)
    assert course.shelf.names(f"feedback/{KICK}") == {f"{pid}.html", f"{pid}.xlsx", "class.html"}
    assert run(["gradebook", "verify", "--course", place]) == 0
    assert "1, 0 missing or changed" in capsys.readouterr().out
    assert course.shelf.names() == {"course.toml", "handouts", "inbox", "feedback"}  # no secret, no names, no grades


def _filled(workbook: bytes, folder: Path, kit) -> Path:
    numbers = kit.impact()
    empty, filled = folder / "empty.xlsx", folder / "returned" / "w.xlsx"
    filled.parent.mkdir()
    empty.write_bytes(workbook)
    units = {"px_per_m": "px/m", "fps": "1/s", "omega1": "rad/s", "omega2": "rad/s", "I": "kg m^2"}
    units |= dict.fromkeys(("v_f1", "v_f2", "v_b1", "v_b2"), "m/s")
    columns = kit.table_of(kit.trajectory_m(numbers))
    fill_workbook(empty, filled, kit.rounded(kit.true_values(numbers)), units, columns)
    return filled

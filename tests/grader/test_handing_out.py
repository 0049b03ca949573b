"""Handing out to the class list: who gets something, what a run writes, and names in one table only.

Releases are made up here (tests/assignments/test_hand_out.py makes real ones): files of some bytes, a key that fits.
"""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import threading
import zipfile
from pathlib import Path

import pytest

import assignments.usecases
from assignments.course import Course, new_course
from assignments.errors import NoVariantError
from assignments.load import load_assignment
from assignments.plan import make_plan
from assignments.release import Order, Release
from assignments.variants import draw_variant
from grader import handing_out
from grader.gradebook import Gradebook
from grader.handing_out import expect, hand_out_to, plan_for, table_file
from vml_course.cli import run
from vml_course.errors import InputError

KICK = "soccer-kick"
NAMES = ("Zoë Ångström-Quince", "=SUM(A1)", "Oak, Jane", "Müller")


def made_up(order: Order, kit) -> Release:
    variant = draw_variant(order.assignment, order.secret, order.student)
    key = kit.key_of(kit.impact(), code=variant.code, student=order.student)
    files = {name: f"{name} of {variant.code}".encode() for name in ("video.mp4", "workbook.xlsx", "handout.html")}
    return Release(variant, key, (), files, {"film": 1.0})


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kit) -> Course:
    monkeypatch.setattr(assignments.usecases, "release", lambda order: made_up(order, kit))
    return _course(tmp_path / "course", NAMES)


def _course(folder: Path, names: tuple[str, ...]) -> Course:
    course = new_course(folder)
    _roster(course, names)
    return course


def _roster(course: Course, names: tuple[str, ...]) -> None:
    with course.roster.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([("name", "email"), *((name, f"m{n}@example.org") for n, name in enumerate(names))])


def _state(folder: Path) -> dict[str, tuple[int, bytes]]:
    return {
        str(path.relative_to(folder)): (path.stat().st_mtime_ns, path.read_bytes())
        for path in folder.rglob("*")
        if path.is_file()
    }


# ---------------------------------------------------------------- a run


def test_everybody_of_the_roster_gets_something_and_a_second_run_changes_nothing(course: Course) -> None:
    first = hand_out_to(course, KICK)
    assert [item.status for item in first.results] == ["made"] * 4
    before = _state(course.folder)
    again = hand_out_to(course, KICK)
    assert [item.status for item in again.results] == ["already"] * 4
    assert _state(course.folder) == before


def test_a_student_who_joins_later_changes_nobody(course: Course) -> None:
    hand_out_to(course, KICK)
    before = _state(course.handouts(KICK))
    _roster(course, (*NAMES, "Late Comer"))
    handed = hand_out_to(course, KICK)
    assert [item.status for item in handed.results] == ["already"] * 4 + ["made"]
    after = _state(course.handouts(KICK))
    assert {path for path in before if after[path] != before[path]} == {"bundle-moodle.zip", "bundle.json"}
    with zipfile.ZipFile(handed.bundle[0]) as bundle:
        assert len(bundle.namelist()) == 5 * 3


def test_only_those_who_are_named_get_something(course: Course) -> None:
    pids = [item.pid for item in _after_enrolling(course)]
    handed = hand_out_to(course, KICK, pids[1:3])
    assert [item.student for item in handed.results] == pids[1:3]
    assert {path.name for path in course.handouts(KICK).iterdir()} == {
        *pids[1:3],
        "zips",
        "bundle-moodle.zip",
        "bundle.json",
    }
    with pytest.raises(InputError, match="a pseudonym of this course"):
        hand_out_to(course, KICK, ["nobody"])


def test_folders_carry_the_platforms_number_where_it_is_known(course: Course) -> None:
    pids = [item.pid for item in _after_enrolling(course)]
    handed = hand_out_to(course, KICK, participants={pids[0]: "48213"})
    with zipfile.ZipFile(handed.bundle[0]) as bundle:
        folders = {name.split("/")[0] for name in bundle.namelist()}
    assert folders == {f"{pids[0]}_48213_assignsubmission_file", *pids[1:]}


def test_names_stand_in_one_table_only_and_never_in_what_is_handed_out(course: Course) -> None:
    handed = hand_out_to(course, KICK)
    words = [word for name in NAMES for word in name.replace("=", " ").replace("(", " ").split() if len(word) > 3]
    for path in course.handouts(KICK).rglob("*"):
        content = path.read_bytes() if path.is_file() else b""
        for word in (*words, "example.org"):
            assert word.encode() not in content, path
            assert word not in str(path.relative_to(course.folder))
    rows = list(csv.reader(handed.table.read_text(encoding="utf-8-sig").splitlines()))
    assert [row[1] for row in rows[1:]] == ["Zoë Ångström-Quince", "'=SUM(A1)", "Oak, Jane", "Müller"]
    assert [row[0] for row in rows[1:]] == list(handed.students)
    assert course.handouts(KICK) not in handed.table.parents
    if os.name == "posix":
        assert handed.table.stat().st_mode & 0o077 == 0


def test_failures_are_listed_last_with_their_reasons(
    course: Course, monkeypatch: pytest.MonkeyPatch, kit, capsys: pytest.CaptureFixture[str]
) -> None:
    unlucky = _after_enrolling(course)[2].pid

    def fail_for_one(order: Order) -> Release:
        if order.student == unlucky:
            raise NoVariantError(KICK, 10, ["the camera is broken"])
        return made_up(order, kit)

    monkeypatch.setattr(assignments.usecases, "release", fail_for_one)
    assert run(["handout", KICK, "--course", str(course.folder)]) == 1
    out = capsys.readouterr().out
    assert "3 of 4 handed out." in out
    assert out.splitlines()[-1].startswith(f"{unlucky}  failed  Oak, Jane")
    assert "the camera is broken" in out
    monkeypatch.setattr(assignments.usecases, "release", lambda order: made_up(order, kit))
    assert run(["handout", KICK, "--course", str(course.folder), "--json"]) == 0
    assert [item["status"] for item in json.loads(capsys.readouterr().out)] == ["already", "already", "made", "already"]


def test_what_was_drawn_again_is_said_and_kept(
    course: Course, monkeypatch: pytest.MonkeyPatch, kit, capsys: pytest.CaptureFixture[str]
) -> None:
    def second_try(order: Order) -> Release:
        one = made_up(order, kit)
        return Release(one.variant, one.key, ("draw 0: I: expected to be measured",), one.files)

    monkeypatch.setattr(assignments.usecases, "release", second_try)
    assert run(["handout", KICK, "--course", str(course.folder)]) == 0
    assert "4 variants were drawn again" in capsys.readouterr().out
    log = (course.folder / "handouts" / f"redrawn-{KICK}.log").read_text(encoding="utf-8")
    assert log.count("draw 0: I: expected to be measured") == 4


# ---------------------------------------------------------------- a look ahead


def _after_enrolling(course: Course) -> list:
    with Gradebook.open(course) as gradebook:
        return list(gradebook.students_from_roster(course.roster))


def test_a_dry_run_says_who_would_get_something_and_writes_nothing(
    course: Course, capsys: pytest.CaptureFixture[str]
) -> None:
    before = _state(course.folder)
    assert [item.status for item in expect(course, KICK)] == ["new"] * 4
    assert _state(course.folder) == before
    handed = hand_out_to(course, KICK)
    _roster(course, (*NAMES, "Late Comer"))
    before = _state(course.folder)
    assert run(["handout", KICK, "--course", str(course.folder), "--dry-run"]) == 0
    assert _state(course.folder) == before
    out = capsys.readouterr().out
    assert "1 would get it, 4 have it. Nothing was written." in out
    assert "would get it      Late Comer" in out
    pid = handed.results[0].student
    assert [(item.pid, item.status) for item in expect(course, KICK, [pid])] == [(pid, "already")]
    with pytest.raises(InputError, match="a pseudonym of this course"):
        expect(course, KICK, ["nobody"])


def test_a_plan_takes_the_cost_of_earlier_runs(
    course: Course, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("assignments.plan.PEERS", 2)
    monkeypatch.setattr(handing_out, "sample_cost", _never)
    hand_out_to(course, KICK)
    before = _state(course.handouts(KICK))
    plan = plan_for(course, KICK)
    assert (plan.each.students, plan.cpu_s) == (4, 4.0)
    assert run(["handout", KICK, "--course", str(course.folder), "--plan"]) == 0
    out = capsys.readouterr().out
    assert "1.00 s of processor time each (film 1.00; from 4 made here)" in out
    assert "Predicted standard deviation" in out
    assert (course.folder / "handouts" / f"plan-{KICK}.svg").read_text(encoding="utf-8").count("<circle") == 8
    assert _state(course.handouts(KICK)) == before
    plot = course.folder / "p.svg"
    assert run(["handout", KICK, "--course", str(course.folder), "--plan", "--plot", str(plot), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["plot"] == str(plot)


def test_without_earlier_runs_one_variant_is_made_to_see_the_cost(
    course: Course, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []
    monkeypatch.setattr(handing_out, "make_plan", lambda *arguments: asked.append(arguments))
    monkeypatch.setattr(handing_out, "sample_cost", lambda assignment: f"cost of {assignment.id}")
    plan_for(course, KICK)
    assert asked[0][3] == f"cost of {KICK}"
    assert len(asked[0][2]) == 4
    assert make_plan is not handing_out.make_plan


def _never(_assignment: object) -> None:
    raise AssertionError("measured though it was known")


# ---------------------------------------------------------------- killed


SLOW = """
import os, sys, time
from pathlib import Path
import assignments.usecases
from assignments.course import open_course
from assignments.model import AnswerKey
from assignments.release import Release
from assignments.variants import draw_variant
from grader.handing_out import hand_out_to

def slow(order):
    variant = draw_variant(order.assignment, order.secret, order.student)
    facts = ({}, {}, {}, {}, {}, "0", {}, ("foot",), [0], [0.0], [[[0.0, 0.0]]])
    time.sleep(0.003)
    body = variant.code.encode() * 20_000
    files = {name: body for name in ("video.mp4", "workbook.xlsx", "handout.html")}
    key = AnswerKey(variant.assignment_id, order.student, variant.code, *facts)
    return Release(variant, key, (), files, {"film": 1.0})

assignments.usecases.release = slow
for _ in sys.stdin:  # a run for each line; what takes long, the imports, is done once
    run = os.fork()
    if run == 0:
        hand_out_to(open_course(Path(sys.argv[1])), "soccer-kick")
        os._exit(0)
    print(run, flush=True)
    print(os.waitstatus_to_exitcode(os.waitpid(run, 0)[1]), flush=True)
"""


@pytest.mark.skipif(os.name != "posix", reason="ends a process by a signal")
def test_a_run_that_is_killed_at_any_instant_goes_on_where_it_stopped(tmp_path: Path) -> None:
    """No half folder has its name, no key is lost, nothing that was done is done again."""
    course = _course(tmp_path / "c", tuple(f"Student {n}" for n in range(40)))
    script, kills, complete = tmp_path / "slow.py", 0, dict[str, int]()
    script.write_text(SLOW, encoding="utf-8")
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "bufsize": 1}
    with subprocess.Popen([sys.executable, str(script), str(course.folder)], **pipes) as runs:
        for number in range(20):
            kills += _run(runs, killed_after_s=0.01 + 0.14 * (0.618 * number % 1.0)) == -signal.SIGKILL
            complete = _none_lost(course, complete)
        assert _run(runs, killed_after_s=60.0) == 0
        runs.stdin.close()
    assert kills >= 5
    _all_there(course, 40)


def _run(runs: subprocess.Popen, killed_after_s: float) -> int:
    """Begin a run, kill it if it still goes on after that time, and return its exit code."""
    runs.stdin.write("go\n")
    process = int(runs.stdout.readline())
    killer = threading.Timer(killed_after_s, os.kill, (process, signal.SIGKILL))
    killer.start()
    code = int(runs.stdout.readline())
    killer.cancel()
    killer.join()
    return code


def _none_lost(course: Course, complete: dict[str, int]) -> dict[str, int]:
    home = course.handouts(KICK)
    folders = [path for path in home.iterdir() if path.is_dir() and path.name != "zips"] if home.is_dir() else []
    for folder in folders:  # whatever has its name is whole, and its key is kept
        assert len({path.read_bytes() for path in folder.iterdir()}) == 1
        assert sorted(path.name for path in folder.iterdir()) == ["handout.html", "video.mp4", "workbook.xlsx"]
    with Gradebook.open(course) as gradebook:
        assert all(gradebook.has_key(KICK, folder.name) for folder in folders)
        assert gradebook.is_whole()
    now = {folder.name: folder.stat().st_mtime_ns for folder in folders}
    assert now.items() >= complete.items()
    return now


def _all_there(course: Course, count: int) -> None:
    home = course.handouts(KICK)
    assert len(_none_lost(course, {})) == count
    assert len(list((home / "zips").glob("*.zip"))) == count
    assert sorted(p.name for p in course.folder.iterdir() if p.name.startswith(".")) == [".gitignore", ".secret"]
    with zipfile.ZipFile(home / "bundle-moodle.zip") as bundle:
        assert bundle.testzip() is None
        assert len(bundle.namelist()) == 3 * count
    table = table_file(course, load_assignment(KICK)).read_text(encoding="utf-8-sig")
    assert table.count("\n") == count + 1

"""From a platform's download to a release: whose each file is, when it came, what it came to."""

from __future__ import annotations

import datetime as dt
import json
from dataclasses import replace
from pathlib import Path

import pytest

from grader.collect import collect
from grader.errors import CollectError, NothingGradedError
from grader.grade import grade
from grader.gradebook import Gradebook
from grader.grading import Wanted, grade_again, grade_collected, grade_files
from grader.releasing import release_grades, released_grades
from grader.usecases import release
from vml_course.cli import run
from vml_course.errors import FileMissingError

SLUG = "soccer-kick"
DUE = dt.datetime(2026, 5, 1, 22, 0, tzinfo=dt.UTC)


def _row(term, i: int):
    with Gradebook.open(term.course) as book:
        return book.row(SLUG, term.pids[i])


def test_a_download_is_matched_kept_and_graded(term) -> None:
    names = {f"s{i}_90{i + 1}_55{i}_lab.xlsx": term.file(i) for i in range(3)}
    found = collect(term.course, SLUG, term.download(**names, **{"__MACOSX/x": b"", "s_901_1_.DS_Store": b""}))
    assert [(item.status, item.pid, item.platform) for item in found[:3]] == [
        ("matched", pid, "canvas") for pid in term.pids
    ]
    graded = grade_collected(term.course, SLUG)
    assert [(item.pid, item.points, item.file.name) for item in graded] == [
        (pid, item.out_of, "lab.xlsx") for pid, item in zip(term.pids, graded, strict=True)
    ]
    assert grade_collected(term.course, SLUG) == []  # nothing waits any more


def test_collecting_again_takes_in_only_what_is_new(term) -> None:
    first = {"s_901_550_lab.xlsx": term.file(0)}
    collect(term.course, SLUG, term.download(**first))
    again = collect(term.course, SLUG, term.download(**first, **{"s_901_551_lab-2.xlsx": term.file(0, e=0.5)}))
    assert [item.status for item in again] == ["duplicate", "matched"]
    assert len(grade_collected(term.course, SLUG)) == 2
    assert _row(term, 0).attempts == 2


def test_a_trial_keeps_nothing(term) -> None:
    collect(term.course, SLUG, term.download(**{"s_901_550_lab.xlsx": term.file(0)}), dry_run=True)
    with Gradebook.open(term.course) as book:
        assert book.receipts("collected") == ()
    assert not (term.course.folder / "inbox").exists()


def test_where_platform_and_workbook_disagree_a_person_decides(term) -> None:
    (found,) = collect(term.course, SLUG, term.download(**{"s_902_550_lab.xlsx": term.file(0)}))
    assert found.status == "conflict"
    assert found.message == f"The workbook is {term.pids[0]}'s, the platform says {term.pids[1]}."
    assert grade_collected(term.course, SLUG) == []


def test_a_copy_that_comes_first_does_not_hide_the_file_of_its_owner(term) -> None:
    download = term.download(**{"a_902_1_lab.xlsx": term.file(0), "b_901_2_lab.xlsx": term.file(0)})
    copy, own = collect(term.course, SLUG, download)
    assert (copy.status, copy.pid) == ("conflict", term.pids[1])
    assert (own.status, own.pid) == ("matched", term.pids[0])
    assert [item.pid for item in grade_collected(term.course, SLUG)] == [term.pids[0]]


def test_grading_says_how_many_files_wait_for_a_person(term, capsys) -> None:
    collect(term.course, SLUG, term.download(**{"a_902_1_lab.xlsx": term.file(0), "b_901_2_lab.xlsx": term.file(0)}))
    assert run(["grade", "--course", str(term.course.folder)]) == 0
    assert "1 more came in that nobody could grade" in capsys.readouterr().out


def test_a_copy_that_comes_second_is_said_to_be_somebody_elses(term) -> None:
    download = term.download(**{"a_901_1_lab.xlsx": term.file(0), "b_902_2_lab.xlsx": term.file(0)})
    _, copy = collect(term.course, SLUG, download)
    assert (copy.status, copy.pid) == ("conflict", term.pids[1])


def test_somebody_whom_the_class_list_does_not_know_hands_in_for_nobody(term) -> None:
    (found,) = collect(term.course, SLUG, term.download(**{"ghost_999_1_lab.xlsx": term.file(0)}))
    assert (found.status, found.pid) == ("conflict", "")
    assert found.message == f"The workbook is {term.pids[0]}'s, whose canvas_id is another than 999: who handed it in?"
    assert grade_collected(term.course, SLUG) == []


def test_where_the_class_list_has_no_numbers_of_the_platform_the_workbook_says_it(term) -> None:
    (found,) = collect(term.course, SLUG, term.download(**{"Ann_4711_assignsubmission_file/lab.xlsx": term.file(0)}))
    assert (found.status, found.pid, found.platform) == ("matched", term.pids[0], "moodle")


def test_what_waited_for_a_person_waits_when_it_comes_again(term, capsys) -> None:
    download, at = term.download(**{"s_902_1_lab.xlsx": term.file(0)}), ["--course", str(term.course.folder)]
    assert run(["collect", SLUG, str(download), *at]) == 1
    assert run(["collect", SLUG, str(download), *at]) == 1
    assert "The same bytes came in before (conflict)." in capsys.readouterr().out


def test_the_workbook_alone_says_whose_it_is(term) -> None:
    folder = term.course.folder / "unpacked"
    (folder / "deep").mkdir(parents=True)
    (folder / "deep" / "anything.xlsx").write_bytes(term.file(2))
    (found,) = collect(term.course, SLUG, folder)
    assert (found.status, found.pid, found.platform) == ("matched", term.pids[2], "")


def test_what_nobody_can_read_is_kept_with_its_reason(term) -> None:
    found = collect(term.course, SLUG, term.download(**{"s_901_1_lab.xlsx": b"no", "other.xlsx": b"neither"}))
    assert [(item.status, item.pid) for item in found] == [("unreadable", term.pids[0]), ("unmatched", "")]
    with Gradebook.open(term.course) as book:
        (receipt,) = book.receipts("unreadable", SLUG)
        assert receipt.arrived.pid == term.pids[0]
        assert "expected an Excel workbook" in receipt.arrived.reason
        assert len(book.receipts("unmatched")) == 1
    assert run(["gradebook", "verify", "--course", str(term.course.folder)]) == 0


def test_a_changed_file_in_the_inbox_shows(term, capsys) -> None:
    collect(term.course, SLUG, term.download(**{"s_901_550_lab.xlsx": term.file(0)}))
    (kept,) = (path for path in (term.course.folder / "inbox").rglob("*") if path.is_file())
    kept.chmod(0o600)
    kept.write_bytes(b"other")
    assert run(["gradebook", "verify", "--course", str(term.course.folder)]) == 1
    assert "1 missing or changed" in capsys.readouterr().out
    kept.unlink()
    assert run(["gradebook", "verify", "--course", str(term.course.folder)]) == 1
    assert "missing" in capsys.readouterr().out


LATE = """[assignment.soccer-kick]
due = 2026-05-01T22:00:00Z
closes = 2026-05-02T22:00:00Z
late = { rule = "fixed", share = 0.5 }
"""


def test_true_values_are_shown_when_nobody_can_hand_in_any_more(term) -> None:
    path = term.course.folder / "w.xlsx"
    path.write_bytes(term.file(0))
    for toml, is_shown in (("", False), (LATE.replace("2026", "2100"), False), (LATE, True)):
        term.say(toml)
        (graded,) = grade_files(term.course, [path])
        assert ("True value" in Path(graded.feedback).read_text(encoding="utf-8")) is is_shown
    term.say(LATE.replace("2026", "2100") + "attempts = 1\n")
    (graded,) = grade_files(term.course, [path])
    assert "True value" in Path(graded.feedback).read_text(encoding="utf-8")
    (graded,) = grade_files(term.course, [path], Wanted(show_truth=False))
    assert "True value" not in Path(graded.feedback).read_text(encoding="utf-8")


# ---------------------------------------------------------------- release


def test_a_release_fixes_what_counts_and_the_next_one_says_what_changed(term) -> None:
    path = term.course.folder / "w.xlsx"
    for i in range(2):
        path.write_bytes(term.file(i))
        grade_files(term.course, [path])
    full = _row(term, 0).out_of
    changes = release_grades(term.course, SLUG, who="tutor")
    assert [(change.before, change.after, change.differs) for change in changes] == [(None, full, True)] * 2
    path.write_bytes(term.file(0, e=0.1))
    grade_files(term.course, [path])
    with Gradebook.open(term.course) as book:
        assert [one.points for one in released_grades(book, SLUG)] == [full, full]
    trial = release_grades(term.course, SLUG, who="tutor", dry_run=True)
    assert [change.differs for change in trial] == [True, False]
    release_grades(term.course, SLUG, who="tutor")
    with Gradebook.open(term.course) as book:
        assert [one.points < full for one in released_grades(book, SLUG)] == [True, False]
        assert book.is_whole()


def test_grading_again_adds_runs_and_a_release_says_what_changes(term, monkeypatch) -> None:
    path = term.course.folder / "w.xlsx"
    for i in range(2):
        path.write_bytes(term.file(i))
        grade_files(term.course, [path])
    release_grades(term.course, SLUG, who="tutor")
    monkeypatch.setattr("grader.marking.grade", lambda *what: replace(grade(*what), points=7.0))
    again = grade_again(term.course, SLUG)
    assert [item.points for item in again] == [7.0, 7.0]
    changes = release_grades(term.course, SLUG, who="tutor", dry_run=True)
    assert [(change.before == change.out_of, change.after) for change in changes] == [(True, 7.0)] * 2
    assert [_row(term, i).attempts for i in range(2)] == [1, 1]
    assert run(["grade", "--again", SLUG, "--course", str(term.course.folder), "--workers", "1"]) == 0


def test_a_file_that_is_named_twice_has_one_receipt(term) -> None:
    path = term.course.folder / "w.xlsx"
    path.write_bytes(term.file(0))
    for _ in range(2):
        grade_files(term.course, [path])
    with Gradebook.open(term.course) as book:
        (receipt,) = book.receipts("graded", SLUG)
    assert receipt.arrived.pid == term.pids[0]


def test_several_workers_grade_as_one_does(term) -> None:
    folder = term.course.folder / "all"
    folder.mkdir()
    for i in range(3):
        (folder / f"{i}.xlsx").write_bytes(term.file(i, **({"e": 0.1} if i else {})))
    (folder / "x.xlsx").write_bytes(b"no")
    alone = grade_files(term.course, [folder])
    together = grade_files(term.course, [folder], Wanted(workers=2))
    assert together == alone
    assert [item.status for item in alone] == ["ok", "ok", "ok", "unreadable"]


def test_a_persons_decision_is_on_the_students_page_at_once(term, capsys) -> None:
    path = term.course.folder / "w.xlsx"
    path.write_bytes(term.file(0, e="about 0.6"))
    (graded,) = grade_files(term.course, [path])
    page = Path(graded.feedback)
    assert "a person will look at this" in page.read_text(encoding="utf-8")
    assert release_grades(term.course, SLUG, who="tutor", dry_run=True)[0].is_provisional
    at = ["--course", str(term.course.folder)]
    assert run(["gradebook", "set", term.pids[0], SLUG, "e", "4", "--reason", "0.6 was meant", *at]) == 0
    text = page.read_text(encoding="utf-8")
    assert "e set to 4 points: 0.6 was meant" in text
    assert "A person decided: 0.6 was meant" in text
    assert "up to" not in text
    assert "a person will look" not in text
    assert f"<strong>{_row(term, 0).points:g}</strong>" in text
    capsys.readouterr()
    assert run(["release", SLUG, *at]) == 0
    assert "may still become fewer" not in capsys.readouterr().out


def test_what_nobody_could_grade_stays_on_the_class_page(term) -> None:
    collect(term.course, SLUG, term.download(**{"s_901_1_lab.xlsx": b"no", "s_902_2_lab.xlsx": term.file(1)}))
    grade_collected(term.course, SLUG)
    page = (term.course.folder / "feedback" / SLUG / "class.html").read_text(encoding="utf-8")
    assert f"lab.xlsx ({term.pids[0]})" in page


def test_bytes_that_are_gone_from_the_inbox_stop_nobody_else(term) -> None:
    collect(term.course, SLUG, term.download(**{f"s_90{i + 1}_{i}_lab.xlsx": term.file(i) for i in range(2)}))
    with Gradebook.open(term.course) as book:
        gone = next(r for r in book.receipts("collected") if r.arrived.pid == term.pids[0]).arrived.file_sha256
    (term.course.folder / "inbox" / gone[:2] / gone).unlink()
    graded = grade_collected(term.course, SLUG)
    assert {item.pid: item.status for item in graded} == {term.pids[0]: "unreadable", term.pids[1]: "ok"}


def test_nothing_graded_cannot_be_released(term) -> None:
    with pytest.raises(NothingGradedError, match="expected grades, got none"):
        release_grades(term.course, SLUG, who="tutor")


# ---------------------------------------------------------------- at the prompt


def test_the_commands_collect_grade_and_release(term, capsys) -> None:
    at = ["--course", str(term.course.folder)]
    download = str(term.download(**{"s_901_550_lab.xlsx": term.file(0), "s_902_1_lab.xlsx": term.file(1)}))
    assert run(["collect", SLUG, download, *at, "--dry-run"]) == 0
    assert "Nothing was kept (--dry-run)." in capsys.readouterr().out
    assert run(["collect", SLUG, download, *at, "--lms", "canvas"]) == 0
    assert "2 matched." in capsys.readouterr().out
    assert run(["grade", *at, "--json"]) == 0
    assert [item["status"] for item in json.loads(capsys.readouterr().out)] == ["ok", "ok"]
    assert run(["grade", *at]) == 0
    assert "Nothing new was collected." in capsys.readouterr().out
    assert run(["grade", *at, "--again", SLUG]) == 0
    assert "2 files: 2 ok." in capsys.readouterr().out
    assert run(["release", SLUG, *at]) == 0
    assert "2 grades, 2 of them changed." in capsys.readouterr().out
    assert run(["collect", SLUG, str(term.download(**{"x.xlsx": b"no"})), *at]) == 1
    assert run(["collect", "no-such", download, *at]) == 2
    assert run(["collect", SLUG, download, *at, "--lms", "webct"]) == 2


def test_points_of_each_file_are_said_to_be_before_lateness(term, capsys) -> None:
    path, at = term.course.folder / "w.xlsx", ["--course", str(term.course.folder)]
    path.write_bytes(term.file(0))
    assert run(["grade", str(path), *at]) == 0
    assert "What counts in the end" not in capsys.readouterr().out
    term.say('[assignment.soccer-kick]\ndue = 2026-05-01T22:00:00\nlate = { rule = "fixed", share = 0.2 }\n')
    assert run(["grade", str(path), *at]) == 0
    assert "What counts in the end: vml gradebook show" in capsys.readouterr().out


def test_what_is_no_download_is_one_line(term) -> None:
    nothing = term.course.folder / "nothing"
    nothing.mkdir()
    broken = term.course.folder / "broken.zip"
    broken.write_bytes(b"PK no")
    with pytest.raises(CollectError, match="expected 1 to 20000 files, got 0"):
        collect(term.course, SLUG, nothing)
    with pytest.raises(CollectError, match="expected a zip as the platform gives it"):
        collect(term.course, SLUG, broken)
    with pytest.raises(FileMissingError, match="expected a zip or a folder"):
        collect(term.course, SLUG, term.course.folder / "none.zip")


# ---------------------------------------------------------------- pages that follow what holds


def _page(term) -> str:
    return (term.course.folder / "feedback" / SLUG / f"{term.pids[0]}.html").read_text(encoding="utf-8")


def test_an_extension_is_on_the_students_page_at_once(term) -> None:
    term.say('[assignment.soccer-kick]\ndue = 2026-05-01T22:00:00\nlate = { rule = "fixed", share = 0.2 }\n')
    collect(term.course, SLUG, term.download(**{"s_LATE_901_1_lab.xlsx": term.file(0)}))
    grade_collected(term.course, SLUG)
    assert "are taken off" in _page(term)
    hours = ["--hours", "8000", "--reason", "ill"]
    assert run(["gradebook", "extend", term.pids[0], *hours, "--course", str(term.course.folder)]) == 0
    assert "are taken off" not in _page(term)


def test_a_release_writes_true_values_when_the_time_is_over(term, capsys) -> None:
    late = 'due = 2026-05-01T22:00:00\nlate = { rule = "fixed", share = 0.5 }\n'
    term.say(f"[assignment.soccer-kick]\n{late}")
    collect(term.course, SLUG, term.download(**{"s_901_1_lab.xlsx": term.file(0)}))
    grade_collected(term.course, SLUG)
    assert "True value" not in _page(term)  # late work earns half
    assert run(["release", SLUG, "--course", str(term.course.folder)]) == 0
    assert "Pages show no true values while work can still earn points" in capsys.readouterr().out
    term.say(f"[assignment.soccer-kick]\n{late}closes = 2026-05-02T22:00:00\n")
    release(term.course, SLUG, who="ann", show_truth=False)
    assert "True value" not in _page(term)
    release(term.course, SLUG, who="ann")
    assert "True value" in _page(term)


def test_true_values_that_the_course_never_shows_stay_away_whatever_command_writes_the_page(term) -> None:
    over = "[assignment.soccer-kick]\ndue = 2026-05-01T22:00:00\n"
    term.say(f'{over}true_values = "never"\n')
    collect(term.course, SLUG, term.download(**{"s_901_1_lab.xlsx": term.file(0)}))
    grade_collected(term.course, SLUG)
    assert "True value" not in _page(term)
    release(term.course, SLUG, who="ann")
    assert "True value" not in _page(term)
    at = ["--reason", "seen", "--course", str(term.course.folder)]
    assert run(["gradebook", "set", term.pids[0], SLUG, "total", "1", *at]) == 0
    assert "True value" not in _page(term)
    term.say('[assignment.soccer-kick]\ndue = 2126-05-01T22:00:00\ntrue_values = "always"\n')
    release(term.course, SLUG, who="ann")
    assert "True value" in _page(term)


def test_a_decision_after_which_another_attempt_counts_says_so(term, capsys) -> None:
    term.say('[assignment.soccer-kick]\ncounts = "best"\n')
    files = {"s_901_1_lab.xlsx": term.file(0), "s_901_2_lab-2.xlsx": term.file(0, I=0.91)}
    collect(term.course, SLUG, term.download(**files))
    grade_collected(term.course, SLUG)
    at = ["--reason", "seen", "--course", str(term.course.folder)]
    assert run(["gradebook", "set", term.pids[0], SLUG, "total", "1", *at]) == 0
    assert "Note: attempt 2 counts now; what you decided stands with attempt 1." in capsys.readouterr().out

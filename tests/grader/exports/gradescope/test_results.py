"""What is said of a submission: everything that a student may hand in ends in results."""

from __future__ import annotations

import re

import pytest

from assignments.load import load_assignment
from assignments.terms import Terms
from grader.autograder.run import graded

TOTAL = load_assignment("soccer-kick").total_points


def test_verdicts_wait_for_the_due_date_unless_attempts_are_counted(lab, pack, right, tmp_path) -> None:
    folder = lab.submit(tmp_path, lab=right)
    waiting = graded(pack, folder, lab.metadata("ana@example.org"))
    lab.check_contract(waiting)
    assert {test["visibility"] for test in waiting["tests"]} == {"after_due_date"}
    counting = graded(lab.on(Terms(attempts=3), pack), folder, lab.metadata("ana@example.org"))
    assert {test["visibility"] for test in counting["tests"]} == {"visible"}
    assert "Attempt 1 of 3" in counting["output"]


def test_what_can_be_read_before_the_due_date_tells_nothing_of_right_and_wrong(lab, pack, right, tmp_path) -> None:
    wrong = lab.workbook_bytes(tmp_path, I=0.5)
    said = [graded(pack, lab.submit(tmp_path, lab=data), lab.metadata("ana@example.org")) for data in (right, wrong)]
    assert said[0]["score"] > said[1]["score"]
    assert said[0]["output"] == said[1]["output"]


def test_no_true_value_is_in_the_results(lab, pack, tmp_path) -> None:
    wrong = lab.workbook_bytes(tmp_path, e=0.31, I=0.5)
    results = graded(pack, lab.submit(tmp_path, lab=wrong), lab.metadata("ana@example.org"))
    told = {number for test in results["tests"] for number in re.findall(r"\d+\.\d+", test["output"])}
    truth = pack.truth.of_address("ana@example.org").key.values
    assert not told & {f"{truth[name]:.{digits}g}" for name in ("e", "I") for digits in (1, 2, 3, 4)}
    failed = {test["tags"][0] for test in results["tests"] if test.get("status") == "failed"}
    assert {"e", "I"} <= failed


def test_a_group_hands_in_the_workbook_of_any_of_its_members(lab, pack, right, tmp_path) -> None:
    folder = lab.submit(tmp_path, lab=right)
    assert graded(pack, folder, lab.metadata("ben@example.org", "ana@example.org"))["score"] == TOTAL
    alone = graded(pack, folder, lab.metadata("ben@example.org"))
    assert alone["score"] == 0
    assert "another video than yours" in alone["output"]


REFUSED = {
    "an unknown student": ("eve@example.org", {"lab": b"right"}, "not on the class list"),
    "no address": ("", {"lab": b"right"}, "not on the class list"),
    "nothing": ("ana@example.org", {}, "no file"),
    "an empty file": ("ana@example.org", {"lab": b""}, "expected an Excel workbook"),
    "an old workbook": (
        "ana@example.org",
        {"lab": b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600)},
        "expected an Excel",
    ),
    "half a workbook": ("ana@example.org", {"lab": b"half"}, "expected an Excel workbook"),
    "two workbooks": ("ana@example.org", {"one": b"right", "two": b"right"}, "Expected one workbook"),
    "a stolen code": ("ana@example.org", {"lab": b"unsigned"}, "not a workbook of this course"),
}


@pytest.mark.parametrize(("email", "files", "words"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_graded_gets_nothing_and_a_polite_text(  # noqa: PLR0917 - what comes in, and what is said
    lab, pack, right, unsigned, tmp_path, email, files, words
) -> None:
    stand_in = {b"right": right, b"half": right[: len(right) // 2], b"unsigned": unsigned}
    folder = lab.submit(tmp_path, **{name: stand_in.get(data, data) for name, data in files.items()})
    results = graded(pack, folder, lab.metadata(email))
    lab.check_contract(results)
    assert (results["score"], results["tests"]) == (0, [])
    assert words in results["output"]
    assert "hand in again" in results["output"]


def test_an_empty_workbook_is_said_to_be_empty(lab, pack, kit, tmp_path) -> None:
    nothing = dict.fromkeys(kit.true_values(kit.impact()), "")
    data = lab.workbook_bytes(tmp_path, **nothing)
    results = graded(pack, lab.submit(tmp_path, lab=data), lab.metadata("ana@example.org"))
    assert results["score"] == 0
    assert "No question is answered" in results["output"]


def test_what_nobody_can_read_reaches_a_person_and_a_known_mistake_is_a_hint(lab, pack, tmp_path) -> None:
    unclear = lab.workbook_bytes(tmp_path, I="about one")
    results = graded(pack, lab.submit(tmp_path, lab=unclear), lab.metadata("ana@example.org"))
    assert "A person will look" in results["output"]
    upside_down = lab.workbook_bytes(tmp_path, e=round(1 / 0.6, 4))
    results = graded(pack, lab.submit(tmp_path, lab=upside_down), lab.metadata("ana@example.org"))
    lab.check_contract(results)
    (hints,) = [test for test in results["tests"] if test["tags"] == ["hints"]]
    assert hints["visibility"] == "after_due_date"
    assert hints["output"].startswith("<ul><li>")


def test_names_of_files_are_escaped(lab, pack, tmp_path) -> None:
    folder = lab.submit(tmp_path, **{"<img src=x onerror=alert(1)>": b"x"})
    assert "<img" not in graded(pack, folder, lab.metadata("ana@example.org"))["output"]


def test_links_out_of_the_submission_are_not_followed(lab, pack, tmp_path) -> None:
    folder, secret = lab.submit(tmp_path), tmp_path / "truth.xlsx"
    secret.write_bytes(b"the truth")
    (folder / "lab.xlsx").symlink_to(secret)
    assert "no file" in graded(pack, folder, lab.metadata("ana@example.org"))["output"]

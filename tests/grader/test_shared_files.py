"""Files that came in under another student's name: told from the receipts, to the instructor alone."""

from __future__ import annotations

import json

import pytest

from grader.collect import collect
from grader.comparing import compare_class
from grader.grading import Whose, grade_collected, grade_files
from grader.shared_files import TOLD_BY_RECEIPTS
from vml_course.cli import run

SLUG = "soccer-kick"


def _found(term):
    """What the receipts say; tables of these students have no noise, so that honest ones share cells too."""
    told = (item for item in compare_class(term.course, SLUG).evidence if item.method in TOLD_BY_RECEIPTS)
    return {(item.pid, item.other, item.method): item for item in told}


@pytest.mark.parametrize(
    "names", [("a_901_1_lab.xlsx", "b_902_2_mine.xlsx"), ("b_901_1_lab.xlsx", "a_902_2_mine.xlsx")]
)
def test_somebody_elses_very_file_is_found_whoever_comes_first(term, names) -> None:
    data = term.file(0)
    own = {"c_903_3_own.xlsx": term.file(2)}
    collect(term.course, SLUG, term.download(**dict.fromkeys(sorted(names), data), **own))
    grade_collected(term.course, SLUG)
    owner, giver, _ = term.pids
    found = _found(term)
    assert set(found) == {(giver, owner, "other-student"), (giver, owner, "same-bytes")}
    code, very = found[giver, owner, "other-student"].words, found[giver, owner, "same-bytes"].words
    assert code.startswith(f"'mine.xlsx', from canvas under the name of {giver} (20")
    assert f"the signed code of the workbook that was made for {owner}." in code
    assert "wrong file" in code
    assert f"is byte by byte the file 'lab.xlsx', from canvas under the name of {owner} (20" in very


def test_a_workbook_made_for_another_is_found_where_its_owner_handed_in_nothing(term) -> None:
    collect(term.course, SLUG, term.download(**{"s_902_1_lab.xlsx": term.file(0)}))
    assert set(_found(term)) == {(term.pids[1], term.pids[0], "other-student")}


def test_a_conflict_that_a_person_settled_stays_evidence_and_is_told_once(term) -> None:
    collect(term.course, SLUG, term.download(**{"s_902_1_lab.xlsx": term.file(0)}))
    before = compare_class(term.course, SLUG)
    path = term.course.folder / "lab.xlsx"
    path.write_bytes(term.file(0))
    (graded,) = grade_files(term.course, [path], whose=Whose(term.pids[0], SLUG, "ann"))
    assert graded.status == "ok"
    after = compare_class(term.course, SLUG)
    assert (before.new, after.new) == (1, 0)
    assert after.evidence == before.evidence


def test_a_name_that_a_person_guessed_accuses_nobody(term) -> None:
    path = term.course.folder / "lab.xlsx"
    path.write_bytes(term.file(0))
    (refused,) = grade_files(term.course, [path], whose=Whose(term.pids[1], SLUG, "ann"))
    assert refused.status == "unreadable"
    assert _found(term) == {}


def test_a_file_that_nobody_can_read_is_found_under_two_names(term) -> None:
    collect(term.course, SLUG, term.download(**{"a_901_1_x.xlsx": b"no workbook", "b_902_2_x.xlsx": b"no workbook"}))
    ((pid, other, method),) = _found(term)
    assert {pid, other} == set(term.pids[:2])
    assert method == "same-bytes"


def test_a_class_that_hands_in_its_own_files_twice_is_left_alone(term) -> None:
    files = {f"s_90{i + 1}_{i}_lab.xlsx": term.file(i) for i in range(3)}
    collect(term.course, SLUG, term.download(**files))
    grade_collected(term.course, SLUG)
    collect(term.course, SLUG, term.download(**{f"again{name}": data for name, data in files.items()}))
    assert _found(term) == {}


def test_at_the_prompt_it_is_told_as_a_fact_and_on_no_students_page(term, capsys) -> None:
    download = term.download(**{"a_901_1_lab.xlsx": term.file(0), "b_902_2_lab.xlsx": term.file(0)})
    course = ["--course", str(term.course.folder)]
    run(["collect", SLUG, str(download), *course])
    run(["grade", *course])
    capsys.readouterr()
    assert run(["integrity", SLUG, *course]) == 0
    said = capsys.readouterr().out
    lines = [line for line in said.splitlines() if line.startswith(f"{term.pids[1]:10}{term.pids[0]:10}")]
    assert [line.split()[2] for line in lines] == ["other-student", "same-bytes"]
    assert all(line.endswith("from the receipts") for line in lines)
    assert "1 workbooks compared; 2 to look at, 2 of them new." in said
    assert run(["integrity", SLUG, "--json", *course]) == 0
    assert json.loads(capsys.readouterr().out)["new"] == 0
    assert run(["release", SLUG, *course]) == 0
    pages = list((term.course.folder / "feedback" / SLUG).glob("*.html"))
    own = (term.course.folder / "feedback" / SLUG / f"{term.pids[0]}.html").read_text(encoding="utf-8")
    assert pages
    assert term.pids[1] not in own

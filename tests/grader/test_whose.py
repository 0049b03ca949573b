"""A person says whose a workbook is: its own code is gone, and the grader would otherwise never know."""

from __future__ import annotations

import io

import openpyxl
import pytest

from grader.collect import collect
from grader.errors import NoKeyError
from grader.gradebook import Gradebook
from grader.grading import Whose, grade_again, grade_files, waiting_files
from vml_course.cli import run
from vml_course.errors import InputError


def _without_code(workbook: bytes) -> bytes:
    """What is left when a student copies the visible sheets into a new workbook."""
    book = openpyxl.load_workbook(io.BytesIO(workbook))
    for name in [name for name in book.sheetnames if name.startswith("_")]:
        del book[name]
    out = io.BytesIO()
    book.save(out)
    return out.getvalue()


@pytest.fixture
def rebuilt(term):
    """Student 0's workbook without its code."""
    path = term.course.folder / "anna.xlsx"
    path.write_bytes(_without_code(term.file(0)))
    return path


def _whose(term, i: int) -> Whose:
    return Whose(term.pids[i], term.assignment.id, "ann")


def test_a_workbook_without_its_code_is_graded_when_a_person_says_whose_it_is(term, rebuilt) -> None:
    assert [item.status for item in grade_files(term.course, [rebuilt])] == ["unreadable"]
    (graded,) = grade_files(term.course, [rebuilt], whose=_whose(term, 0))
    assert (graded.status, graded.pid, graded.points) == ("ok", term.pids[0], graded.out_of)


def test_what_a_person_said_is_kept_with_who_said_it(term, rebuilt) -> None:
    grade_files(term.course, [rebuilt], whose=_whose(term, 0))
    with Gradebook.open(term.course) as book:
        (receipt,) = book.receipts("graded")
        assert (receipt.arrived.told_by, receipt.arrived.pid) == ("ann", term.pids[0])
        assert book.is_whole()
    (graded,) = grade_again(term.course, term.assignment.id)  # nobody has to say it twice
    assert (graded.status, graded.pid) == ("ok", term.pids[0])


def test_a_collected_file_keeps_its_receipt_and_leaves_the_list_of_ungraded(term, rebuilt) -> None:
    download = term.download(**{"s_901_1_lab.xlsx": rebuilt.read_bytes(), "odd name.xlsx": b"no"})
    collect(term.course, term.assignment.id, download)
    grade_files(term.course, [rebuilt], whose=_whose(term, 0))
    with Gradebook.open(term.course) as book:
        assert [one.arrived.source for one in book.receipts("graded")] == ["canvas"]
        assert book.receipts("unreadable") == ()
        assert [one.arrived.name for one in book.receipts("unmatched")] == ["odd name.xlsx"]


def test_numbers_of_another_students_video_are_not_graded_for_this_one(term) -> None:
    theirs = term.course.folder / "theirs.xlsx"
    theirs.write_bytes(term.file(1))
    (graded,) = grade_files(term.course, [theirs], whose=_whose(term, 0))
    assert graded.status == "unreadable"
    assert f"expected a workbook for the video of {term.pids[0]}, got the workbook of {term.pids[1]}" in graded.message


def test_a_student_without_a_variant_has_nothing_to_be_graded_by(term, rebuilt) -> None:
    with pytest.raises(InputError, match="expected a pseudonym of this course, got 's99'"):
        grade_files(term.course, [rebuilt], whose=Whose("s99", term.assignment.id, "ann"))
    with pytest.raises(NoKeyError):
        grade_files(term.course, [rebuilt], whose=Whose(term.pids[0], "two-pucks", "ann"))


@pytest.fixture
def copied(term):
    """Student 1 handed in the workbook of student 0; its file."""
    collect(term.course, term.assignment.id, term.download(**{"s_902_1_lab.xlsx": term.file(0)}))
    path = term.course.folder / "lab.xlsx"
    path.write_bytes(term.file(0))
    return path


@pytest.mark.parametrize("first", [(), (1,), (2,), (2, 1)])
def test_a_conflict_waits_until_it_is_graded_as_somebodys(term, copied, first) -> None:
    """Whoever is named wrongly before: only the owner's variant fits the numbers."""
    for other in first:
        (refused,) = grade_files(term.course, [copied], whose=_whose(term, other))
        assert refused.status == "unreadable"
        assert waiting_files(term.course, term.assignment.id) >= 1
    (graded,) = grade_files(term.course, [copied], whose=_whose(term, 0))
    assert (graded.status, graded.pid) == ("ok", term.pids[0])
    assert waiting_files(term.course, term.assignment.id) == 0
    with Gradebook.open(term.course) as book:
        assert book.is_whole()


def test_a_conflict_that_is_settled_is_none_when_it_comes_again(term, copied) -> None:
    grade_files(term.course, [copied], whose=_whose(term, 0))
    (again,) = collect(term.course, term.assignment.id, term.download(**{"s_902_1_lab.xlsx": term.file(0)}))
    assert (again.status, again.before, again.needs_attention) == ("duplicate", "settled", False)


def test_at_the_prompt(term, rebuilt, capsys) -> None:
    at = ["--course", str(term.course.folder)]
    whose = ["--whose", term.pids[0], "--assignment", term.assignment.id]
    assert run(["collect", term.assignment.id, str(term.download(**{"x.xlsx": rebuilt.read_bytes()})), *at]) == 1
    assert "vml grade FILE --whose STUDENT --assignment soccer-kick" in capsys.readouterr().out
    assert run(["grade", str(rebuilt), *at, *whose]) == 0
    assert term.pids[0] in capsys.readouterr().out
    assert run(["grade", *at, *whose]) == 2
    assert "--whose: expected files, and --assignment ID" in capsys.readouterr().err

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


def test_workbooks_of_another_assignment_are_said_to_be_collected_for_that_one(term, capsys) -> None:
    download, at = str(term.download(**{"s_901_1_lab.xlsx": term.file(0)})), ["--course", str(term.course.folder)]
    assert run(["collect", "two-pucks", download, *at]) == 1
    said = capsys.readouterr().out
    assert "expected a workbook of two-pucks, got one of soccer-kick." in said
    assert f"vml collect soccer-kick {download} --course {term.course.folder}\n" in said
    assert "--whose" not in said
    assert waiting_files(term.course) == 1
    assert run(["collect", "soccer-kick", download, *at]) == 0
    assert "1 matched." in capsys.readouterr().out
    assert run(["grade", *at]) == 0
    assert waiting_files(term.course) == 0
    assert run(["gradebook", "verify", *at]) == 0


def test_each_file_that_waits_has_the_advice_of_its_own_reason(term, rebuilt, capsys) -> None:
    download = str(term.download(**{"a.xlsx": term.file(0), "b.xlsx": rebuilt.read_bytes()}))
    assert run(["collect", "two-pucks", download, "--course", str(term.course.folder)]) == 1
    said = capsys.readouterr().out
    assert "vml collect soccer-kick" in said
    assert "vml grade FILE --whose STUDENT --assignment two-pucks" in said


@pytest.mark.parametrize(
    ("name", "parts", "got"),
    [
        ("my.xlsx", ("[Content_Types].xml", "xl/workbook.xml"), "a workbook. Grade it by itself: vml grade"),
        ("my.zip", ("xl/workbook.xml", "[Content_Types].xml"), "a workbook. Grade it by itself: vml grade"),
        ("my.ods", ("mimetype", "content.xml"), "a workbook. Grade it by itself: vml grade"),
        ("my.docx", ("[Content_Types].xml", "word/document.xml"), "a document. Name the zip or the folder"),
        ("my.odt", ("mimetype", "content.xml"), "a document. Name the zip or the folder"),
    ],
)
def test_one_document_is_no_download_and_nothing_of_it_is_kept(term, capsys, name, parts, got) -> None:
    path = term.download(**dict.fromkeys(parts, b"<x/>")).rename(term.course.folder / name)
    assert run(["collect", "soccer-kick", str(path), "--course", str(term.course.folder)]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"{path}: expected a zip as the platform gives it, or a folder, got {got}")
    assert said.count("\n") == 1
    assert not (term.course.folder / "inbox").exists()
    assert waiting_files(term.course) == 0


def test_a_workbook_that_was_filled_in_is_graded_as_the_refusal_says(term, capsys) -> None:
    path, at = term.course.folder / "my.xlsx", ["--course", str(term.course.folder)]
    path.write_bytes(term.file(0))
    assert run(["collect", "soccer-kick", str(path), *at]) == 2
    assert f"vml grade {path}" in capsys.readouterr().err
    assert run(["grade", str(path), *at]) == 0


@pytest.mark.parametrize(
    ("data", "got"),
    [
        (b"Student,ID\nAnn,1\n", "a text table (CSV)"),
        (b"%PDF-1.7", "a PDF document"),
        (b"PK\x03\x04 cut off", "a damaged or incomplete zip"),
        (b"", "an empty file"),
    ],
)
def test_what_is_no_zip_is_called_by_what_it_is(term, capsys, data, got) -> None:
    path = term.course.folder / "grades.csv"
    path.write_bytes(data)
    assert run(["collect", "soccer-kick", str(path), "--course", str(term.course.folder)]) == 2
    assert f"or a folder, got {got}. Download the submissions" in capsys.readouterr().err


def test_at_the_prompt(term, rebuilt, capsys) -> None:
    at = ["--course", str(term.course.folder)]
    whose = ["--whose", term.pids[0], "--assignment", term.assignment.id]
    assert run(["collect", term.assignment.id, str(term.download(**{"x.xlsx": rebuilt.read_bytes()})), *at]) == 1
    said = capsys.readouterr().out
    assert "vml grade FILE --whose STUDENT --assignment soccer-kick" in said
    assert "are collected for it" not in said
    assert run(["grade", str(rebuilt), *at, *whose]) == 0
    assert term.pids[0] in capsys.readouterr().out
    assert run(["grade", *at, *whose]) == 2
    assert "--whose: expected files, and --assignment ID" in capsys.readouterr().err

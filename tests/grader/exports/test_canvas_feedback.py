"""Canvas takes annotated workbooks back by the numbers in the names of its own download."""

from __future__ import annotations

import io
import zipfile

import openpyxl
import pytest
from sqlalchemy import update

from grader import tables
from grader.collect import collect
from grader.exporting import export_grades
from grader.gradebook import Gradebook
from grader.grading import grade_collected
from grader.lms import recognise
from grader.releasing import release_grades
from vml_course.cli import run

SLUG, TO = "soccer-kick", "canvas-feedback"


def exported(term) -> tuple[dict[str, bytes], dict[str, str]]:
    """Return the files of the zip, and by pseudonym what was said."""
    made = export_grades(term.course, SLUG, TO)
    with zipfile.ZipFile(made.file) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    return files, {line.pid: f"{line.status}: {line.reason}" for line in made.lines}


@pytest.fixture
def graded(term):
    """Two hand in on Canvas, the third by mail; all are graded and released."""
    names = {"ann_901_550_2027_..\\evil Ann.xlsx": term.file(0), "ben_LATE_902_551_lab.xlsx": term.file(1, e=0.1)}
    collect(term.course, SLUG, term.download(**names))
    by_mail = term.course.folder / "mail"
    by_mail.mkdir()
    (by_mail / "lab.xlsx").write_bytes(term.file(2))
    collect(term.course, SLUG, by_mail)
    grade_collected(term.course, SLUG)
    release_grades(term.course, SLUG, who="test")
    return term


def test_a_workbook_goes_back_under_the_numbers_that_it_came_with_and_no_name(graded):
    files, said = exported(graded)
    ann, ben, mailed = graded.pids
    assert set(files) == {f"vml-{ann}_901_550_feedback.xlsx", f"vml-{ben}_902_551_feedback.xlsx"}
    assert said[mailed] == "skipped: was not collected from a download of Canvas"
    for name in files:  # Canvas takes the first two parts that are numbers and nothing else
        assert [part for part in name.split("_") if part.isdigit()][:2] in (["901", "550"], ["902", "551"])
    feedback = openpyxl.load_workbook(io.BytesIO(files[f"vml-{ben}_902_551_feedback.xlsx"])).worksheets[0]
    assert feedback.title == "Feedback"
    assert feedback["A2"].value.startswith(ben)


def test_what_was_graded_anew_waits_for_the_next_release(graded):
    collect(graded.course, SLUG, graded.download(**{"ann_901_560_new.xlsx": graded.file(0, e=0.9)}))
    grade_collected(graded.course, SLUG)
    files, said = exported(graded)
    assert len(files) == 1
    assert said[graded.pids[0]] == "skipped: graded anew since the release: vml release"
    release_grades(graded.course, SLUG, who="test")
    assert f"vml-{graded.pids[0]}_901_560_feedback.xlsx" in exported(graded)[0]


def test_a_file_that_canvas_would_show_as_something_else_stays(term):
    collect(term.course, SLUG, term.download(**{"ann_901_550_lab.xlsm": term.file(0)}))
    grade_collected(term.course, SLUG)
    release_grades(term.course, SLUG, who="test")
    files, said = exported(term)
    assert files == {}
    assert said[term.pids[0]] == "skipped: Canvas would show the workbook as 'lab.xlsm', which would not open"
    assert said[term.pids[1]] == "no grade: nothing was released: left as it is"


def test_an_anonymous_download_is_answered_under_its_own_names(term):
    found = collect(term.course, SLUG, term.download(**{"anon_LATE_x7Ab2_550_lab.xlsx": term.file(0)}))
    assert [item.status for item in found] == ["matched"]
    grade_collected(term.course, SLUG)
    release_grades(term.course, SLUG, who="test")
    (name,) = exported(term)[0]
    again = recognise(name)
    assert (name, again.value, again.reference) == ("anon_x7Ab2_550_feedback.xlsx", "x7Ab2", "anon_x7Ab2_550")


def test_the_same_content_that_came_again_by_mail_still_goes_back_to_canvas(graded):
    again = graded.course.folder / "again"
    again.mkdir()
    (again / "lab.xlsx").write_bytes(graded.file(0))  # written anew: other bytes, the same content
    collect(graded.course, SLUG, again)
    grade_collected(graded.course, SLUG)
    release_grades(graded.course, SLUG, who="test")
    assert f"vml-{graded.pids[0]}_901_550_feedback.xlsx" in exported(graded)[0]


def test_a_receipt_with_the_number_of_the_file_alone_is_not_enough(graded):
    with Gradebook.open(graded.course) as book, book.writing() as connection:
        connection.execute(update(tables.receipt).values(lms_ref="1"))
    files, said = exported(graded)
    assert files == {}
    assert said[graded.pids[0]] == "skipped: was not collected from a download of Canvas"


def test_the_command_says_where_to_upload_it(graded, capsys):
    assert run(["export", SLUG, "--to", TO, "--course", str(graded.course.folder)]) == 1
    said = capsys.readouterr().out
    assert "Upload Submissions" in said
    assert "2 filled, 1 skipped" in said

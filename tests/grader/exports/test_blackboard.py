"""Blackboard's download: UTF-16, tabs, everything in quotes, called .xls."""

from __future__ import annotations

import pytest

from vml_course.errors import TableError

HEAD = (
    '"Last Name"\t"First Name"\t"Username"\t"Student ID"\t"Last Access"\t"Availability"\t'
    '"Soccer kick [Total Pts: 10 Score] |123456"\t"Quiz [Total Pts: up to 5 Score] |123457"\n'
)
ROWS = (
    '"Doe"\t"Jane"\t"jdoe"\t"S0012345"\t"2026-05-01 10:00:00"\t"Yes"\t"Needs Grading"\t"4.50"\n'
    '"Müller"\t"Jürg"\t"jmueller"\t"S2"\t""\t"Yes"\t""\t""\n'
    '"Smith"\t"Ana"\t"asmith1"\t"S3"\t""\t"Yes"\t"In Progress"\t""\n'
    '"New"\t"Nora"\t"nnew"\t"S5"\t""\t"Yes"\t"3.00"\t""\n'
)


def test_only_the_cells_that_are_meant_change(desk, swap) -> None:
    got = desk.run("blackboard", (HEAD + ROWS).encode("utf-16"))
    assert got.startswith(b"\xff\xfe")
    wanted = swap(HEAD + ROWS, ('"Needs Grading"', '"8.5"'), ('"S2"\t""\t"Yes"\t""', '"S2"\t""\t"Yes"\t"6.17"'))
    assert got == wanted.encode("utf-16")


def test_work_in_progress_stays(desk) -> None:
    got = desk.run("blackboard", (HEAD + ROWS).encode("utf-16"), students=desk.job.students[:3])
    assert '"In Progress"' in got.decode("utf-16")
    assert desk.lines["Ana Smith"].reason == "it holds 'In Progress', which stays"


def test_no_column_is_ever_added(desk) -> None:
    with pytest.raises(TableError, match="--column"):
        desk.run("blackboard", HEAD.replace("Soccer kick", "Lab 3").encode("utf-16"))
    got = desk.run("blackboard", (HEAD + ROWS).encode("utf-16"))
    assert {len(line.split("\t")) for line in got.decode("utf-16").splitlines()} == {8}


def test_the_comma_separated_form_in_utf_8_is_filled_as_well(desk) -> None:
    text = "\ufeff" + (HEAD + ROWS).replace("\t", ",")
    got = desk.run("blackboard", text.encode(), column="Quiz")
    assert got.decode() == text.replace('"S2","","Yes","",""', '"S2","","Yes","","3.09"').replace(
        '"4.50"', '"4.25"'
    ).replace('"In Progress",""', '"In Progress","5"')


@pytest.mark.parametrize("head", ['"Last Name"\t"First Name"\t"Username"\n', '"A"\t"Kick [10] |1"\n'])
def test_what_is_no_download_of_blackboard_is_refused(desk, head) -> None:
    with pytest.raises(TableError, match="grade centre"):
        desk.run("blackboard", head.encode("utf-16"))

"""The gradebook of Canvas, as it exports it."""

from __future__ import annotations

import pytest

from vml_course.errors import InputError, TableError

HEAD = "Student,ID,SIS User ID,SIS Login ID,Section,Soccer kick (4711),Quiz 1 (4712),Final Score\r\n"
PEOPLE = (
    "    Points Possible,,,,,10,5,(read only)\r\n"
    '"Doe, Jane",90210,S0012345,jdoe,ME-101-01,,4.5,88.20\r\n'
    '"Müller, Jürg",90211,S2,jmueller,ME-101-01,3.00,-,\r\n'
    '"Smith, Ana",1,S3,asmith1,ME-101-01,EX,,\r\n'
    '"Smith, Ana",2,S4,asmith2,ME-101-01,-,EX,\r\n'
    '"New, Nora",5,S5,nnew,"ME, night",7.5,,\r\n'
    '"Gone, Guy",7,S6,ggone,ME-101-01,,,\r\n'
    '"Who, Ever",99,S99,ever,ME-101-01,2,1,\r\n'
    '"Student, Test",13,,abc123,ME-101-01,,,\r\n'
)
CANVAS = "\ufeff" + HEAD + ",,,,,Manual Posting,,\r\n" + PEOPLE


def test_only_the_cells_that_are_meant_change(desk, swap) -> None:
    got = desk.run("canvas", CANVAS.encode())
    wanted = swap(
        CANVAS,
        ("jdoe,ME-101-01,,", "jdoe,ME-101-01,8.5,"),
        ("jmueller,ME-101-01,3.00,", "jmueller,ME-101-01,6.17,"),
        ("asmith2,ME-101-01,-,", "asmith2,ME-101-01,0,"),
    )
    assert got.decode() == wanted


def test_the_rows_above_the_students_stand_in_either_order(desk) -> None:
    possible, *people = PEOPLE.splitlines(keepends=True)
    posted, turned = ",,,,,Manual Posting,,\r\n", desk.run("canvas", CANVAS.encode()).decode()
    lines = dict(desk.lines)
    got = desk.run("canvas", ("\ufeff" + HEAD + possible + posted + "".join(people)).encode()).decode()
    assert got == turned.replace(posted + possible, possible + posted)
    assert desk.lines == lines


def test_the_table_says_what_became_of_everybody(desk) -> None:
    desk.run("canvas", CANVAS.encode())
    said = {name: (line.status, line.points, line.reason) for name, line in desk.lines.items()}
    assert said["Jane Doe"] == ("filled", "8.5", "17 of 20, scaled to 10")
    assert said["Jürg Müller"] == ("filled", "6.17", "12.35 of 20, scaled to 10; was 3.00")
    assert said["Nora New"] == ("no grade", "", "nothing was released: left as it is")
    assert said["Guy Gone"] == ("skipped", "", "dropped from the course")
    assert said["Who, Ever"][0] == "skipped"
    assert "class list" in said["Who, Ever"][2]
    assert "Student, Test" not in said


def test_excused_stays(desk) -> None:
    got = desk.run("canvas", CANVAS.replace("asmith2,ME-101-01,-", "asmith2,ME-101-01,ex").encode())
    assert b"asmith1,ME-101-01,EX," in got
    assert desk.lines["Ana Smith"].reason == "excused (EX), which stays"


def test_a_score_is_never_cleared_and_marks_stay(desk) -> None:
    template = CANVAS.replace("jdoe,ME-101-01,,", "jdoe,ME-101-01,N/A,")
    got = desk.run("canvas", template.encode())
    assert b'nnew,"ME, night",7.5,' in got
    assert b"jdoe,ME-101-01,N/A," in got
    assert desk.lines["Jane Doe"].status == "skipped"


def test_the_same_score_at_two_decimals_is_no_change(desk) -> None:
    got = desk.run("canvas", CANVAS.replace("jdoe,ME-101-01,,", "jdoe,ME-101-01,8.50,").encode())
    assert b"jdoe,ME-101-01,8.50," in got
    assert desk.lines["Jane Doe"].status == "unchanged"


def test_graded_students_without_a_row_are_told(desk) -> None:
    template = "".join(line for line in CANVAS.splitlines(keepends=True) if "jdoe" not in line)
    desk.run("canvas", template.encode())
    assert desk.lines["Jane Doe"].status == "not in template"
    assert desk.lines["Jane Doe"].needs_attention


def test_semicolons_and_decimal_commas_are_kept(desk) -> None:
    template = (
        "Student;ID;SIS User ID;SIS Login ID;Section;Soccer kick (4711);Quiz 1 (4712)\n"
        "    Points Possible;;;;;10,00;5,00\n"
        "Doe, Jane;90210;S0012345;jdoe;ME;;4,50\n"
    )
    assert desk.run("canvas", template.encode()).decode() == template.replace("ME;;", "ME;8,5;")


def test_a_decimal_comma_between_commas_is_quoted(desk) -> None:
    got = desk.run("canvas", CANVAS.encode(), decimal="comma")
    assert b'jdoe,ME-101-01,"8,5",4.5' in got


def test_points_are_not_scaled_where_the_maximum_is_the_same_or_unknown(desk) -> None:
    got = desk.run("canvas", CANVAS.replace(",10,5,", ",20,5,").encode())
    assert b"jdoe,ME-101-01,17,4.5" in got
    assert desk.lines["Jane Doe"].reason == ""
    template = "".join(line for line in CANVAS.splitlines(keepends=True) if "Possible" not in line)
    assert b"jdoe,ME-101-01,17,4.5" in desk.run("canvas", template.encode())


def test_large_scores_have_no_mark_between_thousands(desk) -> None:
    assert b"jdoe,ME-101-01,1020,4.5" in desk.run("canvas", CANVAS.replace(",10,5,", ",1200,5,").encode())


def test_the_column_may_be_named_with_or_without_its_number(desk) -> None:
    for name in ("Quiz 1 (4712)", "quiz 1"):
        assert b"jdoe,ME-101-01,,4.25," in desk.run("canvas", CANVAS.encode(), column=name)


@pytest.mark.parametrize(
    ("before", "after", "column", "words"),
    [
        ("Soccer kick (4711)", "Lab 3 (4711)", "", "--column"),
        ("Quiz 1 (4712)", "Soccer kick (9)", "", "'Soccer kick \\(9\\)'"),
        ("Quiz 1", "Quiz 1", "Final Score", "reckons itself"),
    ],
)
def test_a_column_that_is_not_clear_is_asked_about(desk, before, after, column, words) -> None:
    with pytest.raises(TableError, match=words):
        desk.run("canvas", CANVAS.replace(before, after).encode(), column=column)


@pytest.mark.parametrize(
    "head",
    [
        "Student,ID,SIS User ID,Section",  # what Canvas itself refuses: a login must follow
        "Student,ID,SIS Login ID,SIS User ID,Section",
        "Student,ID,SIS User ID,SIS Login ID,Email,Section",
        "Student,ID,Kick",
        "name,email",
    ],
)
def test_headings_that_canvas_refuses_are_refused_before(desk, head) -> None:
    with pytest.raises(TableError, match="Export the gradebook anew"):
        desk.run("canvas", f"{head},Soccer kick (4711)\n".encode())


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("Student,ID,Section", '"Doe, Jane",90210,ME'),
        ("Student,ID,SIS Login ID,Section", '"Doe, Jane",,jdoe,ME'),
        ("Student,ID,SIS Login ID,Section", '"Doe, J.",,jane@x.edu,ME'),
        ("Student,ID,SIS User ID,SIS Login ID,Integration ID,Root Account,Section", '"D",,S0012345,,,x.edu,ME'),
        ("LastName,FirstName,ID,Section", "Doe,Jane,,ME"),
    ],
)
def test_every_order_of_headings_that_canvas_writes_is_understood(desk, head, row) -> None:
    got = desk.run("canvas", f"{head},Soccer kick (4711)\n{row},\n".encode())
    assert got.decode() == f"{head},Soccer kick (4711)\n{row},17\n"


def test_two_of_one_name_are_told_apart_or_left_alone(desk) -> None:
    head = "Student,ID,Section,Soccer kick (4711)\n"
    assert desk.run("canvas", f'{head}"Smith, Ana",2,A,\n'.encode()).endswith(b"2,A,0\n")
    assert desk.run("canvas", f'{head}"Smith, Ana",,A,\n'.encode()).endswith(b",A,\n")
    assert "does not say which" in desk.lines["Smith, Ana"].reason
    twice = f'{head}"Doe, Jane",,A,\n"Doe, Jane",,B,\n'.encode()
    assert desk.run("canvas", twice) == twice


def test_numbers_that_contradict_a_name_are_believed(desk) -> None:
    head = "Student,ID,SIS User ID,SIS Login ID,Section,Soccer kick (4711)\n"
    other = f'{head}"Doe, Jane",555,S9,jdoe9,A,\n'.encode()
    assert desk.run("canvas", other) == other
    assert "other numbers" in desk.lines["Doe, Jane"].reason
    mixed = f'{head}"Doe, Jane",90210,S2,,A,\n'.encode()
    assert desk.run("canvas", mixed) == mixed
    assert "two students" in desk.lines["Doe, Jane"].reason


def test_without_a_template_it_says_which_file_is_meant(desk) -> None:
    with pytest.raises(InputError, match="gradebook of Canvas exports"):
        desk.run("canvas")


def test_points_that_a_person_has_still_to_confirm_are_said_to_be_open_written_or_there_before(desk) -> None:
    unsettled = frozenset({"jane2345", "jurg2345", "anab2345"})
    desk.run(
        "canvas", CANVAS.replace("jmueller,ME-101-01,3.00", "jmueller,ME-101-01,6.17").encode(), unsettled=unsettled
    )
    jane, juerg = desk.lines["Jane Doe"], desk.lines["Jürg Müller"]
    assert jane.reason == "open: up to 17 of 20, a person has to look; 17 of 20, scaled to 10"
    assert (juerg.status, juerg.is_open) == ("unchanged", True)
    assert juerg.reason.startswith("open: up to 12.35 of 20, a person has to look")
    assert not desk.lines["Ana Smith"].is_open  # excused: nothing of hers was written

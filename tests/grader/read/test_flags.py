"""No flag without words, and no flag that the reader raises in another way."""

from __future__ import annotations

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import grader.read
from grader.flags import FOR_PERSON, FOR_PERSON_OF_TABLE, FOR_STUDENT, HARMLESS
from grader.grade import grade
from grader.model import Outcome
from grader.read.flags import Flag

READER = Path(grader.read.__file__).parent


def raised() -> set[str]:
    """Every `Flag.X` in the reader's code."""
    files = [file for file in READER.glob("*.py") if file.name != "flags.py"]
    nodes = [node for file in files for node in ast.walk(ast.parse(file.read_text("utf-8")))]
    return {
        node.attr
        for node in nodes
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "Flag"
    }


def test_every_flag_has_words_for_the_student_and_a_place_for_the_person():
    assert set(FOR_STUDENT) == set(Flag)
    assert sorted([*FOR_PERSON, *FOR_PERSON_OF_TABLE, *HARMLESS]) == sorted(Flag)
    assert all(words.endswith(".") for words in (*FOR_STUDENT.values(), *FOR_PERSON.values()))


def test_every_flag_is_one_that_the_reader_raises():
    assert raised() == set(Flag.__members__)


def graded(desk, flags, tracking=None):
    table = desk.table if tracking is None else tracking
    submission = replace(desk.read(desk.workbook().read_bytes()), flags=flags, tracking=table)
    return grade(submission, desk.key, desk.assignment)


def finding(result):
    return next(f for f in result.findings if f.aspect == "table")


@pytest.mark.parametrize("flag", sorted(FOR_PERSON))
def test_a_person_looks_whatever_the_workbook_says(desk, flag):
    assert graded(desk, (flag,)).reasons == (FOR_PERSON[flag],)


@pytest.mark.parametrize("flag", sorted([*HARMLESS, *FOR_PERSON_OF_TABLE]))
def test_nobody_looks_where_the_table_is_right_all_the_same(desk, flag):
    result = graded(desk, (flag,))
    assert finding(result).outcome is Outcome.RIGHT
    assert (result.status, result.reasons) == ("ok", ())
    assert FOR_STUDENT[flag] not in finding(result).message


@pytest.mark.parametrize("flag", sorted(FOR_PERSON_OF_TABLE))
def test_where_the_table_is_not_right_its_cells_are_told_to_both(desk, flag):
    short = {name: column[:3] for name, column in desk.table.items()}
    result = graded(desk, (flag,), short)
    assert FOR_PERSON_OF_TABLE[flag] in result.reasons
    assert "10 rows" in finding(result).message
    if flag is not Flag.UNNAMED_POINTS:  # names are named one by one
        assert FOR_STUDENT[flag] in finding(result).message


def renamed(table, *names):
    return {name.replace(*names): column for name, column in table.items()}


def test_points_with_other_names_are_left_to_a_person_and_the_student_is_told_what_to_do(desk):
    table = desk.table
    for number, point in enumerate(desk.key.points):
        table = renamed(table, point, f"mass_{number}")
    found = finding(graded(desk, (Flag.UNNAMED_POINTS,), table))
    assert found.outcome is Outcome.UNSURE
    assert found.points == found.out_of
    assert "mass_0, mass_1, mass_2" in found.message
    assert "foot, knee, ball" in found.message
    assert "Call the columns foot_x_m, foot_y_m" in found.message
    assert "no tracking table" not in found.message


def test_one_point_with_another_name_is_left_to_a_person_too(desk):
    found = finding(graded(desk, (Flag.UNNAMED_POINTS,), renamed(desk.table, "ball", "sphere")))
    assert found.outcome is Outcome.UNSURE
    assert "sphere; the assignment's are ball." in found.message


def test_a_value_is_held_for_what_its_table_lacks(desk):
    table = renamed(renamed(renamed(desk.table, "ball", "a"), "foot", "b"), "knee", "c")
    said = [f.message for f in graded(desk, (), table).of("e") if f.aspect == "value"]
    assert "your tracking table cannot be compared with your video" in said[0]


def test_a_point_too_many_does_no_harm(desk):
    table = {**desk.table, "toe_x_m": desk.table["foot_x_m"], "toe_y_m": desk.table["foot_y_m"]}
    assert finding(graded(desk, (), table)).outcome is Outcome.RIGHT


def test_pixels_alone_are_told_to_be_pixels(desk):
    found = finding(graded(desk, (), renamed(desk.table, "_m", "_px")))
    assert found.outcome is Outcome.UNSURE
    assert "in pixels only: metres" in found.message


def test_names_without_end_are_cut(desk):
    table = {f"p{i}_{axis}_m": np.arange(60.0) for i in range(40) for axis in "xy"} | {"frame": np.arange(60.0)}
    message = finding(graded(desk, (), table)).message
    assert message.count("p1") < 10
    assert len(message) < 300

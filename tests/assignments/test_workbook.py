"""The student's workbook: what can be typed where, and that it tells nothing."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from openpyxl import load_workbook

from assignments.load import load_assignment
from assignments.variants import draw_variant, given_values
from assignments.workbook import fill_workbook, write_workbook
from vml_course.errors import FileMissingError, UnknownNameError
from vml_course.model.reading import UNITS, read_quantity

KICK = load_assignment("soccer-kick")
VARIANT = draw_variant(KICK, bytes(32), "s1")
GIVEN = given_values(KICK, VARIANT)


@pytest.fixture
def blank(tmp_path: Path) -> Path:
    path = tmp_path / "workbook.xlsx"
    write_workbook(path, KICK, VARIANT, GIVEN)
    return path


def test_every_question_has_a_named_value_cell_and_a_named_unit_cell(blank: Path) -> None:
    names = set(load_workbook(blank).defined_names)
    assert names == {f"{kind}_{question.id}" for question in KICK.questions for kind in ("ans", "unit")}


def test_only_what_is_to_be_typed_is_open(blank: Path) -> None:
    book = load_workbook(blank)
    assert all(sheet.protection.sheet == (sheet.title != "Tracking") for sheet in book)  # there, all may be pasted over
    assert not any(sheet.protection.password for sheet in book)
    open_cells = {cell.coordinate for row in book["Answers"] for cell in row if not cell.protection.locked}
    named = {
        book.defined_names[f"{kind}_{question.id}"].attr_text.split("!")[1].replace("$", "")
        for question in KICK.questions
        for kind in (("ans",) if question.dimension == "number" else ("ans", "unit"))
    }
    assert open_cells == named
    assert not any(not cell.protection.locked for row in book["Instructions"] for cell in row)
    assert all(cell.protection.locked for cell in book["Tracking"][1])
    assert sum(not row[0].protection.locked for row in book["Tracking"].iter_rows(min_row=2)) == 600


def test_the_tracking_header_names_points_and_units(blank: Path) -> None:
    header = [cell.value for cell in load_workbook(blank)["Tracking"][1] if cell.value]
    points = ["foot_x_m", "foot_y_m", "knee_x_m", "knee_y_m", "ball_x_m", "ball_y_m"]
    assert header == ["frame", "t_s", *points]


def test_the_students_own_numbers_are_on_the_first_sheet(blank: Path) -> None:
    rows = [[cell.value for cell in row] for row in load_workbook(blank)["Instructions"]]
    told = {row[1]: row[3] for row in rows if row[1] and isinstance(row[3], int | float)}
    assert told == {given.label: GIVEN[given.id] for given in KICK.givens}


def test_the_hidden_sheet_holds_codes_and_no_number(blank: Path) -> None:
    sheet = load_workbook(blank)["_meta"]
    assert sheet.sheet_state == "veryHidden"
    assert dict(sheet.values) == {
        "format": "1",
        "assignment": "soccer-kick",
        "assignment_version": KICK.version,
        "variant_code": VARIANT.code,
        "signature": VARIANT.signature,
    }


def test_every_unit_offered_is_one_that_the_reader_knows(blank: Path) -> None:
    lists = [v for v in load_workbook(blank)["Answers"].data_validations.dataValidation if v.type == "list"]
    offered = [v.formula1.strip('"').split(",") for v in lists]
    assert len(offered) == len({question.dimension for question in KICK.questions} - {"number"})
    for units in offered:
        dimension = next(name for name, known in UNITS.items() if set(units) <= set(known))
        assert all(read_quantity(f"1 {unit}", dimension).unit == unit for unit in units)


def test_checks_warn_and_never_refuse(blank: Path) -> None:
    checks = load_workbook(blank)["Answers"].data_validations.dataValidation
    assert {check.errorStyle for check in checks} == {"warning"}
    assert all(len(check.prompt or "") <= 255 and len(check.promptTitle or "") <= 32 for check in checks)
    assert all(len(check.formula1) <= 255 for check in checks)


def test_there_is_no_formula(blank: Path) -> None:
    assert not any(cell.data_type == "f" for sheet in load_workbook(blank) for row in sheet for cell in row)


def test_the_same_variant_gives_the_same_bytes_and_no_date(blank: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.xlsx"
    write_workbook(again, KICK, VARIANT, GIVEN)
    assert again.read_bytes() == blank.read_bytes()
    with zipfile.ZipFile(blank) as archive:
        assert {member.date_time[0] for member in archive.infolist()} == {1980}
        core = archive.read("docProps/core.xml").decode()
    assert core.count("2000-01-01T00:00:00Z") == 2
    assert "openpyxl" not in core


def test_answers_typed_into_a_copy_are_found_there(blank: Path, tmp_path: Path) -> None:
    filled = tmp_path / "filled.xlsx"
    tracking = {"frame": np.arange(3), "foot_x_m": [0.1, np.nan, 0.3]}
    fill_workbook(blank, filled, {"e": 0.73, "I": "1,88"}, {"I": "kg m^2"}, tracking)
    book = load_workbook(filled)

    def value(name: str) -> object:
        sheet, place = next(book.defined_names[name].destinations)
        return book[sheet][place].value

    assert (value("ans_e"), value("ans_I"), value("unit_I"), value("ans_v_b2")) == (0.73, "1,88", "kg m^2", None)
    assert [cell.value for cell in book["Tracking"]["A"][1:4]] == [0, 1, 2]
    assert [cell.value for cell in book["Tracking"]["C"][1:5]] == [0.1, None, 0.3, None]
    assert len(book["Answers"].data_validations.dataValidation) == len(
        load_workbook(blank)["Answers"].data_validations.dataValidation
    )
    assert book["_meta"].sheet_state == "veryHidden"


@pytest.mark.parametrize(
    ("answers", "tracking", "message"),
    [({"g": 9.81}, {}, "cell: expected one of .*ans_v_b2"), ({}, {"hip_x_m": [1.0]}, "column: expected one of frame")],
)
def test_what_has_no_place_is_refused(
    blank: Path, tmp_path: Path, answers: dict[str, float], tracking: dict[str, list[float]], message: str
) -> None:
    with pytest.raises(UnknownNameError, match=message):
        fill_workbook(blank, tmp_path / "filled.xlsx", answers, {}, tracking)
    assert not (tmp_path / "filled.xlsx").exists()


def test_a_workbook_that_is_not_there_is_said_so(tmp_path: Path) -> None:
    with pytest.raises(FileMissingError):
        fill_workbook(tmp_path / "none.xlsx", tmp_path / "filled.xlsx", {}, {})

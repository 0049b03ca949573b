"""What students really do to a workbook is understood, or asked about."""

from __future__ import annotations

import datetime as dt
import io
import zipfile

import numpy as np
import openpyxl
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openpyxl.workbook.defined_name import DefinedName

from grader.model import Kind
from grader.read import ReadRequest, read_workbook
from grader.read.locate import claims_of, find_submission
from grader.read.parts import shows_date
from grader.read.sheet import address_of, place_of
from grader.stated import Stated, Unstated, state
from grader.template import template_cells
from vml_course.model.reading import UNITS


def saved(book: openpyxl.Workbook) -> bytes:
    content = io.BytesIO()
    book.save(content)
    return content.getvalue()


def cell(book: openpyxl.Workbook, name: str):
    sheet, place = next(book.defined_names[name].destinations)
    return book[sheet][place]


def edited(data: bytes, edit) -> bytes:
    book = openpyxl.load_workbook(io.BytesIO(data), rich_text=True)
    edit(book)
    return saved(book)


def with_part(data: bytes, name: str, content: bytes) -> bytes:
    result = io.BytesIO(data)
    with zipfile.ZipFile(result, "a") as archive:
        archive.writestr(name, content)
    return result.getvalue()


def test_a_filled_workbook_is_read_whole(desk):
    submission = desk.read(desk.workbook().read_bytes())
    assert submission.assignment_id == "soccer-kick"
    assert submission.code == "CODE1"
    assert submission.flags == ()
    for name, value in desk.truth.items():
        assert submission.answer(name).number == value
        assert submission.answer(name).found_by == "name"
        assert submission.answer(name).unit_text == desk.units.get(name, "")
    assert list(submission.tracking)[:3] == ["frame", "t_s", "foot_x_m"]
    assert submission.tracking["ball_x_m"].shape == (60,)


def test_the_template_has_its_answers_where_we_say(desk):
    submission = desk.read(desk.workbook().read_bytes())
    assert {name: answer.where for name, answer in submission.answers.items()} == template_cells(desk.assignment)


def test_without_names_answers_are_found_by_their_labels(desk):
    def edit(book):
        for name in list(book.defined_names):
            del book.defined_names[name]
        book["Answers"].title = "answers (2)"

    submission = desk.read(edited(desk.workbook().read_bytes(), edit))
    for name, value in desk.truth.items():
        assert (submission.answer(name).number, submission.answer(name).found_by) == (value, "label")
        assert submission.answer(name).unit_text == desk.units.get(name, "")


def test_moved_rows_are_found_by_name_or_label(desk):
    def edit(book):
        answers = book["Answers"]
        for name in list(book.defined_names):
            del book.defined_names[name]
        answers.insert_rows(1, amount=7)
        answers.insert_cols(1, amount=2)

    submission = desk.read(edited(desk.workbook().read_bytes(), edit))
    assert {name: submission.answer(name).number for name in desk.truth} == desk.truth


def test_without_names_and_labels_the_template_address_holds(desk):
    def edit(book):
        for name in list(book.defined_names):
            del book.defined_names[name]
        for row in book["Answers"].iter_rows(min_row=5, max_col=2):
            for item in row:
                item.value = None

    book = read_workbook(ReadRequest("w.xlsx", edited(desk.workbook().read_bytes(), edit)))
    submission = find_submission(book, desk.assignment.questions, template_cells(desk.assignment))
    assert {name: submission.answer(name).number for name in desk.truth} == desk.truth
    assert submission.answer("e").found_by == "address"
    assert find_submission(book, desk.assignment.questions).answer("e").kind is Kind.BLANK


def test_a_renamed_sheet_keeps_its_names(desk):
    submission = desk.read(edited(desk.workbook().read_bytes(), lambda b: setattr(b["Tracking"], "title", "Données")))
    assert submission.tracking["ball_x_m"].size == 60
    assert submission.answer("e").number == desk.truth["e"]


def test_a_lost_reference_falls_back_on_the_label(desk):
    def edit(book):
        book.defined_names["ans_e"] = DefinedName("ans_e", attr_text="Answers!#REF!")

    assert desk.read(edited(desk.workbook().read_bytes(), edit)).answer("e").found_by == "label"


@pytest.mark.parametrize("keeps_names", [True, False])
def test_a_row_inserted_by_a_program_that_leaves_names_behind_is_seen_by_the_labels(desk, keeps_names):
    def edit(book):
        book["Answers"].insert_rows(9)
        if not keeps_names:
            for name in list(book.defined_names):
                del book.defined_names[name]

    book = read_workbook(ReadRequest("w.xlsx", edited(desk.workbook({"v_b2": ""}).read_bytes(), edit)))
    submission = find_submission(book, desk.assignment.questions, template_cells(desk.assignment))
    expected = {**desk.truth, "v_b2": None}
    assert {name: submission.answer(name).number for name in desk.truth} == expected
    assert submission.answer("v_b2").kind is Kind.BLANK
    assert submission.answer("I").unit_text == "kg m^2"


def test_a_whole_export_may_be_pasted_over_the_tracking_sheet(desk):
    """More columns, another order, pixels beside metres: columns are found by their headings."""
    original = desk.read(desk.workbook().read_bytes()).tracking
    names = [
        "frame",
        "step",
        "t_s",
        *(f"{p}_{a}_{u}" for p in ("ball", "foot", "knee") for u in ("px", "m") for a in "xy"),
    ]

    def edit(book):
        sheet = book["Tracking"]
        assert not sheet.protection.sheet
        for column, name in enumerate(names, start=1):
            values = original.get(name, np.arange(60.0))
            for row, value in enumerate([name, *values.tolist()], start=1):
                sheet.cell(row, column).value = value

    pasted = desk.read(edited(desk.workbook().read_bytes(), edit)).tracking
    for name, column in original.items():
        np.testing.assert_array_equal(pasted[name], column)


def test_two_labels_alike_are_not_guessed_between(desk):
    def edit(book):
        del book.defined_names["ans_e"]
        for text in ("Coefficient of restitution", "e"):
            book["Answers"].append([text, "", 0.1])

    answer = desk.read(edited(desk.workbook().read_bytes(), edit)).answer("e")
    assert (answer.kind, answer.found_by, answer.text) == (Kind.TEXT, "several", f"{desk.truth['e']}, 0.1")


def test_an_answer_inside_a_merged_range_is_read_from_its_corner(desk):
    def edit(book):
        place = cell(book, "ans_e")
        book["Answers"].merge_cells(start_row=place.row, end_row=place.row, start_column=3, end_column=4)
        book.defined_names["ans_e"] = DefinedName("ans_e", attr_text=f"Answers!$D${place.row}")

    assert desk.read(edited(desk.workbook().read_bytes(), edit)).answer("e").number == desk.truth["e"]


# ---------------------------------------------------------------- kinds of cells


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (0.73, Kind.NUMBER),
        ("0,73", Kind.TEXT),
        (True, Kind.BOOL),
        (dt.date(2026, 5, 1), Kind.DATE),
        (dt.time(1, 30), Kind.DATE),
        ("=1/0", Kind.UNCACHED),
        ("#DIV/0!", Kind.ERROR),
        (None, Kind.BLANK),
        ("   ", Kind.BLANK),
    ],
)
def test_every_kind_of_cell_is_told_apart(desk, value, kind):
    data = edited(desk.workbook().read_bytes(), lambda book: setattr(cell(book, "ans_e"), "value", value))
    assert desk.read(data).answer("e").kind is kind


def calculated(data: bytes, formula: str, value: str, kind: str = "") -> bytes:
    """Give the formula of `ans_e` the value that a spreadsheet program stored."""
    data = edited(data, lambda book: setattr(cell(book, "ans_e"), "value", f"={formula}"))
    source, result = io.BytesIO(data), io.BytesIO()
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(result, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            for empty in (b"<v></v>", b"<v/>", b"<v />"):
                content = content.replace(
                    f"<f>{formula}</f>".encode() + empty, f"<f>{formula}</f><v>{value}</v>".encode()
                )
            if kind:
                at = content.find(f"<f>{formula}</f>".encode())
                start = content.rfind(b"<c ", 0, at)
                content = content[: start + 3] + f't="{kind}" '.encode() + content[start + 3 :] if at > 0 else content
            new.writestr(name, content)
    return result.getvalue()


def test_a_formula_gives_its_stored_value(desk):
    answer = desk.read(calculated(desk.workbook().read_bytes(), "C13/C12", "0.73")).answer("e")
    assert (answer.kind, answer.number) == (Kind.NUMBER, 0.73)


def test_a_formula_to_another_workbook_is_flagged(desk):
    data = calculated(desk.workbook().read_bytes(), "'[Friend.xlsx]Answers'!C13", "0.73")
    assert desk.read(data).flags == ("formula-to-other-workbook",)


@pytest.mark.parametrize("shown", ["general", "0.00", '0.00" m/s"', "0%"])
def test_the_format_of_a_number_does_not_change_it(desk, shown):
    data = edited(desk.workbook().read_bytes(), lambda book: setattr(cell(book, "ans_e"), "number_format", shown))
    assert desk.read(data).answer("e").number == desk.truth["e"]


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("yyyy-mm-dd", True),
        ("[h]:mm", True),
        ("d. mmmm", True),
        ("[$-407]d. mmm", True),
        ("0.00", False),
        ('0.00" days"', False),
        ("[Red]0.0", False),
        ("0.00E+00", False),
        ("General", False),
        ("", False),
        ("date", True),
    ],
)
def test_date_formats_are_known_by_their_letters(code, expected):
    assert shows_date(code) is expected


@given(st.integers(1, 1_048_576), st.integers(1, 16_384))
@settings(deadline=None)
def test_addresses_and_places_are_inverse(row, column):
    assert place_of(address_of((row, column))) == (row, column)


# ---------------------------------------------------------------- numbers and units


@pytest.mark.parametrize(
    ("question", "value", "unit", "expected"),
    [
        ("v_f1", "0,73", "m/s", 0.73),
        ("v_f1", "\u22120.73", "m/s", -0.73),
        ("v_f1", "73 cm/s", "", 0.73),
        ("v_f1", "73 cm/s", "m/s", 0.73),
        ("v_f1", 36.0, "km/h", 10.0),
        ("I", "0,73 kg·m²", "", 0.73),
        ("I", 7300.0, "kg cm^2", 0.73),
        ("I", 0.73, "N m s^2", 0.73),
        ("omega1", 180.0, "deg/s", np.pi),
        ("px_per_m", 5.0, "px/cm", 500.0),
        ("px_per_m", 0.002, "m/px", 500.0),
        ("fps", "480 fps", "", 480.0),
        ("e", "73 %", "", 0.73),
    ],
)
def test_numbers_are_read_with_their_units(desk, question, value, unit, expected):
    submission = desk.read(desk.workbook({question: value}, {question: unit}).read_bytes())
    stated = state(submission.answer(question), desk.assignment.question(question))
    assert isinstance(stated, Stated)
    assert stated.value == pytest.approx(expected, rel=1e-12)
    assert stated.unit_given


@pytest.mark.parametrize("value", ["1,234", "12.5.2024", "about 15", "nan", "9**9**9", "0x1F", "#N/A"])
def test_texts_that_are_no_single_number_are_not_guessed(desk, value):
    submission = desk.read(desk.workbook({"v_f1": value}).read_bytes())
    assert isinstance(state(submission.answer("v_f1"), desk.assignment.question("v_f1")), Unstated)


@given(
    st.floats(-1e6, 1e6, allow_subnormal=False).filter(lambda x: abs(x) > 1e-6),
    st.sampled_from(sorted(UNITS["velocity"])),
)
@settings(deadline=None, max_examples=15)
def test_any_number_in_any_unit_survives_the_workbook(assignment, good_bytes, value, unit):
    def edit(book):
        cell(book, "ans_v_b2").value, cell(book, "unit_v_b2").value = value, unit

    book = read_workbook(ReadRequest("w.xlsx", edited(good_bytes, edit)))
    stated = state(find_submission(book, assignment.questions).answer("v_b2"), assignment.question("v_b2"))
    assert isinstance(stated, Stated)
    assert stated.value == pytest.approx(value * UNITS["velocity"][unit], rel=1e-12)


# ---------------------------------------------------------------- flags


def test_cells_far_away_are_ignored_and_flagged(desk):
    """Excel's Solver keeps its settings there; they are no attack."""
    data = edited(desk.workbook().read_bytes(), lambda b: setattr(b["Answers"]["XFD1048576"], "value", 1))
    submission = desk.read(data)
    assert submission.flags == ("far-cells",)
    assert submission.answer("e").number == desk.truth["e"]


@pytest.mark.parametrize(
    ("part", "flag"), [("xl/vbaProject.bin", "macros"), ("xl/externalLinks/externalLink1.xml", "links")]
)
def test_macros_and_links_are_flagged_and_not_followed(desk, part, flag):
    assert desk.read(with_part(desk.workbook().read_bytes(), part, b"x")).flags == (flag,)


def test_a_hidden_sheet_of_the_student_is_flagged_and_not_searched(desk):
    def edit(book):
        sheet = book.create_sheet("solution")
        sheet.append(["frame", "t_s", "ball_x_m", "ball_y_m"])
        sheet.append([0, 0, 5, 5])
        sheet.sheet_state = "hidden"

    submission = desk.read(edited(desk.workbook().read_bytes(), edit))
    assert submission.flags == ("hidden-sheet",)
    assert submission.tracking["ball_x_m"].size == 60


def test_content_counts_not_bytes(desk):
    first = desk.read(desk.workbook().read_bytes())
    again = desk.read(edited(desk.workbook().read_bytes(), lambda book: None))
    other = desk.read(desk.workbook({"e": 0.5}).read_bytes())
    assert first.file_sha256 != again.file_sha256
    assert first.content_sha256 == again.content_sha256 != other.content_sha256


# ---------------------------------------------------------------- the tracking table


def test_stray_text_and_gaps_in_the_table_are_tolerated(desk):
    def edit(book):
        sheet = book["Tracking"]
        sheet["C5"].value, sheet["D6"].value, sheet["E7"].value = "lost", None, "0,31"
        sheet["A70"].value = "that's all"

    submission = desk.read(edited(desk.workbook().read_bytes(), edit))
    assert submission.flags == ("text-in-tracking",)
    assert submission.tracking["foot_x_m"].size == 60
    assert np.isnan(submission.tracking["foot_x_m"][3])
    assert np.isnan(submission.tracking["foot_y_m"][4])
    assert submission.tracking["knee_x_m"][5] == 0.31


def test_a_table_elsewhere_with_other_columns_is_found(desk):
    def edit(book):
        del book["Tracking"]
        sheet = book.create_sheet("my data")
        sheet.append(["measured on Sunday"])
        sheet.append([])
        sheet.append(["note", "Frame", "ball x (m)", "ball_y_m"])
        for i in range(20):
            sheet.append(["", i, 0.1 * i, 0.0])

    tracking = desk.read(edited(desk.workbook().read_bytes(), edit)).tracking
    assert set(tracking) == {"frame", "ball_x_m", "ball_y_m"}
    assert tracking["ball_x_m"][19] == pytest.approx(1.9)


def test_a_workbook_without_a_table_has_none(desk):
    assert desk.read(desk.workbook(tracking={}).read_bytes()).tracking == {}


# ---------------------------------------------------------------- other programs


def minimal(parts: dict[str, str]) -> bytes:
    """A workbook with prefixed names, shared strings and no cell addresses, as some converters write them."""
    content = io.BytesIO()
    main = 'xmlns:x="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    relations = 'xmlns="http://schemas.openxmlformats.org/package/2006/relationships"'
    files = {
        "[Content_Types].xml": "<Types/>",
        "_rels\\.rels": f"<Relationships {relations}>"
        f'<Relationship Id="a" Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl\\workbook.xml": f'<x:workbook {main} xmlns:r="{office}"><x:workbookPr date1904="1"/><x:sheets>'
        '<x:sheet name="_meta" sheetId="1" r:id="s"/><x:sheet name="Chart" sheetId="2" r:id="c"/>'
        "</x:sheets></x:workbook>",
        "xl\\_rels\\workbook.xml.rels": f"<Relationships {relations}>"
        f'<Relationship Id="s" Type="{office}/worksheet" Target="worksheets/sheet1.xml"/>'
        f'<Relationship Id="c" Type="{office}/chartsheet" Target="chartsheets/sheet1.xml"/>'
        f'<Relationship Id="l" Type="{office}/hyperlink" Target="http://x" TargetMode="External"/>'
        f'<Relationship Id="t" Type="{office}/sharedStrings" Target="sharedStrings.xml"/></Relationships>',
        "xl\\sharedStrings.xml": f"<x:sst {main}><x:si><x:t>assignment</x:t></x:si><x:si><x:r><x:t>soccer</x:t></x:r>"
        "<x:r><x:t>-kick</x:t></x:r><x:rPh><x:t>no</x:t></x:rPh></x:si><x:si><x:t>variant_code</x:t></x:si></x:sst>",
        "xl\\worksheets\\sheet1.xml": f"<x:worksheet {main}><x:sheetData>"
        "<x:row><x:c t='s'><x:v>0</x:v></x:c><x:c t='s'>"
        "<x:v>1</x:v></x:c></x:row><x:row><x:c t='s'><x:v>2</x:v></x:c><x:c t='str'><x:f>A</x:f><x:v>CODE9</x:v></x:c>"
        "<x:c t='d'><x:v>2026-05-01</x:v></x:c><x:c t='e'><x:v>#REF!</x:v></x:c><x:c><x:v>1e999</x:v></x:c></x:row>"
        "</x:sheetData></x:worksheet>",
    }
    with zipfile.ZipFile(content, "w") as archive:
        for name, text in {**files, **parts}.items():
            archive.writestr(name, text)
    return content.getvalue()


def test_prefixes_backslashes_shared_strings_and_missing_addresses_are_read():
    book = read_workbook(ReadRequest("w.xlsx", minimal({})))
    claims = claims_of(book)
    assert (claims.code, claims.assignment_id) == ("CODE9", "soccer-kick")
    assert book.flags == ("date-system-1904",)
    kinds = [book.sheets[0].at((2, column)).kind for column in range(1, 6)]
    assert kinds == [Kind.TEXT, Kind.TEXT, Kind.DATE, Kind.ERROR, Kind.ERROR]


def test_a_table_written_by_pandas_is_read(desk, tmp_path):
    frame = pd.DataFrame(
        {"frame": range(30), "t_s": np.arange(30) / 480, "ball_x_m": np.linspace(0, 1, 30), "ball_y_m": 0.0}
    )
    with pd.ExcelWriter(tmp_path / "p.xlsx", engine="openpyxl") as writer:
        frame.to_excel(writer, sheet_name="Tracking", index=False)
        pd.DataFrame([["variant_code", "CODE1"], ["assignment", "soccer-kick"]]).to_excel(
            writer, sheet_name="_meta", index=False, header=False
        )
    tracking = desk.read((tmp_path / "p.xlsx").read_bytes()).tracking
    np.testing.assert_allclose(tracking["ball_x_m"], np.linspace(0, 1, 30))

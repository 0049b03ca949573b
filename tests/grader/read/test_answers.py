"""Where answers are found when names are lost, and what odd cells are said to be."""

from __future__ import annotations

import hashlib
import io
from dataclasses import replace

import corpus
import openpyxl
import pytest

from grader.model import Answer, Kind, Outcome
from grader.plausible import settle_readings
from grader.read import BookCell, ReadRequest, UnreadableError, read_workbook
from grader.read.locate import Claims, claims_of, find_beside, find_submission
from grader.read.sheet import _EPOCH, _date_text
from grader.stated import Stated, Unstated, state

META = [["assignment", "soccer-kick"], ["variant_code", "CODE1"], ["assignment_version", "1"]]
LABEL = "Coefficient of restitution"


def book_of(answers, **others):
    return read_workbook(ReadRequest("w.xlsx", corpus.Dialect().write({"Answers": answers, **others, "_meta": META})))


def answer_of(assignment, answers, question="e", template=None, **others):
    return find_submission(book_of(answers, **others), assignment.questions, template).answer(question)


@pytest.mark.parametrize(
    "label", [LABEL, "coefficient of  RESTITUTION:", f"{LABEL} (e)", f"{LABEL} [-] =", "Ｃoefficient of restitution"]
)
def test_a_label_is_known_however_it_is_written(assignment, label):
    assert answer_of(assignment, [[label, "e", 0.73]]).number == 0.73


def test_of_equal_answers_under_one_label_the_first_counts(assignment):
    found = answer_of(assignment, [[LABEL, "e", 0.73], [LABEL, 0.73], [LABEL]])
    assert (found.number, found.where) == (0.73, "Answers!C1")


def test_different_answers_under_one_label_are_left_to_a_person(assignment):
    found = answer_of(assignment, [[LABEL, 0.73], ["x"], [LABEL, 0.5]], template={"e": "Answers!B1"})
    stated = state(found, assignment.question("e"))
    assert isinstance(stated, Unstated)
    assert stated.outcome is Outcome.UNSURE
    assert stated.reason.startswith("Several cells carry this label (Answers!B1, Answers!B3)")


def test_of_many_different_answers_the_first_four_are_shown(assignment):
    found = answer_of(assignment, [[LABEL, number, "m"] for number in (1, 2, 3, 4, 5)])
    assert (found.text, found.unit_text, found.number) == ("1, 2, 3, 4", "", None)
    assert found.where == "Answers!B1, Answers!B2, Answers!B3, Answers!B4"


def test_the_symbol_decides_where_the_label_stands_twice(assignment):
    found = answer_of(assignment, [[LABEL, 0.73], [LABEL, 0.5], ["e", 0.6]])
    assert found.number == 0.6


def test_an_empty_cell_beside_a_label_is_blank(assignment):
    assert answer_of(assignment, [[LABEL, "e"]]).kind is Kind.BLANK
    assert answer_of(assignment, [[LABEL]]).where == "Answers!B1"


BY_HAND = [[LABEL, "e"], *[[]] * 7, [None, None, None, None, 0.5]]


@pytest.mark.parametrize(
    ("grid", "place", "number", "found_by"),
    [
        ([[LABEL, 0.5, 0.73]], "C1", 0.73, "name"),  # the row carries the label: the name is right
        ([["Moment", "I", 1.9], [LABEL, "e", 0.73]], "C1", 0.73, "label"),  # a row was inserted, the name stayed
        ([[LABEL, "e"], ["Moment", 1.9]], "B2", None, "label"),
        ([["e", 0.73], *BY_HAND[1:]], "E9", 0.73, "label"),
        (BY_HAND, "E9", 0.5, "name"),  # moved by hand, away from its label
        ([[LABEL, 0.73]], "B1", 0.73, "name"),
    ],
)
def test_a_name_counts_unless_it_stayed_behind_its_label(assignment, grid, place, number, found_by):
    data = corpus.Dialect().write({"Answers": grid, "_meta": META}, {"ans_e": f"Answers!${place[0]}${place[1]}"})
    found = find_submission(read_workbook(ReadRequest("w", data)), assignment.questions).answer("e")
    assert (found.number, found.found_by) == (number, found_by)


@pytest.mark.parametrize(
    ("grid", "merge", "where"),
    [
        ([[LABEL, None, 0.73]], (1, 1, 1, 2), "Answers!C1"),  # the label spans two columns
        ([["x", 0.73], [LABEL]], (1, 2, 2, 2), "Answers!B2"),  # the answer spans two rows
    ],
)
def test_merged_cells_are_looked_through(assignment, grid, merge, where):
    book = book_of(grid)
    sheet, *others = book.sheets
    merged = replace(book, sheets=(replace(sheet, merges=(merge,)), *others))
    found = find_submission(merged, assignment.questions).answer("e")
    assert (found.number, found.where) == (0.73, where)


@pytest.mark.parametrize(
    ("row", "number", "unit"),
    [
        ([LABEL, "e", 0.73, " m/s "], 0.73, "m/s"),
        ([LABEL, 0.73, 5.0], 0.73, ""),
        ([LABEL, 0.73, "u" * 41], 0.73, "u" * 40),
        ([LABEL, None, None, None, 0.73, "m"], 0.73, "m"),  # four columns are the farthest
        ([LABEL, None, None, None, None, 0.73], None, ""),
        ([LABEL, "e", None, 6.0], None, ""),  # nothing behind the symbol: the points are no answer
    ],
)
def test_right_of_a_label_stands_the_answer_and_then_its_unit(assignment, row, number, unit):
    found = answer_of(assignment, [row])
    assert (found.number, found.unit_text, found.found_by) == (number, unit, "label")


def test_at_the_address_of_the_template_stands_the_answer_and_then_its_unit(assignment):
    found = answer_of(assignment, [[None, 0.73, "m"]], template={"e": "Answers!B1"})
    assert (found.number, found.unit_text, found.found_by) == (0.73, "m", "address")


def test_the_unit_of_a_format_is_that_of_positive_numbers(assignment):
    book = book_of([["e"]])
    sheet, *others = book.sheets
    for code, unit in (('0.0" m/s";-0.0" s"', "m/s"), ('0.0;-0.0" s"', ""), ('0.0"' + "u" * 21 + '"', "")):
        cells = {**sheet.cells, (1, 2): BookCell(Kind.NUMBER, 0.73, "", code)}
        changed = replace(book, sheets=(replace(sheet, cells=cells), *others))
        assert find_submission(changed, assignment.questions).answer("e").unit_text == unit


@pytest.mark.parametrize(
    ("sheet", "reference"),
    [
        ("Answers", "Answers!$A$2"),
        ("Answers", "=ANSWERS!A2"),
        ("My sheet", "'My sheet'!$A$2:$C$9"),
        ("O'Neil", " 'O''Neil'!$A$2 "),
        ("a!b", "'a!b'!$A$2"),
    ],
)
def test_a_reference_is_followed_however_it_is_written(assignment, sheet, reference):
    book = read_workbook(ReadRequest("w", corpus.Dialect().write({sheet: [["x"], [0.73]], "_meta": META})))
    assert find_submission(book, assignment.questions, {"e": reference}).answer("e").number == 0.73


def test_hidden_sheets_and_our_own_have_no_answers(assignment):
    book = book_of([["x"]], Tracking=[["e", 1.0]], INSTRUCTIONS=[["e", 2.0]], Mine=[["e", 3.0]])
    assert find_submission(book, assignment.questions).answer("e").number == 3.0
    sheets = [replace(sheet, is_visible=sheet.name != "Mine") for sheet in book.sheets]
    hidden = find_submission(replace(book, sheets=tuple(sheets)), assignment.questions)
    assert (hidden.answer("e").kind, hidden.flags) == (Kind.BLANK, ("hidden-sheet",))
    ours = [replace(sheet, is_visible=not sheet.name.startswith("_")) for sheet in book.sheets]
    assert find_submission(replace(book, sheets=tuple(ours)), assignment.questions).flags == ()


def test_a_submission_says_all_that_the_workbook_does(assignment):
    grid = [["frame", "t", "Ball x", "Ball y"], *([i, i, i, "-"] for i in range(5))]
    data = corpus.Dialect().write({"Answers": [["e", 0.73]], "Tracking": grid, "_meta": META})
    found = find_submission(read_workbook(ReadRequest("w.xlsx", data)), assignment.questions, points=("ball",))
    assert (found.name, found.assignment_id, found.code) == ("w.xlsx", "soccer-kick", "CODE1")
    assert (found.flags, found.file_sha256) == (("text-in-tracking",), hashlib.sha256(data).hexdigest())
    assert found.tracking["ball_x_m"].tolist() == [0, 1, 2, 3, 4]


def test_the_hash_of_what_is_said_changes_with_every_part_of_it(assignment):
    def said(*row, x=1.0):
        grid = [["frame", "ball_x_m", "ball_y_m"], [1.0, x, 1.0]]
        found = find_submission(book_of([list(row)], Tracking=grid), assignment.questions)
        return found.content_sha256

    usual = said("e", 0.5, "m")
    assert usual == said("e", 0.5 + 1e-16, "m", x=1 + 2e-16) == said("coefficient of restitution", 0.5, "m")
    different = {
        said("e", 0.5),
        said("e", "0.5", "m"),
        said("e", 0.6, "m"),
        said("I", 0.5, "m"),
        said("e", 0.5, "m", x=2.0),
    }
    assert len({usual, *different}) == 6
    assert len(usual) == 64


def test_a_question_without_a_symbol_is_not_found_by_punctuation(assignment):
    question = replace(assignment.question("e"), symbol="")
    assert find_submission(book_of([["==", 0.9]]), [question]).answer("e") == Answer()


def test_an_address_on_a_sheet_that_is_gone_finds_nothing(assignment):
    assert answer_of(assignment, [[1.0]], template={"e": "Elsewhere!A1"}) == Answer()
    assert answer_of(assignment, [[1.0]], template={"e": "Answers"}) == Answer()


def test_a_unit_in_the_number_format_counts(desk):
    book = openpyxl.load_workbook(io.BytesIO(desk.good), rich_text=True)
    sheet, place = next(book.defined_names["ans_v_f1"].destinations)
    book[sheet][place].number_format = '0.00" cm/s"'
    row = book[sheet][place].row
    book[sheet].cell(row, 4).value = None
    content = io.BytesIO()
    book.save(content)
    answer = desk.read(content.getvalue()).answer("v_f1")
    assert answer.unit_text == "cm/s"
    stated = state(answer, desk.assignment.question("v_f1"))
    assert stated.value == pytest.approx(desk.truth["v_f1"] / 100)
    assert stated.unit_given


def test_what_is_no_range_is_merged_with_nothing(assignment):
    data = corpus.Dialect().write({"Answers": [["e", 0.5, None, 0.7]], "_meta": META})
    sheet = corpus.members(data)["xl/worksheets/sheet1.xml"]
    merges = b'<mergeCells><mergeCell ref="B1:C1"/><mergeCell ref="#REF!"/><mergeCell/></mergeCells></worksheet>'
    parts = {"xl/worksheets/sheet1.xml": sheet.replace(b"</worksheet>", merges)}
    assert read_workbook(ReadRequest("w", corpus.with_parts(data, **parts))).sheets[0].merges == ((1, 2, 1, 3),)


def test_a_name_is_cut_and_a_text_between_names_belongs_to_none():
    data = corpus.Dialect().write({"Answers": [["e", 0.5]], "_meta": META}, {"ans_e": "A" * 5000})
    directory = corpus.members(data)["xl/workbook.xml"].replace(b"<definedNames>", b"<calcPr/>text<definedNames>")
    book = read_workbook(ReadRequest("w", corpus.with_parts(data, **{"xl/workbook.xml": directory})))
    assert set(book.names) == {"ans_e"}


def test_a_copied_sheet_has_names_of_its_own_that_hide_none():
    """A program that copies a sheet gives the copy the same names, for that sheet alone."""
    data = corpus.Dialect().write({"Answers": [["e", 0.5]], "_meta": META})
    directory = corpus.members(data)["xl/workbook.xml"]
    own = b'<definedName name="ANS_E" localSheetId="1">Copy!$C$1</definedName>'
    ours = b'<definedName name="ans_e">Answers!$B$1</definedName>'
    for names in (own + ours, ours + own):
        parts = {"xl/workbook.xml": directory.replace(b"<definedNames>", b"<definedNames>" + names)}
        assert read_workbook(ReadRequest("w", corpus.with_parts(data, **parts))).names == {"ans_e": "Answers!$B$1"}


def test_the_meta_sheet_says_its_version():
    assert claims_of(book_of([["x"]])).version == "1"


def test_the_meta_sheet_is_read_by_its_names():
    rows = [[" Variant_Code ", " CODE1 ", "no"], ["assignment", "a"], ["signature", "s"], ["purpose", "p"], [1.0, "x"]]
    data = corpus.Dialect().write({"x": [["variant_code", "no"]], "_META (2)": [*rows, [None, "assignment", "no"]]})
    assert claims_of(read_workbook(ReadRequest("w", data))) == Claims("CODE1", "a", "s", "", "p")
    bare = corpus.Dialect().write({"_meta": rows[:2]})
    assert claims_of(read_workbook(ReadRequest("w", bare))) == Claims("CODE1", "a")


@pytest.mark.parametrize("meta", [[], [["variant_code", "X"]], [["assignment", "soccer-kick"]]])
def test_a_workbook_that_is_not_ours_is_told_so(meta):
    data = corpus.Dialect().write({"Answers": [["x"]], "_meta": meta})
    with pytest.raises(UnreadableError, match=r"w\.xlsx: .* without our variant code.* Type your answers into"):
        claims_of(read_workbook(ReadRequest("w.xlsx", data)))


def test_a_workbook_without_our_hidden_sheet_is_told_so():
    with pytest.raises(UnreadableError, match="without our variant code"):
        claims_of(read_workbook(ReadRequest("w.xlsx", corpus.Dialect().write({"Answers": [["x"]]}))))


def test_a_given_number_is_found_beside_its_label():
    book = book_of([["L", 0.5]], Instructions=[["Mass of the ball", "m", 0.35, "kg"]])
    assert find_beside(book, "mass of the ball") == 0.35
    assert find_beside(book, "Diameter") is None
    assert find_beside(book, "L") == 0.5
    assert find_beside(book_of([["L", None, None, None, 0.5]]), "L") == 0.5  # four columns are the farthest
    assert find_beside(book_of([["L", None, None, None, None, 0.5]]), "L") is None


# ---------------------------------------------------------------- odd cells


@pytest.mark.parametrize(
    ("answer", "outcome", "words"),
    [
        (Answer(), Outcome.WRONG, "Nothing is written"),
        (Answer(Kind.BOOL, text="TRUE"), Outcome.WRONG, "TRUE or FALSE"),
        (Answer(Kind.ERROR, text="#DIV/0!"), Outcome.WRONG, "#DIV/0!"),
        (Answer(Kind.UNCACHED), Outcome.UNSURE, "Ctrl+Alt+F9"),
        (Answer(Kind.DATE, 45413.0, "2024-05-01"), Outcome.UNSURE, "a date, 2024-05-01 and holds the number 45413"),
        (Answer(Kind.DATE, None, "2024-05-01"), Outcome.UNSURE, "a date, 2024-05-01: the spreadsheet"),
        (Answer(Kind.TEXT, text="1,234"), Outcome.UNSURE, "can be read in two ways. Write 1.234 or 1234."),
        (Answer(Kind.TEXT, text="about 15"), Outcome.UNSURE, "A person will look at it."),
        (Answer(Kind.TEXT, text="px/s"), Outcome.UNSURE, "A person will look at it."),
        (Answer(Kind.TEXT, text="1,234 px/s"), Outcome.UNSURE, "can be read in two ways."),
        (Answer(Kind.TEXT, text="15 m/s ± 3 px/s"), Outcome.UNSURE, "A person will look at it."),
        (Answer(Kind.NUMBER, 3.0, "3", "furlong"), Outcome.UNSURE, "A person will look at it."),
    ],
)
def test_a_cell_that_says_no_quantity_has_a_reason(assignment, answer, outcome, words):
    stated = state(answer, assignment.question("v_f1"))
    assert isinstance(stated, Unstated)
    assert stated.outcome is outcome
    assert words in stated.reason


@pytest.mark.parametrize(
    ("text", "unit"),
    [("450 px/s", ""), ("450", "px/s"), ("4.5e2 pixels/s", ""), ("4.5·10^2", "px/s"), ("(450 ± 3) px/s", "")],
)
def test_pixels_are_taken_for_what_they_are(assignment, text, unit):
    stated = state(Answer(Kind.TEXT, None, text, unit), assignment.question("v_f1"))
    assert isinstance(stated, Stated)
    assert (stated.value, stated.in_pixels, stated.unit_given) == (450.0, True, True)


@pytest.mark.parametrize(
    ("text", "unit", "half"),
    [
        ("15", "m/s", 0.5),
        ("15.2", "m/s", 0.05),
        ("15,20", "cm/s", 5e-5),
        ("1.5e1", "m/s", 0.5),
        ("0", "m/s", 0.0),
        ("15.20000", "m/s", 0.0),
        (".5", "m/s", 0.05),
        ("1e-305", "m/s", 0.0),
        ("(15.2 ± 1)", "m/s", 0.05),
        ("1 234.5", "m/s", 0.05),
        ("1.234,5", "m/s", 0.05),
        ("1,234,567", "m/s", 0.0),
        ("0.00730", "m/s", 5e-6),
        ("1.5·10^1", "m/s", 0.0),
    ],
)
def test_half_of_the_last_digit(assignment, text, unit, half):
    stated = state(Answer(Kind.TEXT, None, text, unit), assignment.question("v_f1"))
    assert stated.half_unit == pytest.approx(half)


@pytest.mark.parametrize(
    ("days", "text"),
    [(45413.0, "2024-05-01"), (0.0625, "01:30:00"), (0.0, "00:00:00"), (-1e9, ""), (1e9, ""), (1.0, "1899-12-31")],
)
def test_days_are_said_as_a_date(days, text):
    assert _date_text(days, _EPOCH) == text


# ---------------------------------------------------------------- commas


def settled(assignment, question, text, truth=None, unit=""):
    data = corpus.Dialect().write({"Answers": [[question, text, unit]], "_meta": META})
    submission = find_submission(read_workbook(ReadRequest("w", data)), assignment.questions)
    questions = {q.id: q for q in assignment.questions}
    return settle_readings(submission, questions, truth).answer(question).read_as


@pytest.mark.parametrize(
    ("question", "text", "truth", "read_as"),
    [
        ("e", "1,234", None, "1.234"),
        ("I", "1,234", None, "1.234"),
        ("v_f1", "9,703", None, "9.703"),
        ("fps", "1,200", None, "1200"),
        ("px_per_m", "1,234", None, ""),
        ("px_per_m", "1,000", None, ""),  # one pixel in a metre is the least
        ("fps", "10,000", None, ""),
        ("px_per_m", "1,234", {"px_per_m": 1200.0}, "1234"),
        ("px_per_m", "1,234", {"px_per_m": 0.0}, ""),
        ("v_f1", "9,703 px/s", None, ""),
        ("v_f1", "9,703 and 1,234", None, ""),
        ("v_f1", "15,5", None, ""),
        ("v_f1", "9,703 quux", None, ""),
        ("v_f1", "1,234 km/h", {"v_f1": 0.4}, "1.234 km/h"),
        ("px_per_m", "1,500", {"px_per_m": 50.0}, "1500"),  # thirty times is the farthest
        ("px_per_m", "1,501", {"px_per_m": 50.0}, ""),
        ("px_per_m", "1,500", {"px_per_m": 45000.0}, "1500"),
        ("px_per_m", "1,499", {"px_per_m": 45000.0}, ""),
        ("px_per_m", "1,234", {"px_per_m": float("nan")}, ""),
        ("px_per_m", "1,234", {"fps": 1200.0}, ""),
        ("omega1", "-9,703", {"omega1": 9.0}, "-9.703"),
        ("omega1", "-1,000", None, ""),  # both can be
        ("omega1", "1,001", None, "1.001"),
        ("v_f1", "300,000", None, "300.000"),
        ("v_f1", "9.703", None, ""),
        ("v_f1", "9703,123", None, ""),
        ("v_f1", "0,703", None, ""),
    ],
)
def test_a_comma_is_settled_where_one_reading_alone_is_plausible(assignment, question, text, truth, read_as):
    assert settled(assignment, question, text, truth) == read_as


def test_a_dimension_without_range_settles_nothing(assignment):
    questions = {"e": replace(assignment.question("e"), dimension="time")}
    submission = find_submission(book_of([["e", "1,234"]]), questions.values())
    assert settle_readings(submission, questions).answer("e").read_as == ""


def test_an_answer_to_no_question_is_left_as_it_is(assignment):
    submission = find_submission(book_of([["e", "1,234"], ["fps", 3.0]]), assignment.questions)
    assert settle_readings(submission, {}).answers == submission.answers

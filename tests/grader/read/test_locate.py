"""Where answers, units and the table are found: names that lead nowhere, odd sheet names, labels alone."""

from __future__ import annotations

import corpus
import pytest

from grader.kind import Kind
from grader.read import Book, ReadRequest, UnreadableError, read_workbook
from grader.read.book import Sheet
from grader.read.flags import Flag
from grader.read.locate import Claims, claims_of, find_submission

META = [["assignment", "soccer-kick"], ["variant_code", "CODE1"]]
LABEL = "Coefficient of restitution"
KICK = Claims("CODE1", "soccer-kick")


def submission_of(assignment, answers, names=None, sheet="Answers", points=(), **others):
    data = corpus.Dialect().write({sheet: answers, **others, "_meta": META}, names)
    return find_submission(read_workbook(ReadRequest("w.xlsx", data)), assignment.questions, points=points)


@pytest.mark.parametrize("label", ["coefficient of  RESTITUTION:", f"{LABEL} (e)", f"{LABEL} [-] =", f" {LABEL}."])
def test_a_label_alone_is_known_however_it_is_written(assignment, label):
    assert submission_of(assignment, [[label, 0.73]]).answer("e").number == 0.73


def test_a_label_that_is_all_in_brackets_is_itself(assignment):
    assert submission_of(assignment, [["(e)", 0.73]]).answer("e").kind is Kind.BLANK


def test_the_unit_of_a_named_answer_is_the_one_that_has_its_name(assignment):
    names = {"ans_I": "Answers!$B$1", "unit_I": "Answers!$D$1"}
    found = submission_of(assignment, [["x", 1.9, "no", "kg m^2"]], names).answer("I")
    assert (found.number, found.unit_text, found.found_by) == (1.9, "kg m^2", "name")
    without = submission_of(assignment, [["x", 1.9, "no", "kg m^2"]], {"ans_I": "Answers!$B$1"}).answer("I")
    assert (without.number, without.unit_text) == (1.9, "")


@pytest.mark.parametrize("reference", ["Answers!total", "B1", "#REF!", "Answers!#REF!", "Gone!B1", ""])
def test_a_name_that_leads_nowhere_leaves_it_to_the_label(assignment, reference):
    found = submission_of(assignment, [[LABEL, 0.73]], {"ans_e": reference}).answer("e")
    assert (found.number, found.found_by) == (0.73, "label")


@pytest.mark.parametrize("reference", ["'X X'!$B$1", "=X X!B1", "X X!B1"])
def test_a_sheet_may_have_any_letters_at_the_ends_of_its_name(assignment, reference):
    found = submission_of(assignment, [["x", 0.73]], {"ans_e": reference}, sheet="X X").answer("e")
    assert (found.number, found.where) == (0.73, "X X!B1")


def test_our_own_hidden_sheets_need_nobody_to_look_at_them(assignment):
    def flags(name):
        book = Book("w.xlsx", (Sheet(name, False, {}),), {}, (), "")
        return find_submission(book, assignment.questions, claims=KICK).flags

    assert flags("_meta") == flags("_lists") == ()
    assert flags("notes") == (Flag.HIDDEN_SHEET,)


def test_names_of_the_table_are_matched_with_the_assignments_points(assignment):
    table = [["t_s", "my_ball_x_m", "my_ball_y_m"], *([0.1 * i, i, i] for i in range(5))]
    found = submission_of(assignment, [["x"]], points=("ball", "foot"), Tracking=table)
    assert found.tracking["ball_x_m"].tolist() == [0, 1, 2, 3, 4]


def test_a_workbook_without_our_code_is_told_which_one_is_expected():
    with pytest.raises(UnreadableError, match="expected the workbook of your video, got one without our variant code"):
        claims_of(read_workbook(ReadRequest("w.xlsx", corpus.Dialect().write({"Answers": [["x"]]}))))

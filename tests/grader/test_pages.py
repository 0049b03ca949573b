"""The pages as text: well formed, nothing from outside, nothing that a student typed does anything."""

from __future__ import annotations

import html.parser
import re
from dataclasses import replace

from grader.feedback import Report, class_page, feedback_page, verdict
from grader.grade import grade
from grader.gradebook import Row, Student
from grader.model import Finding, Outcome
from grader.page import prose


class Tags(html.parser.HTMLParser):
    def __init__(self, text: str):
        super().__init__()
        self.seen: list[tuple[str, dict]] = []
        self.open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.seen.append((tag, dict(attrs)))
        if tag not in {"meta", "br", "col", "line", "rect", "circle", "polyline"}:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.seen.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def names(self):
        return [tag for tag, _ in self.seen]


def report(desk, kit, **changes) -> Report:
    values = {**desk.truth, **changes}
    submission = kit.submission_of(desk.assignment, values, None, kit.table_of(kit.trajectory_m(desk.numbers)))
    return Report(desk.assignment, submission, desk.key, grade(submission, desk.key, desk.assignment))


def test_a_page_is_self_contained_and_well_formed(desk, kit):
    page = feedback_page(report(desk, kit, e=0.2, v_b1="1,234"))
    tags = Tags(page)
    assert tags.open == []
    assert "script" not in tags.names()
    assert "link" not in tags.names()
    assert "http" not in re.sub(r"http-equiv", "", page)
    assert tags.names().count("h1") == 1
    assert ("html", {"lang": "en"}) in tags.seen
    assert any("default-src 'none'" in str(a) for tag, a in tags.seen if tag == "meta")
    for tag, attributes in tags.seen:
        if tag == "svg":
            assert attributes["role"] == "img"
    assert tags.names().count("svg") == tags.names().count("title") - 1 == 2


def test_what_a_student_typed_cannot_leave_its_place(desk, kit):
    page = feedback_page(report(desk, kit, v_b1='<script>alert("1")</script> 5'))
    assert "<script" not in page
    assert "&lt;script&gt;" in page


def test_names_on_the_class_page_are_escaped(assignment):
    row = Row(Student("abc", "<b>Bobby</b>"), "soccer-kick", 1, 5.0, 20.0, "review", "", {}, ("E1",), ("Look.",))
    page = class_page(assignment, [row], [("<i>.xls", "an old workbook")])
    assert "<b>Bobby" not in page
    assert "<i>.xls" not in page
    assert Tags(page).open == []


def test_a_class_without_grades_has_a_page(assignment):
    assert "Nothing has been graded yet" in class_page(assignment, [])


def test_a_table_with_one_row_draws_no_curve(desk, kit):
    submission = kit.submission_of(desk.assignment, desk.truth, None, {})
    page = feedback_page(Report(desk.assignment, submission, desk.key, grade(submission, desk.key, desk.assignment)))
    assert "<svg" not in page
    assert "Paste your measured positions" in page


def test_an_error_carried_on_is_shown_as_such():
    finding = Finding("e", "value", Outcome.RIGHT, 1, 1, "", carried=True)
    assert verdict([finding]).word == "carried on"


def test_symbols_in_a_sentence_look_as_they_do_in_the_table(desk, kit):
    done = replace(report(desk, kit), adjustments=("v_b2 set to 1 points: <b>v_f1</b>, not v_b2x",))
    assert "v<sub>b2</sub> set to 1 points: &lt;b&gt;v<sub>f1</sub>&lt;/b&gt;, not v_b2x" in feedback_page(done)
    wrong = report(desk, kit, e=0.2)
    finding = replace(wrong.grade.of("e")[0], outcome=Outcome.WRONG, message="e is (v_b2 − v_f2) / v_f1.")
    told = replace(wrong, grade=replace(wrong.grade, findings=(finding,)))
    assert "e is (v<sub>b2</sub> − v<sub>f2</sub>) / v<sub>f1</sub>." in feedback_page(told)


def test_a_sentence_without_symbols_stays_as_it_is():
    assert prose("a < b, v_x", ["e"]) == "a &lt; b, v_x"

"""Laws of filling a column, whatever stands in the template."""

from __future__ import annotations

from types import SimpleNamespace

from hypothesis import given
from hypothesis import strategies as st

from grader.enrolment import Student
from grader.filling.cells import TextTable
from grader.filling.fill import Column, fill
from grader.filling.job import Job
from grader.filling.numbers import number_in
from grader.filling.people import Asked
from grader.releasing import Released

BEFORE = st.sampled_from(["", "-", "EX", "3", "8.50", "0", "8,5", "N/A", "late", "1e3", '"7.25"', '"-"', "%", " "])
OTHER = st.text(alphabet='a1.,-=+@"', max_size=5).map(lambda text: '"{}"'.format(text.replace('"', '""')))
POINTS = st.one_of(st.none(), st.floats(0, 30))
ROWS = st.lists(st.tuples(BEFORE, OTHER, POINTS), min_size=1, max_size=6)


def made(rows) -> tuple[bytes, Job, dict[int, Asked]]:
    """A table with a row for each student, who has these points of 20, or none."""
    text = "who,score,other\r\n" + "".join(f"s{k},{before},{other}\r\n" for k, (before, other, _) in enumerate(rows))
    students = tuple(Student(f"p{k}", f"Name {k}", "", {"login": f"s{k}"}) for k in range(len(rows)))
    grades = {
        s.pid: Released(s, 1, points, 0.0, points, 20.0)
        for s, (_, _, points) in zip(students, rows, strict=True)
        if points is not None
    }
    asked = {k + 1: Asked("", (("login", f"s{k}"),)) for k in range(len(rows))}
    return text.encode(), Job(SimpleNamespace(), SimpleNamespace(), students, grades), asked  # type: ignore[arg-type]


def column(*, comma: bool = False, has_limit: bool = False, out_of: float = 10.0) -> Column:
    return Column(1, out_of, comma, has_limit=has_limit)


@given(ROWS, st.booleans(), st.booleans())
def test_nothing_but_the_column_changes_no_score_is_cleared_and_no_mark_is_lost(rows, comma, has_limit) -> None:
    data, job, asked = made(rows)
    table, before = TextTable("t.csv", data), TextTable("t.csv", data)
    lines = fill(table, column(comma=comma, has_limit=has_limit), asked, job)
    assert len(lines) == len(rows)
    for row, line in enumerate(lines, start=1):
        assert (table.get(row, 0), table.get(row, 2)) == (before.get(row, 0), before.get(row, 2))
        was, now = before.get(row, 1), table.get(row, 1)
        if line.status != "filled":
            assert now == was
            continue
        assert was.strip() in ("", "-") or number_in(was) is not None
        assert now == line.points
        assert number_in(now) is not None
    assert table.encoded().count(b"\r\n") == len(rows) + 1


@given(ROWS)
def test_filling_again_changes_nothing(rows) -> None:
    data, job, asked = made(rows)
    once = TextTable("t.csv", data)
    fill(once, column(), asked, job)
    twice = TextTable("t.csv", once.encoded())
    lines = fill(twice, column(), asked, job)
    assert twice.encoded() == once.encoded()
    assert not any(line.status == "filled" for line in lines)


@given(ROWS, st.floats(1, 1000))
def test_points_are_scaled_to_what_the_platform_gives_and_it_is_said(rows, out_of) -> None:
    data, job, asked = made(rows)
    table = TextTable("t.csv", data)
    for line, (_, _, points) in zip(fill(table, column(out_of=out_of), asked, job), rows, strict=True):
        if line.status == "filled":
            assert abs(number_in(line.points) - points * out_of / 20) <= 0.005 + 1e-9
            assert ("scaled" in line.reason) == (abs(out_of - 20) >= 1e-9)


@given(st.floats(20.1, 30))
def test_where_the_platform_has_a_limit_more_is_not_written(points) -> None:
    data, job, asked = made([("", '""', points)])
    table = TextTable("t.csv", data)
    (line,) = fill(table, column(has_limit=True), asked, job)
    assert table.encoded() == data
    assert line.reason == "the platform takes 0 to 10 only"

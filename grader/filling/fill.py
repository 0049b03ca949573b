"""Filling one column of a platform's own table with released points."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from grader.enrolment import ACTIVE, Student
from grader.filling.cells import TextTable
from grader.filling.job import Job, Line
from grader.filling.numbers import number_in, points_text
from grader.filling.people import Asked, Directory


@dataclass(frozen=True)
class Column:
    """The column to fill.

    Attributes
    ----------
    at : int
    out_of : float or None
        Points possible on the platform; None when it does not say.
    comma : bool
        Whether its numbers have a decimal comma.
    empty : frozenset of str
        What stands in a cell without a score, in small letters.
    has_limit : bool
        Whether the platform refuses more than `out_of`, and less than nothing.
    """

    at: int
    out_of: float | None
    comma: bool
    empty: frozenset[str] = frozenset({"", "-"})
    has_limit: bool = False


def _free(_row: int) -> str:
    return ""


def fill(
    table: TextTable,
    column: Column,
    asked: Mapping[int, Asked],
    job: Job,
    blocked: Callable[[int], str] = _free,
) -> tuple[Line, ...]:
    """Write released points into a column; a cell is written or left exactly as it is.

    Parameters
    ----------
    asked : mapping of int to Asked
        Whose each row is, by row.
    blocked : callable, optional
        Why a row must not be written, "" when it may.

    Returns
    -------
    tuple of Line
        One a row, then graded students who have none.
    """
    directory, lines, seen = Directory(job.students, asked.values()), list[Line](), set[str]()
    for row, one in asked.items():
        whose = directory.find(one)
        if isinstance(whose, str):
            lines.append(Line(one.name, "skipped", reason=whose))
            continue
        seen.add(whose.pid)
        lines.append(_fill_cell(table, row, column, whose, job, blocked(row)))
    return (*lines, *missing(job, seen))


def missing(job: Job, seen: Iterable[str]) -> tuple[Line, ...]:
    """Return a line of every graded student whom the template does not have."""
    seen = set(seen)
    without = (student for student in job.graded if student.pid not in seen)
    reason = "has a grade, but no row in the template"
    return tuple(Line(s.name, "not in template", _released_text(job, s), reason, s.pid) for s in without)


def no_grade(job: Job, student: Student) -> Line | None:
    """Return why a student gets nothing, None when there is a released grade."""
    if student.status != ACTIVE:
        return Line(student.name, "skipped", reason="dropped from the course", pid=student.pid)
    if job.grade_of(student) is None:
        return Line(student.name, "no grade", reason="nothing was released: left as it is", pid=student.pid)
    return None


def open_text(job: Job, student: Student) -> str:
    """Say that a student's released points are not final, "" where they are."""
    released = job.grade_of(student)
    if released is None or student.pid not in job.unsettled:
        return ""
    return f"open: up to {points_text(released.points)} of {points_text(released.out_of)}, a person has to look"


def _fill_cell(table: TextTable, row: int, column: Column, student: Student, job: Job, blocked: str) -> Line:
    none, released = no_grade(job, student), job.grade_of(student)
    if none is not None or released is None:
        return none or Line(student.name, "no grade", pid=student.pid)
    before = table.get(row, column.at).strip()
    old = number_in(before)
    points, scaled = _scaled(released.points, released.out_of, column)
    text = points_text(points, comma=column.comma)
    blocked = blocked or _reason_to_leave(before, old, points, column)
    if blocked:
        return Line(student.name, "skipped", text, blocked, student.pid)
    is_same, open_ = old is not None and points_text(old, comma=column.comma) == text, open_text(job, student)
    if not is_same:
        table.put(row, column.at, text)
    replaced = f"was {before}" if old is not None and not is_same else ""
    reason = "; ".join(filter(None, (open_, scaled, replaced)))
    return Line(student.name, "unchanged" if is_same else "filled", text, reason, student.pid, bool(open_))


def _reason_to_leave(before: str, old: float | None, points: float, column: Column) -> str:
    """Say why a cell must not be written, "" when it may: marks such as EX stay, and so does what would be refused."""
    if old is None and before.casefold() not in column.empty:
        return f"it holds {before[:30]!r}, which stays"
    if column.has_limit and column.out_of is not None and not 0 <= points <= column.out_of + 1e-9:
        return f"the platform takes 0 to {points_text(column.out_of)} only"
    return ""


def _scaled(points: float, out_of: float, column: Column) -> tuple[float, str]:
    """Return points of the platform's maximum, and how that came about in words."""
    if column.out_of is None or not out_of or abs(column.out_of - out_of) < 1e-9:
        return points, ""
    share = points * column.out_of / out_of
    return share, f"{points_text(points)} of {points_text(out_of)}, scaled to {points_text(column.out_of)}"


def _released_text(job: Job, student: Student) -> str:
    released = job.grade_of(student)
    return points_text(released.points) if released else ""

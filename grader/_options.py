"""Options and printing that the commands of this package share."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from assignments.course import Course

CourseOption = Annotated[
    str, typer.Option("--course", metavar="DIR", help="The course: a folder, or the URL of one in an object store.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]


def the_course(place: str, arriving: str = "") -> Course:
    """Open a course whose settings name only what exists; `arriving` is as in `check_assignments`.

    An unknown assignment is refused: a lost due date is found out too late, and mended with one edit. An unknown
    student is said on standard error only: the class list may come later.

    Raises
    ------
    CourseError
    """
    from assignments.course import open_course  # noqa: PLC0415 - as in every command
    from assignments.course_names import check_assignments, unknown_students  # noqa: PLC0415

    course = open_course(place)
    check_assignments(course, arriving)
    if course.calendar.extensions:
        for mistake in unknown_students(course, _pids(course)):
            typer.echo(str(mistake), err=True)
    return course


def _pids(course: Course) -> tuple[str, ...]:
    from grader.gradebook import Gradebook, is_begun  # noqa: PLC0415

    if not is_begun(course):
        return ()
    with Gradebook.open(course) as book:
        return tuple(student.pid for student in book.students())


def print_json(result: Any) -> None:
    """Print a result for other programs."""
    typer.echo(json.dumps(result, ensure_ascii=False, indent=1, default=str))


@contextmanager
def resumable() -> Iterator[None]:
    """Say that nothing is lost when a long run is stopped by hand."""
    try:
        yield
    except KeyboardInterrupt:
        typer.echo("vml: stopped; run the same command again to continue.", err=True)
        raise typer.Exit(130) from None

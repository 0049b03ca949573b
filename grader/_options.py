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


def the_course(place: str) -> Course:
    """Open a course, and say on standard error what in its settings has no effect."""
    from assignments.course import open_course, strangers_in  # noqa: PLC0415 - as in every command

    course = open_course(place)
    for line in strangers_in(course):
        typer.echo(line, err=True)
    return course


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

"""The command that writes what a learning platform takes back."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader._options import CourseOption, JsonOption, print_json, the_course
from grader.exports import export_names
from grader.grading_commands import AssignmentArgument

if TYPE_CHECKING:
    from grader.filling.job import Line


class DecimalMark(StrEnum):
    """The decimal mark that is written; `auto` is that of the template's other numbers."""

    AUTO = "auto"
    POINT = "point"
    COMMA = "comma"


def register(app: typer.Typer) -> None:
    """Add this command to `app`."""
    app.command("export")(export)


def export(
    assignment: AssignmentArgument,
    course: CourseOption,
    to: Annotated[
        str,
        typer.Option("--to", metavar="PLATFORM", help=f"One of {', '.join(export_names())}."),
    ],
    template: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The platform's own export, which is filled; it stays as it is.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="In the course's folder exports if not given.")
    ] = None,
    column: Annotated[
        str, typer.Option(metavar="HEADING", help="The template's column, where it is not called as the assignment.")
    ] = "",
    decimal: Annotated[DecimalMark, typer.Option(help="Decimal mark; auto is the template's.")] = DecimalMark.AUTO,
    wheels: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Prepared wheels for gradescope; downloaded if not given.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Write what a learning platform takes back, from the newest release.

    Platforms are picky about their own files. So give the one that the platform exports: only grades are filled in.
    Points that a person has still to confirm are written too, and said: the exit code is then 1.

    Example: vml export soccer-kick --to canvas --template Grades-DYN.csv --course dynamics-2026
    """
    from grader.exporting import Wish, export_grades

    wish = Wish(template, out, column, decimal.value, wheels)
    done = export_grades(the_course(course), assignment, to, wish)
    if as_json:
        print_json(asdict(done))
    else:
        _print(done.lines)
        counts = Counter(line.status for line in done.lines)
        typer.echo(", ".join(f"{number} {status}" for status, number in counts.items()) or "Nobody.")
        open_ = sum(line.is_open for line in done.lines)
        if open_:
            typer.echo(
                f"{open_} with open points, written as if all were earned. Settle them: "
                f"vml gradebook set PID {assignment} QUESTION POINTS; then vml release {assignment}, and export again."
            )
        if done.stale:
            typer.echo(
                f"{done.stale} grades have changed since the release and are not in it: vml release {assignment}."
            )
        typer.echo(f"Written: {done.file}. {done.hint}")
    if any(line.needs_attention for line in done.lines):
        raise typer.Exit(1)


def _print(lines: tuple[Line, ...]) -> None:
    for line in lines:
        typer.echo(f"{line.pid or '–':10}{line.status:17}{line.points:>8}  {line.name:28}{line.reason}".rstrip())

"""The commands of this package."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from assignments import assignment_commands


def register(app: typer.Typer) -> None:
    """Add this package's commands to `app`."""
    course = typer.Typer(help="Make and look after a course folder.", no_args_is_help=True)
    course.command("new")(new)
    course.callback()(_group)
    app.add_typer(course, name="course")
    assignment_commands.register(app)


def _group() -> None:
    """Make and look after a course folder."""


def new(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder to make; it may exist.")],
    title: Annotated[str, typer.Option(help="Title that students read; the folder's name if not given.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Make a course: its secret, its roster, its settings.

    Example: vml course new dynamics-2026 --title "Dynamics, spring 2026"
    """
    from assignments.course import new_course
    from assignments.load import assignment_ids

    course = new_course(folder, title)
    if as_json:
        typer.echo(json.dumps({"folder": str(course.folder), "title": course.title, "roster": str(course.roster)}))
        return
    typer.echo(
        f'Made the course "{course.title}" in {course.folder}. Its secret, {course.folder}/.secret, is yours alone.'
    )
    typer.echo(f"Next: put your students into {course.roster} (name,email), then run")
    typer.echo(f"  vml handout {assignment_ids()[0]} --course {course.folder}")

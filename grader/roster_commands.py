"""Commands for the class list."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from grader._options import CourseOption, JsonOption, print_json, the_course


def register(app: typer.Typer) -> None:
    """Add `vml roster ...` to `app`."""
    roster = typer.Typer(help="Take in a class list, and look after who is on it.", no_args_is_help=True)
    for name, command in (("import", import_), ("list", list_), ("drop", drop), ("purge", purge)):
        roster.command(name)(command)
    app.add_typer(roster, name="roster")


def import_(
    file: Annotated[
        Path, typer.Argument(help="CSV as Canvas, Moodle, Blackboard or Gradescope export it, or your own.")
    ],
    course: CourseOption,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say what would happen, change nothing.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Take in a class list: who is new gets a pseudonym, who is known stays who they are.

    Example: vml roster import 2026-10-01_Grades-DYN.csv --course dynamics-2026
    """
    from grader.page import counted
    from grader.rostering import import_roster

    imported = import_roster(the_course(course), file, dry_run=dry_run)
    arrivals = imported.arrivals
    if as_json:
        print_json([{"status": one.status, **asdict(one.student)} for one in arrivals])
        return
    listed = [one for one in arrivals if one.status != "not listed"]
    others = len(arrivals) - len(listed)
    for one in arrivals if others <= len(listed) else listed:  # a list of one late student is no new class list
        pid = "(not yet)" if dry_run and one.status == "new" else one.student.pid
        typer.echo(f"{pid:10}{one.status:12}{one.student.name:28}{one.student.email}".rstrip())
    counts = {
        status: sum(one.status == status for one in arrivals) for status in ("new", "known", "linked", "not listed")
    }
    typer.echo(", ".join(f"{number} {status}" for status, number in counts.items()) + ".")
    if counts["linked"]:
        typer.echo("Linked by name alone: have a look. If one of them is somebody else, give both an e-mail address.")
    if counts["not listed"]:
        typer.echo("Who is not listed stays, with grades. To leave them out: vml roster drop PID.")
    if imported.had_sample:
        typer.echo(f"The sample list in roster.csv {'would be' if dry_run else 'was'} put away.")
    if imported.own_students:
        own = counted(imported.own_students, "student")
        typer.echo(f"In the course as well: {own} of roster.csv. To leave somebody out: vml roster drop PID.")
    if dry_run:
        typer.echo("Nothing was changed (--dry-run).")


def list_(course: CourseOption, as_json: JsonOption = False) -> None:
    """Show the students of a course with their pseudonyms.

    Example: vml roster list --course dynamics-2026
    """
    from grader.rostering import roster_of

    students = roster_of(the_course(course))
    if as_json:
        print_json([asdict(student) for student in students])
        return
    for student in students:
        typer.echo(f"{student.pid:10}{student.status:9}{student.name:28}{student.email}".rstrip())
    typer.echo(f"{len(students)} students.")


def drop(
    pid: Annotated[str, typer.Argument(metavar="PID", help="The student's pseudonym.")], course: CourseOption
) -> None:
    """Leave a student out of what is handed out and exported from now on; their grades stay.

    Example: vml roster drop k3m9x2ab --course dynamics-2026
    """
    from grader.rostering import drop_student

    drop_student(the_course(course), pid)
    typer.echo(f"{pid} is dropped. A class list that has them takes them in again.")


def purge(
    course: CourseOption,
    dropped_only: Annotated[bool, typer.Option("--dropped-only", help="Only of those who were dropped.")] = False,
    yes: Annotated[bool, typer.Option("--yes", help="Do it without asking.")] = False,
) -> None:
    """Remove names and addresses from the gradebook for good; pseudonyms, grades and statistics stay.

    Example: vml roster purge --course dynamics-2024
    """
    from grader.page import counted
    from grader.rostering import places_of_names, purge_names

    opened = the_course(course)
    if not yes:
        typer.confirm("Names cannot be brought back from the gradebook. Remove them?", abort=True)
    number = purge_names(opened, dropped_only=dropped_only)
    typer.echo(f"Gone from the gradebook: the names of {counted(number, 'student')}.")
    for place in places_of_names(opened):
        typer.echo(f"Names are still in {place}: remove it, or make it anew.")

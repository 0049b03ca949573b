"""The command that compares what a class handed in; the instructor alone sees what it says."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated

import typer

from grader._options import CourseOption, JsonOption, print_json, the_course
from vml_course.commands._progress import progress


def register(app: typer.Typer) -> None:
    """Add this command to `app`."""
    app.command("integrity")(integrity)


def integrity(
    assignment: Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="Name, such as soccer-kick.")],
    course: CourseOption,
    as_json: JsonOption = False,
) -> None:
    """Compare the workbooks of a class: whose table follows whose video, who shares noise, cells or files.

    Files that a platform received from one student and that are another's are named too, graded or not. What is found
    is evidence to look at. It changes no grade, and no student's page shows it.

    Example: vml integrity soccer-kick --course dynamics-2026
    """
    from grader.comparing import compare_class
    from grader.shared_files import TOLD_BY_RECEIPTS

    with progress("comparing") as show:
        result = compare_class(the_course(course), assignment, show)
    if as_json:
        print_json(asdict(result))
        return
    for item in result.evidence:
        rate = "from the receipts" if item.method in TOLD_BY_RECEIPTS else _rate(item.false_positive_rate)
        typer.echo(f"{item.pid:10}{item.other or '–':10}{item.method:16}{rate}")
        typer.echo(f"{'':10}{item.words}")
    for pid in result.unread:
        typer.echo(f"{pid:10}could not be read again")
    typer.echo(f"{result.students} workbooks compared; {len(result.evidence)} to look at, {result.new} of them new.")
    typer.echo("This is evidence for a person, not a verdict; no grade was changed.")


def _rate(rate: float) -> str:
    if rate <= 0.0:
        return "never by chance"
    return "says little by itself" if rate >= 1.0 else f"in at most {rate:.1%} of honest classes"

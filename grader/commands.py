"""The commands of this package: parse, one use case, print."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader import export_commands, gradebook_commands, grading_commands, integrity_commands, roster_commands
from grader._options import JsonOption, print_json
from grader.handout_commands import handout
from vml_course.commands._progress import stages

if TYPE_CHECKING:
    from grader.form import Checked


def register(app: typer.Typer) -> None:
    """Add this package's commands to `app`."""
    app.command("demo")(demo)
    app.command("handout")(handout)
    app.command("check")(check)
    roster_commands.register(app)
    grading_commands.register(app)
    gradebook_commands.register(app)
    export_commands.register(app)
    integrity_commands.register(app)


def demo(
    students: Annotated[int, typer.Option(help="Number of sample students, 1 to 60.")] = 3,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the sample course.")] = Path("demo-course"),
    workers: Annotated[int, typer.Option(min=1, max=64, help="Processes that render at the same time.")] = 2,
    as_json: JsonOption = False,
) -> None:
    """Run the whole course once: simulate, render, hand out, measure, hand in, grade.

    Example: vml demo --students 3 --out demo-course
    """
    from grader.demo import run_demo

    with stages() as say:
        result = run_demo(out, students, workers, say)
    if as_json:
        graded = [{**asdict(g), "file": str(g.file), "feedback": g.feedback} for g in result.graded]
        print_json({"course": str(result.course), "stories": dict(result.stories), "graded": graded})
        return
    typer.echo(f"A sample course of {students} is in {result.course}. What the students did, and what the grader says:")
    for item in result.graded:
        typer.echo(f"  {item.points:4.1f} / {item.out_of:g}  {result.stories[item.pid]}")
    typer.echo("Open these in a browser:")
    typer.echo(f"  class page      {result.class_page}")
    for item in result.graded:
        typer.echo(f"  feedback page   {item.feedback}")
    typer.echo(f"Videos and tracks: {result.course / 'students'}; handouts: {result.course / 'handouts'}")


def check(
    workbook: Annotated[Path, typer.Argument(help="The workbook that you are about to hand in.")],
    as_json: JsonOption = False,
) -> None:
    """Look at a workbook as the grader will: can it be read, is it complete, does it agree with itself.

    It says nothing about right or wrong, and needs no course.

    It does not test the variant code either: hand in the workbook that came with your own video.

    Example: vml check workbook.xlsx
    """
    from grader.form import check_workbook

    result = check_workbook(workbook)
    if as_json:
        print_json({**asdict(result), "is_complete": result.is_complete})
    else:
        for answer in result.answers:
            typer.echo(f"{_mark(answer)} {answer.label}: {answer.says}")
        typer.echo(f"{'✓' if result.tracking_rows else '✗'} Tracking table: {result.tracking_rows} rows")
        for remark in result.remarks:
            typer.echo(f"! {remark}")
        complete = "Complete: " + (
            "but it is a practice workbook, which nobody can hand in." if result.is_practice else "it can be handed in."
        )
        typer.echo(complete if result.is_complete else "Not complete yet.")
        typer.echo("Only the form was looked at: not whether values are right, not whether the variant code is yours.")
    if not result.is_complete:
        raise typer.Exit(1)


def _mark(answer: Checked) -> str:
    return {"read": "✓", "no unit": "?", "unclear": "?"}.get(answer.status, "✗")

"""The commands of this package: parse, one use case, print."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader import gradebook_commands, roster_commands
from grader._options import CourseOption, JsonOption, print_json
from vml_course.commands._progress import progress, stages

if TYPE_CHECKING:
    from grader.form import Checked
    from grader.usecases import Graded


def register(app: typer.Typer) -> None:
    """Add this package's commands to `app`."""
    app.command("demo")(demo)
    app.command("handout")(handout)
    app.command("grade")(grade)
    app.command("check")(check)
    roster_commands.register(app)
    gradebook_commands.register(app)


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


def handout(
    assignment: Annotated[str, typer.Argument(help="Name of the assignment, such as soccer-kick.")],
    course: CourseOption,
    student: Annotated[
        list[str] | None, typer.Option("--student", metavar="PID", help="Only this pseudonym. Repeatable.")
    ] = None,
    workers: Annotated[int, typer.Option(min=1, max=64, help="Processes that render at the same time.")] = 1,
    as_json: JsonOption = False,
) -> None:
    """Make every student of the roster a video, a workbook and a handout of their own.

    Example: vml handout soccer-kick --course dynamics-2026 --workers 2
    """
    from assignments.course import open_course
    from grader.usecases import hand_out_to

    with _resumable(), progress("handing out") as show:
        handed, students = hand_out_to(open_course(course), assignment, student or (), workers=workers, progress=show)
    if as_json:
        print_json([{**asdict(item), "folder": str(item.folder)} for item in handed])
    else:
        for item in handed:
            name = students[item.student].name
            typer.echo(f"{item.student}  {item.status:8}{name:24}{item.reason or item.folder}")
        typer.echo(f"{sum(item.status != 'failed' for item in handed)} of {len(handed)} handed out.")
    if any(item.status == "failed" for item in handed):
        raise typer.Exit(1)


def grade(
    files: Annotated[list[Path], typer.Argument(help="Workbooks, or folders of workbooks.")],
    course: CourseOption,
    show_truth: Annotated[
        bool,
        typer.Option(
            "--show-truth/--hide-truth",
            help="Show students the true values and curves. Only after the due date: before it, hide them (default).",
        ),
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Grade workbooks, keep the grades, write a feedback page for each student and one for the class.

    The newest attempt counts. An attempt is as old as the first arrival of its content: an old file graded again stays
    old. Files of one student that come in together are taken in the order in which they were last changed.

    Until the due date the pages hide true values and curves; hints and outcomes stay. After it, add --show-truth.

    Example: vml grade returned/*.xlsx --course dynamics-2026
    """
    from assignments.course import open_course
    from grader.usecases import grade_files

    opened = open_course(course)
    with _resumable(), progress("grading") as show:
        graded = grade_files(opened, files, show_truth=show_truth, progress=show)
    if as_json:
        print_json([{**asdict(g), "file": str(g.file), "feedback": g.feedback or None} for g in graded])
    else:
        _print_graded(graded, opened.folder)
    if any(item.needs_attention for item in graded):
        raise typer.Exit(1)


def _print_graded(graded: Iterable[Graded], folder: Path) -> None:
    from grader.feedback import points_text

    graded = list(graded)
    for item in graded:
        earned = points_text(item.points, is_provisional=item.is_provisional)
        points = f"{earned} / {points_text(item.out_of)}" if item.status in {"ok", "review"} else "–"
        said = item.message.removeprefix(f"{item.file.name}: ")
        line = f"{item.pid or '–':10}{points:>14}  {item.status:11}{item.file.name}{'  ' if said else ''}{said}"
        typer.echo(line)
    for assignment_id in dict.fromkeys(item.assignment_id for item in graded if item.assignment_id):
        typer.echo(f"Class page: {folder / 'feedback' / assignment_id / 'class.html'}")


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
        typer.echo("Complete: it can be handed in." if result.is_complete else "Not complete yet.")
        typer.echo("Only the form was looked at: not whether values are right, not whether the variant code is yours.")
    if not result.is_complete:
        raise typer.Exit(1)


def _mark(answer: Checked) -> str:
    return {"read": "✓", "no unit": "?", "unclear": "?"}.get(answer.status, "✗")


# ---------------------------------------------------------------- shared


@contextmanager
def _resumable() -> Iterator[None]:
    """Say that nothing is lost when a long run is stopped by hand."""
    try:
        yield
    except KeyboardInterrupt:
        typer.echo("vml: stopped; run the same command again to continue.", err=True)
        raise typer.Exit(130) from None

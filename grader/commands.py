"""The commands of this package: parse, one use case, print."""

from __future__ import annotations

import getpass
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader._options import CourseOption, JsonOption, print_json, resumable
from grader.handout_commands import handout
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
    book = typer.Typer(
        help="Look into the gradebook of a course, and settle what needs a person.", no_args_is_help=True
    )
    book.callback()(_group)
    book.command("show")(show)
    book.command("set")(set_)
    app.add_typer(book, name="gradebook")


def _group() -> None:
    """Look into the gradebook of a course, and settle what needs a person."""


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
        graded = [{**asdict(g), "file": str(g.file), "feedback": str(g.feedback)} for g in result.graded]
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
    with resumable(), progress("grading") as show:
        graded = grade_files(opened, files, show_truth=show_truth, progress=show)
    if as_json:
        print_json([{**asdict(g), "file": str(g.file), "feedback": g.feedback and str(g.feedback)} for g in graded])
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
    """Look at a workbook as the grader will: can it be read, is it complete. Says nothing about right or wrong.

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
        typer.echo("Complete: it can be handed in." if result.is_complete else "Not complete yet.")
        typer.echo("Only the form was looked at: not whether values are right, not whether the variant code is yours.")
    if not result.is_complete:
        raise typer.Exit(1)


def _mark(answer: Checked) -> str:
    return {"read": "✓", "no unit": "?", "unclear": "?"}.get(answer.status, "✗")


def show(course: CourseOption, as_json: JsonOption = False) -> None:
    """Show the effective grades of a course.

    Example: vml gradebook show --course dynamics-2026
    """
    from assignments.course import open_course
    from grader.feedback import points_text
    from grader.gradebook import Gradebook

    with Gradebook.open(open_course(course)) as book:
        rows, students = book.rows(), book.students()
    if as_json:
        print_json([asdict(row) for row in rows])
        return
    for row in rows:
        who = f"{row.student.pid}  {row.student.name:24}{row.assignment_id:16}"
        earned = points_text(row.points, is_provisional=row.is_provisional)
        typer.echo(f"{who}{earned} / {points_text(row.out_of)}  attempt {row.attempt}  {row.status}")
        for text in row.adjustments:
            typer.echo(f"{'':10}{text}")
    graded = {row.student.pid for row in rows}
    for student in students:
        if student.pid not in graded:
            typer.echo(f"{student.pid}  {student.name:24}{'nothing graded yet'}")


def set_(
    pid: Annotated[str, typer.Argument(metavar="PID", help="The student's pseudonym.")],
    assignment: Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="Name of the assignment.")],
    question: Annotated[str, typer.Argument(metavar="QUESTION", help="Question, such as e; `total` for the whole.")],
    points: Annotated[float, typer.Argument(metavar="POINTS", help="Points that it is worth.")],
    reason: Annotated[str, typer.Option(help="Why; the student reads it.")],
    course: CourseOption,
    as_json: JsonOption = False,
) -> None:
    """Settle a review: set the points of a question of the attempt that counts. Nothing is overwritten.

    Example: vml gradebook set k3m9x2ab soccer-kick e 6 --reason "0.57 was meant" --course dynamics-2026
    """
    from assignments.course import open_course
    from grader.adjust import Adjustment
    from grader.events import now
    from grader.feedback import points_text
    from grader.usecases import set_points

    adjustment = Adjustment(question, points, reason, getpass.getuser(), now())
    row = set_points(open_course(course), assignment, pid, adjustment)
    if as_json:
        print_json(asdict(row))
        return
    typer.echo(f"{pid}: {adjustment}")
    earned = points_text(row.points, is_provisional=row.is_provisional)
    typer.echo(f"{earned} / {points_text(row.out_of)}  {row.status}  {' '.join(row.reasons)}".rstrip())
    typer.echo("The class page is written anew; the student's page shows it when their file is graded again.")

"""Commands that look into the gradebook and settle what needs a person."""

from __future__ import annotations

import getpass
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from grader._options import CourseOption, JsonOption, print_json, the_course

if TYPE_CHECKING:
    from grader.enrolment import Student

PidArgument = Annotated[str, typer.Argument(metavar="PID", help="The student's pseudonym.")]


# points below 0 are refused as a number, not as an option that is not known
_NUMBERS = {"ignore_unknown_options": True}


def register(app: typer.Typer) -> None:
    """Add `vml gradebook ...` to `app`."""
    book = typer.Typer(
        help="Look into the gradebook of a course, and settle what needs a person.", no_args_is_help=True
    )
    for name, command in (("show", show), ("set", set_), ("extend", extend), ("verify", verify)):
        book.command(name, context_settings=_NUMBERS if command is set_ else None)(command)
    app.add_typer(book, name="gradebook")


def show(course: CourseOption, as_json: JsonOption = False) -> None:
    """Show the effective grades of a course.

    Example: vml gradebook show --course dynamics-2026
    """
    from grader.feedback import points_text
    from grader.gradebook import Gradebook

    with Gradebook.open(the_course(course)) as book:
        rows, students = book.rows(), book.students()
    if as_json:
        print_json([asdict(row) for row in rows])
        return
    for row in rows:
        who = f"{row.student.pid}  {row.student.name:24}{row.assignment_id:16}"
        earned = points_text(row.points, is_provisional=row.is_provisional)
        typer.echo(
            f"{who}{earned} / {points_text(row.out_of)}  attempt {row.attempt}  {row.status}{_if_dropped(row.student)}"
        )
        for text in row.adjustments:
            typer.echo(f"{'':10}{text}")
    graded = {row.student.pid for row in rows}
    for student in students:
        if student.pid not in graded:
            typer.echo(f"{student.pid}  {student.name:24}nothing graded yet{_if_dropped(student)}")


def _if_dropped(student: Student) -> str:
    return "" if student.status == "active" else f"  {student.status}"


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
    from grader.adjust import Adjustment
    from grader.events import now
    from grader.feedback import points_text
    from grader.usecases import set_points

    adjustment = Adjustment(question, points, reason, getpass.getuser(), now())
    before, row = set_points(the_course(course), assignment, pid, adjustment)
    if as_json:
        print_json(asdict(row))
        return
    typer.echo(f"{pid}: {adjustment}")
    earned = points_text(row.points, is_provisional=row.is_provisional)
    typer.echo(f"{earned} / {points_text(row.out_of)}  {row.status}  {' '.join(row.reasons)}".rstrip())
    if row.attempt != before:
        typer.echo(f"Note: attempt {row.attempt} counts now; what you decided stands with attempt {before}.")
    typer.echo("The class page and the student's are written anew.")


def extend(
    pid: PidArgument,
    reason: Annotated[str, typer.Option(help="Why; it is kept.")],
    course: CourseOption,
    assignment: Annotated[str, typer.Option(metavar="ID", help="Only for this one; all if not given.")] = "",
    hours: Annotated[float, typer.Option(min=0, help="More time, in hours.")] = 0.0,
    attempts: Annotated[int, typer.Option(min=0, help="More attempts.")] = 0,
) -> None:
    """Give one student more time or more attempts: a line in course.toml, an event in the gradebook.

    Example: vml gradebook extend k3m9x2ab --hours 48 --reason "ill, note of 20 April" --course dynamics-2026
    """
    from assignments.terms import Extension
    from grader.usecases import extend_student

    given = Extension(pid, reason, assignment, hours, attempts)
    for line in extend_student(the_course(course), given):
        typer.echo(line)
    typer.echo("Handouts that were made show the old date; feedback pages show the new one. Tell the student.")


def verify(course: CourseOption, as_json: JsonOption = False) -> None:
    """Check that nothing in the gradebook was changed: the chain of events, and every file that came in.

    Example: vml gradebook verify --course dynamics-2026
    """
    from grader.verify import verify_course

    report = verify_course(the_course(course))
    if as_json:
        print_json({**asdict(report), "is_whole": report.is_whole})
    else:
        typer.echo(f"Chain of events: {report.events} events, {'unbroken' if report.chain_is_whole else 'BROKEN'}.")
        typer.echo(f"Files that came in: {report.files}, {len(report.damaged)} missing or changed.")
        for name in report.damaged:
            typer.echo(f"  {name}")
    if not report.is_whole:
        raise typer.Exit(1)

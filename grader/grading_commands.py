"""Commands that take in what students hand in, grade it, and say what it came to."""

from __future__ import annotations

import datetime as dt
import getpass
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader._options import CourseOption, JsonOption, print_json, resumable, the_course
from vml_course.commands._progress import progress
from vml_course.errors import InputError

if TYPE_CHECKING:
    from assignments.course import Course
    from grader.collect import Collected
    from grader.grading import Graded
    from grader.releasing import Change

AssignmentArgument = Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="Name, such as soccer-kick.")]
ReceivedOption = Annotated[
    dt.datetime | None,
    typer.Option(help="When all of it was handed in, where nobody says; it counts as in time if not given."),
]
ShowTruthOption = Annotated[
    bool | None,
    typer.Option(
        "--show-truth/--hide-truth",
        help="Show students the true values and curves, or not. If not given: as course.toml says under true_values.",
    ),
]


def register(app: typer.Typer) -> None:
    """Add these commands to `app`."""
    for name, command in (("collect", collect), ("grade", grade), ("release", release)):
        app.command(name)(command)


def collect(
    assignment: AssignmentArgument,
    download: Annotated[Path, typer.Argument(help="The zip as the platform gives it, or a folder.")],
    course: CourseOption,
    lms: Annotated[str, typer.Option(help="canvas, moodle, blackboard, gradescope, or auto.")] = "auto",
    received: ReceivedOption = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say whose each file is, keep nothing.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Take in a platform's download of submissions: whose is each file. `vml grade` then grades what is new.

    Example: vml collect soccer-kick submissions.zip --course dynamics-2026
    """
    from assignments.load import load_assignment
    from grader.collect import collect as take_in

    opened = the_course(course)
    load_assignment(assignment, opened.assignments)
    with resumable(), progress("collecting") as show:
        found = take_in(opened, assignment, download, platform=lms, received=received, dry_run=dry_run, progress=show)
    if as_json:
        print_json([asdict(item) for item in found])
    else:
        for item in found:
            typer.echo(f"{item.pid or '–':10}{item.status:12}{item.platform or '–':12}{item.name}")
            if item.message:
                typer.echo(f"{'':10}{item.message}")
        counts = Counter(item.status for item in found)
        typer.echo(", ".join(f"{number} {status}" for status, number in counts.items()) + ".")
        for advice in _what_settles(
            found, f"--assignment {assignment} --course {course}", f"{download} --course {course}"
        ):
            typer.echo(advice)
        typer.echo("Nothing was kept (--dry-run)." if dry_run else f"Next: vml grade --course {course}")
    if any(item.needs_attention for item in found):
        raise typer.Exit(1)


def _what_settles(found: Iterable[Collected], to_say: str, to_collect: str) -> Iterator[str]:
    """Yield what to do about files that nobody can grade: each advice once, where a file's reason asks for it."""
    waiting = [item for item in found if item.status in {"unmatched", "unreadable", "conflict"}]
    for other in dict.fromkeys(item.belongs_to for item in waiting if item.belongs_to):
        yield f"Workbooks of {other} are collected for it: vml collect {other} {to_collect}"
    if any(not item.belongs_to for item in waiting):
        yield f"Say whose a workbook is: vml grade FILE --whose STUDENT {to_say}"


def grade(
    course: CourseOption,
    files: Annotated[
        list[Path] | None, typer.Argument(help="Workbooks, or folders of workbooks; without any, what was collected.")
    ] = None,
    assignment: Annotated[str, typer.Option(metavar="ID", help="Of what was collected, only this assignment's.")] = "",
    whose: Annotated[
        str,
        typer.Option(metavar="STUDENT", help="With --assignment: these files are this student's, says who grades."),
    ] = "",
    again: Annotated[
        str, typer.Option(metavar="ID", help="Grade everything of this assignment anew; release says what it changes.")
    ] = "",
    show_truth: ShowTruthOption = None,
    received: ReceivedOption = None,
    workers: Annotated[
        int,
        typer.Option(min=0, max=512, help="Processes; 0 is one for each core, where worthwhile."),
    ] = 0,
    cluster: Annotated[
        str, typer.Option(metavar="ADDRESS", help="A dask scheduler that does the work; local:N starts one.")
    ] = "",
    as_json: JsonOption = False,
) -> None:
    """Grade workbooks, keep the grades, write a feedback page for each student and one for the class.

    Which attempt counts, and what lateness takes off, is said in course.toml. An attempt is as old as the first arrival
    of its content: an old file graded again stays old. Files of one student that are named together are taken in the
    order in which they were last changed.

    A workbook that lost its code (rebuilt in another program, its hidden sheet deleted), or that code and platform give
    to different students, is graded when you say whose it is: vml grade FILE --whose s03 --assignment soccer-kick. Who
    said so is written down; numbers of another student's video are not graded.

    Example: vml grade returned/*.xlsx --course dynamics-2026
    """
    from assignments.load import load_assignment
    from grader.grading import Wanted, Whose, grade_again, grade_collected, grade_files, waiting_files

    opened = the_course(course)
    for named in filter(None, (assignment, again)):
        load_assignment(named, opened.assignments)
    if whose and not (files and assignment):
        raise InputError("--whose", "files, and --assignment ID", "neither or one of them")
    says = Whose(whose, assignment, getpass.getuser()) if whose else None
    moment = received and received.replace(tzinfo=received.tzinfo or opened.calendar.zone)
    wanted = Wanted(show_truth, moment, workers, cluster)
    with resumable(), progress("grading") as show:
        if again:
            graded = grade_again(opened, again, wanted, progress=show)
        elif files:
            graded = grade_files(opened, files, wanted, whose=says, progress=show)
        else:
            graded = grade_collected(opened, assignment, wanted, progress=show)
    if as_json:
        print_json([{**asdict(g), "file": str(g.file), "feedback": g.feedback or None} for g in graded])
    else:
        _print_graded(graded, opened, course)
        waiting = 0 if files or again else waiting_files(opened, assignment)
        if waiting:
            typer.echo(
                f"{waiting} more came in that nobody could grade: the class page says why, --whose settles whose."
            )
    if any(item.needs_attention for item in graded):
        raise typer.Exit(1)


def _print_graded(graded: Iterable[Graded], course: Course, named: str) -> None:
    from assignments.terms import Terms
    from grader.feedback import points_text

    graded = list(graded)
    for item in graded:
        earned = points_text(item.points, is_provisional=item.is_provisional)
        points = f"{earned} / {points_text(item.out_of)}" if item.status in {"ok", "review"} else "–"
        said = item.message.removeprefix(f"{item.file.name}: ")
        line = f"{item.pid or '–':10}{points:>14}  {item.status:11}{item.file.name}{'  ' if said else ''}{said}"
        typer.echo(line)
    if not graded:
        typer.echo("Nothing new was collected. Name workbooks, or run vml collect first.")
        return
    counts = Counter(item.status for item in graded)
    statuses = ", ".join(f"{number} {status}" for status, number in counts.most_common())
    typer.echo(f"{len(graded)} file{'s' if len(graded) > 1 else ''}: {statuses}.")
    assignments = dict.fromkeys(item.assignment_id for item in graded if item.assignment_id)
    if any(course.calendar.terms_of(id_) != Terms() for id_ in assignments):
        typer.echo("These are the points of each file by itself.")
        typer.echo(f"What counts in the end: vml gradebook show --course {named}")
    for id_ in assignments:
        typer.echo(f"Class page: {course.shelf.place()}/feedback/{id_}/class.html")


def release(
    assignment: AssignmentArgument,
    course: CourseOption,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only say what would change.")] = False,
    show_truth: ShowTruthOption = None,
    as_json: JsonOption = False,
) -> None:
    """Fix what counts now, for students and platform: exports are made from the newest release.

    Says how it differs from the release before, and writes every page anew.

    Example: vml release soccer-kick --course dynamics-2026
    """
    from grader.usecases import release as release_now
    from grader.usecases import truth_note

    opened = the_course(course)
    with resumable(), progress("writing pages") as show:
        changes = release_now(
            opened,
            assignment,
            who=getpass.getuser(),
            dry_run=dry_run,
            show_truth=show_truth,
            progress=show,
        )
    if as_json:
        print_json([asdict(change) for change in changes])
        return
    for change in changes:
        if change.differs:
            typer.echo(f"{change.student.pid}  {change.student.name:28}{change.before_text:>9} -> {_after(change)}")
    typer.echo(f"{len(changes)} grades, {sum(change.differs for change in changes)} of them changed.")
    open_ = sum(change.is_provisional for change in changes)
    if open_:
        typer.echo(f"{open_} may still become fewer points: settle them first with vml gradebook set.")
    if show_truth is None and (note := truth_note(opened, assignment)):
        typer.echo(note)
    typer.echo(
        "Nothing was released (--dry-run)." if dry_run else f"Next: vml export {assignment} --to csv --course {course}"
    )


def _after(change: Change) -> str:
    return f"{'up to ' if change.is_provisional else ''}{change.after:g}"

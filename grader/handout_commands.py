"""`vml handout`: a variant for every student, a look ahead, or practice.

Heavy imports happen when it runs.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader._options import JsonOption, print_json, resumable, the_course
from vml_course.commands._progress import counted, progress
from vml_course.errors import InputError

if TYPE_CHECKING:
    from assignments.plan import Plan
    from grader.handing_out import Handed


def handout(
    assignment: Annotated[str, typer.Argument(help="Name of the assignment, such as soccer-kick.")],
    course: Annotated[
        str, typer.Option("--course", metavar="DIR", help="The course: a folder, or the URL of one in an object store.")
    ] = "",
    student: Annotated[
        list[str] | None, typer.Option("--student", metavar="PID", help="Only this pseudonym. Repeatable.")
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say who would get something; write nothing.")] = False,
    plan: Annotated[
        bool, typer.Option("--plan", help="Foresee cost, fairness and distinguishable answers; make nothing.")
    ] = False,
    plot: Annotated[Path | None, typer.Option(metavar="FILE.svg", help="With --plan: where its plot goes.")] = None,
    practice: Annotated[
        bool, typer.Option("--practice", help="Make a variant with its truth; needs no course.")
    ] = False,
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="DIR", help="With --practice: where to.")] = None,
    seed: Annotated[int, typer.Option(help="With --practice: another number, another variant.")] = 1,
    workers: Annotated[int, typer.Option(min=1, max=512, help="Processes that work at the same time.")] = 1,
    cluster: Annotated[
        str, typer.Option(metavar="ADDRESS", help="A dask scheduler that does the work; local:N starts one.")
    ] = "",
    as_json: JsonOption = False,
) -> None:
    """Make every student of the roster a video, a workbook and a handout of their own, as a folder and as a zip.

    A run that was stopped or killed goes on where it was; a second run changes nothing; who joins later changes
    nobody's variant. Names stand in handouts/roster-ASSIGNMENT.csv only.

    Example: vml handout soccer-kick --course dynamics-2026 --workers 2
    """
    if practice:
        _practise(assignment, out, seed, as_json=as_json)
        return
    if not course:
        raise InputError(
            "--course", "the course folder", "nothing", "For practice without a course: --practice -o DIR."
        )
    pids = tuple(student or ())
    if plan:
        _plan(course, assignment, pids, plot, as_json=as_json)
    elif dry_run:
        _look_ahead(course, assignment, pids, as_json=as_json)
    else:
        _hand_out(course, assignment, pids, workers, cluster, as_json=as_json)


def _hand_out(course: str, assignment: str, pids: Sequence[str], workers: int, cluster: str, *, as_json: bool) -> None:
    from grader.handing_out import hand_out_to

    with resumable(), counted("handing out", "students") as show:
        handed = hand_out_to(
            the_course(course, assignment), assignment, pids, workers=workers, cluster=cluster, progress=show
        )
    if as_json:
        print_json([asdict(item) for item in handed.results])
    else:
        _print_handed(handed)
    if handed.failed:
        raise typer.Exit(1)


def _print_handed(handed: Handed) -> None:
    for item in handed.results:
        if item.status != "failed":
            name = handed.students[item.student].name
            typer.echo(f"{item.student}  {item.status:8}{name:24}{item.place}")
    again = sum(len(item.refused) for item in handed.results)
    if again:
        typer.echo(f"{again} variants were drawn again after they were foreseen or measured: redrawn-*.log says why.")
    if handed.bundle:
        fits = any("moodle_participant" in (student.ids or {}) for student in handed.students.values())
        until = "" if fits else " (once vml roster import knows its participants' numbers; else one zip a student)"
        typer.echo(f"For Moodle{until}: {', '.join(handed.bundle)}.")
        typer.echo(f"Whose is whose: {handed.table} (keep it to yourself).")
    done = len(handed.results) - len(handed.failed)
    typer.echo(f"{done} of {len(handed.results)} handed out.")
    if handed.failed:
        typer.echo("Not handed out; the same command tries again:")
    for item in handed.failed:
        typer.echo(f"{item.student}  failed  {handed.students[item.student].name:24}{item.reason}")


def _look_ahead(course: str, assignment: str, pids: Sequence[str], *, as_json: bool) -> None:
    from grader.handing_out import expect

    expected = expect(the_course(course, assignment), assignment, pids)
    if as_json:
        print_json([asdict(item) for item in expected])
        return
    for item in expected:
        typer.echo(f"{item.pid or '–':10}{_SAID[item.status]:18}{item.name}")
    count = Counter(_SAID[item.status] for item in expected)
    typer.echo(f"{count['would get it']} would get it, {count['has it']} have it. Nothing was written.")


_SAID = {"already": "has it", "missing": "would get it", "new": "would get it"}


# ---------------------------------------------------------------- plan


def _plan(course: str, assignment: str, pids: Sequence[str], plot: Path | None, *, as_json: bool) -> None:
    from assignments.plan_plot import draw_plan
    from grader.handing_out import plan_for
    from vml_course.chart.svg import to_svg
    from vml_course.io.files import replacing

    opened = the_course(course, assignment)
    with resumable(), progress("looking ahead") as show:
        plan = plan_for(opened, assignment, pids, progress=show)
    home = opened.handouts(assignment).parent
    picture = plot or home / f"plan-{assignment}.svg"
    if plot is None:
        home.mkdir(parents=True, exist_ok=True)
    with replacing(picture) as temporary:
        temporary.write_text(to_svg(draw_plan(plan)), encoding="utf-8", newline="\n")
    if as_json:
        print_json({**asdict(plan), "cpu_s": plan.cpu_s, "disk_bytes": plan.disk_bytes, "plot": str(picture)})
        return
    for line in plan_lines(plan):
        typer.echo(line)
    typer.echo(f"Plot: {picture}")


def plan_lines(plan: Plan) -> list[str]:
    """Say a plan in words and a table."""
    unfair = sum(map(len, plan.unfair.values()))
    return [
        f"{plan.assignment_id}: {plan.students} students; {len(plan.looked_at)} variants looked at.",
        *_cost_lines(plan),
        f"Draws  {plan.redraws:.1f} rejected for each student; {unfair} drawn again as too hard to measure.",
        *(f"       {pid}: {why}" for pid, reasons in plan.unfair.items() for why in reasons),
        *_sharpness_lines(plan),
        *_alike_lines(plan),
    ]


def _cost_lines(plan: Plan) -> list[str]:
    each = plan.each
    stages = ", ".join(f"{stage} {seconds / each.students:.2f}" for stage, seconds in each.cpu_s.items())
    time = f"{each.cpu_s_each:.2f} s of processor time each ({stages}; from {each.students} made here)"
    disk = f"{each.bytes_each / 1e6:.2f} MB each, {plan.disk_bytes / 1e6:.0f} MB on the disk"
    return [f"Cost   {time}, {plan.cpu_s / 60:.1f} min in all.", f"       {disk} (folder, zip and bundle)."]


def _sharpness_lines(plan: Plan) -> list[str]:
    columns = "".join(f"{name:>9}" for name in ("least", "quarter", "median", "quarter", "most", "limit"))
    lines = [
        "Predicted standard deviation, % of what is allowed for full credit:",
        f"       {'':4}{'true values':24}{columns}",
    ]
    for sharp in plan.sharpness:
        span = f"{sharp.low:.3g} to {sharp.high:.3g} {sharp.unit if sharp.unit != '1' else ''}"
        shares = "".join(f"{100 * share:9.1f}" for share in (*sharp.quartiles, sharp.limit))
        lines.append(f"       {sharp.symbol:4}{span:24}{shares}")
    return lines


def _alike_lines(plan: Plan) -> list[str]:
    fits = f"{plan.fits_another:.0%} of honest answers will fit somebody else's truth, too"
    return [
        f"Alike  about {plan.distinguishable:.0f} answers can be told apart; {fits}:",
        "       equal answers prove nothing, equal tracks do.",
    ]


# ---------------------------------------------------------------- practice


def _practise(assignment: str, out: Path | None, seed: int, *, as_json: bool) -> None:
    from assignments.load import load_assignment
    from assignments.practice import SOLUTION, make_practice

    if out is None:
        raise InputError("--practice", "where to put it", "nothing", "Say so with -o DIR.")
    made = make_practice(load_assignment(assignment), out, seed)
    if as_json:
        print_json({"folder": str(made.folder), "files": made.files})
        return
    typer.echo(f"Practice is in {made.folder}: {', '.join(made.files)}.")
    typer.echo(f"Measure the video first; {SOLUTION} tells what is true and what would be accepted.")

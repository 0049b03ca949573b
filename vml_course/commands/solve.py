"""`vml solve`: e and I from a table of tracked points."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from vml_course.model.solution import ImpactSolution
    from vml_course.usecases.solve_table import Solved

EXAMPLE = """Examples; points, gravity and window are usually those of the scene of the model, and options change them:

vml solve kick.csv -g m=0.5kg -g L=0.56m --plot kick.svg --diagram kick-forces.svg

vml solve bat.csv -g m=0.19kg -g L=0.62m --striker barrel --knee hands --flight always --drive none

vml solve door.csv -g m=0.43kg -g L=0.72m -g a=0.5m --striker edge --knee hinge --gravity 0 --flight never
--drive none --window 80ms

vml solve hammer.csv --model hammer-block -g m=1.2kg -g L=0.5m --drive none

vml solve rod.csv --model free-rod -g m=0.25kg -g M=0.8kg -g b=0.16m

vml solve pucks.csv --model two-pucks -g m=0.2kg

vml solve bounce.csv --model spin-bounce -g m=0.6kg -g R=0.12m -g k=0.667

vml solve catch.csv --model ballistic-pendulum -g m=58g -g M=0.8kg -g d=0.33m -g c=0.28m
"""


class Drive(StrEnum):
    """Whether something may drive the striker beside gravity."""

    free = "free"
    none = "none"


class Flight(StrEnum):
    """When gravity acts on the struck body."""

    after = "after"
    always = "always"
    never = "never"


class Method(StrEnum):
    """Which way to solve."""

    both = "both"
    joint = "joint"
    lines = "lines"


def register(app: typer.Typer) -> None:
    """Add `solve` to the commands."""
    app.command("solve", epilog=EXAMPLE)(solve)


def solve(
    table: Annotated[Path, typer.Argument(help="Positions in metres: .xlsx, .csv or .mat, as `vml track` writes.")],
    given: Annotated[
        list[str] | None,
        typer.Option("-g", "--given", metavar="SYMBOL=VALUE", help="A given number with its unit. Repeatable."),
    ] = None,
    model: Annotated[str, typer.Option(help="Impact model.")] = "fixed-pivot",
    striker: Annotated[
        str | None, typer.Option(help="Point that strikes; usually foot, head, tail, puck_a ...")
    ] = None,
    struck: Annotated[
        str | None, typer.Option(help="Centre of the struck body; usually ball, block, puck_b ...")
    ] = None,
    knee: Annotated[str | None, typer.Option(help="Mark at the pivot: lines need it, joint only checks it.")] = None,
    striker_mark: Annotated[
        str | None, typer.Option("--striker-mark", help="Second mark on the body that strikes; a rod needs it.")
    ] = None,
    drive: Annotated[
        Drive | None, typer.Option(help="none: no driving torque is declared; four times as sharp in I. Usually free.")
    ] = None,
    flight: Annotated[
        Flight | None, typer.Option(help="When gravity acts on the struck body; fixed-pivot: after.")
    ] = None,
    at_rest: Annotated[bool, typer.Option("--at-rest", help="The struck body is at rest before the impact.")] = False,
    window: Annotated[
        str | None,
        typer.Option(help="Time each side that the joint fit uses; fixed-pivot: 40 ms, others up to 0.15 s."),
    ] = None,
    gravity: Annotated[
        str | None, typer.Option(help="9.81 m/s^2, or 0 in a view from above, as of rods and pucks.")
    ] = None,
    scale_sd: Annotated[
        str, typer.Option("--scale-sd", help="Relative standard deviation of the scale, such as 0.4%.")
    ] = "0",
    method: Annotated[Method, typer.Option(help="joint: least squares; lines: as a student does it.")] = Method.both,
    plot: Annotated[
        Path | None, typer.Option(help="Write positions, angle, fits and residuals there: .svg or .png.")
    ] = None,
    diagram: Annotated[
        Path | None,
        typer.Option(help="Write the free-body diagram there: .svg or .png. -g M=... -g c=... add the pin reaction."),
    ] = None,
    contact: Annotated[str, typer.Option(help="Duration of the contact, such as 10ms: adds the mean force.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Find restitution e and moment of inertia I of an impact, each with its uncertainty (one standard deviation)."""
    from vml_course.kinetics.models import impact_model
    from vml_course.model.reading import read_number, read_quantity
    from vml_course.usecases.diagram_solution import check_diagram, diagram_solution
    from vml_course.usecases.plot_solution import check_plot, plot_solution
    from vml_course.usecases.solve_table import read_given, solve_table

    if plot is not None:
        check_plot(plot)
    if diagram is not None:
        check_diagram(diagram, model, method.value)
    contact_s = read_quantity(contact, "time", name="--contact").value if contact else None
    values, given_sd = read_given(given or [])
    declared = {
        "striker": striker,
        "struck": struck,
        "knee": knee,
        "striker_mark": striker_mark,
        "drive": drive and drive.value,
        "flight": flight and flight.value,
        "at_rest": at_rest or None,
        "window_s": window and read_quantity(window, "time", name="--window").value,
        "gravity_m_s2": _gravity(gravity),
        "given_sd": given_sd,
        "scale_sd": read_number(scale_sd, name="--scale-sd"),
    }
    told = {name: value for name, value in declared.items() if value is not None}
    options = replace(impact_model(model).usual, **told)  # type: ignore[arg-type]
    solved = solve_table(table, model, values, options, method.value)
    if plot is not None:
        plot_solution(solved, plot)
    if diagram is not None:
        diagram_solution(solved, values, diagram, contact_s)
    if as_json:
        typer.echo(json.dumps(_as_json(solved), indent=1, ensure_ascii=False))
    else:
        _print(solved)
        if not options.scale_sd:
            typer.echo("note: the ± leave out how well the scale is known; say it with --scale-sd, such as 0.4%")


def _gravity(text: str | None) -> float | None:
    """Read an acceleration; nothing needs no unit."""
    from vml_course.model.reading import read_quantity

    if text is None or text.strip() == "0":
        return None if text is None else 0.0
    return read_quantity(text, "acceleration", name="--gravity").value


def _as_json(solved: Solved) -> dict[str, Any]:
    facts = _solution_json(solved.main)
    if solved.joint and solved.lines:
        facts["lines"] = _solution_json(solved.lines)
    return {**facts, "notes": list(solved.notes)}


def _solution_json(solution: ImpactSolution) -> dict[str, Any]:
    """Return one solution; a number that does not exist is null."""
    estimates = {
        symbol: {"value": _number(found.value), "sd": _number(found.sd), **({"unit": found.unit} if found.unit else {})}
        for symbol, found in solution.estimates.items()
    }
    figures = {name: _number(value) for name, value in solution.figures.items()}
    facts = {"model": solution.model, "method": solution.method, "frame_before": solution.frame_before}
    return {**estimates, **facts, "correlation_e_I": _number(solution.correlation_e_I), "figures": figures}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _print(solved: Solved) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    from vml_course.model.rounding import with_uncertainty

    main, found = solved.main, [s for s in (solved.joint, solved.lines) if s is not None]
    table = Table(
        title=f"{main.model}: impact after frame {main.frame_before}",
        title_justify="left",
        box=box.SIMPLE_HEAD,
        padding=(0, 2, 0, 0),
    )
    for name in ("", *(solution.method for solution in found), "unit"):
        table.add_column(name, no_wrap=True)
    for symbol, estimate in main.estimates.items():
        cells = [solution.estimates.get(symbol) for solution in found]
        texts = ["" if cell is None else with_uncertainty(cell.value, cell.sd) for cell in cells]
        table.add_row(symbol, *texts, estimate.unit)
    Console(highlight=False).print(table)
    for note in solved.notes:
        typer.echo(f"note: {note}")

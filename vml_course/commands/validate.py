"""`vml validate`: whether this installation still measures what it promises."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from vml_course.usecases.validate import Verdict

EXAMPLE = "Example: vml validate --quick"


def register(app: typer.Typer) -> None:
    """Add `validate` to the commands."""
    app.command("validate", epilog=EXAMPLE)(validate)


def validate(
    quick: Annotated[bool, typer.Option("--quick", help="Only the main cases, in less than two minutes.")] = False,
    budget: Annotated[Path | None, typer.Option(metavar="FILE", help="Limits as TOML, in place of those shipped.")] = (
        None
    ),
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Render known impacts, track and solve them, and compare with the truth; exit code 1 when a limit is broken."""
    from vml_course.commands._progress import progress
    from vml_course.usecases.budget import read_budget
    from vml_course.usecases.validate import cases
    from vml_course.usecases.validate import validate as run

    rows = read_budget(budget)
    with progress("validate") as show:
        verdicts = run(rows, cases(quick=quick), show)
    if as_json:
        typer.echo(json.dumps({one.score.case: _facts(one) for one in verdicts}, indent=1, ensure_ascii=False))
    else:
        _print(verdicts)
    raise typer.Exit(int(any(one.broken for one in verdicts)))


def _print(verdicts: list[Verdict]) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    table.add_column("scene/condition/method", no_wrap=True)
    for name in ("px rms, worst", "lost", "in 95 %", "ω %", "e %", "I %", ""):
        table.add_column(name, justify="right")
    for one in verdicts:
        score = one.score
        numbers = [
            f"{score.worst_rms_px:.3f}",
            str(score.lost_pictures),
            f"{score.coverage_pct:.0f}",
            *(_two(v) for v in (score.omega_error_pct, score.restitution_error_pct, score.inertia_error_pct)),
        ]
        table.add_row(score.case, *numbers, "over" if one.broken else "ok")
    Console(highlight=False).print(table)
    for one in verdicts:
        for limit in one.broken:
            value = one.score.coverage_pct if limit == "coverage_least_pct" else getattr(one.score, limit)
            typer.echo(f"{one.score.case}: {limit} is {value:.4g}, limit {getattr(one.limits, limit):g}.")
        if one.broken and one.score.note:
            typer.echo(f"{one.score.case}: no solution: {one.score.note}")
    over = sum(bool(one.broken) for one in verdicts)
    typer.echo(f"{len(verdicts) - over} of {len(verdicts)} cases within the budget")


def _two(value: float) -> str:
    return f"{value:.2f}" if math.isfinite(value) else "-"


def _facts(one: Verdict) -> dict[str, Any]:
    score = one.score
    numbers = {
        "worst_rms_px": score.worst_rms_px,
        "lost_pictures": score.lost_pictures,
        "coverage_pct": score.coverage_pct,
        "worst_time_error_ms": score.worst_time_error_ms,
        "omega_error_pct": score.omega_error_pct,
        "restitution_error_pct": score.restitution_error_pct,
        "inertia_error_pct": score.inertia_error_pct,
        "other_error_pct": score.other_error_pct,
    }
    points = {name: _number(value) for name, value in score.rms_px.items()}
    return {
        **{name: _number(value) for name, value in numbers.items()},
        "rms_px": points,
        "over": list(one.broken),
        "limits": {name: _number(value) for name, value in vars(one.limits).items()},
        "note": score.note,
    }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None

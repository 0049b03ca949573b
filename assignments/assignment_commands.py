"""`vml assignment`: look at assignments, check one's own, see one before it is handed out."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from assignments.model import Assignment, Draw

Name = Annotated[str, typer.Argument(metavar="ID|DIR", help="An assignment of the catalogue, or a folder with one.")]
CourseOption = Annotated[
    Path | None, typer.Option("--course", metavar="DIR", help="A course whose own assignments count too.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]


def register(app: typer.Typer) -> None:
    """Add `assignment` and its commands to `app`."""
    group = typer.Typer(help="List, show, check and preview assignments.", no_args_is_help=True)
    group.callback()(_group)
    group.command("list")(list_)
    group.command("show")(show)
    group.command("check")(check)
    group.command("preview")(preview)
    app.add_typer(group, name="assignment")


def _group() -> None:
    """List, show, check and preview assignments."""


def list_(course: CourseOption = None, as_json: JsonOption = False) -> None:
    """List the assignments that can be handed out.

    Example: vml assignment list
    """
    from assignments.load import FILE, assignment_ids, load_assignment

    also = course / "assignments" if course else None
    own = [path.parent.name for path in sorted(also.glob(f"*/{FILE}"))] if also else []
    found = [load_assignment(name, also) for name in dict.fromkeys([*assignment_ids(), *own])]
    rows = [(a.id, a.title, a.scene, ", ".join(_concluded(a)), f"{a.total_points:g}") for a in found]
    if as_json:
        names = ("id", "title", "scene", "finds", "points")
        _print_json([dict(zip(names, row, strict=True)) for row in rows])
        return
    _print_table(("id", "title", "scene", "finds", "points"), rows)


def show(
    assignment: Name,
    course: CourseOption = None,
    mistakes: Annotated[bool, typer.Option("--mistakes", help="List the mistakes that the grader knows, too.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Show what an assignment teaches, asks, tells and draws, and where its folder is.

    Example: vml assignment show two-pucks
    """
    from assignments.key import answerable
    from assignments.load import load_assignment
    from assignments.words import symbol_text, tolerance_text

    found = load_assignment(assignment, course / "assignments" if course else None)
    if as_json:
        _print_json({**asdict(found), "total_points": found.total_points, "mistakes": dict(_mistakes(found))})
        return
    typer.echo(f"{found.title}: {found.summary}\n")
    for goal in found.goals:
        typer.echo(f"  - {goal}")
    asked = [
        (q.group, q.label, symbol_text(q.symbol), q.unit, f"{q.points:g}", tolerance_text(q)) for q in found.questions
    ]
    _print_table(("", "asked", "symbol", "unit", "points", "full points"), asked)
    told = [
        (given.label, symbol_text(given.symbol), given.unit, given.parameter or f"{given.value:g}")
        for given in found.givens
    ]
    _print_table(("given", "symbol", "unit", "from"), told)
    _print_table(("drawn", "from", "to", "in steps of", "never"), [_drawn(draw) for draw in found.draws])
    fixed = ", ".join(f"{name} = {value:g}" for name, value in found.fixed.items())
    derived = ", ".join(f"{item.parameter} by {item.formula}" for item in found.derived)
    for title, text in (("Fixed", fixed), ("Derived", derived), ("Kept apart", ", ".join(found.separation.mistakes))):
        if text:
            typer.echo(f"{title}: {text}.")
    typer.echo(f"Can be asked in this scene: {', '.join(answerable(found.scene))}.")
    if mistakes:
        _print_table(("code", "mistake"), _mistakes(found))
    typer.echo(f"Its folder: {found.folder}")


def check(
    file: Annotated[Path, typer.Argument(metavar="FILE|DIR", help="An assignment.toml, or the folder that holds it.")],
    as_json: JsonOption = False,
) -> None:
    """Name every mistake in an assignment's file, with its line and what was expected; exit code 2 if there is one.

    Example: vml assignment check my-course/assignments/my-kick
    """
    from assignments.check import check_file

    found = check_file(file)
    if as_json:
        _print_json([asdict(item) for item in found.mistakes])
    else:
        for item in found.mistakes:
            typer.echo(
                f"{item.file}:{item.line}: {item.key}: expected {item.expected}, got {item.got}. {item.hint}".strip()
            )
        count = len(found.mistakes)
        good = f'{found.file}: right. "{found.title}" can be handed out.'
        typer.echo(f"{count} mistake{'s' if count > 1 else ''}" if count else good)
    raise typer.Exit(2 if found.mistakes else 0)


def preview(
    assignment: Name,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder for the files.")],
    course: CourseOption = None,
    number: Annotated[int, typer.Option(min=1, help="Another number is another variant.")] = 1,
    as_json: JsonOption = False,
) -> None:
    """Make one made-up variant: video, workbook and handout as students get them, and the instructor's solution.

    Example: vml assignment preview two-pucks -o preview
    """
    from assignments.load import load_assignment
    from assignments.preview import preview as make

    made = make(load_assignment(assignment, course / "assignments" if course else None), out, number)
    if as_json:
        _print_json({**asdict(made), "folder": str(made.folder)})
        return
    for name in made.files:
        typer.echo(f"{made.folder / name}")
    for reason in made.refused:
        typer.echo(f"drawn again: {reason}")


def _concluded(assignment: Assignment) -> list[str]:
    from assignments.words import symbol_text

    return [symbol_text(question.symbol) for question in assignment.questions if question.group == "conclusion"]


def _mistakes(assignment: Assignment) -> list[tuple[str, str]]:
    from assignments.names import filled, names_in
    from assignments.textbook import textbook_of

    names = names_in(assignment.scene, assignment.questions)
    known = textbook_of(assignment.scene).mistakes.values()
    return [(m.code, f"{m.quantity}: {filled(m.about, names)}") for m in known if m.scene in {"", assignment.scene}]


def _drawn(draw: Draw) -> tuple[str, ...]:
    never = ", ".join(f"{low:g} to {high:g}" for low, high in draw.avoid)
    return draw.parameter, f"{draw.low:g}", f"{draw.high:g}", f"{draw.step:g}", never


def _print_json(content: Any) -> None:
    typer.echo(json.dumps(content, indent=1, ensure_ascii=False))


def _print_table(titles: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for title in titles:
        table.add_column(title, justify="right" if title == "points" else "left")
    for row in rows:
        table.add_row(*row)
    Console(highlight=False).print(table)

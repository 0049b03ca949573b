"""`vml render`: a video whose truth is known."""

from __future__ import annotations

import json
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperCommand

if TYPE_CHECKING:
    from vml_course.model.truth import Truth
    from vml_course.usecases.make_video import MadeVideo

EXAMPLE = "Example: vml render soccer_kick --set e=11/15 --set fps=480 --seed 7 -o kick"


class Format(StrEnum):
    """Kinds of video that can be written."""

    mp4 = "mp4"
    avi = "avi"


class _RenderCommand(TyperCommand):
    """Lists the scenes under its help, and looks for them only then."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        from vml_course.synth.scene import scene_class, scene_names

        lines = [f"  {name}  {scene_class(name).title}" for name in scene_names()]
        self.epilog = "\n\n".join(["Scenes:", *lines, "", EXAMPLE])
        super().format_help(ctx, formatter)


def register(app: typer.Typer) -> None:
    """Add `render` to the commands."""
    app.command("render", cls=_RenderCommand)(render)


def render(
    scene: Annotated[str, typer.Argument(metavar="SCENE", help="Name of the scene.")],
    out: Annotated[Path | None, typer.Option("-o", "--out", help="Folder to write into.")] = None,
    values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A parameter, by name or symbol. Repeatable."),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Changes textures and noise, not the motion.")] = 0,
    video_format: Annotated[Format | None, typer.Option("--format", help="Kind of file, as --set format=…")] = None,
    parameters: Annotated[bool, typer.Option("--parameters", help="List what can be set, and end.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Simulate a scene and write its video with truth.json and truth.csv beside it."""
    from vml_course.commands._progress import progress
    from vml_course.errors import InputError
    from vml_course.synth.settings import read_settings
    from vml_course.usecases.make_video import make_video

    if parameters:
        _print_parameters(scene, as_json)
        return
    if out is None:
        raise InputError("--out", "a folder to write into", "nothing", "Add -o FOLDER.")
    chosen = [f"format={video_format.value}"] if video_format else []
    settings = read_settings(scene, [*(values or []), *chosen])
    with progress(f"render {scene}") as show:
        made = make_video(settings.scene, settings.camera, settings.recording, seed, out, show)
    _print_made(made, out, as_json)


def _print_made(made: MadeVideo, folder: Path, as_json: bool) -> None:
    truth = made.truth
    if as_json:
        facts = {
            "video": str(made.video),
            "truth_json": str(folder / "truth.json"),
            "truth_csv": str(folder / "truth.csv"),
            "frames": len(truth.time_s),
            "fps": truth.camera.fps,
            **_unknowns(truth),
            **_event(truth),
            "checks": {check.name: {"value": check.value, "limit": check.limit} for check in truth.checks},
        }
        typer.echo(json.dumps(facts, indent=1))
        return
    typer.echo(f"{made.video}  {len(truth.time_s)} frames at {truth.camera.fps:g} 1/s")
    typer.echo(f"{folder / 'truth.json'}  everything, with {len(truth.checks)} checks passed")
    typer.echo(f"{folder / 'truth.csv'}  {', '.join(truth.points)} in px and m")
    typer.echo(f"{', '.join(f'{symbol} = {value:.5g}' for symbol, value in _unknowns(truth).items())}, {_told(truth)}")


def _unknowns(truth: Truth) -> dict[str, float]:
    real = truth.strain or truth.met
    return {symbol: real.unknown(symbol) for symbol in real.unknowns}


def _event(truth: Truth) -> dict[str, float]:
    """Return when it happens: the impact, or the first frame at full load."""
    if truth.strain:
        frame = int(truth.strain.load.argmax())
        return {"full_load_s": float(truth.time_s[frame]), "full_load_frame": frame, "most_strain": truth.strain.most}
    return {"impact_time_s": truth.met.time_s, "frame_before": truth.met.frame_before}


def _told(truth: Truth) -> str:
    event = _event(truth)
    if truth.strain:
        strain = 100 * event["most_strain"]
        return f"strain of the marks up to {strain:.3g} %, full load from frame {event['full_load_frame']}"
    return f"impact at {event['impact_time_s'] * 1e3:.2f} ms, after frame {event['frame_before']}"


def _print_parameters(scene: str, as_json: bool) -> None:
    from dataclasses import asdict

    from rich import box
    from rich.console import Console
    from rich.table import Table

    from vml_course.synth.settings import settable, settable_words

    known, words = settable(scene), settable_words(scene)
    if as_json:
        typer.echo(json.dumps([*map(asdict, known.values()), *map(asdict, words.values())], indent=1))
        return
    table = Table(title=f"vml render {scene} --set NAME=VALUE", box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for name in ("name", "symbol", "default", "range"):
        table.add_column(name, no_wrap=True)
    table.add_column("meaning")
    for item in known.values():
        table.add_row(item.name, item.symbol, f"{item.default:.6g}", item.range_text, item.about)
    for word in words.values():
        table.add_row(word.name, "", word.default, ", ".join(word.words), word.about)
    Console().print(table)

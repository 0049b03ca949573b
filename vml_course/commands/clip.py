"""`vml clip`: the part of a video that matters, as a file of its own."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

EXAMPLE = "Example: vml clip kick.mp4 --start 400 --end 520 -o kick-clip.avi"


def register(app: typer.Typer) -> None:
    """Add `clip` to the commands."""
    app.command("clip", epilog=EXAMPLE)(clip)


def clip(
    video: Annotated[Path, typer.Argument(help="Video to cut.")],
    start: Annotated[int, typer.Option(help="First frame, counted from 0.")],
    end: Annotated[int, typer.Option(help="Last frame; it is part of the clip.")],
    out: Annotated[Path, typer.Option("-o", "--out", help="Clip to write: .avi (MJPEG) or .mp4 (H.264).")],
    step: Annotated[int, typer.Option(help="Take every STEP-th frame.")] = 1,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Cut a clip; a note beside it keeps frame numbers and rate of the video for `vml track`."""
    from vml_course.commands._progress import progress
    from vml_course.usecases.cut_clip import cut_clip

    with progress(f"clip {video.name}") as show:
        cut = cut_clip(video, out, start, end, step, show)
    for warning in cut.warnings:
        typer.echo(f"warning: {warning}", err=True)
    if as_json:
        facts = {
            "clip": str(cut.clip),
            "note": str(cut.note),
            "frames": cut.count,
            "first_frame": cut.first_frame,
            "last_frame": cut.last_frame,
            "step": step,
            "fps_clip": cut.fps,
            "fps_record": cut.fps_record,
            "warnings": cut.warnings,
        }
        typer.echo(json.dumps(facts, indent=1))
        return
    span = f"frames {cut.first_frame} to {cut.last_frame} of the video"
    typer.echo(f"{cut.clip}  {cut.count} pictures, {span}, recorded at {cut.fps_record:.6g} 1/s")
    typer.echo(f"{cut.note}  frame numbers and times; keep it beside the clip")

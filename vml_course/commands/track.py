"""`vml track`: points through a clip, by digital image correlation."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from vml_course.model.tracked import Tracked
    from vml_course.usecases.check_points import PointCheck
    from vml_course.usecases.estimate_track import TrackEstimate
    from vml_course.usecases.summarise_track import PointSummary
    from vml_course.usecases.track_clip import TrackRequest

EXAMPLE = (
    'Example: vml track kick.mp4 -p ball=513,480 -p foot=146,257 --fps 480 --scale "295,610,795,610=1 m" '
    "-o kick.xlsx --overlay kick-overlay.mp4"
)


def register(app: typer.Typer) -> None:
    """Add `track` to the commands."""
    app.command("track", epilog=EXAMPLE)(track)


def track(
    video: Annotated[
        Path,
        typer.Argument(
            help="Video, a clip of `vml clip` (frames keep the video's numbers), or a folder or pattern of pictures."
        ),
    ],
    points: Annotated[
        list[str] | None,
        typer.Option(
            "-p",
            "--point",
            metavar="NAME=X,Y[@FRAME]",
            help="A point, px, y down, in the first frame or in FRAME: it is tracked both ways. Repeatable.",
        ),
    ] = None,
    marks: Annotated[
        list[str] | None,
        typer.Option(
            "--mark",
            metavar="NAME=X,Y@FRAME",
            help="Where a point is in a further frame, by hand: tracking goes on from there. Repeatable.",
        ),
    ] = None,
    virtuals: Annotated[
        list[str] | None,
        typer.Option(
            "--virtual",
            metavar="NAME=A+B@X,Y",
            help="A point carried by tracked ones of the same body, and where it is seen. Repeatable.",
        ),
    ] = None,
    start: Annotated[int, typer.Option(help="First frame of the file, counted from 0.")] = 0,
    end: Annotated[int | None, typer.Option(help="Last frame of the file; the last one when not given.")] = None,
    step: Annotated[int, typer.Option(help="Take every STEP-th frame.")] = 1,
    fps: Annotated[str | None, typer.Option(metavar="F", help="Frames per second when recorded.")] = None,
    scale: Annotated[
        str | None,
        typer.Option(
            metavar="X1,Y1,X2,Y2=LENGTH", help='Two points, px, and their distance, such as "10,20,110,20=22 cm".'
        ),
    ] = None,
    origin: Annotated[
        str | None, typer.Option(metavar="X,Y", help="World's origin, px; the bottom-left pixel when not given.")
    ] = None,
    axis_angle: Annotated[
        float, typer.Option(metavar="DEG", help="Angle of the x axis from the horizontal, counter-clockwise.")
    ] = 0.0,
    vectors: Annotated[
        list[str] | None,
        typer.Option("--vector", metavar="NAME=TAIL:HEAD", help="A vector between two points. Repeatable."),
    ] = None,
    fill: Annotated[
        str | None, typer.Option(metavar="HOW", help="Fill gaps: linear or quadratic. They stay lost when not given.")
    ] = None,
    method: Annotated[str, typer.Option(help="Tracker; a wrong name lists those there are.")] = "dic",
    block: Annotated[int | None, typer.Option(metavar="PX", help="Side of the block that is matched; 60 px.")] = None,
    shutter: Annotated[
        str | None,
        typer.Option(metavar="F", help="Share of the frame interval that the shutter is open, 0 to 1; auto finds it."),
    ] = None,
    estimate: Annotated[bool, typer.Option("--estimate", help="Say how long it will take, and end.")] = False,
    check: Annotated[bool, typer.Option("--check", help="Say how well each point can be tracked, and end.")] = False,
    out: Annotated[
        list[Path] | None, typer.Option("-o", "--out", help="Table to write: .xlsx, .csv or .mat. Repeatable.")
    ] = None,
    overlay: Annotated[
        Path | None, typer.Option(help="Video with points and vectors drawn over it: .mp4 or .avi.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Track points through a video and write where they are in every frame."""
    from vml_course.commands._progress import progress
    from vml_course.errors import InputError
    from vml_course.usecases.check_points import check_points
    from vml_course.usecases.estimate_track import estimate_track
    from vml_course.usecases.export_track import check_outputs, export_track
    from vml_course.usecases.summarise_track import summarise
    from vml_course.usecases.track_clip import track_clip
    from vml_course.usecases.track_words import read_request

    words = {"fps": fps, "scale": scale, "origin": origin, "shutter": shutter}
    request = read_request(
        video,
        points or [],
        vectors or [],
        words,
        marks=marks or [],
        virtuals=virtuals or [],
        start=start,
        end=end,
        step=step,
        axis_angle_rad=math.radians(axis_angle),
        method=method,
        fill=fill,
        settings={"block": block},
    )
    if check:
        raise typer.Exit(_print_checks(check_points(request), as_json))
    if estimate:
        _say_if_compiling(request)
        _print_estimate(estimate_track(request), as_json)
        return
    tables = out or []
    if not tables and overlay is None:
        raise InputError("-o", "a table or an overlay to write", "nothing", "Add -o track.xlsx.")
    check_outputs(tables, overlay, video)
    _say_if_compiling(request)
    with progress(f"track {video.name}") as show:
        tracked = track_clip(request, show)
    with progress("draw overlay") as show:
        written = export_track(tracked, tables, overlay, show)
    for warning in tracked.warnings:
        typer.echo(f"warning: {warning}", err=True)
    _print(tracked, summarise(tracked), written, as_json)


def _say_if_compiling(request: TrackRequest) -> None:
    from vml_course.usecases.kernels_ready import compile_notice
    from vml_course.usecases.track_clip import check_video

    if notice := compile_notice(request.method):
        check_video(request)  # a mistake is one line: nothing is announced that will not happen
        typer.echo(notice, err=True)


def _print_checks(checks: list[PointCheck], as_json: bool) -> int:
    """Print the verdicts; return 1 when a point should not be tracked, else 0."""
    if as_json:
        typer.echo(json.dumps({one.seed.name: _check_facts(one) for one in checks}, indent=1, ensure_ascii=False))
    else:
        for one in checks:
            typer.echo(f"{one.seed.name}: {one.found.verdict.value}. {one.text}")
    return int(any(one.is_poor for one in checks))


def _check_facts(one: PointCheck) -> dict[str, Any]:
    found = one.found
    return {
        "verdict": found.verdict.value,
        "sigma_px": found.sigma_px if math.isfinite(found.sigma_px) else None,
        "noise_grey": found.noise_grey,
        "returns_px": one.returns_px if math.isfinite(one.returns_px) else None,
        "rival_zncc": found.rival.zncc,
        "rival_offset_px": found.rival.offset_px,
        "text": one.text,
    }


def _print_estimate(found: TrackEstimate, as_json: bool) -> None:
    if as_json:
        facts = {
            "seconds": found.seconds,
            "frames": found.frames,
            "points": found.points,
            "seconds_per_frame": found.seconds_per_frame,
        }
        typer.echo(json.dumps(facts, indent=1))
        return
    typer.echo(
        f"about {found.seconds:.1f} s for {found.points} points in {found.frames} frames"
        f" ({1e3 * found.seconds_per_frame:.1f} ms each). A smaller block or fewer points take less."
    )


def _print(tracked: Tracked, points: list[PointSummary], written: tuple[Path, ...], as_json: bool) -> None:
    if as_json:
        typer.echo(json.dumps(_facts(tracked, points, written), indent=1, ensure_ascii=False))
        return
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0))
    for name in ("point", "found", "worst ZNCC", "sigma px (median)"):
        table.add_column(name, no_wrap=True, justify="left" if name == "point" else "right")
    for one in points:
        table.add_row(one.name, _found(one), *map(_number, (one.worst_zncc, one.median_sigma_px), (3, 4)))
    Console(highlight=False).print(table)
    unit = f"{tracked.calibration.px_per_m:.6g} px/m" if tracked.calibration else "pixels only: no --scale"
    typer.echo(f"{len(tracked.track.frame)} frames at {tracked.fps:.6g} 1/s, {unit}{_shutter(tracked)}")
    for path in written:
        typer.echo(str(path))


def _shutter(tracked: Tracked) -> str:
    """Say what shutter was found in the clip, if it was looked for and found."""
    shutter, sd = (float(tracked.track.settings.get(name, math.nan)) for name in ("shutter", "shutter_sd"))
    return f", shutter open for {shutter:.2f} ± {sd:.2f} of a frame" if math.isfinite(sd) else ""


def _found(one: PointSummary) -> str:
    """Say in how many frames a point has a place, and in how many of them it was not tracked."""
    others = [f"{count} {status}" for status, count in one.statuses.items() if status not in {"auto", "lost"}]
    return f"{one.found} of {one.frames}" + (f" ({', '.join(others)})" if others else "")


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def _facts(tracked: Tracked, points: list[PointSummary], written: tuple[Path, ...]) -> dict[str, Any]:
    frames = tracked.track.frame
    return {
        "video": tracked.video,
        "frames": len(frames),
        "first_frame": int(frames[0]),
        "last_frame": int(frames[-1]),
        "fps": tracked.fps,
        "variable_rate": tracked.info.is_variable_rate,
        "shutter": tracked.track.settings.get("shutter"),
        "px_per_m": tracked.calibration.px_per_m if tracked.calibration else None,
        "points": {
            one.name: {
                "found": one.found,
                "lost": one.frames - one.found,
                "statuses": dict(one.statuses),
                "worst_zncc": one.worst_zncc if math.isfinite(one.worst_zncc) else None,
                "median_sigma_px": one.median_sigma_px if math.isfinite(one.median_sigma_px) else None,
                "references": one.references,
                "drift_px": one.drift_px,
            }
            for one in points
        },
        "files": [str(path) for path in written],
        "warnings": list(tracked.warnings),
    }

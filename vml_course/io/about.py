"""What a table says about itself: scale, settings, warnings, and what each sheet holds."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np

from vml_course.model.motion import Calibration
from vml_course.model.tracked import Tracked

Fact = tuple[str, str | int | float | bool, str]
SHEETS = {
    "Data": "one row per frame: positions, and angles and lengths of vectors",
    "Quality": "how well each point was found: zncc, sigma_px, iterations, status, displacement gradients",
    "Calibration": "scale, origin, axes and clock",
    "Settings": "how the clip was tracked, and from which file",
    "Columns": "what each column of Data and Quality means, and its unit",
}


def software() -> str:
    """Return the program's name and version."""
    return f"vml-course {version('vml-course')}"


def calibration_facts(tracked: Tracked) -> list[Fact]:
    """Return key, value and unit of all that turns pixels and frames into metres and seconds."""
    facts = _scale_facts(tracked.calibration, tracked.scale_relative_sd) if tracked.calibration else []
    return [
        *facts,
        ("fps", tracked.fps, "1/s"),
        ("fps_file", tracked.info.fps or "unknown", "1/s"),
        ("time_base", tracked.time_base, ""),
        ("t0_frame", int(tracked.track.frame[0]) if len(tracked.track.frame) else 0, ""),
    ]


def _scale_facts(calibration: Calibration, relative_sd: float | None) -> list[Fact]:
    facts: list[Fact] = [
        ("m_per_px", 1 / calibration.px_per_m, "m/px"),
        ("px_per_m", calibration.px_per_m, "px/m"),
    ]
    if relative_sd is not None:
        facts.append(("relative_uncertainty", relative_sd, ""))
    if calibration.stick_px is not None:
        stick = zip(("1_x", "1_y", "2_x", "2_y"), calibration.stick_px, strict=True)
        facts += [(f"stick_{corner}_px", value, "px") for corner, value in stick]
    if calibration.length_m is not None:
        facts += [("true_length_m", calibration.length_m, "m"), ("length_typed", calibration.length_text, "")]
    return [
        *facts,
        ("origin_x_px", calibration.origin_px[0], "px"),
        ("origin_y_px", calibration.origin_px[1], "px"),
        ("axis_angle_deg", float(np.degrees(calibration.axis_angle_rad)), "deg"),
        ("y_up", True, ""),
    ]


def settings_facts(tracked: Tracked) -> list[Fact]:
    """Return key, value and unit of how it was tracked and from which file."""
    info = tracked.info
    file: list[Fact] = [
        ("video", tracked.video, ""),
        ("sha256", tracked.sha256, ""),
        ("width_px", info.width_px, "px"),
        ("height_px", info.height_px, "px"),
        ("frames_in_file", info.frame_count, ""),
        ("variable_rate", info.is_variable_rate, ""),
        ("codec", info.codec, ""),
        ("container", info.container, ""),
        ("decoder", f"PyAV {version('av')}", ""),
        ("software", software(), ""),
    ]
    return [(key, value, "") for key, value in tracked.track.settings.items()] + file


def readme_lines(tracked: Tracked) -> list[tuple[str, str]]:
    """Return label and text of the first sheet."""
    points, vectors = tracked.track.points, tracked.vectors
    lines = [
        ("Program", software()),
        ("Video", tracked.video),
        ("Points", ", ".join(points)),
        ("Vectors", ", ".join(f"{one.name} = {one.tail} to {one.head}" for one in vectors) or "none"),
        ("Unit", "metres and pixels" if tracked.motion is not None else "pixels only: no scale was given"),
        ("Missing", "an empty cell was not measured; it is never 0 or a copy"),
    ]
    lines += [("Warning", text) for text in tracked.warnings]
    return lines + [(f"Sheet {name}", text) for name, text in SHEETS.items()]

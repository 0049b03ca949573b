"""What is checked of a measurement before and after it is solved: direction of y, length, gravity, energy."""

from __future__ import annotations

import math

from vml_course.errors import LengthMismatchError, UpsideDownError
from vml_course.kinetics.arc import fit_arc
from vml_course.kinetics.calibration_checks import Fall, apparent_gravity, gravity_cause
from vml_course.kinetics.clear_frames import Seen
from vml_course.kinetics.impact_model import ImpactOptions

LENGTH_SHARE = 0.02
DOUBT_SD = 3.0
RADIUS_NOTE = 0.003


def refuse_misfits(foot: Seen, struck: Seen, length_m: float, options: ImpactOptions) -> None:
    """Refuse data that cannot be what they are said to be.

    Raises
    ------
    UpsideDownError
        When the free body falls upwards.
    LengthMismatchError
        When the given length is not the radius of the striker's path: by 3 sd of their difference, and by 2 %.
    """
    refuse_upside_down(struck, options)
    arc = fit_arc(foot.xy_m, foot.pixel_m)
    # In curvatures: those of a short arc are nearly normal, its radii are not.
    off = abs(1.0 / arc.radius_m - 1.0 / length_m) * length_m
    seen_sd, told_sd = arc.radius_sd_m * length_m / arc.radius_m**2, options.given_sd.get("L", 0.0) / length_m
    if off > max(DOUBT_SD * math.hypot(seen_sd, told_sd, options.scale_sd), LENGTH_SHARE):
        raise LengthMismatchError("given L", arc.radius_m, arc.radius_sd_m, length_m)


def refuse_upside_down(body: Seen, options: ImpactOptions) -> None:
    """Refuse a free body that falls upwards.

    Raises
    ------
    UpsideDownError
    """
    g, fall = options.gravity_m_s2, apparent_gravity(body, options.up_angle_rad)
    if options.flight != "never" and g > 0 and fall.value < -0.5 * g and not _could_fall(fall, g):
        hint = "World coordinates have y up; set the axes, or change the sign of y."
        got = f"{-fall.value:.1f} m/s^2 upwards"
        raise UpsideDownError(options.struck, f"a ball that falls with about {g:g} m/s^2", got, hint)


def _could_fall(fall: Fall, gravity_m_s2: float) -> bool:
    return fall.value + 5.0 * fall.sd > 0.25 * gravity_m_s2


def pinned_notes(figures: dict[str, float], options: ImpactOptions) -> list[str]:
    """Return what a person should know of a pivoted body's solution, beside the common notes."""
    told = {
        _knee_note(figures, options): _knee_stands_off(figures),
        f"the rate of the striker changes by {100 * abs(figures['r']):.1f} % only; I is as uncertain as that "
        "small difference": abs(figures["r"]) < 0.1,
        f"the path of {options.striker} has a radius of {figures['arc_radius_m']:.4g} m, "
        f"{100 * abs(figures['arc_radius_off']):.1f} % {'more' if figures['arc_radius_off'] > 0 else 'less'} than L: "
        "the scale or the clicked point is a little off": _radius_is_off(figures),
        _gravity_note(figures, options): _gravity_is_off(figures, options),
    }
    return [note for note, is_true in told.items() if is_true]


def _radius_is_off(figures: dict[str, float]) -> bool:
    sd = figures["arc_radius_sd_m"] / figures["arc_radius_m"]
    return abs(figures["arc_radius_off"]) > max(RADIUS_NOTE, DOUBT_SD * sd)


def _knee_stands_off(figures: dict[str, float]) -> bool:
    offset = figures.get("knee_offset_m", 0.0)
    return offset > DOUBT_SD * figures.get("knee_offset_sd_m", 0.0) and offset > 0.005


def _knee_note(figures: dict[str, float], options: ImpactOptions) -> str:
    offset_mm = 1000 * figures.get("knee_offset_m", 0.0)
    return f"point {options.knee} is {offset_mm:.0f} mm from the pivot that the path of {options.striker} shows"


def _gravity_is_off(figures: dict[str, float], options: ImpactOptions) -> bool:
    fall = Fall(figures["apparent_g_m_s2"], figures["apparent_g_sd_m_s2"])
    g = options.gravity_m_s2
    return options.flight != "never" and g > 0 and abs(fall.value - g) > max(5.0 * fall.sd, 0.15 * g)


def _gravity_note(figures: dict[str, float], options: ImpactOptions) -> str:
    value, sd = figures["apparent_g_m_s2"], figures["apparent_g_sd_m_s2"]
    cause = gravity_cause(value, options.gravity_m_s2)
    return (
        f"{options.struck} falls with {value:.2f} ± {sd:.2f} m/s^2 instead of {options.gravity_m_s2:g}: "
        f"check frame rate and scale{cause}, or it is not in free flight"
    )

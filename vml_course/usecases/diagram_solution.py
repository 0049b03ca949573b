"""Write the free-body diagram of a solved impact, with the numbers on it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from vml_course.errors import InputError
from vml_course.kinetics.forces import PinnedRod, forces_of
from vml_course.kinetics.free_bodies import free_bodies_diagram
from vml_course.kinetics.free_body import free_body_diagram
from vml_course.usecases.plot_solution import check_drawing, write_drawing
from vml_course.usecases.solve_table import Solved

PINNED, FREE = ("fixed-pivot", "hammer-block"), ("free-rod", "two-pucks")
MODELS = (*PINNED, *FREE)
OPTION = "--diagram"


def check_diagram(path: Path, model: str, method: str) -> None:
    """Check before any work that there is a diagram for the model, and that it can be written there.

    Raises
    ------
    InputError, FileFormatError, FileMissingError
    """
    if model not in MODELS:
        raise InputError(OPTION, f"an impact of two bodies ({', '.join(MODELS)})", model, "Leave it out.")
    if method == "lines":
        raise InputError(OPTION, "a joint solution to draw", "lines alone", "Use --method both or joint.")
    check_drawing(path, OPTION)


def diagram_solution(solved: Solved, given: Mapping[str, float], path: Path, contact_s: float | None = None) -> None:
    """Write both bodies cut free, with impulse, pin reaction and velocities, to an SVG or PNG file.

    Parameters
    ----------
    solved : Solved
        By the joint method.
    given : mapping of str to float
        Of a pinned body: with its mass `M` and its centre's distance `c` from the pivot the pin reaction is drawn too.
    path : Path
    contact_s : float, optional
        Duration of the contact, for the mean force.

    Raises
    ------
    InputError, OutOfRangeError, FileFormatError, FileMissingError
    """
    check_diagram(path, solved.main.model, solved.main.method)
    found = solved.main
    if found.model in FREE:
        drawing = free_bodies_diagram(found, forces_of(found, contact_s), solved.options, given)
    else:
        is_told = "M" in given and "c" in given
        striker = PinnedRod(given["M"], given["c"], found.value("I")) if is_told else None
        drawing = free_body_diagram(found, forces_of(found, contact_s, striker))
    write_drawing(drawing, path)

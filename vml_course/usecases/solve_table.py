"""Solve an impact from a table of tracked points: the reference method and the student's, side by side."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from vml_course.errors import InputError, TooFewFramesError, UnknownNameError
from vml_course.io.tables import read_motion
from vml_course.kinetics.frame_faults import find_frame_faults
from vml_course.kinetics.impact_model import SYMBOLS, ImpactOptions
from vml_course.kinetics.lines import MODELS as BY_LINES
from vml_course.kinetics.lines import solve_by_lines
from vml_course.kinetics.models import impact_model
from vml_course.model.motion import Motion
from vml_course.model.reading import read_quantity
from vml_course.model.solution import ImpactSolution

METHODS = ("both", "joint", "lines")


@dataclass(frozen=True, eq=False)
class Solved:
    """What was found: by the reference method, and by the student's; None where it was not asked or failed."""

    motion: Motion
    options: ImpactOptions
    joint: ImpactSolution | None
    lines: ImpactSolution | None
    notes: tuple[str, ...]

    @property
    def main(self) -> ImpactSolution:
        """The joint solution where there is one, else the lines'."""
        found = self.joint or self.lines
        if found is None:
            raise InputError("method", f"one of {', '.join(METHODS)}", "none")
        return found


def read_given(texts: Iterable[str]) -> tuple[dict[str, float], dict[str, float]]:
    """Read given numbers such as `m=0.5kg` or `L=0.56 m ± 2 mm`.

    Returns
    -------
    given, given_sd : dict
        By symbol, SI units; the second holds those with an uncertainty.

    Raises
    ------
    InputError, UnknownNameError, NumberError, UnitError
    """
    given, given_sd = {}, {}
    for text in texts:
        symbol, equals, number = (part.strip() for part in text.partition("="))
        if not equals:
            raise InputError("-g", "symbol=number unit, such as m=0.5kg", repr(text))
        if symbol not in SYMBOLS:
            raise UnknownNameError("-g symbol", symbol, SYMBOLS)
        reading = read_quantity(number, SYMBOLS[symbol], name=f"given {symbol}")
        given[symbol] = reading.value
        if reading.uncertainty is not None:
            given_sd[symbol] = reading.uncertainty
    return given, given_sd


def solve_table(
    path: Path, model: str, given: Mapping[str, float], options: ImpactOptions | None = None, method: str = "both"
) -> Solved:
    """Read a table in metres and solve it.

    Parameters
    ----------
    path : Path
        XLSX, CSV or MAT with positions in metres, y up.
    model : str
        Name of an impact model.
    given : mapping of str to float
        Given numbers by symbol, SI units.
    options : ImpactOptions, optional
    method : str
        "both", "joint" (reference) or "lines" (the student's).

    Raises
    ------
    VmlError
        Those of the table's reader and of the solver.
    """
    return solve_motion(read_motion(path), model, given, options, method)


def solve_motion(
    motion: Motion, model: str, given: Mapping[str, float], options: ImpactOptions | None = None, method: str = "both"
) -> Solved:
    """Solve an impact from points in metres; see `solve_table`."""
    if method not in METHODS:
        raise UnknownNameError("method", method, METHODS)
    options, solver = options or ImpactOptions(), impact_model(model)
    if method == "lines" and model not in BY_LINES:
        hint = "Use --method joint."
        raise InputError("method", f"joint, lines being for {' and '.join(BY_LINES)}", "lines", hint)
    joint = solver.solve(motion, given, options) if method != "lines" else None
    lines, notes = None, (*(joint.notes if joint else ()), *find_frame_faults(motion).notes)
    if method == "lines":
        lines = solve_by_lines(motion, given, options)
    elif method == "both" and model in BY_LINES:
        try:
            lines = solve_by_lines(motion, given, options)
        except (UnknownNameError, TooFewFramesError) as error:
            notes = (*notes, f"no solution by lines: {error}")
    if joint and lines and model == "hammer-block":
        notes = (*notes, _slowing_note(joint, lines, options.struck))
    return Solved(motion, options, joint, replace(lines, model=model) if lines else None, notes)


def _slowing_note(joint: ImpactSolution, lines: ImpactSolution, struck: str) -> str:
    """Return why lines and the joint fit differ where friction slows the struck body."""
    lost = 100.0 * (1.0 - lines.value("v_b2") / joint.value("v_b2"))
    return (
        f"lines take {struck} to move steadily, but friction slows it: its speed after is {lost:.1f} % too small by "
        "lines, and e and I are off with it"
    )

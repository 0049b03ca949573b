"""What an impact model is, and what it can be told."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from vml_course.errors import InputError, OutOfRangeError, UnknownNameError
from vml_course.model.motion import Motion
from vml_course.model.solution import ImpactSolution

DRIVES = ("free", "none")
FLIGHTS = ("after", "always", "never")

SYMBOLS: Mapping[str, str] = {
    "m": "mass", "M": "mass", "L": "length", "D": "length", "R": "length", "a": "length", "b": "length", "c": "length",
    "d": "length", "k": "number",
}  # fmt: skip
"""Numbers that a student may be given, and their dimensions."""


@dataclass(frozen=True)
class ImpactOptions:
    """What is declared of a measurement beside the given numbers.

    Attributes
    ----------
    striker, struck : str
        Names of the tracked points: the striking point, and the struck body's centre.
    knee : str
        A mark at the pivot, for a check only (a mark 20 mm off would cost 22 % of I).
    striker_mark, struck_mark : str
        A second mark on the striking body, and one on the struck body away from its centre, where a model needs it.
    drive : str
        "free": an unknown constant driving acceleration is allowed for; "none": the assignment declares
        that there is none, which is four times as sharp in I.
    flight : str
        When gravity acts on the struck body: "after" the impact (it lay on a tee), "always", "never".
    at_rest : bool
        Whether the struck body is declared to be at rest before the impact.
    window_s : float
        Time each side of the impact that is fitted; never fewer than 10 frames where there are.
    gravity_m_s2 : float
    up_angle_rad : float
        Direction of "up" from the x axis, counter-clockwise: 90 degrees unless the axes were tilted.
    given_sd : mapping of str to float
        One standard deviation of given numbers, by symbol, SI units.
    scale_sd : float
        Relative standard deviation of the scale.
    """

    striker: str = "foot"
    struck: str = "ball"
    knee: str = "knee"
    striker_mark: str = ""
    struck_mark: str = ""
    drive: str = "free"
    flight: str = "after"
    at_rest: bool = False
    window_s: float = 0.040
    gravity_m_s2: float = 9.81
    up_angle_rad: float = math.pi / 2
    given_sd: Mapping[str, float] = field(default_factory=dict)
    scale_sd: float = 0.0

    def __post_init__(self) -> None:
        for name, known in (("drive", DRIVES), ("flight", FLIGHTS)):
            if getattr(self, name) not in known:
                raise UnknownNameError(name, getattr(self, name), known)
        if not 0.001 <= self.window_s <= 10.0:
            raise OutOfRangeError("window", 0.001, 10.0, "s", self.window_s)

    @property
    def gravity_xy_m_s2(self) -> tuple[float, float]:
        """Acceleration of a free body in the world's axes."""
        g, up = self.gravity_m_s2, self.up_angle_rad
        return -g * math.cos(up), -g * math.sin(up)


class ImpactModel(Protocol):
    """An impact that is understood: a file in `kinetics/models` defines one object `MODEL` of this kind.

    Attributes
    ----------
    name, title : str
    given : mapping of str to str
        Symbol of each number that must be given, and its dimension (a key of `UNITS`).
    optional : mapping of str to str
        Symbols that may be given beside.
    usual : ImpactOptions
        What is declared when nothing is: names of the points, view, and window of the scene that goes with it.
    """

    name: str
    title: str
    given: Mapping[str, str]
    optional: Mapping[str, str]
    usual: ImpactOptions

    def predict(self, parameters: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
        """Return the state after the impact, in closed form."""
        ...

    def solve(self, motion: Motion, given: Mapping[str, float], options: ImpactOptions | None = None) -> ImpactSolution:
        """Return e, I ... with uncertainty from tracked points."""
        ...


def check_given(
    given: Mapping[str, float], needed: Mapping[str, str], optional: Mapping[str, str] | None = None
) -> None:
    """Check that every needed symbol is given, and that it is positive, as those that may be given must be.

    Raises
    ------
    InputError
    """
    examples = {"mass": "0.5kg", "length": "0.56m", "number": "0.4"}
    may = {symbol: dimension for symbol, dimension in (optional or {}).items() if symbol in given}
    for symbol, dimension in {**needed, **may}.items():
        if symbol not in given:
            example = f"Give it with -g {symbol}={examples.get(dimension, '...')}."
            raise InputError(f"given {symbol}", f"a {dimension}", "nothing", example)
        if not (math.isfinite(given[symbol]) and given[symbol] > 0):
            raise InputError(f"given {symbol}", f"a positive {dimension}", f"{given[symbol]:g}")

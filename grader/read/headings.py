"""What a column of a tracking table holds, by its heading, in the manner of whichever program wrote it.

Ours says `ball_x_m`; the classic laboratory `x_ball`; Tracker `t`, `x`, `y` under the name of each mass, or `xball`;
people write `Ball x (cm)`, `time [s]`, `t/s`.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from vml_course.model.units import UNITS

_CLOCKS = {
    **dict.fromkeys(("frame", "frames", "frame_no", "frame_number", "image", "bild"), "frame"),
    "step": "step",
    **dict.fromkeys(("t", "time", "times", "zeit", "temps", "tiempo"), "t"),
}
_LENGTHS = {**UNITS["length"], "px": 1.0}
_TIMES = UNITS["time"]
_SPELLINGS = {"pixel": "px", "pixels": "px", "pix": "px", "sec": "s", "seconds": "s", "second": "s"}
_SPELLINGS |= {"metre": "m", "meter": "m", "metres": "m", "meters": "m", "msec": "ms"}
_FILLERS = frozenset({"pos", "position", "coord", "coordinate", "centre", "center"})
_DERIVED = frozenset({"v", "a", "p", "vel", "acc", "velocity", "acceleration", "speed", "theta", "omega", "alpha"})
_LETTERED = frozenset({"mass", "point", "marker", "object", "body"})  # a letter behind one is a name: mass A


@dataclass(frozen=True)
class Heading:
    """What one column holds.

    Attributes
    ----------
    role : str
        `frame`, `step`, `t`, `x` or `y`.
    point : str
        Which point, "" when the heading does not say.
    unit : str
        As `UNITS` spells it, or `px`; "" when the heading does not say.
    """

    role: str
    point: str = ""
    unit: str = ""

    @property
    def name(self) -> str:
        """The column's name as our own export writes it; lengths and times without unit count as SI."""
        if self.role in {"x", "y"}:
            return f"{self.point}_{self.role}_{'px' if self.unit == 'px' else 'm'}"
        return "t_s" if self.role == "t" else self.role

    @property
    def factor(self) -> float:
        """From the column's unit to metres, pixels or seconds."""
        return {**_LENGTHS, **_TIMES}.get(self.unit, 1.0)


def read_heading(text: str) -> Heading | None:
    """Return what a column holds; None when it is none of a tracking table's.

    >>> read_heading("Ball x (cm)"), read_heading("x_ball").name, read_heading("v_x")
    (Heading(role='x', point='ball', unit='cm'), 'ball_x_m', None)
    """
    words = [word for word in re.split(r"[\W_]+", unicodedata.normalize("NFKC", text).lower()) if word]
    unit = _SPELLINGS.get(words[-1], words[-1]) if len(words) > 1 else ""
    unit = unit if unit in _LENGTHS or unit in _TIMES else ""
    return _heading(words[:-1] if unit else words, unit)


def _heading(words: Sequence[str], unit: str) -> Heading | None:
    clock = _CLOCKS.get("_".join(words))
    if clock is not None:
        return Heading(clock, unit=unit) if not unit or (clock == "t" and unit in _TIMES) else None
    words = [word for word in words if word not in _FILLERS]
    if unit in _TIMES or not words:
        return None
    for role, rest in ((words[-1], words[:-1]), (words[0], words[1:])):
        if role in {"x", "y"}:
            return _of_point(role, rest, unit)
    glued = re.fullmatch(r"(pixel)?([xy])(\w*)", words[0])
    if glued is None or len(words) > 1:
        return None
    return _of_point(glued[2], [glued[3]], "px" if glued[1] else unit)


def _of_point(role: str, words: Sequence[str], unit: str) -> Heading | None:
    if any(word in _DERIVED and before not in _LETTERED for before, word in pairwise(["", *words])):
        return None
    named = [word for word in words if word != "pixel"]
    return Heading(role, "_".join(named), "px" if len(named) < len(words) else unit)


def read_headings(row: Mapping[int, str], above: Mapping[int, str]) -> dict[int, Heading]:
    """Return the headings of a row by column: of points with both x and y, and of clocks.

    Parameters
    ----------
    row, above : mapping of int to str
        Texts by column, of the row and of the one above, where Tracker writes the masses' names.
    """
    found: dict[int, Heading] = {}
    for column, text in sorted(row.items()):
        heading = read_heading(text)
        if heading is not None and heading.role in {"x", "y"} and not heading.point:
            heading = replace(heading, point=_group(above, column))
        if heading is not None and (heading.role == "t" or heading not in found.values()):
            found[column] = heading
    places = {(heading.point, heading.unit, heading.role) for heading in found.values()}
    return {
        column: heading
        for column, heading in found.items()
        if heading.role not in {"x", "y"} or {(heading.point, heading.unit, axis) for axis in "xy"} <= places
    }


def _group(above: Mapping[int, str], column: int) -> str:
    """Return the name that stands over a column, or over the nearest one to its left."""
    nearest = max((c for c in above if c <= column), default=0)
    words = re.findall(r"\w+", above.get(nearest, "").lower())
    return "_".join(words)[:40] or "point"


def match_points(names: Sequence[str], points: Sequence[str]) -> dict[str, str]:
    """Return which of the assignment's points each name of a table means; a name that could be any is left out.

    >>> match_points(["Ball", "foot_marker", "mass_c"], ["foot", "knee", "ball"])
    {'Ball': 'ball', 'foot_marker': 'foot'}
    """
    meant: dict[str, str] = {}
    for name in names:
        words = name.lower().split("_")
        said = [p for p in points if p.lower() == name.lower()] or [p for p in points if p.lower() in words]
        if len(said) == 1 and said[0] not in meant.values():
            meant[name] = said[0]
    if len(names) == len(points) == 1:
        meant[names[0]] = points[0]
    return meant

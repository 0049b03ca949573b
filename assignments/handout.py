"""The student's handout: one printable HTML file that needs nothing beside it.

Everything a student is told stands in it, and nothing of the answers: the template is given the
assignment, the given values and the first picture, never the truth.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined, TemplateError
from markupsafe import Markup, escape
from numpy.typing import NDArray

from assignments.errors import AssignmentFileError
from assignments.load import is_of_catalogue
from assignments.model import Assignment, Variant
from assignments.names import vector_of
from assignments.words import split_symbol, tolerance_text, tracking_columns
from vml_course.errors import InputError
from vml_course.io.files import replacing

TEMPLATES = Path(__file__).parent / "templates"
JPEG_QUALITY = 88  # a quarter of the size of a PNG, and the marks are as sharp on paper
INSET_PX = (48, 32)
RING_PX, LEADER_PX, LEADER_DIRECTIONS = 20.0, 105.0, 24
NAME_PX = 50.0  # about as wide as a name is drawn

Pixels = NDArray[np.uint8]


@dataclass(frozen=True)
class Inset:
    """A small part of the picture, shown so large that its pixels can be counted; `left`, `top` is its first pixel."""

    name: str
    left: int
    top: int
    width: int
    height: int
    image: str


@dataclass(frozen=True)
class Label:
    """A point's ring at x, y, and its name at the end of a leader line; `anchor` is SVG's text-anchor."""

    name: str
    x: float
    y: float
    start: tuple[float, float]
    end: tuple[float, float]
    text: tuple[float, float]
    anchor: str


@dataclass(frozen=True, eq=False)
class FirstPicture:
    """The first picture of a student's video, and where things are in it.

    Attributes
    ----------
    bgr : uint8 array, shape (height, width, 3)
    points_px : mapping of str to (float, float)
        Where each point to track is seen.
    stick_px : (x1, y1, x2, y2)
        Both ends of the known length; shown enlarged, not told.
    """

    bgr: Pixels
    points_px: Mapping[str, tuple[float, float]]
    stick_px: Sequence[float]

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height."""
        return self.bgr.shape[1], self.bgr.shape[0]

    @property
    def image(self) -> str:
        """The whole picture as a data address."""
        return data_address(self.bgr, ".jpg")

    def labels(self) -> list[Label]:
        """Place each name away from the lines between the points, where the body is, and inside the picture."""
        return [self._label(name, x, y) for name, (x, y) in self.points_px.items()]

    def _label(self, name: str, x: float, y: float) -> Label:
        others = [math.atan2(v - y, u - x) for other, (u, v) in self.points_px.items() if other != name]
        angles = (math.tau * k / LEADER_DIRECTIONS for k in range(LEADER_DIRECTIONS))
        angle = max(angles, key=lambda a: (self._has_room(x, y, a), min((_turn(a, b) for b in others), default=0.0)))
        across, down = math.cos(angle), math.sin(angle)
        start, end = ((round(x + r * across), round(y + r * down)) for r in (RING_PX, LEADER_PX))
        text = (round(end[0] + 6 * across), round(end[1] + 9 + 14 * down))
        return Label(name, round(x), round(y), start, end, text, _anchor(angle))

    def _has_room(self, x: float, y: float, angle: float) -> bool:
        width, height = self.size_px
        u, v = x + LEADER_PX * math.cos(angle), y + LEADER_PX * math.sin(angle)
        anchor = _anchor(angle)
        left = u - {"start": 0, "middle": NAME_PX / 2, "end": NAME_PX}[anchor]
        is_inside = 60 <= left <= width - NAME_PX and 60 <= v <= height - 40
        return is_inside and not self._is_on_stick(left + NAME_PX / 2, v)

    def _is_on_stick(self, u: float, v: float) -> bool:
        """Tell whether a name here would lie on the known length or on its caption."""
        x1, y1, x2, y2 = self.stick_px
        return abs(v - (y1 + y2) / 2) < NAME_PX and min(x1, x2) - NAME_PX < u < max(x1, x2) + NAME_PX

    def insets(self) -> tuple[Inset, Inset]:
        """Return both ends of the known length, enlarged."""
        x1, y1, x2, y2 = self.stick_px
        return self._inset("left end", x1, y1), self._inset("right end", x2, y2)

    def _inset(self, name: str, x: float, y: float) -> Inset:
        """Cut a piece whose corner lies on tens of pixels, so that its place tells nothing of the end's."""
        width, height = INSET_PX
        left = _fit(round((x - width / 2) / 10) * 10, width, self.size_px[0])
        top = _fit(round((y - height / 2) / 10) * 10, height, self.size_px[1])
        piece = self.bgr[top : top + height, left : left + width]
        return Inset(name, left, top, width, height, data_address(piece, ".png"))


def render_handout(
    assignment: Assignment,
    variant: Variant,
    given: Mapping[str, float],
    picture: FirstPicture,
    *,
    video: str = "video.mp4",
    terms: Sequence[str] = (),
) -> str:
    """Return the handout as HTML.

    Parameters
    ----------
    assignment : Assignment
        Its template decides what is said.
    variant : Variant
        Only its code is shown.
    given : mapping of str to float
        What the student is told, by the id of the given number.
    picture : FirstPicture
    video : str
        Name of the video file.
    terms : sequence of str
        When and how it is to be handed in, a sentence each.

    Raises
    ------
    AssignmentFileError
        When the template names something that does not exist.
    """
    environment = Environment(
        loader=FileSystemLoader([assignment.folder, str(TEMPLATES)]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(symbol=symbol_html, number=number_text, unit=unit_text, tolerance=tolerance_text)
    told = {"assignment": assignment, "code": variant.code, "given": given, "picture": picture}
    columns, vector = tracking_columns(assignment.points), vector_of(assignment.scene)
    can_check = is_of_catalogue(assignment.folder)
    try:
        template = environment.get_template(assignment.handout_template)
        return template.render(**told, columns=columns, vector=vector, video=video, terms=terms, can_check=can_check)
    except TemplateError as error:
        raise AssignmentFileError(
            f"{assignment.id}/{assignment.handout_template}",
            [InputError("template", "names and commands that exist", error.message or error)],
        ) from error


def write_handout(path: Path, html: str) -> None:
    """Write the file; whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(html, encoding="utf-8", newline="\n")


# ---------------------------------------------------------------- filters


def symbol_html(symbol: str) -> Markup:
    """Set a symbol as in print: letter in italics, subscript upright.

    >>> symbol_html("v_f1")
    Markup('<i>v</i><sub>f1</sub>')
    """
    letter, below = split_symbol(symbol)
    return Markup("<i>{}</i><sub>{}</sub>").format(letter, below) if below else Markup("<i>{}</i>").format(letter)


def number_text(value: float) -> str:
    """Write a given number with as many digits as it has.

    >>> number_text(0.5), number_text(480.0)
    ('0.5', '480')
    """
    return f"{float(value):.6g}"


def unit_text(unit: str) -> Markup:
    """Set a unit as in print.

    >>> unit_text("kg m^2")
    Markup('kg m²')
    """
    return escape(unit.replace("^2", "²"))


def data_address(pixels: Pixels, ending: str) -> str:
    """Return a picture as a `data:` address, so that the page needs no second file."""
    settings = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY] if ending == ".jpg" else []
    _, encoded = cv2.imencode(ending, pixels, settings)
    kind = "jpeg" if ending == ".jpg" else ending.removeprefix(".")
    return f"data:image/{kind};base64,{base64.b64encode(encoded.tobytes()).decode()}"


def _anchor(angle: float) -> str:
    across = math.cos(angle)
    return "middle" if abs(across) < 0.4 else "start" if across > 0 else "end"


def _turn(angle: float, other: float) -> float:
    """Return the angle between two directions, 0 to pi."""
    return abs((angle - other + math.pi) % math.tau - math.pi)


def _fit(start: int, length: int, whole: int) -> int:
    return max(0, min(start, whole - length))

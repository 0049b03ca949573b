"""What a drawing is made of. Coordinates are those of an SVG: y down, one unit a pixel at the usual size."""

from __future__ import annotations

from dataclasses import dataclass

Point = tuple[float, float]

INK, GREY, PALE = "#1b1b1b", "#6b6b6b", "#d9d9d9"
BLUE, ORANGE, GREEN, RED = "#0072b2", "#d55e00", "#009e73", "#b3261e"  # told apart by the colour-blind (Okabe and Ito)


@dataclass(frozen=True, slots=True)
class Line:
    """A line through points; dashed where `dash` says lengths of stroke and gap."""

    points: tuple[Point, ...]
    colour: str = INK
    width: float = 1.0
    dash: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Polygon:
    """A filled area."""

    points: tuple[Point, ...]
    fill: str
    edge: str = "none"


@dataclass(frozen=True, slots=True)
class Dot:
    """A disc."""

    at: Point
    radius: float
    fill: str
    edge: str = "none"


@dataclass(frozen=True, slots=True)
class Words:
    """A text; `anchor` is start, middle or end; `upright` turns it to read from below."""

    at: Point
    text: str
    size: float = 12.0
    colour: str = INK
    anchor: str = "start"
    is_upright: bool = False
    is_bold: bool = False


Shape = Line | Polygon | Dot | Words


@dataclass(frozen=True, slots=True)
class Drawing:
    """Shapes from back to front, with what a screen reader says of them."""

    width: float
    height: float
    shapes: tuple[Shape, ...]
    title: str
    description: str = ""


def arrow(tail: Point, head: Point, colour: str, width: float = 2.0) -> tuple[Shape, ...]:
    """Return an arrow; its tip has the same size at any length."""
    dx, dy = head[0] - tail[0], head[1] - tail[1]
    length = max((dx * dx + dy * dy) ** 0.5, 1e-9)
    ux, uy = dx / length, dy / length
    tip = min(4.5 * width, 0.7 * length)
    base = head[0] - ux * tip, head[1] - uy * tip
    side = 0.42 * tip
    wings = ((base[0] - uy * side, base[1] + ux * side), (base[0] + uy * side, base[1] - ux * side))
    return Line((tail, base), colour, width), Polygon((head, *wings), colour)

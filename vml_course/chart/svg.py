"""A drawing as SVG text."""

from __future__ import annotations

from html import escape

from vml_course.chart.shapes import Dot, Drawing, Line, Point, Polygon, Shape, Words

FONT = "Helvetica, Arial, sans-serif"


def to_svg(drawing: Drawing) -> str:
    """Return the drawing as one SVG element on white, with title and description; every word is escaped.

    >>> tiny = Drawing(8, 8, (Words((1, 7), "a < b"),), "tiny")
    >>> "a &lt; b" in to_svg(tiny)
    True
    """
    w, h = _number(drawing.width), _number(drawing.height)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}" role="img" '
        f'font-family="{FONT}">'
    )
    told = f"<title>{escape(drawing.title)}</title><desc>{escape(drawing.description)}</desc>"
    paper = f'<rect width="{w}" height="{h}" fill="#ffffff"/>'
    return "\n".join([head, told, paper, *map(_shape, drawing.shapes), "</svg>", ""])


def _shape(shape: Shape) -> str:
    match shape:
        case Line():
            dash = f' stroke-dasharray="{" ".join(map(_number, shape.dash))}"' if shape.dash else ""
            look = f'fill="none" stroke="{shape.colour}" stroke-width="{_number(shape.width)}"{dash}'
            return f'<polyline points="{_points(shape.points)}" {look}/>'
        case Polygon():
            return f'<polygon points="{_points(shape.points)}" fill="{shape.fill}" stroke="{shape.edge}"/>'
        case Dot():
            x, y = map(_number, shape.at)
            return f'<circle cx="{x}" cy="{y}" r="{_number(shape.radius)}" fill="{shape.fill}" stroke="{shape.edge}"/>'
        case Words():
            return _words(shape)


def _words(shape: Words) -> str:
    x, y = map(_number, shape.at)
    turn = f' transform="rotate(-90 {x} {y})"' if shape.is_upright else ""
    bold = ' font-weight="bold"' if shape.is_bold else ""
    look = f'font-size="{_number(shape.size)}" fill="{shape.colour}" text-anchor="{shape.anchor}"{bold}{turn}'
    return f'<text x="{x}" y="{y}" {look}>{escape(shape.text)}</text>'


def _points(points: tuple[Point, ...]) -> str:
    return " ".join(f"{_number(x)},{_number(y)}" for x, y in points)


def _number(value: float) -> str:
    return f"{value:.2f}".rstrip("0").rstrip(".")

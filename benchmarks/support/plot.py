"""One chart as SVG, written by hand: points on a logarithmic axis, one row a method, one column a case."""

from __future__ import annotations

from html import escape
from math import floor, isfinite, log10

FONT = 'font-family="Helvetica, Arial, sans-serif" font-size="12" fill="#222"'
COLOURS = ("#0b6e99", "#d1495b", "#5b8c3a", "#8a5fb0")
SHAPES = ("circle", "square", "diamond", "triangle")
PANEL, LEFT, TOP, ROW, GAP = 190, 190, 66, 30, 46
LOW, HIGH = 1e-3, 10.0
MOSTLY = 0.5  # share of pictures in which a point must be found to have an error worth showing


def chart(title: str, cases: list[str], methods: list[str], points: list[str], values: dict) -> str:
    """Return an SVG text.

    Parameters
    ----------
    values : dict
        (case, method, point) -> (error px, pictures lost, of how many).
    """
    width = LEFT + len(cases) * (PANEL + GAP) + 10
    height = TOP + len(methods) * ROW + 62
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" {FONT}>',
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
        f'<text x="12" y="22" font-size="15" font-weight="600">{escape(title)}</text>',
        *_legend(points, width),
        *(_name(method, k) for k, method in enumerate(methods)),
    ]
    for column, case in enumerate(cases):
        parts += _panel(LEFT + column * (PANEL + GAP), case, methods, points, values)
    parts.append(f'<text x="{LEFT}" y="{height - 10}" fill="#555">RMS distance from the truth, px (logarithmic). '
                 "Hollow: lost in some pictures. Cross at the right rim: lost in most.</text>")  # fmt: skip
    return "\n".join([*parts, "</svg>", ""])


def _legend(points, width):
    x = width - 78 * len(points)
    for k, point in enumerate(points):
        yield _mark(x + 78 * k, 18, k, 1.0)
        yield f'<text x="{x + 78 * k + 9}" y="22">{escape(point)}</text>'


def _name(method, k):
    weight = "600" if method.startswith("vml") else "400"
    y = TOP + k * ROW + ROW / 2 + 4
    return f'<text x="{LEFT - 12}" y="{y}" text-anchor="end" font-weight="{weight}">{escape(method)}</text>'


def _panel(x0, case, methods, points, values):
    bottom = TOP + len(methods) * ROW
    yield f'<text x="{x0}" y="{TOP - 10}" fill="#555">{escape(case)}</text>'
    for k in range(len(methods)):
        if k % 2 == 0:
            yield f'<rect x="{x0}" y="{TOP + k * ROW}" width="{PANEL}" height="{ROW}" fill="#f4f5f7"/>'
    for power in range(floor(log10(LOW)), floor(log10(HIGH)) + 1):
        x = x0 + _across(10.0**power)
        yield f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{bottom}" stroke="#d5d8dd"/>'
        yield f'<text x="{x:.1f}" y="{bottom + 16}" text-anchor="middle" font-size="11">{10.0**power:g}</text>'
    for row, method in enumerate(methods):
        for k, point in enumerate(points):
            error, lost, count = values[case, method, point]
            y = TOP + (row + 0.5) * ROW + (k - 1.5) * 5.5
            share = 1.0 - lost / count
            yield _mark(x0 + (_across(error) if isfinite(error) and share > MOSTLY else PANEL), y, k, share)


def _across(value):
    clipped = min(max(value, LOW), HIGH)
    return PANEL * (log10(clipped) - log10(LOW)) / (log10(HIGH) - log10(LOW))


def _mark(x, y, k, share):
    """Full when always found, hollow when sometimes lost, a cross when lost in most pictures."""
    colour = COLOURS[k % 4]
    if share <= MOSTLY:
        return f'<path d="M{x - 3.5:.1f} {y - 3.5:.1f}l7 7m0 -7l-7 7" stroke="{colour}" stroke-width="1.5"/>'
    look = f'fill="{colour if share == 1.0 else "#fff"}" stroke="{colour}" stroke-width="1.4"'
    shape = SHAPES[k % 4]
    if shape == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.6" {look}/>'
    if shape == "square":
        return f'<rect x="{x - 3.2:.1f}" y="{y - 3.2:.1f}" width="6.4" height="6.4" {look}/>'
    if shape == "diamond":
        return f'<path d="M{x:.1f} {y - 4.4:.1f}l4.4 4.4l-4.4 4.4l-4.4 -4.4z" {look}/>'
    return f'<path d="M{x:.1f} {y - 4.2:.1f}l4.2 7.6h-8.4z" {look}/>'

"""A drawing as PNG bytes, drawn by OpenCV: for places that show no SVG."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from vml_course.chart.shapes import Dot, Drawing, Line, Point, Polygon, Shape, Words

SCALE = 2.0
_SHIFT = 4  # OpenCV draws on a grid of 1/16 px
_FONT = cv2.FONT_HERSHEY_SIMPLEX
_WRITES_GREEK = hasattr(cv2, "FontFace")  # OpenCV 5 brings a font of its own; the strokes of 4 are ASCII alone
_UNIT = 22.0  # height of the font's capitals in px at scale 1
SPELLED = {
    "ω": "omega", "θ": "theta", "α": "alpha", "μ": "mu", "²": "^2", "°": " deg", "−": "-", "±": "+/-", "·": " ",
    "→": "->", "₁": "1", "₂": "2", "–": "-", "Σ": "sum",
}  # fmt: skip


def to_png(drawing: Drawing, scale: float = SCALE) -> bytes:
    """Return the drawing as PNG on white, `scale` pixels for each of its units."""
    size = round(drawing.height * scale), round(drawing.width * scale), 3
    image = np.full(size, 255, dtype=np.uint8)
    for shape in drawing.shapes:
        _draw(image, shape, scale)
    return bytes(cv2.imencode(".png", image)[1].tobytes())


def spelled(words: str) -> str:
    """Return words in letters that OpenCV 4 has.

    >>> spelled("ω = 26.8 rad/s ± 2°")
    'omega = 26.8 rad/s +/- 2 deg'
    """
    for letter, name in SPELLED.items():
        words = words.replace(letter, name)
    words = words.replace("( ", "(")
    return words.encode("ascii", "replace").decode()


def _draw(image: NDArray[np.uint8], shape: Shape, scale: float) -> None:
    match shape:
        case Line():
            for piece in _dashes(shape) if shape.dash else [shape.points]:
                width = max(1, round(shape.width * scale))
                cv2.polylines(image, [_grid(piece, scale)], False, _bgr(shape.colour), width, cv2.LINE_AA, _SHIFT)  # noqa: FBT003
        case Polygon():
            cv2.fillPoly(image, [_grid(shape.points, scale)], _bgr(shape.fill), cv2.LINE_AA, _SHIFT)
            edge = _bgr(shape.fill if shape.edge == "none" else shape.edge)
            cv2.polylines(image, [_grid(shape.points, scale)], True, edge, 1, cv2.LINE_AA, _SHIFT)  # noqa: FBT003
        case Dot():
            (x, y), radius = _grid([shape.at], scale)[0, 0], round(shape.radius * scale * (1 << _SHIFT))
            for colour, stroke in ((shape.fill, -1), (shape.edge, 1)):
                if colour != "none":
                    cv2.circle(image, (int(x), int(y)), radius, _bgr(colour), stroke, cv2.LINE_AA, _SHIFT)
        case Words():
            _write(image, shape, scale)


def _write(image: NDArray[np.uint8], shape: Words, scale: float) -> None:
    words, height = shape.text if _WRITES_GREEK else spelled(shape.text), 0.70 * shape.size * scale / _UNIT
    stroke = max(1, round(height * (2.0 if shape.is_bold else 1.4)))
    (width, tall), below = cv2.getTextSize(words, _FONT, height, stroke)
    shift = {"start": 0.0, "middle": 0.5, "end": 1.0}[shape.anchor] * width
    x, y = shape.at[0] * scale, shape.at[1] * scale
    if not shape.is_upright:
        cv2.putText(image, words, (round(x - shift), round(y)), _FONT, height, _bgr(shape.colour), stroke, cv2.LINE_AA)
        return
    strip = np.full((tall + below, max(width, 1), 3), 255, dtype=np.uint8)
    cv2.putText(strip, words, (0, tall), _FONT, height, _bgr(shape.colour), stroke, cv2.LINE_AA)
    strip = np.rot90(strip)
    left, top = max(round(x) - tall, 0), max(round(y + shift) - len(strip), 0)
    place = image[top : top + len(strip), left : left + strip.shape[1]]
    np.minimum(place, strip[: place.shape[0], : place.shape[1]], out=place)


def _dashes(line: Line) -> list[tuple[Point, ...]]:
    """Cut a line into strokes of its dash."""
    points = np.asarray(line.points, dtype=np.float64)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    stroke, gap = line.dash or (1.0, 0.0)
    pieces = []
    for start in np.arange(0.0, along[-1], stroke + gap):
        at = np.unique(
            np.concatenate([[start, min(start + stroke, along[-1])], along[(along > start) & (along < start + stroke)]])
        )
        pieces.append(tuple(zip(np.interp(at, along, points[:, 0]), np.interp(at, along, points[:, 1]), strict=True)))
    return pieces


def _grid(points: object, scale: float) -> NDArray[np.int32]:
    scaled = np.asarray(points, dtype=np.float64) * scale
    return np.round(np.clip(scaled, -1e5, 1e5) * (1 << _SHIFT)).astype(np.int32).reshape(-1, 1, 2)


def _bgr(colour: str) -> tuple[int, int, int]:
    """Return blue, green, red of `#rrggbb`."""
    return int(colour[5:7], 16), int(colour[3:5], 16), int(colour[1:3], 16)

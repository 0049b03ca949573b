"""Drawing on a picture: lines, arrows, texts with a dark outline, so that they show on any video."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
Colour = tuple[int, int, int]
Point = tuple[float, float]

# Blue, green, red. The marks' colours can be told apart by the colour-blind (Okabe and Ito).
BLACK: Colour = (0, 0, 0)
WHITE: Colour = (255, 255, 255)
BLUE: Colour = (255, 120, 20)
LIGHT_BLUE: Colour = (255, 190, 120)
YELLOW: Colour = (60, 225, 250)
RED: Colour = (70, 70, 255)
MARKS: tuple[Colour, ...] = (
    (0, 159, 230), (115, 200, 40), (233, 180, 86), (167, 121, 204), (66, 228, 240), (0, 94, 213),
)  # fmt: skip
_SHIFT = 4  # OpenCV draws on a grid of 1/16 px
_FONT = cv2.FONT_HERSHEY_SIMPLEX


class Pen:
    """Draws on one image; `size` scales strokes and texts (1 at a height of 720 px)."""

    def __init__(self, image: Image, size: float = 1.0) -> None:
        self.image, self.size = image, size

    def line(self, points: Sequence[Point], colour: Colour, width: float, *, is_closed: bool = False) -> None:
        """Draw a polyline with a dark outline."""
        path = [_grid(points)]
        for stroke, paint in ((width + 2, BLACK), (width, colour)):
            cv2.polylines(self.image, path, is_closed, paint, self._stroke(stroke), cv2.LINE_AA, _SHIFT)

    def plain_line(self, points: Sequence[Point], colour: Colour, width: float) -> None:
        """Draw a polyline without an outline."""
        cv2.polylines(self.image, [_grid(points)], False, colour, self._stroke(width), cv2.LINE_AA, _SHIFT)  # noqa: FBT003

    def arrow(self, tail: Point, head: Point, colour: Colour, width: float) -> None:
        """Draw an arrow; its tip has the same size at any length."""
        way = np.subtract(head, tail)
        length = float(np.hypot(*way))
        if length < 1:
            return
        along, across = way / length, np.array([-way[1], way[0]]) / length
        tip = min(5.5 * width * self.size, 0.6 * length)
        base = np.asarray(head) - along * tip
        left, right = base + across * tip * 0.42, base - across * tip * 0.42
        wings = _grid([head, (float(left[0]), float(left[1])), (float(right[0]), float(right[1]))])
        cv2.polylines(self.image, [wings], True, BLACK, self._stroke(2.5), cv2.LINE_AA, _SHIFT)  # noqa: FBT003
        self.line([tail, (float(base[0]), float(base[1]))], colour, width)
        cv2.fillPoly(self.image, [wings], colour, cv2.LINE_AA, _SHIFT)

    def arc(self, centre: Point, radius: float, start_rad: float, sweep_rad: float, colour: Colour) -> None:
        """Draw an arc; angles counter-clockwise as one sees them, from the picture's horizontal."""
        angles = start_rad + np.linspace(0, sweep_rad, max(3, int(abs(sweep_rad) * 12)))
        x, y = centre
        self.line([(x + radius * np.cos(a), y - radius * np.sin(a)) for a in angles], colour, 1.5)

    def cross(self, at: Point, colour: Colour) -> None:
        """Draw a mark: a cross whose middle stays free, so that one sees what is measured."""
        x, y = at
        near, far = 4 * self.size, 12 * self.size
        for ax, ay in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            self.line([(x + near * ax, y + near * ay), (x + far * ax, y + far * ay)], colour, 2)

    def diamond(self, at: Point, colour: Colour) -> None:
        """Draw a diamond about a place: put there by hand."""
        (x, y), far = at, 15 * self.size
        self.line([(x + far, y), (x, y + far), (x - far, y), (x, y - far)], colour, 2, is_closed=True)

    def ring(self, at: Point, colour: Colour, radius: float) -> None:
        """Draw a ring about a place."""
        reach, angles = radius * self.size, np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
        x, y = at
        self.line([(x + reach * np.cos(a), y + reach * np.sin(a)) for a in angles], colour, 2, is_closed=True)

    def text(self, words: str, at: Point, colour: Colour, height: float = 0.75) -> None:
        """Write words with a dark outline; `at` is their lower left corner."""
        # The outline is the same writing, shifted: in some OpenCV versions a thicker stroke makes wider letters.
        reach = max(1, round(1.5 * self.size))
        for dx, dy in ((-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)):
            self._write(words, (at[0] + reach * dx, at[1] + reach * dy), BLACK, height)
        self._write(words, at, colour, height)

    def text_size(self, words: str, height: float = 0.75) -> tuple[int, int]:
        """Return width and height of words in px."""
        (width, tall), _ = cv2.getTextSize(shown(words), _FONT, height * self.size, self._stroke(1.5))
        return int(width), int(tall)

    def _write(self, words: str, at: Point, colour: Colour, height: float) -> None:
        place = (round(at[0]), round(at[1]))
        cv2.putText(self.image, shown(words), place, _FONT, height * self.size, colour, self._stroke(1.5), cv2.LINE_AA)

    def shade(self, left: int, top: int, width: int, height: int) -> None:
        """Darken a box, to write on."""
        box = self.image[max(top, 0) : top + height, max(left, 0) : left + width]
        box[...] = (box.astype(np.uint16) * 3 // 10).astype(np.uint8)

    def _stroke(self, width: float) -> int:
        return max(1, round(width * self.size))


def shown(words: str) -> str:
    """Return words in the letters that the font has."""
    return words.encode("ascii", "replace").decode()


def _grid(points: Sequence[Point]) -> NDArray[np.int32]:
    bounded = np.clip(np.asarray(points, dtype=np.float64), -1e5, 1e5)
    return np.round(bounded * (1 << _SHIFT)).astype(np.int32).reshape(-1, 1, 2)

"""A verdict on a block in a plain sentence: what is wrong, and what to do about it."""

from __future__ import annotations

import numpy as np

from vml_course.track.trackability import Trackability, Verdict


def sentence(found: Trackability) -> str:
    """Return what to tell the person who placed the point."""
    return _SENTENCES[found.verdict](found)


def _good(found: Trackability) -> str:
    return f"Good texture. Expect about ±{found.sigma_px:.2g} px."


def _fair(found: Trackability) -> str:
    return f"Faint texture. Expect about ±{found.sigma_px:.2g} px; a larger block or a stronger pattern does better."


def _edge(found: Trackability) -> str:
    return (
        f"Only an edge: the block can slide {direction(found.strength.slide_rad)}. "
        "Take a corner, or a larger block that holds one."
    )


def _repeating(found: Trackability) -> str:
    x, y = found.rival.offset_px
    return (
        f"Looks the same at {side(x, y)} (correlation {found.rival.zncc:.2f}); the tracker may jump there. "
        "Take a larger block, or a spot that is unlike its neighbours."
    )


def _poor(found: Trackability) -> str:
    if np.isfinite(found.sigma_px):
        return f"Almost no texture: expect ±{found.sigma_px:.2g} px. Take a larger block, or a spot with a pattern."
    return "No texture here. Track a mark, a seam or a logo on the same body instead."


_SENTENCES = {
    Verdict.GOOD: _good,
    Verdict.FAIR: _fair,
    Verdict.EDGE: _edge,
    Verdict.REPEATING: _repeating,
    Verdict.POOR: _poor,
}


def direction(angle_rad: float) -> str:
    """Return a line's direction in words, from its angle in the picture (y down).

    >>> direction(0.1), direction(1.5), direction(-0.8), direction(0.8)
    ('left and right', 'up and down', 'up to the right and down to the left', 'down to the right and up to the left')
    """
    steep = abs(np.degrees(angle_rad))
    if steep < 22.5:
        return "left and right"
    if steep > 67.5:
        return "up and down"
    return "down to the right and up to the left" if angle_rad > 0.0 else "up to the right and down to the left"


def side(x_px: float, y_px: float) -> str:
    """Return an offset in words; y down.

    >>> side(12, 0), side(-3, 8)
    ('12 px to the right', '3 px to the left and 8 px down')
    """
    words = []
    if x_px:
        words.append(f"{abs(x_px):g} px to the {'right' if x_px > 0 else 'left'}")
    if y_px:
        words.append(f"{abs(y_px):g} px {'down' if y_px > 0 else 'up'}")
    return " and ".join(words) or "no distance"

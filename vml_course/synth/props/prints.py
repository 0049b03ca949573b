"""What is printed on a body, for trackers to live on or to fall for: speckle, a logo, stripes, or nothing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.synth.canvas import Canvas
from vml_course.synth.shapes import Point, both, box, disc, polygon, tapered
from vml_course.synth.texture import Plane, grain

INK = (24.0, 30.0, 58.0)
PAPER = (236.0, 232.0, 220.0)
RED = (188.0, 44.0, 48.0)
STRIPE_M = 0.036  # from one stripe to the next: two of them in the block of a tracker, which cannot tell them apart


@dataclass(frozen=True, slots=True)
class Print:
    """What is printed on all bodies of a clip.

    Attributes
    ----------
    seed : int
        Which speckle.
    kind : str
        One of `views.PRINTS`.
    contrast, size_px : float
        Of the speckle, as multiples of the usual and of a pixel.
    """

    seed: int
    kind: str = "speckle"
    contrast: float = 1.0
    size_px: float = 1.0

    def speckle(self, on: Canvas, name: str, grey: float, samples_per_px: float, size_px: float = 1.0) -> Plane:
        """Return the grey levels of a body's speckle; nothing where something else is printed."""
        shape = (on.opacity.shape[0], on.opacity.shape[1])
        if self.kind != "speckle":
            return np.zeros(shape, np.float32)
        return grey * self.contrast * grain(self.seed, name, shape, samples_per_px, size_px * self.size_px)

    @property
    def has_targets(self) -> bool:
        """Whether targets show the places that nothing else would; nothing does on plain bodies."""
        return self.kind != "plain"

    def draw_stripes(self, on: Canvas, inside_m: Plane, from_m: float) -> None:
        """Draw dark stripes below a height, where a distance is negative, and only where stripes are printed."""
        if self.kind == "stripes":
            on.fill(both(inside_m, stripes(on, from_m)), INK)


def draw_logo(on: Canvas, centre: Point, height_m: float) -> None:
    """Print a shield with a ball and a chevron, which looks different from every side."""
    x, y, half = *centre, height_m / 2
    on = on.near((x - half, y - 1.2 * half), (x + half, y + 1.2 * half))
    shield = [(x - 0.72 * half, y), (x, y - half), (x + 0.72 * half, y), (x + 0.72 * half, y + half)]
    corners = [*shield, (x - 0.72 * half, y + half)]
    on.fill(polygon(on, corners), INK)
    inner = np.asarray(polygon(on, corners) + 0.1 * half, np.float32)
    on.fill(inner, PAPER)
    on.fill(both(inner, box(on, (x - half, y + 0.5 * half), (x + half, y + half))), RED)
    on.fill(disc(on, (x - 0.22 * half, y + 0.14 * half), 0.24 * half), INK)
    for rise in (0.0, -0.3):
        tip, thick = (x, y + (rise - 0.5) * half), 0.06 * half
        for side in (-0.62, 0.62):
            arm = tapered(on, (tip, thick), ((x + side * half, y + (rise + 0.02) * half), thick))
            on.fill(both(inner, arm), RED)


def stripes(on: Canvas, from_m: float) -> Plane:
    """Return the distance to level stripes below a height: along them nothing tells one place from another."""
    across = np.abs(((from_m - on.y_m) / STRIPE_M) % 1.0 - 0.5) * STRIPE_M - STRIPE_M / 4
    return np.asarray(across + 0.0 * on.x_m, np.float32)

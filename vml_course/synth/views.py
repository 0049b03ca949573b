"""What every experiment lets one choose of its look: what is printed on the bodies, and what is behind them.

The words alone: how each looks is drawn by `props`, by the same names.
"""

from __future__ import annotations

from dataclasses import dataclass

from vml_course.model.choice import choice
from vml_course.model.quantity import quantity
from vml_course.synth.scene import Scene

PRINTS = ("speckle", "logo", "stripes", "plain")
ROOMS = ("lab", "gym", "grass", "grid")
FLOORS = ("table", "boards", "grass", "grid")


@dataclass(frozen=True)
class PrintedScene(Scene):
    """A scene whose bodies are printed, for trackers to live on or to fall for."""

    texture: str = choice(
        "speckle", PRINTS, about="what is printed on the bodies; along stripes nothing can be told apart"
    )
    speckle: float = quantity(1.0, "", 0.0, 2.5, about="contrast of the speckle, as a multiple of the usual")
    speckle_px: float = quantity(1.0, "px", 0.5, 6.0, about="size of the speckle's smallest spots, usually a pixel")


@dataclass(frozen=True)
class SideView(PrintedScene):
    """A scene before a wall, above a floor; another usual background is one line in the scene."""

    background: str = choice("lab", ROOMS, about="what is behind")


@dataclass(frozen=True)
class TopView(PrintedScene):
    """A scene on a level floor or table, seen from above."""

    background: str = choice("table", FLOORS, about="what is below")

"""What every experiment lets one choose of its look: what is printed on the bodies, and what is behind them."""

from __future__ import annotations

from dataclasses import dataclass

from vml_course.model.camera import Camera
from vml_course.model.choice import choice
from vml_course.model.quantity import quantity
from vml_course.synth.canvas import Canvas, camera_canvas
from vml_course.synth.props.backgrounds import BACKGROUNDS
from vml_course.synth.props.floors import FLOORS
from vml_course.synth.props.prints import PRINTS, Print
from vml_course.synth.scene import Scene


@dataclass(frozen=True)
class PrintedScene(Scene):
    """A scene whose bodies are printed, for trackers to live on or to fall for."""

    texture: str = choice(
        "speckle", PRINTS, about="what is printed on the bodies; along stripes nothing can be told apart"
    )
    speckle: float = quantity(1.0, "", 0.0, 2.5, about="contrast of the speckle, as a multiple of the usual")
    speckle_px: float = quantity(1.0, "px", 0.5, 6.0, about="size of the speckle's smallest spots, usually a pixel")

    def printed(self, seed: int) -> Print:
        """Return what is printed."""
        return Print(seed, self.texture, self.speckle, self.speckle_px)


@dataclass(frozen=True)
class SideView(PrintedScene):
    """A scene before a wall, above a floor; another usual background is one line in the scene."""

    background: str = choice("lab", BACKGROUNDS, about="what is behind")

    def room(self, camera: Camera, seed: int, floor_m: float) -> Canvas:
        """Draw what is behind, with the line where wall and floor meet at a height."""
        on = camera_canvas(camera)
        BACKGROUNDS[self.background](on, seed, floor_m)
        return on


@dataclass(frozen=True)
class TopView(PrintedScene):
    """A scene on a level floor or table, seen from above."""

    background: str = choice("table", FLOORS, about="what is below")

    def floor(self, camera: Camera, seed: int) -> Canvas:
        """Draw what is below."""
        on = camera_canvas(camera)
        FLOORS[self.background](on, seed)
        return on

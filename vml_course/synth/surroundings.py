"""What every experiment's drawing begins with: what is behind or below, and what is printed on the bodies."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.canvas import Canvas, camera_canvas
from vml_course.synth.props.backgrounds import BACKGROUNDS
from vml_course.synth.props.floors import FLOORS
from vml_course.synth.props.prints import Print
from vml_course.synth.views import PrintedScene, SideView, TopView


def printed_of(scene: PrintedScene, seed: int) -> Print:
    """Return what is printed on the bodies."""
    return Print(seed, scene.texture, scene.speckle, scene.speckle_px)


def room_of(scene: SideView, camera: Camera, seed: int, floor_m: float) -> Canvas:
    """Draw what is behind, with the line where wall and floor meet at a height."""
    on = camera_canvas(camera)
    BACKGROUNDS[scene.background](on, seed, floor_m)
    return on


def floor_of(scene: TopView, camera: Camera, seed: int) -> Canvas:
    """Draw what is below."""
    on = camera_canvas(camera)
    FLOORS[scene.background](on, seed)
    return on

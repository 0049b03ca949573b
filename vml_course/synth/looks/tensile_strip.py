"""How a scene is drawn: a speckled strip is pulled in a testing machine."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.canvas import sheet
from vml_course.synth.props.dots import spray
from vml_course.synth.props.rig import draw_back, draw_grip, draw_marks, draw_ruler
from vml_course.synth.scenes.tensile_strip import GRIP_M, HELD_M, RULER_M, TensileStrip
from vml_course.synth.shapes import box
from vml_course.synth.sprite import OVERSAMPLE, make_sprite
from vml_course.synth.strained import StrainedLook


def look(scene: TensileStrip, camera: Camera, seed: int) -> StrainedLook:
    """Draw the machine, the strip and its marks."""
    half, wide = scene.length_m / 2 + HELD_M, scene.width_m / 2
    on = sheet((half, half, wide, wide), camera.px_per_m, OVERSAMPLE)
    spray(on, seed, box(on, (-half, -wide), (half, wide)), scene.speckle_px, scene.speckle)
    draw_marks(on, scene.points_m())
    grip = GRIP_M, scene.width_m / 2 + 0.006
    return StrainedLook(
        background=draw_back(camera, seed),
        sheet=make_sprite(on),
        sprites={
            "left_grip": draw_grip(grip, camera.px_per_m, seed, 1.0),
            "right_grip": draw_grip(grip, camera.px_per_m, seed, -1.0),
            "ruler": draw_ruler(RULER_M, camera.px_per_m),
        },
    )

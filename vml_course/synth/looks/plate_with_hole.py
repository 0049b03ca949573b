"""How a scene is drawn: a large speckled plate with a round hole is pulled."""

from __future__ import annotations

import numpy as np

from vml_course.model.camera import Camera
from vml_course.synth.canvas import sheet
from vml_course.synth.props.dots import spray
from vml_course.synth.props.rig import draw_back, draw_marks, draw_ruler
from vml_course.synth.scenes.plate_with_hole import RULER_M, PlateWithHole
from vml_course.synth.shapes import disc
from vml_course.synth.sprite import OVERSAMPLE, make_sprite
from vml_course.synth.strained import StrainedLook

BEYOND_M = 0.008  # how far the drawing goes on beyond the picture, for what comes in when the plate slides


def look(scene: PlateWithHole, camera: Camera, seed: int) -> StrainedLook:
    """Draw the plate as far as the picture goes, and a bit farther."""
    left, top = (camera.origin_x_px / camera.px_per_m, camera.origin_y_px / camera.px_per_m)
    width, height = (size / camera.px_per_m for size in camera.size_px)
    reach = left, width - left, height - top, top
    on = sheet(tuple(part + BEYOND_M for part in reach), camera.px_per_m, OVERSAMPLE)  # type: ignore[arg-type]
    plate = np.asarray(-disc(on, (0.0, 0.0), scene.radius_m), np.float32)
    spray(on, seed, plate, scene.speckle_px, scene.speckle)
    draw_marks(on, scene.points_m())
    return StrainedLook(
        background=draw_back(camera, seed),
        sheet=make_sprite(on),
        sprites={"ruler": draw_ruler(RULER_M, camera.px_per_m)},
    )

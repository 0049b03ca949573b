"""How a scene is drawn: a puck hits a free rod off its centre (air table, seen from above)."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.balls import draw_puck
from vml_course.synth.props.plank import draw_rod
from vml_course.synth.props.scale import draw_bar
from vml_course.synth.scenes.struck_rod import MARK_AT, StruckRod
from vml_course.synth.surroundings import floor_of, printed_of

RED = (184.0, 62.0, 52.0)


def look(scene: StruckRod, camera: Camera, seed: int) -> Look:
    """Draw table, rod and puck."""
    table, printed = floor_of(scene, camera, seed), printed_of(scene, seed)
    draw_bar(table, scene.marks_m())
    height = MARK_AT * scene.rod_length_m / 2
    marks = (0.0, -height), (0.0, height)
    rod = draw_rod(marks, scene.rod_half_width_m, scene.rod_length_m / 2, camera.px_per_m, printed)
    return Look(
        background=table,
        sprites={"rod": rod, "ball": draw_puck(scene.ball_radius_m, camera.px_per_m, printed, "3", RED)},
    )

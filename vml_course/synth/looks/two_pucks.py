"""How a scene is drawn: two pucks meet obliquely (air table, seen from above)."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.balls import draw_puck
from vml_course.synth.props.scale import draw_bar
from vml_course.synth.scenes.two_pucks import TwoPucks
from vml_course.synth.surroundings import floor_of, printed_of

BLUE = (48.0, 94.0, 168.0)
RED = (184.0, 62.0, 52.0)


def look(scene: TwoPucks, camera: Camera, seed: int) -> Look:
    """Draw table and pucks."""
    table, printed = floor_of(scene, camera, seed), printed_of(scene, seed)
    draw_bar(table, scene.marks_m())
    return Look(
        background=table,
        sprites={
            "puck_a": draw_puck(scene.puck_a_radius_m, camera.px_per_m, printed, "1", BLUE),
            "puck_b": draw_puck(scene.puck_b_radius_m, camera.px_per_m, printed, "2", RED),
        },
    )

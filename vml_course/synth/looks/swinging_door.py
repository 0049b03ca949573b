"""How a scene is drawn: a ball bounces off a door that stands still (seen from above)."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.football import draw_football
from vml_course.synth.props.plank import draw_door, draw_frame
from vml_course.synth.props.scale import draw_bar
from vml_course.synth.scenes.swinging_door import CARD_M, SwingingDoor
from vml_course.synth.surroundings import floor_of, printed_of


def look(scene: SwingingDoor, camera: Camera, seed: int) -> Look:
    """Draw the floor with the wall, the door and the ball."""
    floor, printed = floor_of(scene, camera, seed), printed_of(scene, seed)
    draw_bar(floor, scene.marks_m())
    draw_frame(floor, scene.door_thickness_m / 2)
    half = scene.door_thickness_m / 2
    return Look(
        background=floor,
        sprites={
            "door": draw_door(scene.door_length_m, half, CARD_M, camera.px_per_m, printed),
            "ball": draw_football(scene.ball_diameter_m / 2, camera.px_per_m, printed),
        },
    )

"""How a scene is drawn: a bat that swings about the hands hits an incoming ball."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.balls import draw_softball
from vml_course.synth.props.bat import Bat, draw_bat
from vml_course.synth.props.scale import draw_bar
from vml_course.synth.props.stand import draw_stand
from vml_course.synth.scenes.bat_and_ball import BatAndBall
from vml_course.synth.surroundings import printed_of, room_of

FLOOR_BELOW_BARREL_M = 0.14


def look(scene: BatAndBall, camera: Camera, seed: int) -> Look:
    """Draw the room with the rig's post, the bat and the ball."""
    floor = -(scene.barrel_distance_m + FLOOR_BELOW_BARREL_M)
    room, printed = room_of(scene, camera, seed, floor), printed_of(scene, seed)
    draw_bar(room, scene.marks_m())
    draw_stand(room, (0.0, 0.0), (-0.16, floor + 0.02))
    bat = Bat(scene.barrel_distance_m, scene.barrel_radius_m)
    return Look(
        background=room,
        sprites={
            "bat": draw_bat(bat, camera.px_per_m, printed),
            "ball": draw_softball(scene.ball_diameter_m / 2, camera.px_per_m, printed),
        },
    )

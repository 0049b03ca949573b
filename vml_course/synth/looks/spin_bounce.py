"""How a scene is drawn: a ball with spin bounces off the floor, with friction."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.balls import draw_basketball
from vml_course.synth.props.scale import draw_bar
from vml_course.synth.scenes.spin_bounce import RIM_AT, SpinBounce
from vml_course.synth.surroundings import printed_of, room_of


def look(scene: SpinBounce, camera: Camera, seed: int) -> Look:
    """Draw the room and the ball."""
    mark = (RIM_AT * scene.ball_radius_m, 0.0)
    ball = draw_basketball(scene.ball_radius_m, camera.px_per_m, printed_of(scene, seed), mark)
    room = room_of(scene, camera, seed, 0.0)
    draw_bar(room, scene.marks_m())
    return Look(background=room, sprites={"ball": ball})

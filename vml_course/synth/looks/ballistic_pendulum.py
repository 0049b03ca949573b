"""How a scene is drawn: a ball flies into a hanging catcher and stays there."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.catcher import draw_catcher, draw_tennis_ball
from vml_course.synth.props.scale import draw_bar
from vml_course.synth.props.stand import draw_stand
from vml_course.synth.scenes.ballistic_pendulum import BallisticPendulum
from vml_course.synth.surroundings import printed_of, room_of


def look(scene: BallisticPendulum, camera: Camera, seed: int) -> Look:
    """Draw the room with the stand, the catcher and the ball."""
    catcher = scene.catcher
    floor = -(catcher.bottom_m + 0.08)
    room, printed = room_of(scene, camera, seed, floor), printed_of(scene, seed)
    draw_bar(room, scene.marks_m())
    draw_stand(room, (0.0, 0.0), (0.42, floor + 0.02))
    return Look(
        background=room,
        sprites={
            "pendulum": draw_catcher(catcher, camera.px_per_m, printed),
            "pellet": draw_tennis_ball(scene.pellet_radius_m, camera.px_per_m, printed),
        },
    )

"""How a scene is drawn: a leg that swings about the knee kicks a football off a tee."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.football import draw_football
from vml_course.synth.props.gym import draw_tee, draw_thigh
from vml_course.synth.props.leg import Leg, draw_leg
from vml_course.synth.props.scale import draw_scale
from vml_course.synth.scenes.soccer_kick import KNEE_M, SHIN_AT, SHIN_M, SoccerKick
from vml_course.synth.surroundings import printed_of, room_of

FLOOR_ABOVE_BAR_M = 0.07


def look(scene: SoccerKick, camera: Camera, seed: int) -> Look:
    """Draw the gym, the leg and the ball."""
    radius, printed = scene.ball_diameter_m / 2, printed_of(scene, seed)
    leg = Leg(scene.leg_length_m, scene.foot_radius_m, KNEE_M, SHIN_M, SHIN_AT)
    room = room_of(scene, camera, seed, scene.floor_m + FLOOR_ABOVE_BAR_M)
    x, y = scene.law().ball_m.tolist()
    draw_tee(room, (x, y - radius), scene.floor_m)
    draw_scale(room, scene.marks_m())
    draw_thigh(room, seed)
    return Look(
        background=room,
        sprites={
            "leg": draw_leg(leg, camera.px_per_m, printed, plain_knee=scene.knee == "plain"),
            "ball": draw_football(radius, camera.px_per_m, printed),
        },
    )

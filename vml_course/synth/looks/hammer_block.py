"""How a scene is drawn: a pendulum hammer hits a block that slides away with friction."""

from __future__ import annotations

from vml_course.model.camera import Camera
from vml_course.synth.look import Look
from vml_course.synth.props.hammer import Hammer, draw_block, draw_hammer, draw_rail
from vml_course.synth.props.scale import draw_bar
from vml_course.synth.props.stand import draw_stand
from vml_course.synth.scenes.hammer_block import BAR_BELOW_HEAD_M, HammerBlock
from vml_course.synth.surroundings import printed_of, room_of


def look(scene: HammerBlock, camera: Camera, seed: int) -> Look:
    """Draw the room with stand and bench, the hammer and the block."""
    bench = -(scene.hammer_length_m + scene.block_half_height_m)
    floor = -(scene.hammer_length_m + BAR_BELOW_HEAD_M - 0.05)
    room, printed = room_of(scene, camera, seed, floor), printed_of(scene, seed)
    draw_bar(room, scene.marks_m())
    draw_stand(room, (0.0, 0.0), (-0.42, floor + 0.02))
    draw_rail(room, bench, scene.head_radius_m, floor)
    half = scene.block_half_width_m, scene.block_half_height_m
    hammer = Hammer(scene.hammer_length_m, scene.head_radius_m)
    return Look(
        background=room,
        sprites={
            "hammer": draw_hammer(hammer, camera.px_per_m, printed),
            "block": draw_block(half, camera.px_per_m, printed),
        },
    )

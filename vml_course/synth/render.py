"""From a truth to its pictures: only what moved is drawn anew, the sensor's noise is fresh in every frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.frame import Picture
from vml_course.model.recording import Recording
from vml_course.model.truth import Truth
from vml_course.synth.bent import Bent
from vml_course.synth.exposure import Swept, count_instants, expose, expose_shaken
from vml_course.synth.look import Look, look_of
from vml_course.synth.path import fine_path
from vml_course.synth.rows import row_exposures
from vml_course.synth.scene import AnyScene, Scene, scene_class
from vml_course.synth.sensor import make_sensor
from vml_course.synth.shake import wander
from vml_course.synth.sheet import Sheet
from vml_course.synth.sight import Sight
from vml_course.synth.sprite import Planes, Sprite, make_planes
from vml_course.synth.strained import draw_strained


def render(truth: Truth, recording: Recording) -> Iterator[Picture]:
    """Yield the pictures of a clip, one a frame, as an ideal camera with a noisy sensor sees them."""
    sensor = make_sensor(truth, recording)
    for number, planes in enumerate(draw_frames(truth)):
        yield sensor.expose(planes, number)


def scene_of(truth: Truth) -> AnyScene:
    """Return the scene that a truth was made from."""
    return scene_class(truth.scene)(**truth.parameters)


def impact_scene_of(truth: Truth) -> Scene:
    """Return the scene that the truth of an impact was made from."""
    if not isinstance(scene := scene_of(truth), Scene):
        raise TypeError(f"{scene.name}: nothing is hit")
    return scene


def draw_frames(truth: Truth) -> Iterator[Planes]:
    """Yield the pictures without noise and rounding; each is overwritten by the next."""
    if isinstance(scene := scene_of(truth), Sheet):
        yield from draw_strained(truth, scene)
        return
    sight = Sight(truth.camera)
    look: Look = look_of(impact_scene_of(truth), sight.board, truth.seed)
    sprites = [look.sprites[body] for body in truth.bodies]
    still = sight.still(make_planes(look.background))
    planes = still.copy()
    for bodies, offset_px in _exposed(truth, sprites, sight):
        if truth.camera.shake_px:
            yield expose_shaken(still, bodies, offset_px)
            continue
        changed = expose(planes, bodies)
        yield planes
        for box in changed:
            planes.restore(still, box)


def _exposed(
    truth: Truth, sprites: Sequence[Sprite], sight: Sight
) -> Iterator[tuple[Sequence[Swept | Bent], FloatArray]]:
    """Yield the bodies of each exposure, and how far the picture is shifted at its instants."""
    if truth.camera.is_square and not truth.camera.rolling_shutter:
        for pose_px, offset_px in exposures(truth, sprites):
            yield [Swept(sprite, pose_px[:, k]) for k, sprite in enumerate(sprites)], offset_px
    else:
        for pose_px, offset_px in row_exposures(truth, impact_scene_of(truth), sprites):
            yield [Bent(sprite, pose_px[:, :, k], sight, offset_px) for k, sprite in enumerate(sprites)], offset_px


def exposures(truth: Truth, sprites: Sequence[Sprite]) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield what each exposure sees at its k instants.

    Returns
    -------
    float array, shape (k, b, 3)
        Where the bodies are: px, px, rad.
    float array, shape (k, 2)
        How far the picture is shifted.
    """
    if not truth.camera.shutter:
        offset_px = truth.offset_px[:, None]
        yield from zip(to_picture(truth.camera, truth.pose[:, None], offset_px), offset_px, strict=True)
        return
    path = fine_path(impact_scene_of(truth), truth.camera.fps)

    def seen(time_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        offset_px = wander(truth.seed, truth.camera.shake_px, time_s)
        return to_picture(truth.camera, path.at(time_s), offset_px), offset_px

    for time_s in truth.time_s:
        rough, _ = seen(time_s + truth.camera.exposure_s * np.linspace(-0.5, 0.5, 17))
        count = count_instants(sprites, rough)
        yield seen(time_s + truth.camera.exposure_s * ((np.arange(count) + 0.5) / count - 0.5))


def to_picture(camera: Camera, pose: FloatArray, offset_px: FloatArray) -> FloatArray:
    """Turn poses in metres into poses in pixels: shape (..., b, 3), with a shift of shape (..., 2)."""
    return np.concatenate([camera.to_px(pose[..., :2]) + offset_px[..., None, :], pose[..., 2:]], axis=-1)

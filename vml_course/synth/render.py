"""From a truth to its pictures: only what moved is drawn anew, the sensor's noise is fresh in every frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from vml_course.model.arrays import FloatArray
from vml_course.model.camera import Camera
from vml_course.model.frame import Picture
from vml_course.model.recording import Recording
from vml_course.model.truth import Truth
from vml_course.synth.exposure import Swept, count_instants, expose
from vml_course.synth.path import fine_path
from vml_course.synth.scene import Scene, scene_class
from vml_course.synth.sprite import Planes, Sprite, make_planes
from vml_course.synth.texture import Plane, choose, normals

NOISE_SPAN_PX = 256  # the noise field is that much larger than the picture; each frame reads it elsewhere
CHROMA_NOISE = 0.5


def render(truth: Truth, recording: Recording) -> Iterator[Picture]:
    """Yield the pictures of a clip, one a frame, as an ideal camera with a noisy sensor sees them."""
    sensor = make_sensor(truth.camera.size_px, recording.noise_grey, truth.seed, len(truth.time_s))
    for number, planes in enumerate(draw_frames(truth)):
        yield sensor.expose(planes, number)


def scene_of(truth: Truth) -> Scene:
    """Return the scene that a truth was made from."""
    return scene_class(truth.scene)(**truth.parameters)


def draw_frames(truth: Truth) -> Iterator[Planes]:
    """Yield the pictures without noise and rounding; each is overwritten by the next."""
    look = scene_of(truth).look(truth.camera, truth.seed)
    sprites = [look.sprites[body] for body in truth.bodies]
    still = make_planes(look.background)
    planes = still.copy()
    for pose_px in exposures(truth, sprites):
        changed = expose(planes, [Swept(sprite, pose_px[:, k]) for k, sprite in enumerate(sprites)])
        yield planes
        for box in changed:
            planes.restore(still, box)


def exposures(truth: Truth, sprites: Sequence[Sprite]) -> Iterator[FloatArray]:
    """Yield where the bodies are while each frame is exposed: shape (k, b, 3), px, px, rad, at k instants."""
    if not truth.camera.shutter:
        yield from to_picture(truth.camera, truth.pose[:, None])
        return
    path = fine_path(scene_of(truth), truth.camera.fps)
    for time_s in truth.time_s:
        rough = to_picture(truth.camera, path.at(time_s + truth.camera.exposure_s * np.linspace(-0.5, 0.5, 17)))
        count = count_instants(sprites, rough)
        middles = (np.arange(count) + 0.5) / count - 0.5
        yield to_picture(truth.camera, path.at(time_s + truth.camera.exposure_s * middles))


def to_picture(camera: Camera, pose: FloatArray) -> FloatArray:
    """Turn poses in metres into poses in pixels, shape (..., 3)."""
    return np.concatenate([camera.to_px(pose[..., :2]), pose[..., 2:]], axis=-1)


@dataclass(frozen=True, eq=False)
class Sensor:
    """Adds noise and rounds to 8 bits.

    Attributes
    ----------
    noise : float32 array
        In grey levels, larger than the picture by `NOISE_SPAN_PX` each way.
    place : int array, shape (n,)
        Where each frame reads it.
    """

    noise: Plane
    place: np.ndarray[tuple[int], np.dtype[np.int64]]

    def expose(self, planes: Planes, frame: int) -> Picture:
        """Return one frame as the sensor stores it."""
        return Picture(
            luma=self._plane(planes.luma, frame, 1.0),
            blue=self._plane(np.ascontiguousarray(planes.chroma[..., 0]), frame, CHROMA_NOISE),
            red=self._plane(np.ascontiguousarray(planes.chroma[..., 1]), frame + 1, CHROMA_NOISE),
        )

    def _plane(self, clean: Plane, frame: int, gain: float) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
        down, right = divmod(int(self.place[frame]), NOISE_SPAN_PX)
        rows, columns = clean.shape
        noise = self.noise[down : down + rows, right : right + columns]
        return np.asarray(cv2.addWeighted(clean, 1.0, noise, gain, 0.0, dtype=cv2.CV_8U))


def make_sensor(size_px: tuple[int, int], noise_grey: float, seed: int, frames: int) -> Sensor:
    """Return a sensor of a given noise (standard deviation in grey levels) for a number of frames."""
    shape = (size_px[1] + NOISE_SPAN_PX, size_px[0] + NOISE_SPAN_PX)
    noise = normals(seed, "sensor", shape) * np.float32(noise_grey)
    return Sensor(noise, choose(seed, "sensor frames", frames + 1, NOISE_SPAN_PX**2))

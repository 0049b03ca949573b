"""The sensor: light on it, noise from it, 8 bits out of it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from vml_course.model.arrays import FloatArray
from vml_course.model.frame import Luma, Picture
from vml_course.model.recording import Recording
from vml_course.model.truth import Truth
from vml_course.synth.light import GREY, as_lit, dark_corners, light_at
from vml_course.synth.sprite import Planes
from vml_course.synth.texture import Plane, choose, normals

NOISE_SPAN_PX = 256  # the noise field is that much larger than the picture; each frame reads it elsewhere
CHROMA_NOISE = 0.5
WHITE = 255.0


@dataclass(frozen=True, eq=False)
class Sensor:
    """Turns drawn planes into stored pictures.

    Attributes
    ----------
    recording : Recording
    light : float array, shape (n, 1) or (n, rows)
        Relative brightness of each frame, or of each of its rows.
    corners : float32 array, shape (h, w)
        Vignetting.
    noise : float32 array
        Of standard deviation 1, larger than the picture by `NOISE_SPAN_PX` each way; in grey levels (read
        noise) where no shot noise is asked for.
    place : int array, shape (n + 1,)
        Where each frame reads it.
    """

    recording: Recording
    light: FloatArray
    corners: Plane
    noise: Plane
    place: NDArray[np.int64]

    def expose(self, planes: Planes, frame: int) -> Picture:
        """Return one frame as the sensor stores it."""
        if self._is_even:
            return self._expose_evenly(planes, frame)
        store, spread = self._store, self._spread(planes.luma, frame)
        blue, red = (np.ascontiguousarray(planes.chroma[..., k]) for k in (0, 1))
        return Picture(
            luma=store(planes.luma, (frame, frame), 0.0, spread),
            blue=store(blue, (frame, frame), GREY, spread),
            red=store(red, (frame, frame + 1), GREY, spread),
        )

    @property
    def _is_even(self) -> bool:
        """Whether light and noise are the same all over a picture: then one pass does everything."""
        how = self.recording
        return self.light.shape[1] == 1 and not (how.vignetting or how.shot_noise_grey)

    def _expose_evenly(self, planes: Planes, frame: int) -> Picture:
        light, (rows, columns) = float(self.light[frame, 0]), planes.luma.shape
        gain = light * self.recording.contrast
        picture = Picture(
            np.empty((rows, columns), np.uint8),
            *(np.empty((rows // 2, columns // 2), np.uint8) for _ in range(2)),
        )
        drawn = planes.luma, planes.chroma[..., 0], planes.chroma[..., 1]
        for stored, plane, late, black in zip(
            (picture.luma, picture.blue, picture.red), drawn, (0, 0, 1), (0.0, GREY, GREY), strict=True
        ):
            shift = black + light * (GREY - black) - gain * GREY
            store_evenly(plane, self._noise(plane, frame + late), (gain, CHROMA_NOISE if black else 1.0, shift), stored)
        return picture

    def _store(self, drawn: Plane, frames: tuple[int, int], black: float, spread: Plane | None) -> Luma:
        every, strength = (2, CHROMA_NOISE) if black else (1, 1.0)
        lit = as_lit(drawn, self._light(frames[0])[::every, ::every], self.recording.contrast, black)
        noise = self._noise(drawn, frames[1]) * (1.0 if spread is None else spread[::every, ::every])
        return np.asarray(cv2.addWeighted(lit, 1.0, noise, strength, 0.0, dtype=cv2.CV_8U))

    def _spread(self, luma: Plane, frame: int) -> Plane | None:
        """Return the noise's standard deviation: read noise, and shot noise by the root of the light."""
        read, shot = self.recording.noise_grey, self.recording.shot_noise_grey
        if not shot:
            return None
        lit = as_lit(luma, self._light(frame), self.recording.contrast, 0.0)
        return np.asarray(np.sqrt(np.maximum(lit, 0.0) * np.float32(shot**2 / WHITE) + np.float32(read**2)))

    def _light(self, frame: int) -> Plane:
        return np.asarray(self.light[frame].astype(np.float32)[:, None] * self.corners)

    def _noise(self, drawn: Plane, frame: int) -> Plane:
        down, right = divmod(int(self.place[frame]), NOISE_SPAN_PX)
        rows, columns = drawn.shape
        return self.noise[down : down + rows, right : right + columns]


def store_evenly(drawn: Plane, noise: Plane, how: tuple[float, float, float], stored: Luma) -> None:
    """Store gain times drawn, strength times noise, and shift (`how`), as bytes: one pass, in one thread.

    OpenCV would do it in threads of its own, which wait in a busy loop beside the encoder's.
    """
    gain, strength, shift = (np.float32(value) for value in how)
    _store_bytes(drawn, noise, (gain, strength, shift), stored)


@njit(fastmath={"nnan", "nsz"}, cache=True, nogil=True, error_model="numpy")  # no NaN: minima become one instruction
def _store_bytes(drawn, noise, how, stored):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN202
    gain, strength, shift = how
    for y in range(drawn.shape[0]):
        for x in range(drawn.shape[1]):
            value = drawn[y, x] * gain + noise[y, x] * strength + shift
            value = min(max(value, np.float32(0)), np.float32(255))
            stored[y, x] = np.uint8(np.int32(np.rint(value)))


def make_sensor(truth: Truth, recording: Recording) -> Sensor:
    """Return the sensor that films a clip."""
    (width, height), time_s = truth.camera.size_px, truth.time_s
    noise = normals(truth.seed, "sensor", (height + NOISE_SPAN_PX, width + NOISE_SPAN_PX))
    return Sensor(
        recording=recording,
        light=light_at(recording, time_s, time_s[-1], truth.camera.exposure_s)[:, None],
        corners=dark_corners(recording.vignetting, (height, width)),
        noise=noise if recording.shot_noise_grey else noise * np.float32(recording.noise_grey),
        place=choose(truth.seed, "sensor frames", len(time_s) + 1, NOISE_SPAN_PX**2),
    )

"""Rendered clips with known truth, kept in a folder so that a rerun need not render them again."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from pathlib import Path

import av
import numpy as np

from vml_course.errors import VmlError
from vml_course.io.truth import read_truth_json
from vml_course.io.video import read_frames, write_video
from vml_course.model.quantity import quantities_of
from vml_course.model.recording import Recording
from vml_course.model.truth import Truth
from vml_course.synth.render import render
from vml_course.synth.scene import scene_class
from vml_course.usecases.make_video import make_video

POINTS = ("knee", "shin", "foot", "ball")
BLOCK = 60


@dataclass(frozen=True)
class Case:
    """One way of filming the kick."""

    name: str
    title: str
    recording: dict = field(default_factory=dict)
    camera: dict = field(default_factory=dict)
    scene: dict = field(default_factory=dict)


BLURRED = {"fps": 240.0, "shutter": 0.9}
CALM = Case("calm", "2000 1/s, noise 2", {"crf": 18, "noise_grey": 2.0, "file_fps": 480.0}, {"fps": 2000.0})
CASES = (
    Case("lossless", "480 1/s, noise 1, lossless", {"crf": 0, "noise_grey": 1.0}),
    Case("compressed", "480 1/s, noise 2, H.264 crf 18", {"crf": 18, "noise_grey": 2.0}),
    Case("noisy", "480 1/s, noise 3, H.264 crf 23", {"crf": 23, "noise_grey": 3.0}),
    Case("mjpeg", "480 1/s, noise 2, MJPEG", {"format": "avi", "noise_grey": 2.0}),
    Case("blurred", "240 1/s, shutter 0.9, noise 2, H.264 crf 18", {"crf": 18, "noise_grey": 2.0}, BLURRED),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Clip:
    """A rendered case: its file, truth, and pictures."""

    case: Case
    video: Path
    truth: Truth

    @property
    def true_px(self):
        """Where the points really are: (n, p, 2)."""
        return self.truth.xy_px[:, [self.truth.point_index(name) for name in POINTS]]

    def frames(self):
        """All pictures, decoded."""
        return [frame.luma for frame in read_frames(self.video)]


def make_clip(case: Case, folder: Path, seed: int = 1) -> Clip | None:
    """Render a case, or take it from the folder; None when this version's camera knows no such effect."""
    kind = scene_class("soccer_kick")
    if not set(case.camera) <= set(quantities_of(kind.default_camera)):
        return None
    camera = dataclasses.replace(kind.default_camera, **case.camera)
    recording, place = Recording(**case.recording), folder / f"{case.name}-{seed}"
    video = place / f"video.{recording.format}"
    try:
        truth = read_truth_json(place / "truth.json")
    except VmlError:  # not there, or kept by another version
        truth = make_video(kind(**case.scene), camera, recording, seed, place).truth
    return Clip(case, video, truth)


def to_and_fro(count: int, length: int) -> list[int]:
    """Return picture numbers that run through a clip forwards and backwards, `length` of them."""
    period = [*range(count), *range(count - 2, 0, -1)]
    return [period[k % len(period)] for k in range(length)]


def write_long(clip: Clip, length: int, path: Path) -> Path:
    """Write a clip played to and fro, with fresh noise only as far as the clip has it."""
    if not path.exists():
        pictures = list(render(clip.truth, Recording(**clip.case.recording)))
        order = to_and_fro(len(pictures), length)
        write_video(path, (pictures[k] for k in order), clip.truth.camera.fps, clip.case.recording.get("crf", 18))
    return path


def decode_all(path: Path, last: int | None = None) -> int:
    """Decode every picture's luma view (up to `last`) with PyAV on all threads, and nothing else: the yardstick."""
    count = 0
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        stream.thread_type = "AUTO"
        for frame in container.decode(stream):
            memoryview(frame.planes[0])
            count += 1
            if last is not None and count > last:
                break
    return count


def radial_rms(error_px) -> float:
    """Root mean square of distances; lost ones are left out (they are counted apart)."""
    seen = error_px[np.isfinite(error_px)]
    return float(np.sqrt(np.mean(seen**2))) if seen.size else float("nan")

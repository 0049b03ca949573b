"""Make a clip whose truth is known: simulate, render, write the video and the truth beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from vml_course.io.files import making_folder, replacing_together
from vml_course.io.truth import write_truth_csv, write_truth_json
from vml_course.io.video import write_video
from vml_course.model.camera import Camera
from vml_course.model.frame import Picture
from vml_course.model.recording import FORMATS, Recording
from vml_course.model.truth import Truth
from vml_course.synth.render import render
from vml_course.synth.scene import AnyScene
from vml_course.synth.simulate import simulate

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class MadeVideo:
    """Where the video is, and what is true of it."""

    video: Path
    truth: Truth


def make_video(
    scene: AnyScene, camera: Camera, recording: Recording, seed: int, folder: Path, progress: Progress | None = None
) -> MadeVideo:
    """Write `video.mp4` (or `.avi`), `truth.json` and `truth.csv` into a folder, in place of an older clip there.

    The three appear together or, where anything fails, not at all; an older clip then stays as it was.

    The video itself holds nothing of the truth, neither in its name nor in its metadata.

    Parameters
    ----------
    scene, camera, recording
        What is filmed and how.
    seed : int
        For textures and noise.
    folder : Path
        Made when missing.
    progress : callable, optional
        Told after every picture: how many are done, of how many.

    Raises
    ------
    SceneRefusedError
        Before anything is written.
    FileFormatError
        When the folder cannot be made or written into, or an older file is open elsewhere.
    """
    truth = replace(simulate(scene, camera, seed), recording=recording)
    video = folder / f"video.{recording.format}"
    with (
        making_folder(folder),
        replacing_together(video, folder / "truth.json", folder / "truth.csv") as (film, all_of_it, table),
    ):
        pictures = _counted(render(truth, recording), len(truth.time_s), progress)
        write_video(film, pictures, recording.file_fps or camera.fps, int(recording.crf), recording.stored_codec)
        write_truth_json(all_of_it, truth)
        write_truth_csv(table, truth)
    _remove_older(folder, recording.format)
    return MadeVideo(video, truth)


def _remove_older(folder: Path, kept: str) -> None:
    """Remove a video of another format, which the new truth does not belong to."""
    for other in FORMATS:
        if other != kept:
            (folder / f"video.{other}").unlink(missing_ok=True)


def _counted(pictures: Iterator[Picture], total: int, progress: Progress | None) -> Iterator[Picture]:
    for done, picture in enumerate(pictures, start=1):
        yield picture
        if progress:
            progress(done, total)

"""The same pictures in other wrappings give the same track."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
import pytest

from vml_course.cli import run
from vml_course.errors import InputError
from vml_course.io.video import probe
from vml_course.model.track import Seed
from vml_course.usecases.cut_clip import cut_clip
from vml_course.usecases.track_clip import TrackRequest, track_clip

FRAMES, FPS, TURN_DEG, SHIFT_PX = 12, 240, 2.0, (1.3, -0.7)
SEEDS = (Seed("left", 85, 110), Seed("right", 155, 110))
RANGE_PX = 0.01  # what the coarser steps of the limited range may move a point


@pytest.fixture(scope="module")
def planes(speckle: Any, rotated: Any, camera_of: Any) -> list[np.ndarray]:
    return [camera_of(speckle.picture(rotated(TURN_DEG * k), np.multiply(SHIFT_PX, k))) for k in range(FRAMES)]


def record(path: Path, planes: list[np.ndarray], codec: str, pixels: str, **options: str) -> Path:
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=FPS, options=options)
        (stream.height, stream.width), stream.pix_fmt = planes[0].shape, pixels
        for number, plane in enumerate(planes):
            frame = av.VideoFrame.from_ndarray(plane, format="gray").reformat(format=pixels)
            frame.pts, frame.time_base = number, Fraction(1, FPS)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def test_pixels_that_are_not_square_are_said(planes: list[np.ndarray], tmp_path: Path) -> None:
    """HDV camcorders store 1440 columns for 1920: lengths along x come out a quarter too short."""
    path = tmp_path / "hdv.mp4"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=25)
        (stream.height, stream.width), stream.pix_fmt = planes[0].shape, "yuv420p"
        stream.codec_context.sample_aspect_ratio = Fraction(4, 3)
        for plane in planes[:3]:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(plane, format="gray").reformat(format="yuv420p")))
        container.mux(stream.encode(None))
    assert probe(path).pixel_aspect == pytest.approx(4 / 3)
    (warning,) = cut_clip(path, tmp_path / "clip.avi", 0, 2).warnings
    assert warning.startswith("hdv.mp4: the pixels are 1.333 times as wide as high;")


def places(video: Path, **changes: Any) -> np.ndarray:
    return track_clip(TrackRequest(video, SEEDS, settings={"block": 41}, **changes)).track.xy_px


def test_full_and_limited_range_give_the_same_track(planes: list[np.ndarray], tmp_path: Path) -> None:
    """Limited range maps 0..255 to 16..235: another contrast and brightness, which matching takes out."""
    full = record(tmp_path / "full.mkv", planes, "ffv1", "gray")
    limited = record(tmp_path / "limited.mkv", planes, "ffv1", "yuv420p")
    compressed = {
        pixels: record(tmp_path / f"{pixels}.mp4", planes, "libx264", pixels, crf="4")
        for pixels in ("yuvj420p", "yuv420p")
    }
    assert np.abs(places(full) - places(limited)).max() < RANGE_PX
    assert np.abs(places(compressed["yuvj420p"]) - places(compressed["yuv420p"])).max() < 2 * RANGE_PX


@pytest.mark.parametrize(("pixels", "codec"), [("yuv420p10le", "libx265"), ("bgr0", "ffv1"), ("gray16le", "ffv1")])
def test_deeper_and_coloured_pictures_give_the_same_track(
    planes: list[np.ndarray], tmp_path: Path, pixels: str, codec: str
) -> None:
    options = {"x265-params": "log-level=none:lossless=1"} if codec == "libx265" else {}
    plain = places(record(tmp_path / "plain.mkv", planes, "ffv1", "gray"))
    assert np.abs(places(record(tmp_path / "other.mkv", planes, codec, pixels, **options)) - plain).max() < RANGE_PX


@pytest.fixture
def folder(planes: list[np.ndarray], tmp_path: Path) -> Path:
    folder = tmp_path / "frames"
    folder.mkdir()
    for number, plane in enumerate(planes):
        (folder / f"img{number}.png").write_bytes(cv2.imencode(".png", plane)[1].tobytes())
    return folder


def test_a_folder_of_pictures_is_tracked_like_the_video_of_them(
    planes: list[np.ndarray], folder: Path, tmp_path: Path
) -> None:
    video = record(tmp_path / "video.mkv", planes, "ffv1", "gray")
    wanted = places(video)
    tracked = track_clip(TrackRequest(folder, SEEDS, settings={"block": 41}, fps=FPS))
    np.testing.assert_array_equal(tracked.track.xy_px, wanted)
    np.testing.assert_allclose(tracked.track.time_s, np.arange(FRAMES) / FPS, atol=1e-12)
    later = TrackRequest(folder / "img*.png", SEEDS, settings={"block": 41}, fps=FPS, start=0, step=2)
    np.testing.assert_allclose(track_clip(later).track.time_s, np.arange(0, FRAMES, 2) / FPS, atol=1e-12)


def test_a_folder_needs_a_rate_and_is_not_cut(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"^fps: expected the frames .*, got none\. frames does not tell it: .* --fps\.$"
    ):
        places(folder)
    with pytest.raises(InputError, match=r"^frames: expected a video, which tells its rate, got pictures without one"):
        cut_clip(folder, tmp_path / "clip.avi", 0, 5)
    assert not (tmp_path / "clip.avi").exists()


def test_the_command_line_tracks_a_folder_with_an_overlay(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "img5.png").unlink()
    overlay = tmp_path / "overlay.mp4"
    words = ["track", str(folder), "-p", "a=85,110", "--block", "41", "-o", str(tmp_path / "a.csv")]
    assert run(words) == 2
    assert "--fps" in capsys.readouterr().err
    assert run([*words, "--fps", "240", "--overlay", str(overlay)]) == 0
    assert "numbers jump from img4.png to img6.png" in capsys.readouterr().err
    assert probe(overlay).frame_count == FRAMES - 1
    assert run([*words[:-1], str(tmp_path / "a.xlsx"), "--fps", "240"]) == 0


def test_pictures_of_odd_size_are_tracked_cut_and_drawn_on(planes: list[np.ndarray], tmp_path: Path) -> None:
    odd = [plane[:-1, :-1] for plane in planes]
    video = record(tmp_path / "odd.mkv", odd, "ffv1", "gray")
    whole = places(record(tmp_path / "even.mkv", planes, "ffv1", "gray"))
    np.testing.assert_allclose(places(video), whole, atol=1e-6)
    clip = cut_clip(video, tmp_path / "clip.mp4", 0, 5).clip
    assert (probe(clip).height_px, probe(clip).width_px) == tuple(side // 2 * 2 for side in odd[0].shape)
    np.testing.assert_allclose(places(clip), whole[:6], atol=0.05)
    overlay = tmp_path / "overlay.avi"
    words = ["track", str(video), "-p", "a=85,110", "--block", "41", "-o", str(tmp_path / "a.csv")]
    assert run([*words, "--overlay", str(overlay)]) == 0
    assert probe(overlay).frame_count == FRAMES

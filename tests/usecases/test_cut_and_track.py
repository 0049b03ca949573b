"""Clips and tracks of a speckle that moves as we say."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.errors import (
    FileFormatError,
    FrameRangeError,
    InputError,
    SeedError,
    UnitError,
    UnknownNameError,
    VideoError,
    VmlError,
)
from vml_course.io.video import exact_rate_of, probe, write_video
from vml_course.model.frame import Picture
from vml_course.model.track import Seed
from vml_course.usecases.cut_clip import cut_clip
from vml_course.usecases.estimate_track import estimate_track
from vml_course.usecases.export_track import export_track
from vml_course.usecases.summarise_track import summarise
from vml_course.usecases.track_clip import TrackRequest, VectorRequest, track_clip
from vml_course.usecases.track_words import read_point, read_request, read_scale, read_vector

FRAMES, FPS, TURN_DEG, SHIFT_PX = 24, 480, 1.5, (0.7, -0.4)
TRACKING_PX = 0.1  # the tracker's own tests are stricter; here places are compared, not accuracy
SEEDS = (Seed("left", 85, 110), Seed("right", 155, 110))


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory, speckle: Any, rotated: Any, camera_of: Any) -> Path:
    path = tmp_path_factory.mktemp("speckle") / "speckle.mp4"
    half = np.full((speckle.height_px // 2, speckle.width_px // 2), 128, np.uint8)
    planes = (camera_of(speckle.picture(rotated(TURN_DEG * k), np.multiply(SHIFT_PX, k))) for k in range(FRAMES))
    write_video(path, (Picture(plane, half, half) for plane in planes), FPS, crf=8)
    return path


@pytest.fixture(scope="module")
def place(speckle: Any, rotated: Any) -> Callable[..., np.ndarray]:
    def where(seed: Seed, frame: int, since: int = 0) -> np.ndarray:
        start = (np.array([seed.x_px, seed.y_px]) - speckle.middle - np.multiply(SHIFT_PX, since)) @ rotated(
            TURN_DEG * since
        )
        return speckle.moved(speckle.middle + start, rotated(TURN_DEG * frame), np.multiply(SHIFT_PX, frame))

    return where


def request(video: Path, **changes: Any) -> TrackRequest:
    return TrackRequest(**{"video": video, "seeds": SEEDS, "settings": {"block": 41}, **changes})


def test_points_are_found_where_they_are_in_pixels_metres_and_seconds(video: Path, place: Any) -> None:
    tracked = track_clip(
        request(video, stick_px=(10, 20, 110, 20), length_m=0.25, vectors=(VectorRequest("bar", "left", "right"),))
    )
    truth = np.array([[place(seed, k) for seed in SEEDS] for k in range(FRAMES)])
    np.testing.assert_allclose(tracked.track.xy_px, truth, atol=TRACKING_PX)
    np.testing.assert_allclose(tracked.track.time_s, np.arange(FRAMES) / FPS, atol=1e-12)
    assert tracked.motion is not None
    bottom = probe(video).height_px - 1
    np.testing.assert_allclose(tracked.motion.xy_m[..., 1], (bottom - truth[..., 1]) / 400, atol=TRACKING_PX / 400)
    (bar,) = tracked.vectors
    np.testing.assert_allclose(np.degrees(bar.angle_rad), -TURN_DEG * np.arange(FRAMES), atol=0.05)
    np.testing.assert_allclose(bar.length, 70 / 400, rtol=1e-3)
    assert not tracked.warnings


def test_a_clip_keeps_frame_numbers_and_times_of_its_source(video: Path, tmp_path: Path, place: Any) -> None:
    for kind in ("avi", "mp4"):
        clip = tmp_path / f"clip.{kind}"
        cut = cut_clip(video, clip, 5, 20, 3)
        assert (cut.count, cut.first_frame, cut.last_frame, cut.fps, cut.fps_record) == (6, 5, 20, 160, 480)
        assert probe(clip).frame_count == 6
        assert exact_rate_of(clip) == 160
        seeds = tuple(Seed(seed.name, *place(seed, 5)) for seed in SEEDS)
        tracked = track_clip(request(clip, seeds=seeds))
        assert tracked.track.frame.tolist() == [5, 8, 11, 14, 17, 20]
        np.testing.assert_allclose(tracked.track.time_s, np.arange(6) * 3 / 480, atol=1e-12)
        assert (tracked.video, tracked.fps) == ("speckle.mp4", 480)
        truth = np.array([[place(seed, k) for seed in SEEDS] for k in range(5, 21, 3)])
        np.testing.assert_allclose(tracked.track.xy_px, truth, atol=TRACKING_PX)


def test_a_clip_of_a_clip_still_knows_the_first_source(video: Path, tmp_path: Path) -> None:
    cut_clip(video, tmp_path / "one.avi", 4, 20, 2)
    cut = cut_clip(tmp_path / "one.avi", tmp_path / "two.avi", 1, 7, 3)
    assert (cut.first_frame, cut.last_frame, cut.fps_record) == (6, 18, 480)
    note = json.loads((tmp_path / "two.avi.vmlclip.json").read_text("utf-8"))
    assert (note["source"], note["first_source_frame"], note["step"]) == ("speckle.mp4", 6, 6)
    assert note["pts"] == [stamp * 32 for stamp in (6, 12, 18)]


def test_a_note_of_another_clip_is_refused(video: Path, tmp_path: Path) -> None:
    clip = tmp_path / "clip.avi"
    cut_clip(video, clip, 0, 5)
    write_video(clip, _flat(6), 30)
    with pytest.raises(FileFormatError, match=r"clip\.avi\.vmlclip\.json.* another clip"):
        track_clip(request(clip))
    (tmp_path / "clip.avi.vmlclip.json").write_text("{]")
    with pytest.raises(FileFormatError, match="something else"):
        track_clip(request(clip))


def _flat(count: int) -> list[Picture]:
    return [Picture(np.full((64, 64), 99, np.uint8), *[np.full((32, 32), 128, np.uint8)] * 2)] * count


def test_a_clip_does_not_overwrite_its_video_and_a_wrong_range_writes_nothing(video: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the same file"):
        cut_clip(video, video, 0, 5)
    with pytest.raises(FrameRangeError, match="0 to 23"):
        cut_clip(video, tmp_path / "clip.avi", 30, 40)
    assert list(tmp_path.iterdir()) == []


def test_the_true_rate_stretches_the_times(video: Path) -> None:
    assert track_clip(request(video, fps=240.0, end=5)).track.time_s[5] == pytest.approx(5 / 240)
    half = track_clip(request(video, start=4, end=12, step=4))
    np.testing.assert_allclose(half.track.time_s, [0, 4 / 480, 8 / 480])


def test_a_variable_rate_is_said_and_its_own_times_are_used(video: Path, tmp_path: Path) -> None:
    path, stamps = tmp_path / "uneven.mp4", [2 * n + (n % 4 == 3) for n in range(FRAMES)]
    with av.open(str(video)) as source, av.open(str(path), "w") as target:
        stream = target.add_stream("libx264", rate=30, options={"crf": "8"})
        stream.width, stream.height, stream.pix_fmt = 240, 220, "yuv420p"
        stream.codec_context.time_base = Fraction(1, 960)
        for stamp, frame in zip(stamps, source.decode(video=0), strict=True):
            plain = frame.reformat(format="yuv420p")
            plain.pts, plain.time_base = stamp, Fraction(1, 960)
            target.mux(stream.encode(plain))
        target.mux(stream.encode(None))
    tracked = track_clip(request(path))
    np.testing.assert_allclose(tracked.track.time_s, np.array(stamps) / 960, atol=1e-9)
    assert any("frame rate varies" in line for line in tracked.warnings)
    mean = float(exact_rate_of(path))
    slow = track_clip(request(path, fps=2 * mean))
    np.testing.assert_allclose(slow.track.time_s, np.array(stamps) / 960 / 2, atol=1e-9)
    cut_clip(path, tmp_path / "clip.avi", 3, 15, 4)
    cut = track_clip(request(tmp_path / "clip.avi"))
    np.testing.assert_allclose(cut.track.time_s, np.subtract(stamps[3:16:4], stamps[3]) / 960, atol=1e-9)


def test_impossible_requests_are_refused_before_any_picture_is_decoded(tmp_path: Path) -> None:
    nothing = tmp_path / "nothing.mp4"
    cases: list[tuple[dict[str, Any], type[VmlError]]] = [
        ({"method": "magic"}, UnknownNameError),
        ({"settings": {"magic": 1}}, UnknownNameError),
        ({"vectors": (VectorRequest("bar", "left", "top"),)}, UnknownNameError),
        ({"vectors": (VectorRequest("bar", "left", "left"),)}, InputError),
        ({"vectors": (VectorRequest("bar", "left", "right"),) * 2}, InputError),
        ({"seeds": (*SEEDS, SEEDS[0])}, InputError),
    ]
    for changes, error in cases:
        with pytest.raises(error):
            track_clip(request(nothing, **changes))


def test_what_does_not_fit_the_video_is_refused(video: Path) -> None:
    with pytest.raises(FrameRangeError):
        track_clip(request(video, start=50))
    with pytest.raises(SeedError, match="left"):
        track_clip(request(video, seeds=(Seed("left", 5000, 10),)))
    with pytest.raises(InputError, match="fps"):
        track_clip(request(video, fps=0.0))
    with pytest.raises(VideoError):
        track_clip(request(Path(__file__)))


def test_progress_counts_every_picture(video: Path) -> None:
    said: list[tuple[int, int]] = []
    track_clip(request(video, end=9), lambda done, total: said.append((done, total)))
    assert said == [(k, 10) for k in range(1, 11)]


def test_the_estimate_is_for_all_frames_of_the_request(video: Path) -> None:
    found = estimate_track(request(video, start=2, step=2))
    assert (found.frames, found.points) == (11, 2)
    assert found.seconds_per_frame > 0
    assert found.seconds > 10 * found.seconds_per_frame  # and what opening the file takes, once


def test_all_files_are_written_and_wrong_names_are_found_first(video: Path, tmp_path: Path) -> None:
    tracked = track_clip(request(video, end=5))
    names = [tmp_path / f"out.{kind}" for kind in ("xlsx", "csv", "mat")]
    with pytest.raises(FileFormatError):
        export_track(tracked, [*names, tmp_path / "out.ods"])
    with pytest.raises(FileFormatError):
        export_track(tracked, names, tmp_path / "out.gif")
    assert list(tmp_path.iterdir()) == []
    written = export_track(tracked, names, tmp_path / "out.avi")
    assert all(path.is_file() for path in written)
    assert len(written) == 4


def test_a_summary_counts_what_was_found(video: Path) -> None:
    first, second = summarise(track_clip(request(video)))
    assert (first.name, first.found, first.frames) == ("left", FRAMES, FRAMES)
    assert second.worst_zncc > 0.95
    assert 0 < second.median_sigma_px < 0.1


# ---------------------------------------------------------------- words


@given(x=st.floats(-1e4, 1e4), y=st.floats(-1e4, 1e4), name=st.text(min_size=1).filter(str.strip))
def test_a_point_is_read_as_it_is_written(x: float, y: float, name: str) -> None:
    seed = read_point(f"{name}={x:.4f},{y:.4f}")
    assert seed == Seed(name.strip(), float(f"{x:.4f}"), float(f"{y:.4f}"))


@given(st.text())
def test_any_text_is_a_point_or_one_line(text: str) -> None:
    for reader in (read_point, read_vector, read_scale):
        try:
            reader(text)
        except VmlError as error:
            line = str(error)
        else:
            line = ""
        assert "\n" not in line


@pytest.mark.parametrize(
    ("text", "metres"),
    [("0.22 m", 0.22), ("22 cm", 0.22), ("220mm", 0.22), ("1 ft", 0.3048), ("8,5 in", 0.2159), ("0,22 m", 0.22)],
)
def test_a_length_may_have_any_unit_of_the_list(text: str, metres: float) -> None:
    stick, length_m, typed = read_scale(f"1,2,3.5,4={text}")
    assert stick == (1, 2, 3.5, 4)
    assert length_m == pytest.approx(metres)
    assert typed == text


def test_words_that_cannot_be_read_name_their_option() -> None:
    with pytest.raises(InputError, match=r"-p: expected a point as NAME=X,Y"):
        read_point("ball")
    with pytest.raises(InputError, match=r"-p ball: expected two numbers"):
        read_point("ball=1;2")
    with pytest.raises(InputError, match=r"--vector"):
        read_vector("shin=knee")
    with pytest.raises(InputError, match=r"--scale: expected two points and a length"):
        read_scale("1,2,3=0.22 m")
    with pytest.raises(UnitError, match=r"--scale"):
        read_scale("1,2,3,4=0.22")
    with pytest.raises(InputError, match=r"-p: expected at least one point"):
        read_request(Path("a.mp4"), [], [], {})
    made = read_request(Path("a.mp4"), ["a=1,2"], [], {"fps": "240 fps", "origin": "3,4.5", "scale": None}, step=2)
    assert (made.fps, made.origin_px, made.step) == (240.0, (3.0, 4.5), 2)
    assert math.isclose(made.seeds[0].x_px, 1)

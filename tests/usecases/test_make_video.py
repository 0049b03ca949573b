"""A made video holds the pictures of its truth and nothing of its numbers."""

from pathlib import Path

import numpy as np
import pytest

from vml_course.errors import FileFormatError, InputError, SceneRefusedError, UnknownNameError
from vml_course.io.truth import read_truth_csv, read_truth_json
from vml_course.io.video import probe, read_frames
from vml_course.synth.render import render
from vml_course.synth.settings import read_settings
from vml_course.usecases import make_video as make_video_module
from vml_course.usecases.make_video import make_video

SMALL = ["fps=240", "width_px=640", "height_px=360", "px_per_m=250", "origin_x_px=210", "origin_y_px=100"]
CODEC_GREY = 6.0  # root mean square difference of a decoded picture


def make(folder, *texts, seed=4, **more):
    made = read_settings("soccer_kick", [*SMALL, *texts])
    return make_video(made.scene, made.camera, made.recording, seed, folder, **more), made


@pytest.mark.parametrize(
    ("kind", "codec", "worst"),
    [
        ("mp4", "h264", CODEC_GREY), ("avi", "mjpeg", CODEC_GREY), ("mp4", "hevc", CODEC_GREY),
        ("mp4", "vp9", CODEC_GREY), ("avi", "ffv1", 1e-9),
    ],
)  # fmt: skip
def test_the_video_shows_what_was_rendered(tmp_path, kind, codec, worst):
    video, made = make(tmp_path, f"format={kind}", f"codec={codec}")
    info = probe(video.video)
    assert info.codec == codec
    assert (info.width_px, info.height_px, info.frame_count) == (640, 360, len(video.truth.time_s))
    assert info.fps == pytest.approx(240)
    pairs = zip(read_frames(video.video), render(video.truth, made.recording), strict=True)
    for decoded, drawn in pairs:
        difference = decoded.luma.astype(float) - drawn.luma
        assert np.sqrt((difference**2).mean()) < worst
        assert abs(difference.mean()) < 0.5


def test_the_truth_lies_beside_the_video(tmp_path):
    video, _ = make(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["truth.csv", "truth.json", "video.mp4"]
    assert np.array_equal(read_truth_json(tmp_path / "truth.json").pose, video.truth.pose)
    assert len(read_truth_csv(tmp_path / "truth.csv")["frame"]) == len(video.truth.time_s)


def test_the_video_tells_nothing_of_its_truth(tmp_path):
    video, _ = make(tmp_path, "e=0.6125", seed=987654)
    content = video.video.read_bytes()
    for word in (b"soccer", b"0.6125", b"987654", b"vml", b"restitution", str(tmp_path).encode()):
        assert word not in content


class BrokenWriterError(RuntimeError):
    pass


FILES = ["truth.csv", "truth.json", "video.mp4"]
FAILURES = ["write_video", "write_truth_json", "write_truth_csv"]


def half_way(error):
    """A writer that leaves half a file behind and fails, as a full disk or Ctrl-C does."""

    def write(path, *_):
        path.write_bytes(b"half")
        raise error

    return write


@pytest.mark.parametrize("error", [BrokenWriterError, KeyboardInterrupt])
@pytest.mark.parametrize("writer", FAILURES)
def test_a_writer_that_fails_leaves_no_file_and_no_folder(tmp_path, monkeypatch, writer, error):
    monkeypatch.setattr(make_video_module, writer, half_way(error))
    with pytest.raises(error):
        make(tmp_path / "deep" / "kick")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("writer", FAILURES)
def test_a_writer_that_fails_leaves_an_older_clip_as_it_was(tmp_path, monkeypatch, writer):
    make(tmp_path)
    older = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    monkeypatch.setattr(make_video_module, writer, half_way(BrokenWriterError))
    with pytest.raises(BrokenWriterError):
        make(tmp_path, "e=0.5")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == older


def test_pictures_that_end_half_way_leave_nothing(tmp_path):
    def tell(done, _):
        if done == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        make(tmp_path / "kick", progress=tell)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("held", FILES)
@pytest.mark.parametrize("moment", ["moved aside", "put in place"])
def test_an_older_file_that_another_program_holds_stops_all_three(tmp_path, monkeypatch, held, moment):
    make(tmp_path)
    older = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    replace = Path.replace

    def refusing(self, target):
        if (self if moment == "moved aside" else Path(target)).name == held and not refused:
            refused.append(held)
            raise PermissionError(13, "Permission denied", str(self))
        return replace(self, target)

    refused = []
    monkeypatch.setattr(Path, "replace", refusing)
    with pytest.raises(FileFormatError, match="expected a file that may be written, got no permission"):
        make(tmp_path, "e=0.5")
    assert refused
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == older


def test_a_file_in_the_place_of_the_folder_is_told_in_one_line(tmp_path):
    (tmp_path / "kick").write_text("notes")
    with pytest.raises(FileFormatError, match="kick: expected a folder to write into") as caught:
        make(tmp_path / "kick")
    assert "\n" not in str(caught.value)
    assert (tmp_path / "kick").read_text() == "notes"


def test_progress_counts_the_pictures(tmp_path):
    told = []
    video, _ = make(tmp_path, progress=lambda done, total: told.append((done, total)))
    frames = len(video.truth.time_s)
    assert told == [(k, frames) for k in range(1, frames + 1)]


def test_a_refused_scene_leaves_no_folder(tmp_path):
    with pytest.raises(SceneRefusedError):
        make(tmp_path / "new", "time_after_s=0.04", "omega1=50")
    assert not (tmp_path / "new").exists()


def test_a_clip_of_another_format_takes_the_older_ones_place(tmp_path):
    make(tmp_path, "format=mp4")
    make(tmp_path, "format=avi")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["truth.csv", "truth.json", "video.avi"]


def test_a_refused_clip_leaves_the_older_one(tmp_path):
    make(tmp_path, "format=mp4")
    with pytest.raises(SceneRefusedError):
        make(tmp_path, "format=avi", "time_after_s=0.04", "omega1=50")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["truth.csv", "truth.json", "video.mp4"]


def test_the_file_may_claim_another_rate_while_the_truth_keeps_its_own(tmp_path):
    video, _ = make(tmp_path, "file_fps=30")
    assert probe(video.video).fps == pytest.approx(30)
    assert video.truth.time_s[1] == pytest.approx(1 / 240)


@pytest.mark.parametrize("codec", ["h264", "hevc", "vp9"])
def test_a_coarser_rate_factor_makes_a_smaller_file(tmp_path, codec):
    sizes = [make(tmp_path, f"codec={codec}", f"crf={crf}")[0].video.stat().st_size for crf in (18, 40)]
    assert sizes[1] < 0.5 * sizes[0]


@pytest.mark.parametrize("codec", ["h264", "hevc", "vp9", "mjpeg", "ffv1"])
def test_the_same_clip_is_the_same_file_in_every_codec(tmp_path, codec):
    kind = "avi" if codec in ("mjpeg", "ffv1") else "mp4"
    first, again = (make(tmp_path, f"format={kind}", f"codec={codec}")[0].video.read_bytes() for _ in range(2))
    assert first == again
    assert b"x265" not in first
    assert b"Lavc" not in first


def test_a_codec_that_a_file_cannot_hold_is_refused():
    with pytest.raises(
        InputError, match=r"codec: expected one of h264, hevc, vp9 in mp4, got ffv1\. Or set format=avi"
    ):
        read_settings("soccer_kick", ["codec=ffv1"])
    with pytest.raises(UnknownNameError, match="codec: expected one of usual, h264"):
        read_settings("soccer_kick", ["codec=divx"])


@pytest.mark.parametrize(("width", "height"), [(1920, 1080), (1078, 66)])
def test_any_even_size_can_be_filmed(tmp_path, width, height):
    scale, y = (250, 100) if height > 500 else (50, 10)
    where = [f"width_px={width}", f"height_px={height}", f"px_per_m={scale}", "origin_x_px=300", f"origin_y_px={y}"]
    made = read_settings("soccer_kick", [*where, "fps=60"])
    video = make_video(made.scene, made.camera, made.recording, 1, tmp_path)
    info = probe(video.video)
    assert (info.width_px, info.height_px) == (width, height)


@pytest.mark.parametrize(
    "effects",
    [
        ("shutter=0.5", "contrast=0.5", "brightness_drift=0.2", "noise_grey=2"),
        ("k1=-0.1", "roll_deg=3", "pan_deg=4", "tilt_deg=-5", "rolling_shutter=0.8", "shake_px=1"),
    ],
)
def test_the_truth_file_alone_is_enough_to_make_the_pictures_again(tmp_path, effects):
    video, made = make(tmp_path, *effects)
    truth = read_truth_json(tmp_path / "truth.json")
    assert truth.recording == made.recording
    pairs = zip(render(truth, truth.recording), render(video.truth, made.recording), strict=True)
    assert all(np.array_equal(again.luma, first.luma) for again, first in pairs)

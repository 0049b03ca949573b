from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from vml_course.errors import FileFormatError, FileMissingError, FrameRangeError, InputError, VideoError
from vml_course.io.video import bgr_of, picture_from_bgr, probe, read_frames, read_pictures, write_video
from vml_course.model.frame import Picture

WIDTH, HEIGHT = 160, 96
LUMA_RMS = 2.5  # grey levels that compression may cost, mean over a clip
OPEN_GOP, QUIET = {"x264-params": "open-gop=1:keyint=12:bframes=3"}, {"x265-params": "log-level=none"}
HEADS = [b"", b"RIFF\x00\x10\x00\x00AVI LIST", b"\x00\x00\x00\x18ftypmp42", b"\x1aE\xdf\xa3", b"G@\x00\x10"]
SEEK = [(0, 5, 1), (7, 20, 3), (31, 31, 1), (50, 59, 2)]


def luma(number: int, height: int = HEIGHT, width: int = WIDTH) -> np.ndarray:
    """A texture in 0 to 255 that moves; a 4×4 corner block tells the number (least bit first)."""
    rng = np.random.default_rng(5)
    coarse = rng.integers(0, 256, (height // 8, width // 8)).astype(np.uint8)
    plane = np.roll(cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC), number, 1)
    for bit in range(8):
        plane[:8, 8 * bit : 8 * bit + 8] = 235 if number >> bit & 1 else 20
    return plane


def number_in(plane: np.ndarray) -> int:
    middle = 0.5 * (float(plane[:8, :64].max()) + float(plane[:8, :64].min())) if plane[:8, :64].max() > 128 else 255
    return sum(1 << bit for bit in range(8) if plane[2:6, 8 * bit + 2 : 8 * bit + 6].mean() > middle)


def pictures(count: int, height: int = HEIGHT, width: int = WIDTH) -> Iterator[Picture]:
    grey = np.full((height // 2, width // 2), 128, np.uint8)
    return (Picture(luma(number, height, width), grey, grey) for number in range(count))


def record(
    path: Path, stamps: Iterable[int], base: Fraction, pixels: str = "yuv420p", codec: str = "libx264", **options: str
) -> Path:
    """Write a file as other programs might, with time stamps of one's choice."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=30, options={"crf": "10", **options} if "x26" in codec else options)
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, pixels
        stream.codec_context.time_base = base
        for number, stamp in enumerate(stamps):
            frame = av.VideoFrame.from_ndarray(luma(number), format="gray").reformat(format=pixels)
            frame.pts, frame.time_base = stamp, base
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


@pytest.fixture(scope="module")
def clips(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("clips")
    even, uneven = range(60), [2 * n + (n % 5 == 0) + (n > 30) * 3 for n in range(60)]
    made = {"mp4": folder / "a.mp4", "avi": folder / "a.avi"}
    for path in made.values():
        write_video(path, pictures(60), 480)
    return made | {
        "b-frames": record(folder / "b.mp4", even, Fraction(1, 480), g="12", bf="3"),
        "mkv": record(folder / "c.mkv", even, Fraction(1, 480), g="12", bf="3"),
        "open-gop": record(folder / "d.mp4", even, Fraction(1, 30), **OPEN_GOP),
        "vfr mp4": record(folder / "e.mp4", uneven, Fraction(1, 480), g="12"),
        "vfr mkv": record(folder / "f.mkv", uneven, Fraction(1, 120), g="12"),
        "ts": record(folder / "g.ts", even, Fraction(1, 30), g="12"),
        "b-frames in avi": record(folder / "h.avi", even, Fraction(1, 30), g="12", bf="3"),
        "hevc 10 bit": record(folder / "i.mp4", even, Fraction(1, 30), "yuv420p10le", "libx265", **QUIET),
        "rgb": record(folder / "j.avi", even, Fraction(1, 30), "bgr24", "rawvideo"),
        "packed": record(folder / "k.avi", even, Fraction(1, 30), "yuyv422", "rawvideo"),
        "lossless gray": record(folder / "l.mkv", even, Fraction(1, 30), "gray", "ffv1"),
        "444": record(folder / "m.mp4", even, Fraction(1, 30), "yuv444p"),
    }  # fmt: skip


ALL = [
    "mp4", "avi", "b-frames", "mkv", "open-gop", "vfr mp4", "vfr mkv", "ts", "b-frames in avi", "hevc 10 bit", "rgb",
    "packed", "lossless gray", "444",
]  # fmt: skip


@pytest.mark.parametrize("name", ALL)
def test_every_container_counts_its_pictures_and_gives_each_by_its_number(clips: dict[str, Path], name: str) -> None:
    info = probe(clips[name])
    assert (info.frame_count, info.width_px, info.height_px) == (60, WIDTH, HEIGHT)
    assert info.is_variable_rate == name.startswith("vfr")
    assert not info.damage
    for start, end, step in SEEK:
        frames = list(read_frames(clips[name], start, end, step))
        assert [frame.index for frame in frames] == list(range(start, end + 1, step))
        assert [number_in(frame.luma) for frame in frames] == list(range(start, end + 1, step))


@pytest.mark.parametrize("name", ["mp4", "avi"])
@pytest.mark.parametrize("rate", [Fraction(480), Fraction(30000, 1001), Fraction(960), Fraction(26777, 1000)])
def test_a_written_rate_comes_back_exactly_and_so_do_the_time_stamps(tmp_path: Path, name: str, rate: Fraction) -> None:
    path = tmp_path / f"clip.{name}"
    assert write_video(path, pictures(30), float(rate)) == 30
    assert probe(path).fps == float(rate)
    for frame in read_frames(path):
        assert frame.time_s == pytest.approx(frame.index / rate, abs=1e-12)


@pytest.mark.parametrize("name", ["mp4", "avi"])
def test_the_luma_that_was_drawn_is_the_luma_that_is_decoded(clips: dict[str, Path], name: str) -> None:
    errors = [frame.luma.astype(float) - luma(frame.index) for frame in read_frames(clips[name])]
    assert float(np.sqrt(np.mean(np.square(errors)))) < LUMA_RMS


@pytest.mark.parametrize("name", ["mp4", "avi"])
def test_black_and_white_keep_the_full_range(tmp_path: Path, name: str) -> None:
    plane = np.zeros((HEIGHT, WIDTH), np.uint8)
    plane[:, WIDTH // 2 :] = 255
    grey = np.full((HEIGHT // 2, WIDTH // 2), 128, np.uint8)
    path = tmp_path / f"clip.{name}"
    write_video(path, [Picture(plane, grey, grey)] * 3, 30)
    decoded = next(iter(read_frames(path))).luma
    assert decoded[:, :64].mean() < 1
    assert decoded[:, 96:].mean() > 254
    picture = next(iter(read_pictures(path))).picture
    assert bgr_of(picture)[50, 150].min() > 250


@pytest.mark.parametrize("name", ["mp4", "avi"])
def test_colours_survive(tmp_path: Path, name: str) -> None:
    image = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    colours = [(20, 20, 220), (200, 60, 30), (40, 180, 60), (235, 235, 235)]
    for place, colour in enumerate(colours):
        image[:, 40 * place : 40 * place + 40] = colour
    path = tmp_path / f"clip.{name}"
    write_video(path, [picture_from_bgr(image)] * 3, 30)
    decoded = bgr_of(next(iter(read_pictures(path))).picture)
    for place, colour in enumerate(colours):
        np.testing.assert_allclose(decoded[48, 40 * place + 20], colour, atol=6)


def test_the_same_pictures_give_the_same_bytes_without_titles_or_dates(tmp_path: Path) -> None:
    for name in ("mp4", "avi"):
        first, second = tmp_path / f"first.{name}", tmp_path / f"second.{name}"
        for path in (first, second):
            write_video(path, pictures(20), 480)
        assert first.read_bytes() == second.read_bytes()
        with av.open(str(first)) as container:
            assert not {"title", "comment", "encoder", "creation_time", "date"} & set(container.metadata)


def test_variable_rates_give_their_own_times(clips: dict[str, Path]) -> None:
    times = [frame.time_s for frame in read_frames(clips["vfr mp4"])]
    expected = [(2 * n + (n % 5 == 0) + (n > 30) * 3) / 480 for n in range(60)]
    np.testing.assert_allclose(np.subtract(times, times[0]), np.subtract(expected, expected[0]), atol=1e-9)


def test_one_dropped_picture_is_a_variable_rate_but_matroska_rounding_is_not(tmp_path: Path) -> None:
    stamps = [n + (n > 20) for n in range(60)]
    assert probe(record(tmp_path / "drop.mp4", stamps, Fraction(1, 30))).is_variable_rate
    assert not probe(record(tmp_path / "even.mkv", range(60), Fraction(1, 480))).is_variable_rate


def test_a_phone_held_upright_gives_upright_pictures(clips: dict[str, Path], tmp_path: Path) -> None:
    """The display matrix of the track header is overwritten as phones write it: a quarter turn."""
    data = bytearray(clips["mp4"].read_bytes())
    matrix = data.index(b"tkhd") + 4 + 40
    quarter = [0, 1 << 16, 0, -(1 << 16), 0, 0, HEIGHT << 16, 0, 1 << 30]
    data[matrix : matrix + 36] = b"".join(number.to_bytes(4, "big", signed=True) for number in quarter)
    path = tmp_path / "upright.mp4"
    path.write_bytes(data)
    info = probe(path)
    assert (info.width_px, info.height_px) == (HEIGHT, WIDTH)
    shown = next(iter(read_frames(path))).luma
    stored = next(iter(read_frames(clips["mp4"]))).luma
    np.testing.assert_array_equal(shown, np.rot90(stored, -1))  # that matrix turns clockwise
    assert next(iter(read_pictures(path))).picture.luma.shape == (WIDTH, HEIGHT)


# ---------------------------------------------------------------- what is no video


def test_a_missing_file_an_empty_file_and_a_text_each_give_one_line(tmp_path: Path) -> None:
    with pytest.raises(FileMissingError, match=r"nothing\.mp4: expected an existing file"):
        probe(tmp_path / "nothing.mp4")
    with pytest.raises(FileMissingError, match="a folder"):
        probe(tmp_path)
    (tmp_path / "empty.mp4").touch()
    with pytest.raises(VideoError, match=r"empty\.mp4: .* empty file"):
        probe(tmp_path / "empty.mp4")
    (tmp_path / "text.mp4").write_text("#EXTM3U\nthis is not a video\n" * 50)
    with pytest.raises(VideoError, match=r"text\.mp4: expected a video") as caught:
        probe(tmp_path / "text.mp4")
    assert "\n" not in str(caught.value)


def test_sound_alone_is_no_video(tmp_path: Path) -> None:
    path = tmp_path / "sound.mp4"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("aac", rate=44100)
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 44100), np.float32), format="fltp", layout="mono")
        frame.rate = 44100
        container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    with pytest.raises(VideoError, match="without pictures"):
        probe(path)


def test_a_recording_cut_off_before_its_index_says_so(clips: dict[str, Path], tmp_path: Path) -> None:
    data = record(tmp_path / "whole.mp4", range(60), Fraction(1, 30)).read_bytes()
    path = tmp_path / "cut.mp4"
    path.write_bytes(data[: len(data) * 2 // 3])
    with pytest.raises(VideoError, match=r"cut\.mp4: .*moov atom"):
        probe(path)


@pytest.mark.parametrize("name", ["mp4", "avi", "mkv", "ts"])
def test_a_file_that_ends_early_is_readable_up_to_there_and_says_so(
    clips: dict[str, Path], tmp_path: Path, name: str
) -> None:
    data = clips[name].read_bytes()
    path = tmp_path / f"cut{clips[name].suffix}"
    path.write_bytes(data[: len(data) * 2 // 3])
    info = probe(path)
    assert 20 < info.frame_count < 50
    if name in ("mp4", "avi"):
        assert info.damage
    frames = list(read_frames(path, 0, info.frame_count - 2))
    assert [number_in(frame.luma) for frame in frames] == list(range(info.frame_count - 1))


def test_damage_in_the_middle_names_the_last_usable_frame(clips: dict[str, Path], tmp_path: Path) -> None:
    data = bytearray(clips["avi"].read_bytes())
    place = data.index(b"00dc", len(data) // 2) + 200
    data[place : place + 600] = bytes(600)
    path = tmp_path / "damaged.avi"
    path.write_bytes(data)
    with pytest.raises(VideoError, match=r"damage at frame \d+. Frames 0 to \d+ can be used") as caught:
        list(read_frames(path))
    last = int(str(caught.value).rsplit(" ", 1)[1].rstrip("."))
    frames = list(read_frames(path, 0, last))
    assert [number_in(frame.luma) for frame in frames] == list(range(last + 1))


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(min_size=0, max_size=3000), head=st.sampled_from(HEADS))
def test_garbage_is_a_video_error_and_nothing_else(tmp_path: Path, data: bytes, head: bytes) -> None:
    path = tmp_path / "garbage.mp4"
    path.write_bytes(head + data)
    with pytest.raises(VideoError):
        probe(path)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    place=st.floats(0, 0.999), patch=st.binary(min_size=1, max_size=400), name=st.sampled_from(["mp4", "avi", "mkv"])
)
@example(place=0.025, patch=b"\x80", name="mp4")  # metadata that is no UTF-8
def test_a_video_with_wounds_is_read_or_refused_but_never_a_traceback(
    clips: dict[str, Path], tmp_path: Path, place: float, patch: bytes, name: str
) -> None:
    data = bytearray(clips[name].read_bytes())
    at = int(place * len(data))
    data[at : at + len(patch)] = patch
    path = tmp_path / f"wounded{clips[name].suffix}"
    path.write_bytes(data)
    try:
        frames = list(read_frames(path))
    except VideoError:
        return
    assert [frame.index for frame in frames] == list(range(len(frames)))


# ---------------------------------------------------------------- ranges and writing


@pytest.mark.parametrize(("start", "end", "step"), [(-1, 5, 1), (60, None, 1), (10, 60, 1), (10, 9, 1), (0, 5, 0)])
def test_frames_outside_the_video_are_refused_at_once(clips: dict[str, Path], start: int, end: int, step: int) -> None:
    with pytest.raises(FrameRangeError):
        read_frames(clips["mp4"], start, end, step)


def test_the_range_error_says_the_range(clips: dict[str, Path]) -> None:
    with pytest.raises(FrameRangeError, match=r"start: expected a frame of a\.mp4, 0 to 59, got 75\."):
        read_frames(clips["mp4"], 75)


def failing(count: int) -> Iterator[Picture]:
    yield from pictures(count)
    raise RuntimeError


def test_a_failed_or_refused_write_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "clip.mp4"
    write_video(path, pictures(5), 30)
    before = path.read_bytes()
    grey = np.full((HEIGHT // 2, WIDTH // 2), 128, np.uint8)
    with pytest.raises(RuntimeError):
        write_video(path, failing(5), 30)
    with pytest.raises(InputError, match="one size"):
        write_video(path, [*pictures(2), Picture(luma(0, 48, 80), grey, grey)], 30)
    with pytest.raises(VideoError, match="at least one picture"):
        write_video(path, [], 30)
    with pytest.raises(InputError, match="even"):
        write_video(path, [Picture(luma(0)[:95], grey, grey)], 30)
    with pytest.raises(InputError, match="fps"):
        write_video(path, pictures(2), 0)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_an_unknown_ending_or_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"\.mp4 \(H\.264\) or \.avi"):
        write_video(tmp_path / "clip.mov", pictures(1), 30)
    with pytest.raises(FileMissingError, match="folder"):
        write_video(tmp_path / "nowhere" / "clip.mp4", pictures(1), 30)

"""Every kind of file that cameras, phones and cutting programs leave behind, picture by picture.

What our reader gives for random requests is compared with a plain decoding of the whole file in one go, in which
no seek, no index and none of our code has a part.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from vml_course.errors import VideoError, VmlError
from vml_course.io.source import open_source
from vml_course.io.timing import rate_of
from vml_course.io.video import bgr_of, probe, read_frames, read_pictures

COUNT = 30
SIZE = (96, 160)
NTH = Fraction(1, 30)
SILENT = "log-level=none"
UNEVEN = tuple(2 * n + (n % 5 == 0) + (n > 20) * 3 for n in range(COUNT))
EVEN = tuple(range(COUNT))


def luma(number: int, size: tuple[int, int] = SIZE) -> np.ndarray:
    """A smooth texture that moves by one pixel a picture, and tells its number in a row of 8×8 px bits."""
    height, width = size
    coarse = np.random.default_rng(5).integers(0, 256, (height // 8 + 1, width // 8 + 1)).astype(np.uint8)
    plane = np.roll(cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC), number, 1)
    for bit in range(8):
        plane[:8, 8 * bit : 8 * bit + 8] = 235 if number >> bit & 1 else 20
    return plane


@dataclass(frozen=True)
class Kind:
    """How a file is written: its name's ending, codec, pixels, time stamps, and the encoder's options."""

    ending: str
    codec: str = "libx264"
    pixels: str = "yuv420p"
    options: dict[str, str] = field(default_factory=dict)
    stamps: Iterable[int] = EVEN
    base: Fraction = NTH
    size: tuple[int, int] = SIZE
    container: dict[str, str] = field(default_factory=dict)
    rate: int = 30


def record(folder: Path, kind: Kind) -> Path:
    path = folder / f"clip.{kind.ending}"
    with av.open(str(path), "w", options=kind.container) as container:
        stream = container.add_stream(kind.codec, rate=kind.rate, options=kind.options)
        (stream.height, stream.width), stream.pix_fmt = kind.size, kind.pixels
        stream.codec_context.time_base = kind.base
        for number, stamp in enumerate(kind.stamps):
            frame = av.VideoFrame.from_ndarray(luma(number, kind.size), format="gray").reformat(format=kind.pixels)
            frame.pts, frame.time_base = stamp, kind.base
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def trimmed(path: Path, start_s: float) -> Path:
    """Cut the beginning off without decoding, as phones do: the pictures stay, an edit list hides them."""
    out = path.with_name(f"trimmed{path.suffix}")
    with av.open(str(path)) as source, av.open(str(out), "w") as target:
        stream = source.streams.video[0]
        copy = target.add_stream_from_template(stream)
        shift = round(start_s / stream.time_base)
        for packet in source.demux(stream):
            if packet.size:
                packet.pts, packet.dts, packet.stream = packet.pts - shift, packet.dts - shift, copy
                target.mux(packet)
    return out


B_FRAMES = {"g": "12", "bf": "3", "crf": "10"}
OPEN_GOP = {"x264-params": "open-gop=1:keyint=12:bframes=3:scenecut=0", "crf": "10"}
HEVC_OPEN = {"x265-params": f"{SILENT}:open-gop=1:keyint=12:min-keyint=12:bframes=3:scenecut=0"}
VPX = {"deadline": "good", "cpu-used": "5", "g": "12", "auto-alt-ref": "1", "lag-in-frames": "16"}
HEVC = {"x265-params": SILENT, "g": "12"}
JPEG = {"qmin": "2", "qmax": "2"}
KINDS = {
    "hevc": Kind("mp4", "libx265", options=HEVC),
    "hevc 10 bit": Kind("mp4", "libx265", "yuv420p10le", HEVC),
    "hevc, open gop": Kind("mp4", "libx265", options=HEVC_OPEN),
    "hevc in ts": Kind("ts", "libx265", options=HEVC),
    "h264 10 bit": Kind("mp4", pixels="yuv420p10le", options=B_FRAMES),
    "vp8": Kind("webm", "libvpx", options=VPX),
    "vp9": Kind("webm", "libvpx-vp9", options=VPX),
    "vp9 in mp4": Kind("mp4", "libvpx-vp9", options=VPX),
    "av1": Kind("mp4", "libsvtav1", options={"preset": "12", "g": "12"}),
    "av1 in mkv, 10 bit": Kind("mkv", "libsvtav1", "yuv420p10le", {"preset": "12", "g": "12"}),
    "variable rate mp4": Kind("mp4", options=B_FRAMES, stamps=UNEVEN, base=Fraction(1, 480)),
    "variable rate mkv": Kind("mkv", options=B_FRAMES, stamps=UNEVEN, base=Fraction(1, 120)),
    "b-frames mp4": Kind("mp4", options=B_FRAMES),
    "b-frames mov": Kind("mov", options=B_FRAMES),
    "b-frames mkv": Kind("mkv", options=B_FRAMES),
    "b-frames avi": Kind("avi", options=B_FRAMES),
    "mpeg-4 b-frames avi": Kind("avi", "mpeg4", options={"g": "12", "bf": "2"}),
    "open gop mp4": Kind("mp4", options=OPEN_GOP),
    "open gop mkv": Kind("mkv", options=OPEN_GOP),
    "open gop avi": Kind("avi", options=OPEN_GOP),
    "mpeg-ts": Kind("ts", options=B_FRAMES),
    "mpeg-2 in ts": Kind("ts", "mpeg2video", options={"g": "12", "bf": "2"}),
    "flash": Kind("flv", options=B_FRAMES),
    "fragments": Kind("mp4", options=B_FRAMES, container={"movflags": "frag_keyframe+empty_moov"}),
    "interlaced": Kind("mp4", options=B_FRAMES | {"flags": "+ildct+ilme"}),
    "intra refresh": Kind("mp4", options={"x264-params": "intra-refresh=1:keyint=12:bframes=0"}),
    "bare h264": Kind("h264", options=B_FRAMES),
    "mkv at 480 1/s": Kind("mkv", options=B_FRAMES, base=Fraction(1, 480), rate=480),
    "prores": Kind("mov", "prores_ks", "yuv422p10le"),
    "odd size, h264": Kind("mp4", pixels="yuv444p", size=(241, 321)),
    "odd size, mjpeg": Kind("avi", "mjpeg", "yuvj420p", JPEG, size=(241, 321)),
    "odd size, vp9": Kind("webm", "libvpx-vp9", options=VPX, size=(241, 321)),
    "odd size, ffv1": Kind("mkv", "ffv1", size=(241, 321)),
    "odd size, rgb": Kind("avi", "huffyuv", "rgb24", size=(97, 161)),
    "grey ffv1": Kind("mkv", "ffv1", "gray"),
    "grey 10 bit": Kind("mkv", "ffv1", "gray10le"),
    "grey 16 bit": Kind("mkv", "ffv1", "gray16le"),
    "grey h264": Kind("mp4", pixels="gray"),
    "grey, not compressed": Kind("avi", "rawvideo", "gray"),
    "huffyuv": Kind("avi", "huffyuv", "yuv422p"),
    "packed": Kind("avi", "rawvideo", "uyvy422"),
    "planes of rgb": Kind("avi", "utvideo", "gbrp"),
    "full range": Kind("mp4", pixels="yuvj420p", options=B_FRAMES),
    "gif": Kind("gif", "gif", "gray", stamps=range(0, 4 * COUNT, 4), base=Fraction(1, 100)),
    "gif of variable rate": Kind("gif", "gif", "rgb8", stamps=[10 * n for n in UNEVEN], base=Fraction(1, 100)),
}
TRIMMED = {
    "trimmed": Kind("mp4", options=B_FRAMES),
    "trimmed, open gop": Kind("mp4", options=OPEN_GOP),
    "trimmed, hevc": Kind("mov", "libx265", options=HEVC),
    "trimmed, variable rate": Kind("mp4", options=B_FRAMES, stamps=UNEVEN, base=Fraction(1, 480)),
}
UNTIMED = {"b-frames avi", "open gop avi", "bare h264"}  # their stamps are guesses of the demuxer
SAMPLES = st.lists(st.tuples(st.integers(0, 400), st.integers(0, 12), st.integers(1, 3)), min_size=6, max_size=6)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    made: dict[str, Path] = {}
    for name, kind in (KINDS | TRIMMED).items():
        folder = tmp_path_factory.mktemp("odd")
        path = record(folder, kind)
        made[name] = trimmed(path, 17 * float(kind.base)) if name in TRIMMED else path
    return made


@cache
def sequential(path: Path) -> list[tuple[float | None, np.ndarray]]:
    """Time and grey picture (as floats, not rounded) of every picture, decoded in one go."""
    with av.open(str(path)) as container:
        return [(frame.time, grey_of(frame)) for frame in container.decode(video=0)]


def grey_of(frame: av.VideoFrame) -> np.ndarray:
    first, plane = frame.format.components[0], frame.planes[0]
    if not first.is_luma:
        return frame.to_ndarray(format="rgb24").astype(float) @ (0.299, 0.587, 0.114)
    if frame.format.name == "uyvy422":
        return np.frombuffer(plane, np.uint8).reshape(plane.height, -1)[:, 1 : 2 * frame.width : 2].astype(float)
    words = np.frombuffer(plane, np.uint8 if first.bits == 8 else "<u2").reshape(plane.height, -1)
    return words[:, : frame.width] / 2.0 ** (first.bits - 8)


# ---------------------------------------------------------------- each kind, picture by picture


@pytest.mark.parametrize("name", [*KINDS, *TRIMMED])
@settings(max_examples=3, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(requests=SAMPLES)
def test_any_picture_asked_for_is_the_one_that_a_plain_decoding_shows(
    files: dict[str, Path], name: str, requests: list[tuple[int, int, int]]
) -> None:
    path, whole = files[name], sequential(files[name])
    info = probe(path)
    assert info.frame_count == len(whole)
    assert (info.height_px, info.width_px) == whole[0][1].shape
    assert not info.damage
    for place, length, step in [(0, COUNT, 1), *requests]:
        start = place % len(whole)
        end = min(start + length, len(whole) - 1)
        frames = list(read_frames(path, start, end, step))
        assert [frame.index for frame in frames] == list(range(start, end + 1, step))
        for frame in frames:
            time_s, grey = whole[frame.index]
            assert np.abs(frame.luma - np.minimum(grey, 255)).max() <= (0.5 if "rgb" not in name else 1.0)
            if name not in UNTIMED:
                assert frame.time_s == pytest.approx(time_s, abs=1e-9)


@pytest.mark.parametrize("name", list(TRIMMED))
def test_pictures_hidden_by_an_edit_list_are_not_counted_though_the_header_does(
    files: dict[str, Path], name: str
) -> None:
    with av.open(str(files[name])) as container:
        claimed = container.streams.video[0].frames
    info = probe(files[name])
    assert claimed == COUNT > info.frame_count > 0
    assert info.is_variable_rate == ("variable" in name)


@pytest.mark.parametrize("name", list(KINDS))
def test_the_rate_is_that_of_the_recording_whatever_the_container_rounds(files: dict[str, Path], name: str) -> None:
    info, kind = probe(files[name]), KINDS[name]
    assert info.is_variable_rate == ("variable" in name)
    if not info.is_variable_rate and name != "bare h264":
        step = list(kind.stamps)[1] * kind.base
        assert info.fps == float(1 / step)


@pytest.mark.parametrize("rate", [Fraction(25), Fraction(30000, 1001), Fraction(240), Fraction(480), Fraction(960)])
def test_a_milliseconds_clock_tells_the_rate_though_the_header_is_wrong(tmp_path: Path, rate: Fraction) -> None:
    info = probe(record(tmp_path, Kind("mkv", options=B_FRAMES, base=1 / rate, rate=10)))
    assert info.fps == float(rate)
    assert not info.is_variable_rate


@given(rate=st.floats(5, 900), count=st.integers(20, 400), tick=st.sampled_from([1000, 600, 12800, 90000]))
def test_any_even_rate_is_found_within_what_rounding_allows(rate: float, count: int, tick: int) -> None:
    pts = np.round(np.arange(count) * tick / rate).astype(np.int64)
    assume(np.diff(pts).min() > 0)
    found, is_variable = rate_of(pts, Fraction(1, tick), None)
    assert not is_variable
    assert float(found) == pytest.approx(rate, rel=2 * rate / tick / count)


# ---------------------------------------------------------------- turned, cut, joined


def turned(path: Path, quarters: int) -> Path:
    """Overwrite the display matrix of the track header, as phones write it, by quarter turns clockwise."""
    data, (height, width) = bytearray(path.read_bytes()), SIZE
    one = 1 << 16
    matrices = [
        (one, 0, 0, 0, one, 0, 0, 0),
        (0, one, 0, -one, 0, 0, height * one, 0),
        (-one, 0, 0, 0, -one, 0, width * one, height * one),
        (0, -one, 0, one, 0, 0, 0, width * one),
    ]
    place = data.index(b"tkhd") + 4 + 40
    words = (*matrices[quarters], 1 << 30)
    data[place : place + 36] = b"".join(word.to_bytes(4, "big", signed=True) for word in words)
    out = path.with_name(f"turned{quarters}{path.suffix}")
    out.write_bytes(data)
    return out


@pytest.mark.parametrize("quarters", [0, 1, 2, 3])
def test_a_turned_phone_gives_upright_pictures_grey_and_in_colours(
    files: dict[str, Path], tmp_path: Path, quarters: int
) -> None:
    path = turned(files["b-frames mp4"], quarters)
    plain = [frame.luma for frame in read_frames(files["b-frames mp4"])]
    info = probe(path)
    assert (info.height_px, info.width_px) == plain[0].shape[:: -1 if quarters % 2 else 1]
    for number in (0, 17, 4):
        luma = next(iter(read_frames(path, number))).luma
        np.testing.assert_array_equal(luma, np.rot90(plain[number], -quarters))
        colours = bgr_of(next(iter(read_pictures(path, number))).picture)
        shown = bgr_of(next(iter(read_pictures(files["b-frames mp4"], number))).picture)
        np.testing.assert_array_equal(colours, np.rot90(shown, -quarters))


@pytest.mark.parametrize("name", ["b-frames mp4", "b-frames mov", "open gop mp4", "hevc", "av1"])
@pytest.mark.parametrize(("first", "behind"), [(2, 20), (10, 22)])
def test_an_edit_list_may_hide_both_ends(
    files: dict[str, Path], tmp_path: Path, name: str, first: int, behind: int
) -> None:
    """As phones trim: the movie keeps all its pictures, and only the times to be shown are overwritten."""
    data = bytearray(files[name].read_bytes())
    movie, media = (int.from_bytes(data[data.index(box) + 16 :][:4], "big") for box in (b"mvhd", b"mdhd"))
    place = data.index(b"elst") + 12
    for offset, value in ((0, (behind - first) * movie // 30), (4, first * media // 30)):
        data[place + offset : place + offset + 4] = value.to_bytes(4, "big")
    path = tmp_path / f"trimmed{files[name].suffix}"
    path.write_bytes(data)
    assert_same_pictures(path)
    assert probe(path).frame_count == behind - first


@pytest.mark.parametrize("name", ["open gop mkv", "hevc, open gop"])
@pytest.mark.parametrize("ending", ["mkv", "mp4"])
def test_a_video_that_begins_inside_a_recording_begins_with_its_first_whole_picture(
    files: dict[str, Path], tmp_path: Path, name: str, ending: str
) -> None:
    """Cut at the second key picture of open groups: what is shown before it leans on what was cut off."""
    path = tmp_path / f"inside.{ending}"
    with av.open(str(files[name])) as source, av.open(str(path), "w") as target:
        copy, keys = target.add_stream_from_template(source.streams.video[0]), 0
        for packet in source.demux(source.streams.video[0]):
            keys += packet.is_keyframe
            if keys > 1 and packet.size:
                packet.stream = copy
                target.mux(packet)
    assert_same_pictures(path)


def test_a_transport_stream_that_begins_anywhere_begins_with_its_first_whole_picture(
    files: dict[str, Path], tmp_path: Path
) -> None:
    data, path = files["mpeg-ts"].read_bytes(), tmp_path / "inside.ts"
    path.write_bytes(data[188 * (len(data) // 188 // 3) :])
    assert_same_pictures(path)


def assert_same_pictures(path: Path) -> None:
    whole = sequential(path)
    assert 0 < probe(path).frame_count == len(whole) < COUNT
    for start in (0, len(whole) // 2, len(whole) - 1):
        for frame in read_frames(path, start):
            np.testing.assert_array_equal(frame.luma, whole[frame.index][1])


def test_pictures_that_change_their_size_are_refused_with_the_last_one_that_can_be_used(tmp_path: Path) -> None:
    path = tmp_path / "two.h264"
    kinds = [Kind("h264", options=B_FRAMES, size=size) for size in (SIZE, (64, 96))]
    parts = [record(tmp_path, kind).read_bytes() for kind in kinds]
    path.write_bytes(b"".join(parts))
    with pytest.raises(VideoError, match=r"^two\.h264: expected pictures of one size, .* frame 30\. .* --end 29\.$"):
        list(read_frames(path))
    assert len(list(read_frames(path, 0, 29))) == COUNT


def test_joined_transport_streams_say_that_a_picture_is_missing_at_the_joint(
    files: dict[str, Path], tmp_path: Path
) -> None:
    path = tmp_path / "joined.ts"
    path.write_bytes(2 * files["mpeg-ts"].read_bytes())
    info = probe(path)
    assert info.damage == "pictures inside the file are damaged and left out"
    frames = list(read_frames(path))
    assert len(frames) == info.frame_count == 2 * COUNT - 1
    np.testing.assert_array_equal(frames[-1].luma, sequential(files["mpeg-ts"])[-1][1])


# ---------------------------------------------------------------- for the eye


@pytest.mark.parametrize("name", ["grey ffv1", "grey 10 bit", "full range", "planes of rgb", "odd size, rgb"])
def test_full_range_pictures_keep_their_brightness_for_the_eye(files: dict[str, Path], name: str) -> None:
    for (_, grey), one in zip(sequential(files[name])[:3], read_pictures(files[name], 0, 2), strict=True):
        height, width = one.picture.luma.shape
        assert (height, width) == (grey.shape[0] // 2 * 2, grey.shape[1] // 2 * 2)
        assert np.abs(one.picture.luma - np.minimum(grey, 255)[:height, :width]).max() <= 2


@pytest.mark.parametrize("name", ["b-frames mp4", "hevc 10 bit", "packed", "odd size, ffv1"])
def test_limited_range_pictures_are_spread_for_the_eye(files: dict[str, Path], name: str) -> None:
    for (_, grey), one in zip(sequential(files[name])[:3], read_pictures(files[name], 0, 2), strict=True):
        height, width = one.picture.luma.shape
        spread = np.clip((grey[:height, :width] - 16) * 255 / 219, 0, 255)
        assert np.abs(one.picture.luma - spread).max() <= 2


# ---------------------------------------------------------------- wounds


@pytest.mark.parametrize("name", list(KINDS))
@settings(max_examples=4, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 0.999), patch=st.binary(min_size=1, max_size=60), is_cut=st.booleans())
def test_a_wounded_file_of_any_kind_is_read_or_refused_in_one_line(
    files: dict[str, Path], tmp_path: Path, name: str, share: float, patch: bytes, is_cut: bool
) -> None:
    data = bytearray(files[name].read_bytes())
    place = int(share * len(data))
    data[place : place + len(patch)] = patch
    path = tmp_path / f"wounded.{KINDS[name].ending}"
    path.write_bytes(data[:place] if is_cut else data)
    said = ""
    try:
        source = open_source(path)
        numbers = [frame.index for frame in source.frames(0, None, 1)]
        assert numbers == list(range(source.info.frame_count))
    except VmlError as error:
        said = str(error)
    assert "\n" not in said

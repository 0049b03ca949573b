"""Video out: in MP4 usually H.264, in AVI usually MJPEG, by the file's ending.

Luma is kept in full range (0 to 255) in all of them, so that a decoded plane equals the drawn one but for
compression. No title, comment, date or encoder's name goes into the file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain
from pathlib import Path
from typing import cast

import av
import numpy as np
from av.container import OutputContainer
from av.video.stream import VideoStream

from vml_course.errors import FileFormatError, InputError, UnknownNameError, VideoError
from vml_course.io.files import check_folder, replacing
from vml_course.model.frame import Picture

FULL_RANGE, BT601 = 2, 6
# x264 divides its work by the number of threads; a fixed number gives the same bytes on every machine.
THREADS = 4


@dataclass(frozen=True)
class _Kind:
    codec: str
    pixels: str
    container: dict[str, str]
    stream: dict[str, str] = field(default_factory=dict)


def _kinds(crf: int) -> dict[str, dict[str, _Kind]]:
    """Return what can be written, by ending and codec; the usual codec of an ending comes first."""
    mp4, avi = {"fflags": "+bitexact", "movflags": "+faststart"}, {"fflags": "+bitexact"}
    exact = {"flags": "+bitexact"}
    # superfast: no macroblock tree, which would starve the many short pictures of a 480 1/s clip of bits.
    h264 = {"crf": str(crf), "preset": "superfast", **exact}
    # One frame at a time and no calling card: the same bytes on every machine, and nothing about the encoder.
    quiet = "log-level=error:info=0:frame-threads=1"
    hevc = {"crf": str(crf), "preset": "superfast", "x265-params": quiet, "tag": "hvc1", **exact}
    vp9 = {"crf": str(crf), "b": "0", "deadline": "good", "cpu-used": "5", "lag-in-frames": "0", **exact}
    # Quantiser 2 is about JPEG quality 95; beyond the usual factor of 18 each step coarsens by one.
    steps = str(min(31, max(2, crf - 16)))
    mjpeg = {"flags": "+qscale+bitexact", "qmin": steps, "qmax": steps}
    return {
        ".mp4": {
            "h264": _Kind("libx264", "yuv420p", mp4, h264),
            "hevc": _Kind("libx265", "yuv420p", mp4, hevc),
            "vp9": _Kind("libvpx-vp9", "yuv420p", mp4, vp9),
        },
        ".avi": {
            "mjpeg": _Kind("mjpeg", "yuvj420p", avi, mjpeg),
            "ffv1": _Kind("ffv1", "yuv420p", avi, {"level": "3", **exact}),
        },
    }


def _kind(path: Path, crf: int, codec: str = "") -> _Kind:
    kinds = _kinds(crf).get(path.suffix.lower())
    if kinds is None:
        raise FileFormatError(path.name, "a name ending in .mp4 (H.264) or .avi (MJPEG)", repr(path.suffix))
    if codec and codec not in kinds:
        raise UnknownNameError(f"{path.name}: codec", codec, kinds)
    return kinds[codec or next(iter(kinds))]


def write_video(path: Path, pictures: Iterable[Picture], fps: float | Fraction, crf: int = 18, codec: str = "") -> int:
    """Write pictures as a video of constant rate and return how many.

    Parameters
    ----------
    path : Path
        Ends in `.mp4` (H.264) or `.avi` (MJPEG). Nothing is left behind when writing fails.
    pictures : iterable of Picture
        All of one size, even in width and height.
    fps : float or Fraction
        Pictures per second; kept exactly (29.97002997 is 30000/1001).
    crf : int
        Constant rate factor: 18 looks lossless; in H.264 0 is. FFV1 always is.
    codec : str
        h264, hevc or vp9 in `.mp4`, mjpeg or ffv1 in `.avi`; the first unless told.

    Raises
    ------
    FileFormatError
        When the ending names no format.
    UnknownNameError
        When the codec is none of the format's.
    InputError
        When the rate or a picture's size is not possible.
    VideoError
        When there is no picture to write.
    """
    path = Path(path)
    kind, rate = _kind(path, crf, codec), exact_rate(fps)
    source = iter(pictures)
    first = next(source, None)
    if first is None:
        raise VideoError(path.name, "at least one picture", "none")
    _check_size(path, first.luma.shape)
    with replacing(path) as temporary, av.open(str(temporary), "w", options=kind.container) as container:
        stream = _add_stream(container, kind, rate, first.luma.shape)
        return _encode(container, stream, _checked(path, chain([first], source)), kind)


def check_video_name(path: Path) -> None:
    """Refuse a name that no video can be written to, before anything is measured.

    Raises
    ------
    FileFormatError, FileMissingError
    """
    _kind(path, 0)
    check_folder(path)


def exact_rate(fps: float | Fraction) -> Fraction:
    """Return a rate as the fraction that was meant.

    >>> exact_rate(29.97002997), exact_rate(240), exact_rate(26.777)
    (Fraction(30000, 1001), Fraction(240, 1), Fraction(26777, 1000))

    Raises
    ------
    InputError
    """
    if not (np.isfinite(float(fps)) and 0 < fps <= 100_000):
        raise InputError("fps", "a rate above 0 and up to 100000 1/s", f"{float(fps):g}")
    return Fraction(fps).limit_denominator(1001)


def _check_size(path: Path, shape: tuple[int, ...]) -> None:
    if shape[0] % 2 or shape[1] % 2 or not shape[0] or not shape[1]:
        raise InputError(path.name, "pictures of even width and height", f"{shape[1]}×{shape[0]}")


def _checked(path: Path, pictures: Iterable[Picture]) -> Iterator[Picture]:
    size: tuple[int, ...] | None = None
    for picture in pictures:
        size = size or picture.luma.shape
        if picture.luma.shape != size:
            expected, got = (f"{shape[1]}×{shape[0]}" for shape in (size, picture.luma.shape))
            raise InputError(path.name, f"pictures of one size ({expected})", got)
        yield picture


def _add_stream(container: OutputContainer, kind: _Kind, rate: Fraction, shape: tuple[int, ...]) -> VideoStream:
    stream = cast("VideoStream", container.add_stream(kind.codec, rate=rate, options=kind.stream))
    stream.height, stream.width = shape
    stream.pix_fmt = kind.pixels
    context = stream.codec_context
    context.time_base = 1 / rate
    context.color_range, context.colorspace = FULL_RANGE, BT601
    context.thread_count = THREADS
    return stream


def _encode(container: OutputContainer, stream: VideoStream, pictures: Iterable[Picture], kind: _Kind) -> int:
    count = 0
    for count, picture in enumerate(pictures, start=1):
        frame = _frame(picture, kind.pixels)
        frame.pts, frame.time_base = count - 1, stream.codec_context.time_base
        container.mux(stream.encode(frame))
    container.mux(stream.encode(None))
    return count


def _frame(picture: Picture, pixels: str) -> av.VideoFrame:
    height, width = picture.luma.shape
    frame = av.VideoFrame(width, height, pixels)
    for plane, samples in zip(frame.planes, (picture.luma, picture.blue, picture.red), strict=True):
        lines = np.frombuffer(memoryview(plane), dtype=np.uint8).reshape(-1, plane.line_size)  # wider than the picture
        lines[: samples.shape[0], : samples.shape[1]] = samples
    frame.color_range, frame.colorspace = FULL_RANGE, BT601
    return frame

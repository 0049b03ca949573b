"""A clip that lies in a folder as single pictures: files in natural order, numbered from 0, without a clock."""

from __future__ import annotations

import re
import struct
from collections import Counter
from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import cast

import av
import numpy as np
from av.video.codeccontext import VideoCodecContext

from vml_course.errors import FileMissingError, VideoError
from vml_course.io.container import PICTURE_KINDS
from vml_course.io.index import PictureIndex, index_video
from vml_course.io.planes import upright_shape
from vml_course.model.frame import VideoInfo

UNKNOWN_RATE = Fraction(0)
MAGIC = {b"\x89PNG": "png", b"\xff\xd8": "mjpeg", b"BM": "bmp", b"II*\0": "tiff", b"MM\0*": "tiff"}
COUNTER = re.compile(r"%0?[0-9]*d")  # as in img_%04d.png


def index_clip(path: Path) -> PictureIndex:
    """List the pictures of a video file, of a folder of pictures, or of a pattern such as `run3/img_*.png`.

    Raises
    ------
    FileMissingError, VideoError
    """
    is_pattern = not path.exists() and bool(re.search(r"[*?]|%[0-9]*d", path.name))
    return index_sequence(path) if is_pattern or path.is_dir() else index_video(path)


def index_sequence(path: Path) -> PictureIndex:
    """List pictures that are files of their own; their stamps are their numbers, their rate is unknown (0).

    Raises
    ------
    FileMissingError
        When there are none.
    VideoError
        When they are of several kinds, or the first cannot be decoded.
    """
    path = path if path.name else path.resolve()
    files = _one_kind(path, _candidates(path))
    height, width = upright_shape(_decode(files[0]))
    numbers = np.arange(len(files), dtype=np.int64)
    kind = PICTURE_KINDS[files[0].suffix.lower()]
    info = VideoInfo(
        width, height, len(files), 0.0, is_variable_rate=False, codec=kind, container="pictures", damage=_gap(files)
    )
    return PictureIndex(path, numbers, numbers, Fraction(1), may_seek=True, rate=UNKNOWN_RATE, info=info, files=files)


def pictures_from(index: PictureIndex, start: int) -> Iterator[tuple[int, av.VideoFrame]]:
    """Decode the files from number `start` on.

    Raises
    ------
    VideoError
        At a file that is damaged or of another size than the first; it names the file.
    """
    size = f"{index.info.width_px}×{index.info.height_px} px"
    for number, file in enumerate(index.files[start:], start=start):
        frame = _decode(file)
        height, width = upright_shape(frame)
        if f"{width}×{height} px" != size:
            raise VideoError(file.name, f"a picture of {size}, as {index.files[0].name}", f"{width}×{height} px")
        yield number, frame


def natural(file: Path) -> tuple[list[str | int], str]:
    """Return the key that sorts names as people do: numbers by their value.

    >>> [file.name for file in sorted([Path("a10.png"), Path("a9.png"), Path("A1.png")], key=natural)]
    ['A1.png', 'a9.png', 'a10.png']
    """
    pieces = re.split("([0-9]+)", file.name.casefold())
    return [int(piece) if place % 2 else piece for place, piece in enumerate(pieces)], file.name


def _candidates(path: Path) -> Iterable[Path]:
    """Yield the files of a folder or pattern; `%04d` stands for digits, `*` and `?` for what a shell takes them for."""
    if path.is_dir():
        return path.iterdir()
    if not COUNTER.search(path.name):
        return path.parent.glob(path.name)
    head, tail = (re.escape(part) for part in COUNTER.split(path.name, maxsplit=1))
    wanted = re.compile(f"{head}[0-9]+{tail}")
    return (file for file in path.parent.glob("*") if wanted.fullmatch(file.name))


def _one_kind(path: Path, candidates: Iterable[Path]) -> tuple[Path, ...]:
    files = [file for file in candidates if file.suffix.lower() in PICTURE_KINDS and not file.name.startswith(".")]
    if not files:
        kinds = ", ".join(PICTURE_KINDS)
        raise FileMissingError(str(path), f"pictures ({kinds})", "a folder without any" if path.is_dir() else "none")
    kinds_found = Counter(PICTURE_KINDS[file.suffix.lower()] for file in files)
    if len(kinds_found) > 1:
        got = " and ".join(f"{count} {kind}" for kind, count in kinds_found.items())
        raise VideoError(path.name, "pictures of one kind", got, f"Name one kind: {path.name}/*{files[0].suffix}")
    return tuple(sorted(files, key=natural))


def _gap(files: tuple[Path, ...]) -> str:
    """Say where the numbers in the names jump: a picture that is missing makes all later times wrong."""
    numbers = [re.findall("[0-9]+", file.stem)[-1:] for file in files]
    counted = [int(found[0]) for found in numbers if found]
    steps = [later - earlier for earlier, later in pairwise(counted)]
    if len(counted) < len(files) or len(set(steps)) < 2:
        return ""
    usual = Counter(steps).most_common(1)[0][0]
    place = next(place for place, step in enumerate(steps) if step != usual)
    return f"numbers jump from {files[place].name} to {files[place + 1].name}, pictures may be missing"


def _decode(file: Path) -> av.VideoFrame:
    """Decode one file with a decoder of its own, which costs 0.02 ms: none may remember the picture before."""
    data = file.read_bytes()
    if _is_stack(data):
        raise VideoError(file.name, "one picture in each file", "a stack of several", "Write them as single files.")
    try:
        frames = _decoder(data).decode(av.Packet(data))
    except (av.FFmpegError, ValueError) as error:
        raise _damaged(file) from error
    if not frames:
        raise _damaged(file)
    return frames[0]


def _decoder(data: bytes) -> VideoCodecContext:
    """Return a decoder by the first bytes: names lie."""
    codec = next((codec for magic, codec in MAGIC.items() if data.startswith(magic)), None)
    if codec is None:
        raise ValueError(data[:4])
    decoder = cast("VideoCodecContext", av.CodecContext.create(codec, "r"))
    decoder.thread_count = 1  # the picture is handed out at once
    if codec == "mjpeg":
        decoder.options = {"err_detect": "explode"}  # else half a picture is filled up with grey
    return decoder


def _is_stack(data: bytes) -> bool:
    """Whether a TIFF has a second page, which no decoder would show: its first directory points to another."""
    if MAGIC.get(data[:4]) != "tiff":
        return False
    order = "<" if data.startswith(b"II") else ">"
    try:
        (place,) = struct.unpack_from(f"{order}I", data, 4)
        (entries,) = struct.unpack_from(f"{order}H", data, place)
        (following,) = struct.unpack_from(f"{order}I", data, place + 2 + 12 * entries)
    except struct.error:
        return False  # cut off: the decoder says so
    return bool(following)


def _damaged(file: Path) -> VideoError:
    return VideoError(file.name, "a picture that can be decoded", "something else or a damaged file")

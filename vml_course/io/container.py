"""A video file opened, its errors in plain words."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import av
from av.container import InputContainer
from av.video.stream import VideoStream

from vml_course.errors import VideoError
from vml_course.io.files import existing

# Containers we promise to read; play lists and scripts, which open further files, are not among them.
FORMATS = "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpegts,mpeg,asf,flv,ogg,gif,mxf,dv,nut,mjpeg,h264,hevc"
# Kinds of single pictures that we read as a clip, by the ending of their names.
PICTURE_KINDS = {
    ".png": "png", ".jpg": "jpeg", ".jpeg": "jpeg", ".bmp": "bmp", ".tif": "tiff", ".tiff": "tiff",
}  # fmt: skip
UNKNOWN_CODEC = ("a codec that cannot be decoded", "Convert it to H.264.")
EXPECTED = "a video that can be decoded"


@contextmanager
def open_video(path: Path) -> Iterator[tuple[InputContainer, VideoStream]]:
    """Open the first video stream of a file; decoder errors inside the block become `VideoError`.

    Raises
    ------
    FileMissingError
    VideoError
        When the file is empty, cut off before its index, or no video.
    """
    if existing(path).stat().st_size == 0:
        raise VideoError(path.name, EXPECTED, "an empty file (0 bytes)")
    options = {"format_whitelist": FORMATS, "protocol_whitelist": "file"}
    try:
        # Metadata is not ours to read: bytes that are no UTF-8 must not stop the pictures.
        with av.open(f"file:{path}", options=options, metadata_errors="replace") as container:
            if not container.streams.video:
                raise VideoError(path.name, EXPECTED, "a file without pictures")
            stream = container.streams.video[0]
            if stream.codec_context is None:
                raise VideoError(path.name, EXPECTED, *UNKNOWN_CODEC)
            stream.thread_type = "AUTO"
            yield container, stream
    except av.FFmpegError as error:
        raise VideoError(path.name, EXPECTED, *_explain(path, error)) from error


def pictures_of(container: InputContainer, stream: VideoStream) -> Iterator[av.VideoFrame]:
    """Decode the pictures from the present place on; packets that were cut off are left out, as in the index."""
    for packet in container.demux(stream):
        if not packet.is_corrupt:
            yield from packet.decode()


def _explain(path: Path, error: av.FFmpegError) -> tuple[str, str]:
    with path.open("rb") as file:
        is_mp4 = file.read(8)[4:] == b"ftyp"
    if is_mp4 and not _has_box(path, b"moov"):
        return "a cut-off file (its index, the moov atom, is missing)", "Copy it again from the camera."
    if isinstance(error, av.DecoderNotFoundError):
        return UNKNOWN_CODEC
    if path.suffix.lower() in PICTURE_KINDS:
        return "a single picture", "Give the folder of a series of pictures, or a pattern such as folder/*.png."
    return "something else or a damaged file", "Is it really a video?"


def _has_box(path: Path, name: bytes) -> bool:
    """Whether an MP4 file has a top-level box of that name."""
    size, place = path.stat().st_size, 0
    with path.open("rb") as file:
        while place + 8 <= size:
            file.seek(place)
            head = file.read(16)
            if head[4:8] == name:
                return True
            length = int.from_bytes(head[:4], "big")
            length = int.from_bytes(head[8:16], "big") if length == 1 else length
            place += length if length >= 8 else size
    return False

"""The picture of the impact: the last frame before it, cut out around the bodies, small enough to be part of a page."""

from __future__ import annotations

import base64
import json
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from assignments.course import HANDOUTS
from assignments.model import AnswerKey
from assignments.names import names_in
from vml_course.errors import FileMissingError, VmlError
from vml_course.io.shelf import FolderShelf, Shelf
from vml_course.io.video import bgr_of, read_pictures

KEPT = "frames"  # folder on the shelf
MOST_BYTES = 15_000  # of the data address
WIDTH, HEIGHT = 440, 330  # px of the cut-out
_QUALITIES = (80, 65, 50, 35, 20)


@dataclass(frozen=True)
class ImpactFrame:
    """A cut-out of one frame.

    Attributes
    ----------
    index : int
        Number of the frame in the video.
    left, top, width, height : int
        The cut-out in pixels of the video.
    address : str
        The picture as a data address (JPEG).
    """

    index: int
    left: int
    top: int
    width: int
    height: int
    address: str


def impact_frame(shelf: Shelf, key: AnswerKey) -> ImpactFrame | None:
    """Return the frame at the impact from the video that was handed out; None where there is no such video.

    Decoding takes a tenth of a second or more, so the cut-out is kept, and found again by every later page.

    Parameters
    ----------
    shelf : Shelf
        The course's.
    key : AnswerKey
        Of the very variant that was handed out.
    """
    index, name = _frame_before(key), f"{KEPT}/{key.assignment_id}/{key.student}.json"
    if index is None:
        return None
    try:
        frame = _kept(shelf, name, key)
        if frame is None:
            frame = _made(shelf, key, index)
            if frame is not None:
                content = {"video_sha256": key.video_sha256, **asdict(frame)}
                shelf.write(name, json.dumps(content).encode())
    except VmlError:
        return None
    return frame


def _kept(shelf: Shelf, name: str, key: AnswerKey) -> ImpactFrame | None:
    """Return the cut-out that was kept of this very video."""
    try:
        content = json.loads(shelf.read(name))
        return ImpactFrame(**content) if content.pop("video_sha256") == key.video_sha256 else None
    except (FileMissingError, ValueError, TypeError, KeyError, AttributeError):
        return None


def _made(shelf: Shelf, key: AnswerKey, index: int) -> ImpactFrame | None:
    picture = _picture(shelf, key, index)
    return None if picture is None else cut_out(picture, _middle_px(key, index), index)


def cut_out(picture: NDArray[np.uint8], middle_px: tuple[float, float], index: int) -> ImpactFrame | None:
    """Cut a picture around a place; None where it cannot be made small enough.

    Parameters
    ----------
    picture : uint8 array, shape (h, w, 3)
        Blue, green, red.
    middle_px : (float, float)
    index : int
    """
    high, wide = picture.shape[:2]
    width, height = min(WIDTH, wide), min(HEIGHT, high)
    left = _start(middle_px[0], width, wide)
    top = _start(middle_px[1], height, high)
    part = np.ascontiguousarray(picture[top : top + height, left : left + width])
    for quality in _QUALITIES:
        address = _address(part, quality)
        if len(address) <= MOST_BYTES:
            return ImpactFrame(index, left, top, width, height, address)
    return None


def _start(middle: float, size: int, whole: int) -> int:
    return int(min(max(round(middle - size / 2), 0), whole - size))


def _address(part: NDArray[np.uint8], quality: int) -> str:
    data = cv2.imencode(".jpg", part, [cv2.IMWRITE_JPEG_QUALITY, quality, cv2.IMWRITE_JPEG_OPTIMIZE, 1])[1]
    return f"data:image/jpeg;base64,{base64.b64encode(data.tobytes()).decode('ascii')}"


def _frame_before(key: AnswerKey) -> int | None:
    """Return the last frame before the impact, None where the key has no impact in the video."""
    number = key.truth.get("frame_before", float("nan"))
    return int(number) if 0 <= number < len(key.frame) else None


def _middle_px(key: AnswerKey, index: int) -> tuple[float, float]:
    """Return the place between the bodies, nearer to the one that is struck."""
    names = names_in(key.scene)
    wanted = [names[word] for word in ("struck", "struck", "striker")]
    at = [key.xy_px[index, key.points.index(name)] for name in wanted if name in key.points]
    seen = np.array([xy for xy in at if np.isfinite(xy).all()]).reshape(-1, 2)
    x, y = seen.mean(axis=0) if len(seen) else np.nanmean(key.xy_px[index], axis=0)
    return float(x), float(y)


def _picture(shelf: Shelf, key: AnswerKey, index: int) -> NDArray[np.uint8] | None:
    folder = f"{HANDOUTS}/{key.assignment_id}/{key.student}"
    name = next((name for name in sorted(shelf.names(folder)) if name.startswith("video.")), "")
    if not name:
        return None
    if isinstance(shelf, FolderShelf):
        return _decoded(Path(shelf.place(f"{folder}/{name}")), index)
    with tempfile.TemporaryDirectory() as temporary:
        copy = Path(temporary) / name
        copy.write_bytes(shelf.read(f"{folder}/{name}"))
        return _decoded(copy, index)


def _decoded(path: Path, index: int) -> NDArray[np.uint8]:
    return bgr_of(next(iter(read_pictures(path, index, index))).picture)

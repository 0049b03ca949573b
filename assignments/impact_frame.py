"""The picture of the impact: the last frame before it, cut out around the bodies, small enough to be part of a page.

It is cut when a video is handed out, where the video is decoded anyway, and kept on the shelf beside the handouts,
under the hash of the very video: pages then decode nothing.
"""

from __future__ import annotations

import base64
import json
from dataclasses import asdict, dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from assignments.model import AnswerKey
from assignments.names import names_in
from vml_course.errors import FileMissingError
from vml_course.io.shelf import Shelf

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


def index_of(key: AnswerKey) -> int | None:
    """Return the last frame before the impact, None where the key has no impact in the video."""
    number = key.truth.get("frame_before", float("nan"))
    return int(number) if 0 <= number < len(key.frame) else None


def cut_for(key: AnswerKey, picture: NDArray[np.uint8], index: int) -> ImpactFrame | None:
    """Cut a frame of a variant's video between the bodies; None where it cannot be made small enough."""
    return cut_out(picture, _middle_px(key, index), index)


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


def keep_frame(shelf: Shelf, key: AnswerKey, frame: ImpactFrame) -> None:
    """Keep a cut-out, bound to the video that it was cut from."""
    shelf.write(_name(key), json.dumps({"video_sha256": key.video_sha256, **asdict(frame)}).encode())


def kept_frame(shelf: Shelf, key: AnswerKey) -> ImpactFrame | None:
    """Return the cut-out that was kept of this very video, None where there is none or it is damaged."""
    try:
        content = json.loads(shelf.read(_name(key)))
        return ImpactFrame(**content) if content.pop("video_sha256") == key.video_sha256 else None
    except (FileMissingError, ValueError, TypeError, KeyError, AttributeError):
        return None


def _name(key: AnswerKey) -> str:
    return f"{KEPT}/{key.assignment_id}/{key.student}.json"


def _start(middle: float, size: int, whole: int) -> int:
    return int(min(max(round(middle - size / 2), 0), whole - size))


def _address(part: NDArray[np.uint8], quality: int) -> str:
    data = cv2.imencode(".jpg", part, [cv2.IMWRITE_JPEG_QUALITY, quality, cv2.IMWRITE_JPEG_OPTIMIZE, 1])[1]
    return f"data:image/jpeg;base64,{base64.b64encode(data.tobytes()).decode('ascii')}"


def _middle_px(key: AnswerKey, index: int) -> tuple[float, float]:
    """Return the place between the bodies, nearer to the one that is struck."""
    names = names_in(key.scene)
    wanted = [names[word] for word in ("struck", "struck", "striker")]
    at = [key.xy_px[index, key.points.index(name)] for name in wanted if name in key.points]
    seen = np.array([xy for xy in at if np.isfinite(xy).all()]).reshape(-1, 2)
    x, y = seen.mean(axis=0) if len(seen) else np.nanmean(key.xy_px[index], axis=0)
    return float(x), float(y)

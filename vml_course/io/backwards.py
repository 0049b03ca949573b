"""Pictures in reverse: decoders only run forwards, so pieces are decoded and handed out from their ends.

A piece holds no more pictures than fit into a fixed room, so memory does not grow with the clip. Where it can it
starts at a key picture: then nothing is decoded twice.
"""

from __future__ import annotations

from collections.abc import Iterator

from vml_course.io.index import PictureIndex
from vml_course.io.video import frames_of
from vml_course.model.frame import Frame

ROOM_BYTES = 96_000_000  # of luma planes: about 100 pictures of 720p
LONGEST_PIECE = 256  # pictures


def frames_backwards(
    index: PictureIndex, start: int, end: int | None, step: int, room_bytes: int = ROOM_BYTES
) -> Iterator[Frame]:
    """Decode the luma of the pictures that `frames_of` would, the last one first.

    Raises
    ------
    FrameRangeError
        At once, when the range does not lie inside the video.
    VideoError
        On the way, at a damaged picture.
    """
    last = len(index.pts) - 1 if end is None else end
    frames_of(index, start, last, step)  # the range is checked there
    return _backwards(index, range(start, last + 1, step), room_bytes)


def pieces(wanted: range, keys: list[int], longest: int) -> Iterator[range]:
    """Cut the numbers of wanted pictures into pieces, the last one first, in key pictures where there are any.

    >>> list(pieces(range(0, 10), [0, 4, 8], 5))
    [range(8, 10), range(4, 8), range(0, 4)]
    >>> list(pieces(range(0, 10, 3), [0], 2))
    [range(6, 12, 3), range(0, 6, 3)]
    """
    end = len(wanted)
    while end:
        start = max(end - longest, 0)
        if start:
            inside = [key for key in keys if wanted[start] <= key <= wanted[end - 1]]
            if inside:
                start = -(-(inside[0] - wanted.start) // wanted.step)  # the first wanted one at or after the key
        yield wanted[start:end]
        end = start


def _backwards(index: PictureIndex, wanted: range, room_bytes: int) -> Iterator[Frame]:
    size = index.info.width_px * index.info.height_px
    longest = max(1, min(room_bytes // size, LONGEST_PIECE))
    for piece in pieces(wanted, index.keys.tolist() if index.may_seek else [], longest):
        held = list(frames_of(index, piece[0], piece[-1], piece.step))
        while held:
            yield held.pop()

"""The picture of the impact for a student's page: the one that was kept at hand-out, else out of the video."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assignments.course import HANDOUTS
from assignments.impact_frame import ImpactFrame, cut_for, index_of, keep_frame, kept_frame
from assignments.model import AnswerKey
from vml_course.errors import VmlError
from vml_course.io.shelf import FolderShelf, Shelf
from vml_course.io.video import bgr_of, read_pictures

__all__ = ["ImpactFrame", "impact_frame"]


def impact_frame(shelf: Shelf, key: AnswerKey) -> ImpactFrame | None:
    """Return the frame at the impact of the video that was handed out; None where there is none.

    Courses that were handed out before frames were kept have their videos: decoding one costs more than all the rest
    of a page, so that the cut-out is kept, and found again by every later page.

    Parameters
    ----------
    shelf : Shelf
        The course's.
    key : AnswerKey
        Of the very variant that was handed out.
    """
    index = index_of(key)
    if index is None:
        return None
    try:
        frame = kept_frame(shelf, key)
        if frame is None:
            picture = _picture(shelf, key, index)
            frame = None if picture is None else cut_for(key, picture, index)
            if frame is not None:
                keep_frame(shelf, key, frame)
    except VmlError:
        return None
    return frame


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

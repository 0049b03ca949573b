"""Write a tracked clip: tables, and the video with everything drawn over it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from vml_course.io.encode import check_video_name
from vml_course.io.files import check_not_source
from vml_course.io.overlay import write_overlay
from vml_course.io.tables import check_table_name, write_track
from vml_course.model.tracked import Tracked

Progress = Callable[[int, int], None]


def check_outputs(tables: Sequence[Path], overlay: Path | None = None, video: Path | None = None) -> None:
    """Refuse names that nothing can be written to, before anything is measured.

    Raises
    ------
    FileFormatError
        When an ending names no format, a name is that of the video or given twice, or cannot be written.
    FileMissingError
        When a folder does not exist.
    """
    taken = [] if video is None else [video]
    for path in (*tables, *([overlay] if overlay is not None else [])):
        check_video_name(path) if path is overlay else check_table_name(path)
        check_not_source(path, taken)
        taken.append(path)


def export_track(
    tracked: Tracked, tables: Sequence[Path], overlay: Path | None = None, progress: Progress | None = None
) -> tuple[Path, ...]:
    """Write tables (.xlsx, .csv, .mat) and an overlay video (.avi, .mp4); return what was written.

    Each file takes its place only when it is whole.

    Raises
    ------
    FileFormatError, FileMissingError
        Before anything is written.
    VideoError
        When the video cannot be read again for the overlay.
    """
    check_outputs(tables, overlay, tracked.path)
    for path in tables:
        write_track(path, tracked)
    if overlay is None:
        return tuple(tables)
    write_overlay(overlay, tracked, progress=progress)
    return (*tables, overlay)

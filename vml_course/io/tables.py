"""Tables out and in, by the file's ending."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from vml_course.errors import FileFormatError
from vml_course.io.csv_file import write_csv
from vml_course.io.files import check_folder, existing
from vml_course.io.mat import write_mat
from vml_course.io.read_motion import motion_from_mat, motion_from_table
from vml_course.io.xlsx import write_xlsx
from vml_course.model.motion import Motion
from vml_course.model.tracked import Tracked

WRITERS: Mapping[str, Callable[[Path, Tracked], None]] = {".xlsx": write_xlsx, ".csv": write_csv, ".mat": write_mat}
READERS: Mapping[str, Callable[[Path], Motion]] = {
    ".xlsx": motion_from_table,
    ".csv": motion_from_table,
    ".txt": motion_from_table,
    ".tsv": motion_from_table,
    ".mat": motion_from_mat,
}


def check_table_name(path: Path) -> None:
    """Refuse a name that no table can be written to, before anything is measured.

    Raises
    ------
    FileFormatError, FileMissingError
    """
    if path.suffix.lower() not in WRITERS:
        raise FileFormatError(path.name, f"a name ending in {', '.join(WRITERS)}", repr(path.suffix))
    check_folder(path)


def write_track(path: Path, tracked: Tracked) -> None:
    """Write a tracked clip as XLSX, CSV or MAT.

    Raises
    ------
    FileFormatError
        When the ending names no table that we write.
    """
    check_table_name(path)
    WRITERS[path.suffix.lower()](path, tracked)


def read_motion(path: Path) -> Motion:
    """Read points in metres from XLSX, CSV, MAT or Tracker's text; an empty cell is NaN.

    Raises
    ------
    FileMissingError
    FileFormatError
        When the ending names no table that we read.
    MissingScaleError
        When the table has pixels only.
    TableError
        When a column is missing or a cell holds text; it names column and row.
    """
    path = Path(path)
    if path.suffix.lower() not in READERS and not path.is_dir():
        raise FileFormatError(path.name, f"a name ending in {', '.join(READERS)}", repr(path.suffix))
    return READERS[existing(path).suffix.lower()](path)

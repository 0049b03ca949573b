"""What learning platforms get: the same bytes for the same files, pseudonyms as names."""

from __future__ import annotations

import zipfile
from pathlib import Path

from assignments.bundle import write_bundle, zip_bytes
from assignments.tray import Tray
from vml_course.io.shelf import FolderShelf

FILES = {"handout.html": b"<p>", "video.mp4": b"pictures", "workbook.xlsx": b"cells"}


def _tray(folder: Path, *students: str) -> Tray:
    tray = Tray(FolderShelf(folder), "h")
    for student in students:
        tray.put(student, {name: data + student.encode() for name, data in FILES.items()})
    return tray


def test_a_student_has_the_same_files_as_a_folder_and_as_a_zip(tmp_path: Path) -> None:
    tray = _tray(tmp_path, "s1")
    assert tray.holds("s1")
    with zipfile.ZipFile(tmp_path / "h" / "zips" / "s1.zip") as archive:
        assert {n: archive.read(n) for n in archive.namelist()} == {
            p.name: p.read_bytes() for p in (tmp_path / "h" / "s1").iterdir()
        }


def test_nothing_is_compressed_so_that_bytes_do_not_depend_on_the_compressor() -> None:
    content = zip_bytes(FILES)
    assert all(data in content for data in FILES.values())


def test_the_bundle_has_a_folder_for_each_student_under_the_number_that_the_platform_knows(tmp_path: Path) -> None:
    path = _tray(tmp_path, "s1", "s2").bundle({"s1": "s1_48213_assignsubmission_file", "s2": "s2", "s3": "s3"})
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        assert {name.split("/")[0] for name in archive.namelist()} == {"s1_48213_assignsubmission_file", "s2"}
        assert archive.read("s2/video.mp4") == b"picturess2"
        participant = archive.namelist()[0].split("/")[0].split("_", 4)[1]  # as Moodle reads it
    assert participant == "48213"


def test_the_bundle_is_left_alone_until_something_changes(tmp_path: Path) -> None:
    shelf, zips = _tray(tmp_path, "s1", "s2").shelf, {"s1": "h/zips/s1.zip"}
    path = tmp_path / "b.zip"
    assert write_bundle(shelf, "b.zip", zips)
    before = path.stat().st_mtime_ns, path.read_bytes()
    assert not write_bundle(shelf, "b.zip", zips)
    assert (path.stat().st_mtime_ns, path.read_bytes()) == before
    assert write_bundle(shelf, "b.zip", {**zips, "s2": "h/zips/s2.zip"})
    shelf.write("h/zips/s1.zip", zip_bytes({**FILES, "video.mp4": b"another"}))
    assert write_bundle(shelf, "b.zip", zips)
    path.write_bytes(b"not a zip")
    assert write_bundle(shelf, "b.zip", zips)


def test_there_is_no_bundle_of_nothing(tmp_path: Path) -> None:
    assert Tray(FolderShelf(tmp_path), "h").bundle({"s1": "s1"}) == ""

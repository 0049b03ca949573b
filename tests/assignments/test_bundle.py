"""What learning platforms get: the same bytes for the same files, pseudonyms as names."""

from __future__ import annotations

import zipfile
from pathlib import Path

from assignments.bundle import write_bundle, zip_bytes
from assignments.shelf import Shelf

FILES = {"handout.html": b"<p>", "video.mp4": b"pictures", "workbook.xlsx": b"cells"}


def _shelf(folder: Path, *students: str) -> Shelf:
    shelf, work = Shelf(folder / "h"), folder / "work"
    work.mkdir()
    for student in students:
        shelf.put(student, {name: data + student.encode() for name, data in FILES.items()}, work)
    return shelf


def test_a_student_has_the_same_files_as_a_folder_and_as_a_zip(tmp_path: Path) -> None:
    shelf = _shelf(tmp_path, "s1")
    assert shelf.holds("s1")
    with zipfile.ZipFile(shelf.zip("s1")) as archive:
        assert {n: archive.read(n) for n in archive.namelist()} == {
            p.name: p.read_bytes() for p in shelf.folder("s1").iterdir()
        }


def test_nothing_is_compressed_so_that_bytes_do_not_depend_on_the_compressor() -> None:
    content = zip_bytes(FILES)
    assert all(data in content for data in FILES.values())


def test_the_bundle_has_a_folder_for_each_student_under_the_number_that_the_platform_knows(tmp_path: Path) -> None:
    shelf = _shelf(tmp_path, "s1", "s2")
    path = shelf.bundle({"s1": "s1_48213_assignsubmission_file", "s2": "s2", "s3": "s3"})
    assert path is not None
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        assert {name.split("/")[0] for name in archive.namelist()} == {"s1_48213_assignsubmission_file", "s2"}
        assert archive.read("s2/video.mp4") == b"picturess2"
        participant = archive.namelist()[0].split("/")[0].split("_", 4)[1]  # as Moodle reads it
    assert participant == "48213"


def test_the_bundle_is_left_alone_until_something_changes(tmp_path: Path) -> None:
    shelf = _shelf(tmp_path, "s1", "s2")
    zips = {"s1": shelf.zip("s1")}
    path = tmp_path / "b.zip"
    assert write_bundle(path, zips)
    before = path.stat().st_mtime_ns, path.read_bytes()
    assert not write_bundle(path, zips)
    assert (path.stat().st_mtime_ns, path.read_bytes()) == before
    assert write_bundle(path, {**zips, "s2": shelf.zip("s2")})
    shelf.zip("s1").write_bytes(zip_bytes({**FILES, "video.mp4": b"another"}))
    assert write_bundle(path, zips)
    path.write_bytes(b"not a zip")
    assert write_bundle(path, zips)


def test_there_is_no_bundle_of_nothing(tmp_path: Path) -> None:
    assert Shelf(tmp_path).bundle({"s1": "s1"}) is None

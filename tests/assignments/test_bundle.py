"""What learning platforms get: the same bytes for the same files, pseudonyms as names, in parts of a size they take."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import pytest

import assignments.handouts
from assignments.bundle import unzipped, zip_bytes
from assignments.handouts import Handouts
from vml_course.io.shelf import FolderShelf, Shelf, open_shelf

FILES = {"handout.html": b"<p>", "video.mp4": b"pictures" * 100, "workbook.xlsx": b"cells"}


@pytest.fixture(params=["folder", "memory"])
def shelf(request: pytest.FixtureRequest, tmp_path: Path) -> Shelf:
    if request.param == "folder":
        return FolderShelf(tmp_path / "course")
    return open_shelf(f"memory://{tmp_path.name}")


@pytest.fixture
def handouts(shelf: Shelf) -> Handouts:
    return Handouts(shelf, "kick")


def _put(handouts: Handouts, *students: str) -> None:
    for student in students:
        handouts.put(student, {name: data + student.encode() for name, data in FILES.items()})


def _names(*students: str) -> dict[str, str]:
    return {student: student for student in students}


def _bundled(handouts: Handouts, number: int = 0) -> dict[str, bytes]:
    return unzipped(handouts.shelf.read(handouts._part(number)))


def _folders(handouts: Handouts, number: int = 0) -> list[str]:
    return sorted({name.split("/")[0] for name in _bundled(handouts, number)})


def test_a_student_has_the_same_files_as_a_folder_and_as_a_zip(handouts: Handouts) -> None:
    _put(handouts, "s1")
    assert handouts.complete() == {"s1"}
    files = {name: handouts.shelf.read(f"handouts/kick/s1/{name}") for name in FILES}
    assert unzipped(handouts.shelf.read("handouts/kick/zips/s1.zip")) == files


def test_who_lacks_the_folder_or_the_zip_does_not_have_everything(tmp_path: Path) -> None:
    shelf = FolderShelf(tmp_path)
    (tmp_path / "handouts" / "kick" / "zips").mkdir(parents=True)
    (tmp_path / "handouts" / "kick" / "zips" / "s1.zip").touch()
    (tmp_path / "handouts" / "kick" / "s2").mkdir()
    assert Handouts(shelf, "kick").complete() == frozenset()


def test_nothing_is_compressed_so_that_bytes_do_not_depend_on_the_compressor() -> None:
    content = zip_bytes(FILES)
    assert all(data in content for data in FILES.values())
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert {member.date_time for member in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_the_bundle_has_a_folder_for_each_student_under_the_number_that_the_platform_knows(
    handouts: Handouts, tmp_path: Path
) -> None:
    _put(handouts, "s1", "s2")
    handouts.put_bundle({"s1": "s1_48213_assignsubmission_file", "s2": "s2", "s3": "s3"})
    assert _folders(handouts) == ["s1_48213_assignsubmission_file", "s2"]
    assert _bundled(handouts)["s2/workbook.xlsx"] == b"cellss2"
    assert _folders(handouts)[0].split("_", 4)[1] == "48213"  # as Moodle reads it


def test_there_is_no_bundle_of_nothing(handouts: Handouts) -> None:
    assert handouts.put_bundle(_names("s1")) == []
    assert not handouts.shelf.exists(handouts._part(0))


def test_only_the_last_part_is_written_anew_when_students_join(
    handouts: Handouts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(assignments.handouts, "PART_BYTES", 2 * 830)
    _put(handouts, "s1", "s2", "s3")
    places = handouts.put_bundle(_names("s1", "s2", "s3"))
    assert [place.rpartition("/")[2] for place in places] == ["bundle-moodle.zip", "bundle-moodle-2.zip"]
    assert (_folders(handouts, 0), _folders(handouts, 1)) == (["s1", "s2"], ["s3"])
    written = _noting_writes(handouts.shelf, monkeypatch)
    handouts.put_bundle(_names("s1", "s2", "s3"))
    assert written == []
    _put(handouts, "s4")
    written.clear()
    handouts.put_bundle(_names("s1", "s2", "s3", "s4"))
    assert written == ["handouts/kick/bundle-moodle-2.zip", "handouts/kick/bundle.json"]
    assert _folders(handouts, 1) == ["s3", "s4"]


def test_parts_of_which_a_student_is_made_anew_are_written_anew_even_after_a_kill(
    handouts: Handouts, tmp_path: Path
) -> None:
    _put(handouts, "s1", "s2")
    handouts.put_bundle(_names("s1", "s2"))
    handouts.open_bundle(["s2"])  # the run is killed after this
    handouts.put("s2", {**FILES, "video.mp4": b"another"})
    handouts.put_bundle(_names("s1", "s2"))
    assert _bundled(handouts)["s2/video.mp4"] == b"another"


def test_what_a_smaller_class_no_longer_needs_becomes_empty(
    handouts: Handouts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(assignments.handouts, "PART_BYTES", 1)
    _put(handouts, "s1", "s2")
    assert len(handouts.put_bundle(_names("s1", "s2"))) == 2
    assert len(handouts.put_bundle(_names("s1"))) == 1
    assert _bundled(handouts, 1) == {}


@pytest.mark.parametrize("content", [b"{", b"3", b"\xff"])
def test_a_spoilt_list_of_parts_tells_nothing(handouts: Handouts, tmp_path: Path, content: bytes) -> None:
    _put(handouts, "s1")
    handouts.put_bundle(_names("s1"))
    handouts.shelf.write("handouts/kick/bundle.json", content)
    handouts.put_bundle(_names("s1"))
    assert json.loads(handouts.shelf.read("handouts/kick/bundle.json")) == [[["s1", "s1"]]]


def _noting_writes(shelf: Shelf, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    written, write = [], shelf.write

    def noted(name: str, data: bytes, *, read_only: bool = False) -> None:
        written.append(name)
        write(name, data, read_only=read_only)

    monkeypatch.setattr(shelf, "write", noted)
    return written

"""A place for files: the same promises in a folder, in memory, and on an S3 server."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from vml_course.errors import FileMissingError, InputError
from vml_course.io.shelf import FolderShelf, Shelf, open_shelf


@pytest.fixture(params=["folder", "file", "memory", "s3"])
def shelf(request: pytest.FixtureRequest, tmp_path: Path) -> Shelf:
    if request.param == "s3":
        return open_shelf(f"{request.getfixturevalue('bucket')}/{tmp_path.name}")
    return open_shelf(
        {"folder": tmp_path / "s", "file": f"file://{tmp_path}/s", "memory": f"memory://{tmp_path.name}"}[request.param]
    )


def test_what_is_written_is_read(shelf: Shelf) -> None:
    shelf.write("a/b/c.bin", b"\x00\xff")
    shelf.write("a/b/c.bin", b"second")
    assert shelf.read("a/b/c.bin") == b"second"
    assert shelf.exists("a/b/c.bin")
    assert not shelf.exists("a/b")
    assert shelf.names("a/b") == {"c.bin"}
    assert shelf.names() == {"a"}


def test_what_is_not_there_is_said(shelf: Shelf) -> None:
    assert not shelf.exists("none.txt")
    assert shelf.names("nowhere") == frozenset()
    with pytest.raises(FileMissingError, match=r"none\.txt: expected a file that can be read"):
        shelf.read("none.txt")


def test_a_folder_takes_the_place_of_an_older_one(shelf: Shelf) -> None:
    shelf.put_files("handouts/x", {"old.txt": b"1", "same.txt": b"1"}, last="same.txt")
    shelf.put_files("handouts/x", {"same.txt": b"2", "new.txt": b"2"}, last="same.txt")
    assert shelf.names("handouts/x") == {"same.txt", "new.txt"}
    assert shelf.read("handouts/x/same.txt") == b"2"
    assert shelf.names("handouts") == {"x"}


def test_what_a_killed_run_left_beside_is_gone_with_the_next(tmp_path: Path) -> None:
    (tmp_path / "h" / ".x.new").mkdir(parents=True)
    (tmp_path / "h" / ".x.new" / "half.txt").write_bytes(b"1")
    open_shelf(tmp_path).put_files("h/x", {"a.txt": b"1"}, last="a.txt")
    assert open_shelf(tmp_path).names("h") == {"x"}
    assert open_shelf(tmp_path).names("h/x") == {"a.txt"}


@pytest.mark.parametrize("name", ["/etc/passwd", "../x", "a/../../x", "a//b", "a\\b", "./a"])
def test_no_name_leads_out(shelf: Shelf, name: str) -> None:
    with pytest.raises(InputError, match="a relative name inside the course"):
        shelf.write(name, b"x")


def test_a_place_is_told_as_the_user_named_it(tmp_path: Path, bucket: str) -> None:
    assert open_shelf(tmp_path).place("a/b") == str(tmp_path / "a" / "b")
    assert open_shelf(f"{bucket}/dyn").place("a") == "s3://course-bucket/dyn/a"
    assert open_shelf("memory://dyn").place("a") == "memory://dyn/a"
    assert isinstance(open_shelf("C:/course"), FolderShelf)


def test_an_unknown_kind_of_place_is_one_line() -> None:
    with pytest.raises(InputError, match=r"gopher://x: expected a folder or the URL of an object store") as caught:
        open_shelf("gopher://x")
    assert "\n" not in str(caught.value)


def test_a_bucket_that_is_not_there_is_said(bucket: str) -> None:
    assert bucket
    with pytest.raises(FileMissingError, match="expected a place to write to"):
        open_shelf("s3://no-such-bucket/x").write("a", b"x")


@pytest.mark.skipif(os.name != "posix", reason="modes of files are POSIX's")
def test_what_is_never_to_change_is_read_only_in_a_folder(tmp_path: Path) -> None:
    open_shelf(tmp_path).write("inbox/ab", b"x", read_only=True)
    assert stat.S_IMODE((tmp_path / "inbox" / "ab").stat().st_mode) == 0o444


def test_the_last_file_of_a_folder_is_sent_last(tmp_path: Path, monkeypatch) -> None:
    """A reader that waits for it finds all others."""
    shelf = open_shelf(f"memory://{tmp_path.name}")
    sent = []
    monkeypatch.setattr(shelf, "_send", lambda path, _data: sent.append(path.rpartition("/")[2]))
    shelf.put_files("x", {"a.txt": b"1", "b.txt": b"1", "c.txt": b"1"}, last="a.txt")
    assert sent == ["b.txt", "c.txt", "a.txt"]

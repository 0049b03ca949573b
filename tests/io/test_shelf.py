"""A place for files: the same promises in a folder, in memory, and on an S3 server."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from pathlib import Path

import pytest
import s3fs
from moto.server import ThreadedMotoServer

from vml_course.errors import FileMissingError, InputError
from vml_course.io.shelf import FolderShelf, Shelf, open_shelf


@pytest.fixture(scope="module")
def bucket() -> Iterator[str]:
    """Run an S3 server of its own on loopback and return the URL of a bucket."""
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    told = {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ACCESS_KEY_ID": "nobody",
        "AWS_SECRET_ACCESS_KEY": "nothing",
        "AWS_DEFAULT_REGION": "us-east-1",
    }
    before = {name: os.environ.get(name) for name in told}
    os.environ.update(told)
    s3fs.S3FileSystem.clear_instance_cache()
    s3fs.S3FileSystem().mkdir("course-bucket")
    yield "s3://course-bucket"
    s3fs.S3FileSystem.clear_instance_cache()
    server.stop()
    for name, value in before.items():
        if value is None:
            os.environ.pop(name)
        else:
            os.environ[name] = value


@pytest.fixture(params=["folder", "file", "memory", "s3"])
def shelf(request: pytest.FixtureRequest, tmp_path: Path) -> Shelf:
    if request.param == "s3":
        return open_shelf(f"{request.getfixturevalue('bucket')}/{tmp_path.name}")
    return open_shelf(
        {"folder": tmp_path / "s", "file": f"file://{tmp_path}/s", "memory": f"memory://{tmp_path.name}"}[request.param]
    )


def _made(folder: Path, **files: str) -> Path:
    folder.mkdir(parents=True)
    for name, text in files.items():
        (folder / f"{name}.txt").write_text(text, encoding="utf-8")
    return folder


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


def test_a_folder_takes_the_place_of_an_older_one(shelf: Shelf, tmp_path: Path) -> None:
    shelf.put_folder(_made(tmp_path / "one", old="1", same="1"), "handouts/x", last="same.txt")
    shelf.put_folder(_made(tmp_path / "two", same="2", new="2"), "handouts/x", last="same.txt")
    assert shelf.names("handouts/x") == {"same.txt", "new.txt"}
    assert shelf.read("handouts/x/same.txt") == b"2"
    assert shelf.names("handouts") == {"x"}


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
    shelf.put_folder(_made(tmp_path / "one", a="1", b="1", c="1"), "x", last="a.txt")
    assert sent == ["b.txt", "c.txt", "a.txt"]

"""A folder of pictures as a clip."""

from __future__ import annotations

import hashlib
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from vml_course.errors import FileMissingError, FrameRangeError, VideoError
from vml_course.io.sequence import natural
from vml_course.io.source import open_source
from vml_course.io.video import probe, read_frames, read_pictures

SIZE = (60, 80)
JPEG_LEVELS = 4


def grey(number: int, size: tuple[int, int] = SIZE) -> np.ndarray:
    coarse = np.random.default_rng(7).integers(0, 256, (size[0] // 6, size[1] // 6)).astype(np.uint8)
    return np.roll(cv2.resize(coarse, size[::-1], interpolation=cv2.INTER_CUBIC), 2 * number, 1)


def write(path: Path, picture: np.ndarray) -> Path:
    """Write a picture whatever the name says: OpenCV goes by the ending, so the bytes are made first."""
    quality = [cv2.IMWRITE_JPEG_QUALITY, 98] if path.suffix.lower() in (".jpg", ".jpeg") else []
    path.write_bytes(cv2.imencode(path.suffix.lower(), picture, quality)[1].tobytes())
    return path


def folder_of(tmp_path: Path, name: str, count: int = 12) -> Path:
    folder = tmp_path / "frames"
    folder.mkdir()
    for number in range(count):
        write(folder / name.format(number), grey(number))
    return folder


def shown(path: Path, *span: int | None) -> list[int]:
    """Return which picture of the series each picture is, by its nearest likeness."""
    series = np.array([grey(number) for number in range(12)], float)
    return [int(np.argmin(np.abs(series - frame.luma).mean(axis=(1, 2)))) for frame in read_frames(path, *span)]


@pytest.mark.parametrize("ending", ["png", "PNG", "bmp", "tif", "tiff", "jpg", "jpeg"])
def test_pictures_are_taken_in_natural_order_and_by_any_number(tmp_path: Path, ending: str) -> None:
    folder = folder_of(tmp_path, f"img{{}}.{ending}")
    info = probe(folder)
    assert (info.frame_count, info.height_px, info.width_px) == (12, *SIZE)
    assert (info.fps, info.is_variable_rate, info.damage, info.container) == (0.0, False, "", "pictures")
    assert shown(folder) == list(range(12))
    assert shown(folder, 3, 11, 4) == [3, 7, 11]
    levels = JPEG_LEVELS if ending.startswith("jp") else 0
    for frame in read_frames(folder, 5):
        assert np.abs(frame.luma.astype(int) - grey(frame.index)).max() <= levels
    for one in read_pictures(folder, 2, 4):
        assert np.abs(one.picture.luma.astype(int) - grey(one.index)).max() <= levels + 1


def test_sixteen_bits_colours_and_transparency_become_grey_of_eight_bits(tmp_path: Path) -> None:
    plane = grey(3)
    colours = np.dstack([plane, np.roll(plane, 9, 0), np.roll(plane, 5, 1)])
    kinds = {
        "deep.png": (plane.astype(np.uint16) * 257, plane),
        "deep.tif": (plane.astype(np.uint16) * 257, plane),
        "colour.png": (colours, cv2.cvtColor(colours, cv2.COLOR_BGR2GRAY)),
        "clear.png": (np.dstack([colours, plane]), cv2.cvtColor(colours, cv2.COLOR_BGR2GRAY)),
        "palette.bmp": (plane, plane),
    }
    for name, (picture, expected) in kinds.items():
        folder = tmp_path / name
        folder.mkdir()
        write(folder / name, picture)
        luma = next(iter(read_frames(folder))).luma
        assert np.abs(luma.astype(int) - expected).max() <= 1, name


def test_a_photograph_taken_upright_is_shown_upright(tmp_path: Path) -> None:
    """The orientation 6 of Exif: to be turned a quarter clockwise."""
    photo = write(tmp_path / "photo.jpg", grey(0))
    entry = b"\x12\x01\x03\x00\x01\x00\x00\x00\x06\x00\x00\x00"  # tag 0x0112, one short
    exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0" + entry + bytes(4)
    data = photo.read_bytes()
    photo.write_bytes(data[:2] + b"\xff\xe1" + (len(exif) + 2).to_bytes(2, "big") + exif + data[2:])
    assert (probe(tmp_path).width_px, probe(tmp_path).height_px) == SIZE
    luma = next(iter(read_frames(tmp_path))).luma
    assert np.abs(luma.astype(int) - np.rot90(grey(0), -1)).max() <= JPEG_LEVELS


@pytest.mark.parametrize("pattern", ["b*.png", "b_%02d.png", "b_%d.png", "b_??.png"])
def test_a_pattern_takes_its_own_pictures_only(tmp_path: Path, pattern: str) -> None:
    folder = folder_of(tmp_path, "b_{:02d}.png")
    write(folder / "a_01.png", grey(0, (20, 20)))
    write(folder / ".b_00.png", grey(0, (20, 20)))
    assert shown(folder / pattern) == list(range(12))


def test_other_files_in_the_folder_do_not_matter(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, "{:03d}.png")
    (folder / "Thumbs.db").write_bytes(b"thumbs")
    (folder / "notes.txt").write_text("frames of run 3")
    write(folder / "._000.png", grey(9))
    assert shown(folder) == list(range(12))
    whole = b"".join((folder / f"{number:03d}.png").read_bytes() for number in range(12))
    source = open_source(folder)
    assert (source.name, source.sha256, source.rate) == ("frames", hashlib.sha256(whole).hexdigest(), 0)


@given(numbers=st.lists(st.integers(0, 10**6), unique=True, min_size=1), digits=st.integers(1, 7))
def test_names_sort_by_the_values_of_their_numbers(numbers: list[int], digits: int) -> None:
    names = [Path(f"Run 2 frame{number:0{digits}d}.png") for number in numbers]
    assert sorted(names, key=natural) == [Path(f"Run 2 frame{number:0{digits}d}.png") for number in sorted(numbers)]


# ---------------------------------------------------------------- refused by name


def test_a_picture_of_another_size_is_refused_by_its_name(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, "img{}.png")
    write(folder / "img7.png", grey(7, (60, 82)))
    assert shown(folder, 0, 6) == list(range(7))
    with pytest.raises(VideoError, match=r"^img7\.png: expected a picture of 80×60 px, as img0\.png, got 82×60 px\.$"):
        list(read_frames(folder))


def test_kinds_that_are_mixed_are_refused_with_what_to_do(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, "img{}.png")
    write(folder / "cover.jpg", grey(0))
    with pytest.raises(VideoError, match=r"^frames: expected pictures of one kind, got .*12 png.* Name one kind"):
        probe(folder)
    assert shown(folder / "*.png") == list(range(12))


def test_a_number_that_is_missing_is_said(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, "img{}.png")
    (folder / "img5.png").unlink()
    assert probe(folder).damage == "numbers jump from img4.png to img6.png, pictures may be missing"
    assert not probe(folder / "img?.png").damage.startswith("numbers jump from img6")


def test_no_picture_at_all_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(FileMissingError, match=r"expected pictures \(.png, .*\), got a folder without any\."):
        probe(tmp_path)
    with pytest.raises(FileMissingError, match=r"img_\*\.png: expected pictures .*, got none\."):
        probe(tmp_path / "img_*.png")
    with pytest.raises(FileMissingError, match="no such file"):
        probe(tmp_path / "img_0.png")
    with pytest.raises(VideoError, match=r"one\.png: .* got a single picture\. Give the folder"):
        probe(write(tmp_path / "one.png", grey(0)))


def test_a_single_jpeg_is_no_video(tmp_path: Path) -> None:
    with pytest.raises(VideoError, match="a single picture"):
        probe(write(tmp_path / "one.jpg", grey(0)))


def test_a_stack_in_one_file_is_refused_with_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "stack.tif").write_bytes(cv2.imencodemulti(".tif", [grey(0), grey(1)])[1].tobytes())
    with pytest.raises(VideoError, match=r"^stack\.tif: expected one picture in each file, got a stack of several\."):
        probe(tmp_path)


def test_a_range_outside_the_series_is_refused_at_once(tmp_path: Path) -> None:
    with pytest.raises(FrameRangeError, match=r"a frame of frames, 0 to 11, got 12"):
        read_frames(folder_of(tmp_path, "{}.png"), 12)


@pytest.mark.parametrize("ending", ["png", "jpg", "bmp", "tif"])
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 0.98), patch=st.binary(max_size=40), is_cut=st.booleans())
def test_a_wounded_picture_is_shown_whole_or_refused_by_its_name(
    tmp_path: Path, ending: str, share: float, patch: bytes, is_cut: bool
) -> None:
    folder = tmp_path / "wounds"
    folder.mkdir(exist_ok=True)
    data = bytearray(write(folder / f"a.{ending}", grey(0)).read_bytes())
    at = int(share * len(data))
    data[at : at + len(patch)] = b"" if is_cut else patch
    (folder / f"b.{ending}").write_bytes(data[:at] if is_cut else data)
    said = ""
    try:
        assert [frame.index for frame in read_frames(folder)] == [0, 1]
    except VideoError as error:
        said = str(error)
    assert said or not is_cut
    assert not said or said.startswith(f"b.{ending}: ")
    assert "\n" not in said

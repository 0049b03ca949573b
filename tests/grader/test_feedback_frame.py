"""The picture of the impact: one frame of the video that was handed out, cut out, small, and kept."""

from __future__ import annotations

import base64
from dataclasses import replace

import cv2
import numpy as np
import pytest

from assignments.impact_frame import HEIGHT, MOST_BYTES, WIDTH, cut_for, cut_out, keep_frame
from grader.frame import impact_frame
from vml_course.io.shelf import FolderShelf, open_shelf
from vml_course.io.video import picture_from_bgr, write_video

INDEX = 7


def decoded(frame) -> np.ndarray:
    data = base64.b64decode(frame.address.partition(",")[2])
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)


def ramp(seed: int = 1) -> np.ndarray:
    """A smooth picture whose blue grows to the right and green downwards."""
    y, x = np.mgrid[:480, :640]
    return np.dstack([x / 640 * 255, y / 480 * 255, np.full_like(x, 90 + seed)]).astype(np.uint8)


@pytest.fixture
def course(desk, tmp_path):
    """A shelf with a video whose frame 7 alone is bright, and the key of it."""
    key = replace(desk.key, truth={**desk.key.truth, "frame_before": float(INDEX)})
    folder = tmp_path / "handouts" / key.assignment_id / key.student
    folder.mkdir(parents=True)
    bright, dark = np.full((480, 640, 3), 220, np.uint8), np.full((480, 640, 3), 30, np.uint8)
    write_video(folder / "video.mp4", (picture_from_bgr(bright if n == INDEX else dark) for n in range(12)), 30)
    return FolderShelf(tmp_path), key


def test_the_frame_is_the_one_at_the_impact(course):
    frame = impact_frame(*course)
    assert frame is not None
    assert frame.index == INDEX
    assert decoded(frame).mean() == pytest.approx(220, abs=4)
    assert decoded(frame).shape == (frame.height, frame.width, 3) == (HEIGHT, WIDTH, 3)


def test_the_cut_shows_the_place_that_was_asked_for():
    frame = cut_out(ramp(), (400.0, 200.0), 3)
    assert (frame.left + WIDTH / 2, frame.top + HEIGHT / 2) == (pytest.approx(400, abs=180), pytest.approx(200, abs=1))
    blue, green, _ = decoded(frame)[HEIGHT // 2, WIDTH // 2]
    assert blue == pytest.approx((frame.left + WIDTH / 2) / 640 * 255, abs=4)
    assert green == pytest.approx((frame.top + HEIGHT / 2) / 480 * 255, abs=4)


@pytest.mark.parametrize("middle", [(-500.0, -500.0), (0.0, 479.0), (9999.0, 9999.0)])
def test_a_cut_never_leaves_the_picture(middle):
    frame = cut_out(ramp(), middle, 0)
    assert 0 <= frame.left <= 640 - frame.width
    assert 0 <= frame.top <= 480 - frame.height


def test_a_small_video_is_taken_whole():
    frame = cut_out(ramp()[:100, :120], (60.0, 50.0), 0)
    assert (frame.left, frame.top, frame.width, frame.height) == (0, 0, 120, 100)


def test_a_picture_stays_small_or_is_left_out():
    noise = np.random.default_rng(1).integers(0, 256, (480, 640, 3), dtype=np.uint8)
    found = cut_out(noise, (300.0, 200.0), 0)
    assert found is None or len(found.address) <= MOST_BYTES
    assert len(cut_out(ramp(), (300.0, 200.0), 0).address) <= MOST_BYTES


def test_a_frame_that_was_kept_is_found_again_without_the_video(course):
    shelf, key = course
    assert impact_frame(shelf, key) is not None
    made = impact_frame(shelf, key)
    (shelf.folder / "handouts" / key.assignment_id / key.student / "video.mp4").unlink()
    assert impact_frame(shelf, key) == made
    assert impact_frame(shelf, replace(key, video_sha256="1" * 64)) is None


def test_a_frame_that_was_kept_at_hand_out_needs_no_video(desk, tmp_path):
    key = replace(desk.key, truth={**desk.key.truth, "frame_before": float(INDEX)})
    frame = cut_for(key, ramp(), INDEX)
    keep_frame(FolderShelf(tmp_path), key, frame)
    assert impact_frame(FolderShelf(tmp_path), key) == frame


@pytest.mark.parametrize("spoilt", [b"", b"[]", b"{}", b'{"video_sha256": 1}', b"\xff"])
def test_a_kept_frame_that_is_damaged_is_made_again(course, spoilt):
    shelf, key = course
    shelf.write(f"frames/{key.assignment_id}/{key.student}.json", spoilt)
    assert impact_frame(shelf, key).index == INDEX


def test_a_course_in_an_object_store_has_its_pictures_too(course, tmp_path):
    shelf, key = course
    far, name = open_shelf("memory://pictures"), f"handouts/{key.assignment_id}/{key.student}/video.mp4"
    far.write(name, shelf.read(name))
    assert impact_frame(far, key) == impact_frame(shelf, key)


def test_without_a_video_there_is_no_picture(desk, tmp_path):
    key = replace(desk.key, truth={**desk.key.truth, "frame_before": 7.0})
    assert impact_frame(FolderShelf(tmp_path), key) is None
    assert impact_frame(FolderShelf(tmp_path), key) is None


def test_a_video_that_is_none_gives_no_picture(course):
    shelf, key = course
    (shelf.folder / "handouts" / key.assignment_id / key.student / "video.mp4").write_bytes(b"text")
    assert impact_frame(shelf, key) is None


@pytest.mark.parametrize("frame_before", [float("nan"), -1.0, 1e9])
def test_an_impact_outside_of_the_video_has_no_picture(course, frame_before):
    shelf, key = course
    assert impact_frame(shelf, replace(key, truth={**key.truth, "frame_before": frame_before})) is None

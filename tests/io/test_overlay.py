from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from vml_course.errors import FileFormatError, VideoError
from vml_course.io.drawing import BLUE, MARKS, YELLOW
from vml_course.io.overlay import Scenery, block_corners, draw_row, write_overlay
from vml_course.io.video import bgr_of, probe, read_pictures, write_video
from vml_course.kinetics.vectors import vector_series
from vml_course.model.frame import Picture, VideoInfo
from vml_course.model.motion import Calibration
from vml_course.model.track import Status, Track
from vml_course.model.tracked import Tracked

FRAMES, WIDTH, HEIGHT = 12, 960, 540
NEAR = 45  # grey levels of each colour, after compression and 4:2:0
INFO = VideoInfo(WIDTH, HEIGHT, 20, 480.0, is_variable_rate=False, codec="h264", container="mp4")


@pytest.fixture(scope="module")
def tracked(tmp_path_factory: pytest.TempPathFactory) -> Tracked:
    """Pictures 4, 5, ... of a grey clip: `b` moves to the right, `a` stands still and is lost in row 7."""
    path = tmp_path_factory.mktemp("clip") / "kick.mp4"
    grey, half = np.full((HEIGHT, WIDTH), 128, np.uint8), np.full((HEIGHT // 2, WIDTH // 2), 128, np.uint8)
    write_video(path, [Picture(grey, half, half)] * 20, 480)
    xy = np.zeros((FRAMES, 2, 2))
    xy[:, 0], xy[:, 1, 0], xy[:, 1, 1] = (300, 300), 600 + 5 * np.arange(FRAMES), 300
    status = np.zeros((FRAMES, 2), np.int8)
    status[7, 0], xy[7, 0] = Status.LOST, np.nan
    ones = np.where(status == Status.LOST, np.nan, 1.0)
    track = Track(
        ("a", "b"), 4 + np.arange(FRAMES), np.arange(FRAMES) / 480, xy, 0.01 * ones, ones, np.ones((FRAMES, 2)), status,
        np.zeros((FRAMES, 2, 4)), {"block": 60},
    )  # fmt: skip
    calibration = Calibration(400.0, (0.0, HEIGHT - 1.0))
    motion = calibration.apply(track)
    vector = vector_series("way", "a", "b", motion.of("a"), motion.of("b"))
    return Tracked(track, INFO, calibration, motion, (vector,), 480.0, path.name, path=path, first_picture=4)


def has_colour(image: np.ndarray, colour: tuple[int, int, int]) -> bool:
    return bool((np.abs(image.astype(int) - colour).max(axis=2) < NEAR).any())


@pytest.mark.parametrize("kind", ["mp4", "avi"])
def test_an_overlay_has_one_picture_a_row_and_shows_points_and_vectors(
    tmp_path: Path, tracked: Tracked, kind: str
) -> None:
    path = tmp_path / f"overlay.{kind}"
    assert write_overlay(path, tracked) == FRAMES
    info = probe(path)
    assert (info.frame_count, info.fps, info.width_px, info.height_px) == (FRAMES, 30.0, WIDTH, HEIGHT)
    images = [bgr_of(one.picture) for one in read_pictures(path)]
    shown = images[3]
    assert has_colour(shown[265:336, 265:336], MARKS[0])
    assert has_colour(shown[265:336, 580:651], MARKS[1])
    assert has_colour(shown[290:310, 400:560], BLUE)
    assert has_colour(shown[290:310, 320:360], YELLOW)
    assert abs(int(shown[450, 500].mean()) - 128) < 5
    lost = images[7]
    edge = np.s_[266:275, 280:320]
    assert np.abs(shown[edge].astype(int) - 128).max() > 60
    assert np.abs(lost[edge].astype(int) - 128).max() < 10, "a lost point's block is not drawn at an old place"


def test_small_pictures_are_enlarged_so_that_texts_can_be_read(tmp_path: Path, tracked: Tracked) -> None:
    clip = tmp_path / "small.mp4"
    plane, half = np.full((240, 320), 90, np.uint8), np.full((120, 160), 128, np.uint8)
    write_video(clip, [Picture(plane, half, half)] * 20, 240)
    small = Tracked(**{**vars(tracked), "path": clip})
    write_overlay(tmp_path / "o.mp4", small)
    info = probe(tmp_path / "o.mp4")
    assert (info.width_px, info.height_px) == (960, 720)


def test_a_block_follows_its_gradient() -> None:
    turn = np.radians(30)
    gradient = np.array([np.cos(turn) - 1, -np.sin(turn), np.sin(turn), np.cos(turn) - 1])
    corners = np.array(block_corners((100, 50), 60, gradient))
    np.testing.assert_allclose(corners.mean(axis=0), (100, 50))
    np.testing.assert_allclose(np.hypot(*(corners - (100, 50)).T), np.hypot(30, 30))
    right_edge = corners[1:3].mean(axis=0) - (100, 50)  # turned clockwise, as y points down
    np.testing.assert_allclose(np.degrees(np.arctan2(right_edge[1], right_edge[0])), 30)


def test_an_overlay_needs_its_video_and_a_known_ending(tmp_path: Path, tracked: Tracked) -> None:
    with pytest.raises(FileFormatError):
        write_overlay(tmp_path / "overlay.gif", tracked)
    with pytest.raises(VideoError):
        write_overlay(tmp_path / "overlay.mp4", Tracked(**{**vars(tracked), "path": None}))
    assert list(tmp_path.iterdir()) == []


def test_how_a_place_came_about_shows_in_the_shape_of_its_mark(tracked: Tracked) -> None:
    kinds = [Status.AUTO, Status.MANUAL, Status.INTERP, Status.VIRTUAL]
    status = np.array(tracked.track.status)
    status[: len(kinds), 0] = kinds
    gradient = np.array(tracked.track.gradient)
    gradient[1 : len(kinds), 0] = np.nan
    size = 1.5
    marked = replace(tracked, track=replace(tracked.track, status=status, gradient=gradient), vectors=())
    scenery = Scenery(marked, 1, size, "real speed", 0.0)
    plain = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)
    crops = [draw_row(plain.copy(), scenery, row)[255:345, 255:345].astype(int) for row in range(len(kinds))]
    for one, other in combinations(range(len(kinds)), 2):
        assert (np.abs(crops[one] - crops[other]).max(axis=2) > NEAR).sum() > 40

    def is_drawn(row: int, dx: float, dy: float) -> bool:
        return has_colour(
            crops[row][45 + round(dy) - 1 : 47 + round(dy), 45 + round(dx) - 1 : 47 + round(dx)], MARKS[0]
        )

    side = 0.5 * 15 * size
    assert [is_drawn(row, side, side) for row in range(2)] == [False, True]  # a diamond's side
    assert [is_drawn(row, 30, 10) for row in range(4)] == [True, False, False, False]  # a block's edge
    assert [is_drawn(row, 9 * size, 0) for row in range(4)] == [True, True, True, True]  # an arm of the cross, a ring
    assert [is_drawn(row, 5 * size, 0) for row in range(4)] == [True, True, False, False]  # the cross alone

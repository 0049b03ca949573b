"""A larger block has more texture, until it takes in what does not move with it."""

from itertools import pairwise

import cv2
import numpy as np
import pytest

from vml_course.model.frame import Frame
from vml_course.model.track import Seed
from vml_course.track.block_size import BlockSize, best_size, block_sizes
from vml_course.track.trackers.dic import Dic

DISC_PX = 25  # radius


@pytest.fixture(scope="module")
def pilot_of(speckle, camera_of):
    """Six pictures of a textured disc that moves over a wall (radius None: everything moves)."""
    base = speckle.picture().astype(np.float32)
    wall = np.roll(base, (37, 61), (0, 1))
    x, y = np.meshgrid(np.arange(speckle.width_px), np.arange(speckle.height_px))

    def make(radius_px, step_px=(3.0, 1.5)):
        frames = []
        for k in range(6):
            dx, dy = np.multiply(step_px, k)
            moved = cv2.warpAffine(
                base, np.array([[1.0, 0.0, dx], [0.0, 1.0, dy]]), base.shape[::-1], flags=cv2.INTER_CUBIC
            )
            cover = 1.0
            if radius_px is not None:
                cover = np.clip(radius_px + 0.5 - np.hypot(x - 110 - dx, y - 100 - dy), 0.0, 1.0)
            frames.append(Frame(k, k / 240, camera_of(cover * moved + (1 - cover) * wall, 1.0, k)))
        return frames

    return make


SEED = Seed("ball", 110.0, 100.0)
SIZES = (20, 30, 40, 50, 60, 80)


def test_on_a_large_body_larger_is_better(pilot_of):
    sizes = block_sizes(Dic(), pilot_of(None), SEED, SIZES)
    assert [one.block for one in sizes] == list(SIZES)
    assert all(later.sigma_px < earlier.sigma_px for earlier, later in pairwise(sizes))
    assert all(one.background < 0.05 for one in sizes)
    assert best_size(sizes).block == 80


def test_on_a_ball_the_wall_behind_it_counts(pilot_of):
    sizes = {one.block: one for one in block_sizes(Dic(), pilot_of(DISC_PX), SEED, SIZES)}
    assert sizes[30].background < 0.05
    corners = 1.0 - np.pi * DISC_PX**2 / 60**2
    assert sizes[60].background == pytest.approx(corners, abs=0.15)
    assert best_size(list(sizes.values())).block in {30, 40, 50}


def test_what_hardly_moves_tells_nothing_of_its_background(pilot_of):
    assert all(np.isnan(one.background) for one in block_sizes(Dic(), pilot_of(DISC_PX, (0.0, 0.0)), SEED, SIZES))


def test_sizes_that_leave_the_picture_are_left_out(pilot_of):
    sizes = block_sizes(Dic(), pilot_of(None), Seed("ball", 30.0, 100.0), SIZES)
    assert [one.block for one in sizes] == [20, 30, 40, 50, 60]


def test_without_texture_no_size_is_best():
    assert best_size([BlockSize(20, float("inf"), float("nan"))]) is None
    assert best_size([BlockSize(20, 0.1, 0.4), BlockSize(30, 0.05, 0.5)]).block == 20

"""A rounded corner is smoothing: how deep, how clear and how near it must be, on a path with one corner."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import uniform_filter1d

from grader.smoothed import smoothing_of

IMPACT = slice(17, 41)  # the rows that are looked at


@pytest.fixture(scope="module")
def look(kick, fit):
    """How a table looks whose corner, of some px a frame, is rounded off by so many frames, `size` times as deep.

    `part` of what remains near the impact is the corner, the rest is noise that has nothing of it.
    """

    def found(width, size=1.0, part=1.0, slope_px=40.0, points=3, rows=slice(None)):
        frame = np.arange(60.0)[rows]
        true_px = np.repeat(np.abs(frame - 28.5)[:, None, None] * slope_px, points, axis=1).repeat(2, axis=2)
        corner = size * (uniform_filter1d(true_px, width, axis=0, mode="nearest") - true_px)
        near, noise = corner[IMPACT], np.random.default_rng(7).normal(size=corner[IMPACT].shape)
        noise -= near * (near * noise).sum() / (near**2).sum()
        noise *= np.sqrt((1 / part - 1) * (near**2).sum() / (noise**2).sum())
        own_px = true_px + corner
        own_px[IMPACT] += noise
        table = replace(fit, frame=frame, own_m=own_px / 500, true_m=true_px / 500)
        return smoothing_of(table, kick.key)

    return found


@pytest.mark.parametrize("width", [3, 5, 7, 9, 13, 17, 21])
def test_a_clean_corner_tells_its_width(look, width):
    assert look(width) == width


@pytest.mark.parametrize(
    ("width", "size", "is_seen"),
    [(3, 0.52, True), (3, 0.48, False), (21, 1.58, True), (21, 1.62, False), (7, -1, False)],
)
def test_a_corner_is_about_as_deep_as_a_mean_cuts_it(look, width, size, is_seen):
    assert (look(width, size=size) > 0) == is_seen


@pytest.mark.parametrize("size", [0.8, 1.2])
@pytest.mark.parametrize(("part", "is_seen"), [(0.33, True), (0.27, False)])
def test_three_tenths_of_what_remains_must_be_the_corner(look, size, part, is_seen):
    assert (look(7, size=size, part=part) > 0) == is_seen


@pytest.mark.parametrize(("part", "is_seen"), [(0.62, True), (0.5, False)])
def test_one_point_alone_must_be_clearer(look, part, is_seen):
    """48 numbers: eight sd are a part of 0.57."""
    assert (look(7, part=part, points=1) > 0) == is_seen


def test_a_corner_that_cannot_be_seen_is_not_looked_for(look):
    true_px = np.abs(np.arange(60.0) - 28.5)
    corner = (uniform_filter1d(true_px, 21, mode="nearest") - true_px)[IMPACT]
    rms = float(np.sqrt((corner**2).mean()))
    assert look(21, slope_px=0.21 / rms) == 21
    assert look(21, slope_px=0.19 / rms) == 0


@pytest.mark.parametrize(("rows", "is_seen"), [(29, True), (28, False)])
def test_twelve_rows_about_the_impact_are_enough(look, rows, is_seen):
    assert (look(13, rows=slice(0, rows)) > 0) == is_seen

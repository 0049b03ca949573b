"""Laying a drawing over a picture, against the same in plain numpy."""

import numpy as np
import pytest

from vml_course.synth.overlay import cover, lay_over
from vml_course.synth.smear import add_warps

GREY = 1e-4


def turned(angle, at=(40.0, 37.3), centre=(60.0, 81.0), scale=4.0):
    c, s = scale * np.cos(angle), scale * np.sin(angle)
    matrix = np.array([[c, -s, 0.0], [s, c, 0.0]])
    matrix[:, 2] = centre - matrix[:, :2] @ at
    return matrix


def drawing(colours, margin=4):
    roll = np.random.default_rng(7)
    sheet = roll.uniform(0, 200, (170, 130, colours + 1)).astype(np.float32)
    sheet[..., -1] /= 200
    sheet[:margin] = sheet[-margin:] = sheet[:, :margin] = sheet[:, -margin:] = 0
    return sheet


def read(sheet, column, row):
    """Bilinear; beyond the sheet there is nothing."""
    framed = np.pad(sheet.astype(np.float64), ((1, 1), (1, 1), (0, 0)))
    high = np.array(framed.shape[:2]) - 2
    column, row = np.clip(column + 1, 0, high[1] + 0.999), np.clip(row + 1, 0, high[0] + 0.999)
    j, i = np.floor(column).astype(int), np.floor(row).astype(int)
    p, q = (column - j)[..., None], (row - i)[..., None]
    upper, lower = ((1 - p) * framed[i + k, j] + p * framed[i + k, j + 1] for k in (0, 1))
    return (1 - q) * upper + q * lower


def places(matrix, shape):
    y, x = np.mgrid[: shape[0], : shape[1]]
    return (matrix[k, 0] * x + matrix[k, 1] * y + matrix[k, 2] for k in (0, 1))


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2, -2.5])
@pytest.mark.parametrize(("colours", "margin"), [(1, 4), (1, 0), (2, 4)])
def test_a_drawing_is_laid_over_a_picture_at_32nds_of_a_sample(angle, colours, margin):
    sheet, matrix = drawing(colours, margin), turned(angle)
    picture = np.random.default_rng(1).uniform(0, 255, (83, 90, colours)).astype(np.float32)
    y, x = np.mgrid[:83, :90]
    # to 1/1024 each for the way along a row and for its start, then together to the nearest 1/32
    fixed = [np.rint(way[0] * x * 1024) + np.rint((way[1] * y + way[2]) * 1024) for way in matrix]
    column, row = (np.floor((place + 16) / 32) / 32 for place in fixed)
    seen = read(sheet, column, row)
    expected = picture * (1 - seen[..., -1:]) + seen[..., :-1]
    lay_over(picture, sheet, matrix)
    assert np.abs(picture - expected).max() < GREY


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2, -2.5])
def test_drawings_are_added_up_exactly_where_they_are(angle):
    sheet, ways = drawing(1), np.array([turned(angle, at=(40.0 + k, 37.3)) for k in range(3)])
    total = np.zeros((83, 90, 2), np.float32)
    add_warps(sheet, ways, total)
    expected = sum(read(sheet, *places(matrix, total.shape)) for matrix in ways)
    assert np.abs(total - expected).max() < 10 * GREY


def test_a_veil_hides_in_proportion_to_its_opacity():
    picture, veil = np.full((2, 3, 1), 100, np.float32), np.zeros((2, 3, 2), np.float32)
    veil[0, 0] = 10.0, 0.25
    cover(picture, veil)
    assert picture[..., 0].tolist() == [[85, 100, 100], [100, 100, 100]]

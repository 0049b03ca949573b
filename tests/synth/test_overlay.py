"""Laying a drawing over a picture, against scipy's splines."""

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from vml_course.synth.overlay import cover
from vml_course.synth.spline import VARIANCE, add_gathered, add_warps, lay_over, make_drawing

GREY = 2e-3  # float32 places and weights, for samples of up to 200


def turned(angle, at=(40.0, 37.3), centre=(60.0, 81.0), scale=2.0):
    c, s = scale * np.cos(angle), scale * np.sin(angle)
    matrix = np.array([[c, -s, 0.0], [s, c, 0.0]])
    matrix[:, 2] = centre - matrix[:, :2] @ at
    return matrix


def drawing(colours):
    roll = np.random.default_rng(7)
    sheet = roll.uniform(0, 200, (170, 130, colours + 1)).astype(np.float32)
    sheet[..., -1] /= 200
    sheet[:4] = sheet[-4:] = sheet[:, :4] = sheet[:, -4:] = 0
    sheet[60:90, 40:70] = 0  # a hole, which is skipped
    return sheet


def read(sheet, column, row):
    """Quadratic B-splines whose coefficients are the samples; beyond the sheet there is nothing."""
    planes = np.moveaxis(sheet.astype(np.float64), -1, 0)
    seen = [map_coordinates(plane, [row, column], order=2, prefilter=False, mode="constant") for plane in planes]
    return np.stack(seen, axis=-1)


def places(matrix, shape):
    y, x = np.mgrid[: shape[0], : shape[1]]
    return (matrix[k, 0] * x + matrix[k, 1] * y + matrix[k, 2] for k in (0, 1))


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2, -2.5])
@pytest.mark.parametrize("colours", [1, 2])
def test_a_drawing_is_laid_over_a_picture_where_it_is(angle, colours):
    sheet, matrix = drawing(colours), turned(angle)
    picture = np.random.default_rng(1).uniform(0, 255, (83, 90, colours)).astype(np.float32)
    seen = read(sheet, *places(matrix, picture.shape))
    expected = picture * (1 - seen[..., -1:]) + seen[..., :-1]
    lay_over(picture, make_drawing(sheet), matrix)
    assert np.abs(picture - expected).max() < GREY


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2, -2.5])
def test_drawings_are_added_up_where_they_are(angle):
    sheet, ways = drawing(1), np.array([turned(angle, at=(40.0 + k, 37.3)) for k in range(3)])
    total = np.zeros((83, 90, 2), np.float32)
    add_warps(make_drawing(sheet), ways, total)
    expected = sum(read(sheet, *places(matrix, total.shape)) for matrix in ways)
    assert np.abs(total - expected).max() < 3 * GREY


def test_drawings_are_gathered_where_each_pixel_looks_in_each_rows_pose():
    sheet, total = drawing(2), np.zeros((83, 90, 3), np.float32)
    ways = np.array([[turned(0.3 + 0.002 * y, at=(40.0 + k, 37.3)) for y in range(83)] for k in range(2)])
    y, x = np.mgrid[:83, :90].astype(np.float64)
    looks = np.stack([x + 2 * np.sin(y / 9), y + np.cos(x / 7)], axis=-1)
    add_gathered(make_drawing(sheet), ways, looks, total)
    seen = np.einsum("kyij,yxj->kyxi", ways[..., :2], looks) + ways[:, :, None, :, 2]
    assert np.abs(total - sum(read(sheet, *np.moveaxis(k, -1, 0)) for k in seen)).max() < 3 * GREY


def test_reading_shifts_nothing_and_blurs_the_same_everywhere():
    """The moments of what one sample becomes when it is read with any offset."""
    sheet = np.zeros((41, 41, 1), np.float32)
    sheet[20, 20] = 1.0
    for offset in np.linspace(-0.5, 0.5, 9):
        total = np.zeros((41, 41, 1), np.float32)
        add_warps(make_drawing(sheet), np.array([[[1.0, 0.0, offset], [0.0, 1.0, 0.0]]]), total)
        weight, x = total[..., 0].sum(axis=0).astype(np.float64), np.arange(41) - 20
        assert weight.sum() == pytest.approx(1.0, abs=1e-6)
        assert (weight * x).sum() == pytest.approx(-offset, abs=1e-6)
        assert (weight * (x + offset) ** 2).sum() == pytest.approx(VARIANCE, abs=1e-6)


def test_a_veil_hides_in_proportion_to_its_opacity():
    picture, veil = np.full((2, 3, 1), 100, np.float32), np.zeros((2, 3, 2), np.float32)
    veil[0, 0] = 10.0, 0.25
    cover(picture, veil)
    assert picture[..., 0].tolist() == [[85, 100, 100], [100, 100, 100]]

"""The spline over a crop is the picture's own, wherever the crop lies."""

import cv2
import numpy as np
import pytest

from vml_course.correlate.bspline import (
    gradients_at_pixels,
    mirror,
    prefilter_taps,
    spline_crop,
    values_at_pixels,
)

GREY_TOLERANCE = 0.01  # the filter's cut-off


def coefficients(image, x0, y0, w, h, blur_px=0.0):
    crop = np.empty((h, w), np.float32)
    spline_crop(image, prefilter_taps(blur_px), x0, y0, crop)
    return crop


def test_the_spline_passes_through_the_pixels(speckle, camera_of):
    image = camera_of(speckle.picture())
    crop = coefficients(image, 30, 40, 62, 52)
    assert np.abs(values_at_pixels(crop) - image[41:91, 31:91]).max() < GREY_TOLERANCE


def test_a_crop_beyond_the_border_sees_the_picture_mirrored(speckle, camera_of):
    image = camera_of(speckle.picture())
    padded = camera_of(np.pad(image.astype(float), 40, mode="reflect"))
    assert np.allclose(coefficients(image, -7, -9, 40, 30), coefficients(padded, 33, 31, 40, 30), atol=1e-4)
    height, width = image.shape
    far = coefficients(image, width - 20, height - 15, 30, 30)
    assert np.allclose(far, coefficients(padded, width + 20, height + 25, 30, 30), atol=1e-4)


def test_mirror_reflects_about_the_first_and_last_pixel():
    assert [mirror(k, 4) for k in (-4, -3, -2, -1, 0, 3, 4, 5, 6, 7)] == [2, 3, 2, 1, 0, 3, 2, 1, 0, 1]
    assert mirror(5, 1) == 0


def test_gradients_are_those_of_a_wave():
    x, y = np.meshgrid(np.arange(60.0), np.arange(50.0))
    image = (128 + 100 * np.sin(x / 5) * np.cos(y / 7)).round().astype(np.uint8)
    image.setflags(write=False)
    across, down = gradients_at_pixels(coefficients(image, 9, 9, 42, 32))
    px, py = x[10:40, 10:50], y[10:40, 10:50]
    assert np.abs(across - 20 * np.cos(px / 5) * np.cos(py / 7)).max() < 1.2  # rounding to whole grey levels
    assert np.abs(down + 100 / 7 * np.sin(px / 5) * np.sin(py / 7)).max() < 1.2


@pytest.mark.parametrize("blur_px", [0.0, 0.6, 1.5])
def test_taps_keep_the_mean(blur_px):
    taps = prefilter_taps(blur_px).astype(float)
    assert taps[0] + 2 * taps[1:].sum() == pytest.approx(1.0, abs=1e-6)


def test_blur_in_the_taps_is_a_gaussian_blur():
    rng = np.random.default_rng(3)
    image = rng.integers(0, 255, (80, 80)).astype(np.uint8)
    image.setflags(write=False)
    blurred = cv2.GaussianBlur(image.astype(np.float32), (0, 0), 0.8)
    crop = coefficients(image, 19, 19, 42, 42, blur_px=0.8)
    assert np.abs(values_at_pixels(crop) - blurred[20:60, 20:60]).max() < 1.0

"""Texture is what is left when the noise's share is taken away."""

import numpy as np
import pytest

from vml_course.correlate.texture import noise_grey, texture_of


@pytest.mark.parametrize("noise", [1.0, 3.0, 8.0])
def test_white_noise_is_measured_and_is_no_texture(noise):
    block = 128 + np.random.default_rng(2).normal(0, noise, (60, 60))
    assert noise_grey(block) == pytest.approx(noise, rel=0.1)
    texture = texture_of(block)
    assert texture.strongest < texture.insignificant


def test_an_edge_holds_one_direction_only():
    block = np.where(np.arange(60) < 30, 60.0, 180.0) + np.random.default_rng(2).normal(0, 2, (60, 60))
    texture = texture_of(block)
    assert texture.weakest < texture.insignificant < texture.strongest


def test_speckle_holds_both(speckle):
    texture = texture_of(speckle.picture()[80:140, 90:150])
    assert texture.weakest > 10 * texture.insignificant

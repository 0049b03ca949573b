"""Random numbers that must never change, and the grain made from them."""

import numpy as np
import pytest

from vml_course.synth.texture import choose, grain, normals, raw_bits

PINNED = ["c06636c1a48ec96f", "1f4d6289ade6fc01", "6da8dae8bc06f854"]


def test_a_seed_and_a_name_give_these_bits_for_ever():
    """Videos that were handed out must be reproducible with any later version of NumPy."""
    assert [f"{word:016x}" for word in raw_bits(7, "leg", 3)] == PINNED


def test_names_and_seeds_are_independent():
    words = {tuple(raw_bits(seed, name, 2)) for seed in range(4) for name in ("leg", "ball", "wall")}
    assert len(words) == 12


def test_normals_have_mean_0_and_deviation_1_and_are_uncorrelated():
    noise = normals(1, "test", (400, 500))
    assert noise.mean() == pytest.approx(0.0, abs=0.01)
    assert noise.std() == pytest.approx(1.0, abs=0.01)
    assert abs(np.corrcoef(noise[:, :-1].ravel(), noise[:, 1:].ravel())[0, 1]) < 0.01


def test_chosen_numbers_are_all_different():
    chosen = choose(3, "frames", 200, 256)
    assert len(set(chosen.tolist())) == 200
    assert chosen.min() >= 0
    assert chosen.max() < 256


def test_grain_is_as_fine_as_asked():
    fine = grain(1, "test", (400, 400), samples_per_px=4.0)
    assert fine.shape == (400, 400)
    assert fine.std() == pytest.approx(1.0, abs=0.15)
    one_px = np.corrcoef(fine[:, :-4].ravel(), fine[:, 4:].ravel())[0, 1]
    five_px = np.corrcoef(fine[:, :-20].ravel(), fine[:, 20:].ravel())[0, 1]
    assert one_px > 0.5
    assert abs(five_px) < 0.2

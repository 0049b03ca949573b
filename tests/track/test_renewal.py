"""A reference is cut anew only when the block has changed its look for good; the track says so, and what it costs."""

import numpy as np
import pytest

from vml_course.model.track import Seed
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker

POINT = np.array([118.4, 112.7])
SEED = [Seed("mark", float(POINT[0]), float(POINT[1]))]
PICTURES = 60
WITHIN_95 = 1.96
LEAST_COVERAGE = 0.90
NOISY_PX = 0.25


def renewals(track):
    """Rows from which on the point was compared with another block than before."""
    return np.flatnonzero(np.diff(track.reference[:, 0])) + 1


@pytest.fixture(scope="module")
def changing(speckle, clip_of, rotated):
    """A body that turns and wanders, while its pattern turns into another one, one texture after the other."""

    def film(seed, pictures=PICTURES):
        other = type(speckle)(seed=100 + seed)
        poses = [(rotated(1.2 * k), (0.35 * k, 0.2 * k)) for k in range(pictures)]

        def fade(k, picture):
            share = 0.5 - 0.5 * np.cos(np.pi * k / (pictures - 1))
            return (1 - share) * picture + share * other.picture(*poses[k])

        return clip_of(poses, noise_grey=2.0, retouch=fade), poses

    return film


@pytest.mark.parametrize("seed", range(4))
def test_a_pattern_that_turns_into_another_is_followed_and_each_renewal_is_in_the_track(changing, error_of, seed):
    frames, poses = changing(seed)
    track = run(make_tracker("dic"), frames, SEED)
    assert not track.is_lost.any()
    rows = renewals(track)
    assert 1 <= len(rows) <= 8
    assert track.reference[rows, 0].tolist() == track.frame[rows - 1].tolist()
    assert (track.drift_px[: rows[0], 0] == 0).all()
    assert (np.diff(track.drift_px[:, 0]) >= 0).all()
    error = error_of(track, poses, [POINT])[:, 0]
    assert error.max() < 5 * track.sigma_px[:, 0].max()
    assert error.max() < 1.0


@pytest.mark.accuracy
def test_sigma_holds_what_renewals_add(changing, speckle):
    within = []
    for seed in range(10, 34):
        frames, poses = changing(seed)
        track = run(make_tracker("dic"), frames, SEED)
        truth = np.array([speckle.moved(POINT, *pose) for pose in poses])
        within.append(np.abs(track.xy_px[1:, 0] - truth[1:]) <= WITHIN_95 * track.sigma_px[1:, :1])
    assert np.mean(within) >= LEAST_COVERAGE


def test_the_turn_goes_on_across_renewals(changing):
    frames, _ = changing(1)
    track = run(make_tracker("dic"), frames, SEED)
    linear = track.gradient[:, 0] + np.array([1.0, 0.0, 0.0, 1.0])
    angle = np.degrees(np.unwrap(np.arctan2(linear[:, 2], linear[:, 0])))
    assert np.abs(angle - 1.2 * np.arange(PICTURES)).max() < 1.0


def test_noise_as_strong_as_the_texture_is_no_reason_and_loses_nothing(clip_of, error_of, rotated):
    """Contrast 17, noise 14: the block is blurred by a pixel, else it could not tell its own rotation."""
    poses = [(rotated(1.0 * k), (0.5 * k, 0.0)) for k in range(20)]
    track = run(make_tracker("dic"), clip_of(poses, noise_grey=14.0), SEED)
    assert not track.is_lost.any()
    assert len(renewals(track)) == 0
    assert (track.drift_px == 0).all()
    assert error_of(track, poses, [POINT]).max() < NOISY_PX


def test_a_block_that_is_hidden_for_a_while_is_not_replaced_by_what_hides_it(clip_of, error_of, rotated):
    poses = [(rotated(0.5 * k), (1.0 * k, 0.0)) for k in range(30)]

    def cover(k, picture):
        if 8 <= k < 14:  # half of the block
            picture[60:170, 118 + k :] = 100 + 15 * np.sin(np.arange(picture.shape[1] - 118 - k) / 3)
        return picture

    track = run(make_tracker("dic"), clip_of(poses, retouch=cover), SEED)
    assert len(renewals(track)) == 0
    assert np.nanmax(error_of(track, poses, [POINT])[15:]) < 0.02

"""A block is found to the limit that its noise sets, and says how well."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vml_course.correlate.icgn import Outcome, compose, match
from vml_course.correlate.template import (
    build_template,
    corner_sigma_px,
    cut_patch,
    projected_hessian,
    significant_hessian,
    solving_matrix,
)

BLOCK = 60
CLEAN_PX = 0.003  # bias of the cubic spline and of whole grey levels
CRAMER_RAO_RATIO = 1.2
ROUNDING_VARIANCE = 1 / 12  # of whole grey levels


def pose_of(point, linear):
    return np.concatenate([point, np.asarray(linear).ravel()])


def template_at(image, point, **options):
    return build_template(cut_patch(image, tuple(point), BLOCK), **options)


@pytest.mark.parametrize("angle_deg", [0.0, 3.0, -25.0, 100.0, 180.0])
def test_a_known_affine_motion_comes_back(speckle, rotated, camera_of, angle_deg):
    point, shift = np.array([121.3, 108.8]), np.array([4.3, -2.6])
    linear = rotated(angle_deg) @ np.array([[1.03, 0.01], [0.0, 0.98]])
    found = match(
        camera_of(speckle.picture(linear, shift)),
        template_at(camera_of(speckle.picture()), point),
        pose_of(point + shift + [0.5, -0.5], rotated(angle_deg)),
    )
    assert found.outcome is Outcome.CONVERGED
    assert np.abs(found.pose[:2] - speckle.moved(point, linear, shift)).max() < 4 * CLEAN_PX  # blobs do not stretch
    assert np.abs(found.pose[2:] - linear.ravel()).max() < 2e-3


@settings(max_examples=15, deadline=None)
@given(gain=st.floats(0.6, 1.4), offset=st.floats(-20, 20))
def test_gain_and_offset_of_the_light_move_nothing(speckle, camera_of, gain, offset):
    point, shift = np.array([120.0, 110.0]), np.array([0.4, 0.3])
    image = camera_of(128 + gain * (speckle.picture(None, shift) - 128) + offset)
    found = match(image, template_at(camera_of(speckle.picture()), point), pose_of(point, np.eye(2)))
    assert np.abs(found.pose[:2] - point - shift).max() < 2 * CLEAN_PX
    assert found.gain == pytest.approx(gain, abs=0.01)
    assert found.zncc > 0.99


@pytest.fixture(scope="module")
def many_matches(speckle, rotated, camera_of):
    """Errors and sigmas of 240 matches with noise 2 in both pictures, at twelve sub-pixel places; and the bound."""
    clean = speckle.picture()
    errors, sigmas = [], []
    rng = np.random.default_rng(5)
    point = np.array([120.2, 110.4])
    for k in range(12):
        linear, shift = rotated(rng.uniform(-20, 20)), rng.uniform(-2, 2, 2)
        picture, truth = speckle.picture(linear, shift), speckle.moved(point, linear, shift)
        for n in range(20):
            template = template_at(camera_of(clean, 2.0, 1000 * k + 2 * n), point)
            found = match(camera_of(picture, 2.0, 1000 * k + 2 * n + 1), template, pose_of(truth + 0.2, linear))
            errors.append(found.pose[:2] - truth)
            sigmas.append(found.sigma_px)
    hessian = projected_hessian(cut_patch(camera_of(clean), tuple(point), BLOCK))
    variance = 2 * (2.0**2 + ROUNDING_VARIANCE) * np.trace(solving_matrix(hessian, "affine")[:2, :2]) / 2
    return np.array(errors), np.array(sigmas), np.sqrt(variance)


def test_white_noise_costs_no_more_than_the_cramer_rao_bound_allows(many_matches):
    errors, _, bound = many_matches
    assert np.sqrt((errors**2).mean()) < CRAMER_RAO_RATIO * bound


def test_nothing_pulls_a_match_to_one_side(many_matches):
    errors, _, bound = many_matches
    assert np.abs(errors.mean(axis=0)).max() < 0.4 * bound


def test_the_95_percent_interval_covers_the_truth_90_to_98_times_in_100(many_matches):
    errors, sigmas, _ = many_matches
    assert 0.90 <= (np.abs(errors) < 1.96 * sigmas[:, None]).mean() <= 0.98


def test_masked_pixels_do_not_count(speckle, camera_of):
    point, shift = np.array([120.0, 110.0]), np.array([0.4, 0.3])
    picture = speckle.picture(None, shift)
    picture[:110] = np.random.default_rng(0).uniform(0, 255, picture[:110].shape)
    weight = np.ones((BLOCK, BLOCK), np.float32)
    weight[:34] = 0.0
    template = template_at(camera_of(speckle.picture()), point, weight=weight)
    found = match(camera_of(picture), template, pose_of(point, np.eye(2)))
    assert np.abs(found.pose[:2] - point - shift).max() < 0.01
    assert found.zncc > 0.99


def test_a_block_that_leaves_the_picture_says_so(speckle, camera_of):
    image = camera_of(speckle.picture())
    template = template_at(image, (120.0, 110.0))
    assert match(image, template, pose_of((25.0, 110.0), np.eye(2))).outcome is Outcome.OUTSIDE


def test_a_blank_picture_says_so(speckle, camera_of):
    template = template_at(camera_of(speckle.picture()), (120.0, 110.0))
    blank = camera_of(np.full((220, 240), 90.0))
    assert match(blank, template, pose_of((120.0, 110.0), np.eye(2))).outcome is Outcome.BLANK


@settings(max_examples=30, deadline=None)
@given(x=st.floats(60, 180), y=st.floats(60, 160), seed=st.integers(0, 99))
def test_a_wrong_start_never_blows_up(speckle, camera_of, x, y, seed):
    noise = camera_of(np.random.default_rng(seed).uniform(0, 255, (220, 240)))
    template = template_at(camera_of(speckle.picture()), (120.0, 110.0))
    found = match(noise, template, pose_of((x, y), np.eye(2)), max_shift_px=20.0)
    assert np.all(np.isfinite(found.pose))
    assert found.outcome is not Outcome.CONVERGED or found.zncc < 0.6


@given(step=st.lists(st.floats(-0.2, 0.2), min_size=6, max_size=6), angle_deg=st.floats(-180, 180))
def test_composing_with_a_step_undoes_it(rotated, step, angle_deg):
    pose = pose_of((10.0, 20.0), rotated(angle_deg))
    after = pose.copy()
    compose(after, np.array(step), False)
    u, v, ux, uy, vx, vy = step
    for offset in ([0.0, 0.0], [3.0, -5.0]):
        stepped = np.array([u, v]) + np.array([[1 + ux, uy], [vx, 1 + vy]]) @ offset
        again = after[:2] + after[2:].reshape(2, 2) @ stepped
        assert np.allclose(again, pose[:2] + pose[2:].reshape(2, 2) @ offset, atol=1e-9)


def test_a_rigid_warp_stays_a_rotation(speckle, rotated, camera_of):
    point = np.array([120.0, 110.0])
    template = template_at(camera_of(speckle.picture()), point, warp="rigid")
    found = match(camera_of(speckle.picture(rotated(2.0))), template, pose_of(point, np.eye(2)))
    linear = found.pose[2:].reshape(2, 2)
    assert np.allclose(linear @ linear.T, np.eye(2), atol=1e-12)
    assert np.degrees(np.arctan2(linear[1, 0], linear[0, 0])) == pytest.approx(2.0, abs=0.01)


def test_a_round_dot_cannot_say_how_it_is_turned(camera_of):
    x, y = np.meshgrid(np.arange(100.0), np.arange(100.0))
    dot = camera_of(60 + 150 / (1 + np.exp((np.hypot(x - 50, y - 50) - 4) / 0.5)), 1.0)
    hessian = significant_hessian(cut_patch(dot, (50.0, 50.0), BLOCK), 1.0)
    assert corner_sigma_px(hessian, "translation", 1.0, 29.5) < 0.05
    assert min(corner_sigma_px(hessian, warp, 1.0, 29.5) for warp in ("affine", "rigid")) > 0.25


def test_speckle_can(speckle, camera_of):
    hessian = significant_hessian(cut_patch(camera_of(speckle.picture(), 2.0), (120.0, 110.0), BLOCK), 2.0)
    assert corner_sigma_px(hessian, "affine", 2.0, 29.5) < 0.05

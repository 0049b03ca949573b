"""Prints and backgrounds of every scene: declared once, usual where nothing is said, and doing what they are for."""

import numpy as np
import pytest

from vml_course.model.choice import choices_of
from vml_course.model.quantity import quantities_of
from vml_course.synth.look import look_of
from vml_course.synth.props.backgrounds import BACKGROUNDS
from vml_course.synth.props.floors import FLOORS
from vml_course.synth.render import draw_frames
from vml_course.synth.scene import scene_class, scene_names
from vml_course.synth.simulate import simulate
from vml_course.synth.views import PRINTS, PrintedScene, SideView, TopView

PRINTED = [name for name in scene_names() if issubclass(scene_class(name), PrintedScene)]
PLACE = {"soccer_kick": "shin"}  # else the first point that is tracked
REACH = 18  # px about it
FOUND = 0.004  # px of standard deviation at one grey level of noise, in the worst direction

every_printed = pytest.mark.parametrize("name", PRINTED)


def look(name, **how):
    kind = scene_class(name)
    return look_of(kind(**how), kind.default_camera, 3)


def uncertain_px(name, texture):
    """Cramer-Rao bound at one grey level of noise, in the direction in which a place is hardest to find."""
    kind = scene_class(name)
    truth = simulate(kind(texture=texture), kind.default_camera, 5)
    x, y = np.round(truth.point_px(PLACE.get(name, truth.points[0]))).astype(int)
    block = next(draw_frames(truth)).luma[y - REACH : y + REACH + 1, x - REACH : x + REACH + 1].astype(np.float64)
    slopes = np.reshape(np.gradient(block), (2, -1))
    return max(np.linalg.eigvalsh(slopes @ slopes.T)[0], 1e-9) ** -0.5


def test_experiments_from_the_side_and_from_above_are_all_printed():
    assert {"soccer_kick", "bat_and_ball", "spin_bounce", "two_pucks", "swinging_door"} <= set(PRINTED)
    for name in PRINTED:
        kind, words = scene_class(name), choices_of(scene_class(name))
        assert words["texture"].words == PRINTS
        assert words["background"].words == tuple(BACKGROUNDS if issubclass(kind, SideView) else FLOORS)
        assert issubclass(kind, SideView | TopView)
        assert {"speckle", "speckle_px"} <= set(quantities_of(kind))


@every_printed
def test_backgrounds_fill_the_picture_and_differ(name):
    words = choices_of(scene_class(name))["background"].words
    drawn = [look(name, background=word).background for word in words]
    for k, room in enumerate(drawn):
        assert room.opacity.min() == pytest.approx(1.0, abs=1e-5)
        for other in drawn[k + 1 :]:
            assert np.abs(room.colour - other.colour).mean() > 3


@every_printed
def test_speckle_and_logo_can_be_found_while_stripes_and_plain_bodies_are_traps(name):
    uncertain = {texture: uncertain_px(name, texture) for texture in PRINTS}
    assert max(uncertain["speckle"], uncertain["logo"]) < FOUND
    assert min(uncertain["stripes"], uncertain["plain"]) > 2 * uncertain["logo"]


@every_printed
def test_no_speckle_is_left_at_contrast_zero(name):
    """Two seeds then draw the same bodies."""
    kind = scene_class(name)
    first, second = (look_of(kind(speckle=0.0), kind.default_camera, seed).sprites for seed in (1, 2))
    usual = look_of(kind(), kind.default_camera, 1).sprites
    for body in kind.bodies:
        assert np.array_equal(first[body].luma, second[body].luma)
        assert not np.array_equal(first[body].luma, usual[body].luma)

"""What holds for every body that is strained, over the whole range of its parameters."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vml_course.errors import InputError, SceneRefusedError
from vml_course.model.frame import Frame
from vml_course.model.quantity import quantities_of
from vml_course.model.recording import Recording
from vml_course.model.track import Seed
from vml_course.synth.kirsch import Kirsch
from vml_course.synth.loading import differences
from vml_course.synth.render import draw_frames, render
from vml_course.synth.scene import impact_scene_names, scene_class, scene_names
from vml_course.synth.simulate import simulate
from vml_course.synth.strained import origins
from vml_course.track.run import run
from vml_course.track.tracker import make_tracker

SHEETS = sorted(set(scene_names()) - set(impact_scene_names()))
REALISED = 1e-9
DIFFERENCE = 1e-6  # of numerical derivatives, relative
BACK_PX = 1e-4
TRACKED_PX = 0.01
STRAIN = 1e-4
SHORT = {"rest_s": 0.1, "ramp_s": 0.2, "hold_s": 0.1, "unload_s": 0.2}

every_sheet = pytest.mark.parametrize("name", SHEETS)
few = settings(max_examples=25, deadline=None, derandomize=True)
places = st.tuples(st.floats(1.0, 6.0), st.floats(0.0, 2 * np.pi))
numbers = st.builds(
    Kirsch, st.floats(0.012, 0.03), st.floats(2e6, 40e6), st.floats(2e9, 4e9), st.floats(0.0, 0.5)
)  # fmt: skip


def any_sheet(data, name):
    """A sheet anywhere in its ranges."""
    values = {}
    for field, item in quantities_of(scene_class(name)).items():
        inside = st.integers(int(item.low), int(item.high)) if item.whole else st.floats(item.low, item.high)
        values[field] = data.draw(inside)
    return scene_class(name)(**values)


@every_sheet
@few
@given(data=st.data())
def test_it_is_honest_or_leaves_the_picture(name, data):
    scene = any_sheet(data, name)
    try:
        truth = simulate(scene, replace(scene.default_camera, fps=24.0), 0)
    except SceneRefusedError as error:
        told = str(error).split("failed checks: ")[1].split("; ")
        assert all("outside the picture, px" in check for check in told)
        return
    assert truth.impact is None
    assert truth.model == ""
    assert truth.strain.load.max() == pytest.approx(1.0, abs=REALISED)
    assert all(check.passed for check in truth.checks)


@every_sheet
def test_the_middle_of_the_range_stays_in_the_picture(name):
    """So that the property above is not empty."""
    kind = scene_class(name)
    default = kind()
    for share in (0.95, 1.05):
        values = {
            field: float(np.clip(getattr(default, field) * share, item.low, item.high))
            for field, item in quantities_of(kind).items()
            if not item.whole
        }
        assert simulate(kind(**values), kind.default_camera, 0).strain.unknowns


@every_sheet
@few
@given(data=st.data())
def test_the_truths_gradient_is_that_of_the_places(name, data):
    """At every load, with slip and turn: the places of points close by differ by the gradient."""
    scene = any_sheet(data, name)
    points, load, step = np.array(list(scene.points_m().values())), np.array([0.0, 0.3, 1.0]), 1e-6
    stated = scene.whole_gradient(points, load)
    for k, way in enumerate(step * np.eye(2)):
        found = (scene.place(points + way, load[:, None]) - scene.place(points - way, load[:, None])) / (2 * step)
        assert np.abs(found - np.eye(2)[k] - stated[..., k]).max() < DIFFERENCE * 0.1


@every_sheet
@few
@given(data=st.data(), load=st.floats(0.0, 1.0))
def test_the_way_back_leads_to_the_point_that_is_seen(name, data, load):
    scene = any_sheet(data, name)
    points = np.array(list(scene.points_m().values()))
    assert np.abs(scene.origin_of(scene.place(points, load), load) - points).max() < REALISED


@every_sheet
@few
@given(data=st.data())
def test_the_load_rises_holds_and_goes_back(name, data):
    scene = any_sheet(data, name)
    time = np.linspace(0.0, scene.length_s, 2001)
    load, full = scene.history(time), scene.rest_s + scene.ramp_s
    assert (load[time <= scene.rest_s] == 0.0).all()
    assert (np.diff(load[time <= full]) >= -REALISED).all()
    held = (time >= full + REALISED) & (time <= full + scene.hold_s - REALISED)
    assert load[held] == pytest.approx(1.0, abs=REALISED)
    assert (np.diff(load[time >= full + scene.hold_s]) < 0.0).all()
    assert load[-1] == pytest.approx(0.0, abs=REALISED)


def test_load_steps_are_held_half_their_time():
    scene = scene_class("tensile_strip")(load_steps=4, ramp_s=4.0, rest_s=1.0)
    assert scene.history(np.array([1.5, 1.75, 1.99, 2.25, 2.75, 4.9])) == pytest.approx(
        [0.25, 0.25, 0.25, 0.375, 0.5, 1.0]
    )


@few
@given(kirsch=numbers, place=places)
def test_kirschs_stress_is_timoshenkos(kirsch, place):
    """Timoshenko and Goodier, Theory of Elasticity, §35, in polar coordinates."""
    (times, angle), s = place, kirsch.stress_Pa
    q = 1 / times**2
    radial = s / 2 * (1 - q) + s / 2 * (1 + 3 * q**2 - 4 * q) * np.cos(2 * angle)
    hoop = s / 2 * (1 + q) - s / 2 * (1 + 3 * q**2) * np.cos(2 * angle)
    shear = -s / 2 * (1 - 3 * q**2 + 2 * q) * np.sin(2 * angle)
    c, n = np.cos(angle), np.sin(angle)
    xx, yy, xy = kirsch.stress(times * kirsch.radius_m * np.array([c, n]))
    assert xx * c**2 + yy * n**2 + 2 * xy * c * n == pytest.approx(radial, abs=REALISED * s)
    assert xx * n**2 + yy * c**2 - 2 * xy * c * n == pytest.approx(hoop, abs=REALISED * s)
    assert (yy - xx) * c * n + xy * (c**2 - n**2) == pytest.approx(shear, abs=REALISED * s)


@few
@given(kirsch=numbers, place=places)
def test_kirschs_field_is_in_equilibrium_and_obeys_hooke(kirsch, place):
    times, angle = place
    at = (times + 0.01) * kirsch.radius_m * np.array([np.cos(angle), np.sin(angle)])
    assert np.abs(kirsch.stress_of(kirsch.gradient(at)) - kirsch.stress(at)).max() < REALISED * kirsch.stress_Pa
    step = 1e-4 * kirsch.radius_m
    x, y = (
        (kirsch.stress(at + way) - kirsch.stress(at - way)) * kirsch.radius_m / (2 * step * kirsch.stress_Pa)
        for way in step * np.eye(2)
    )
    assert x[0] + y[2] == pytest.approx(0.0, abs=DIFFERENCE)
    assert x[2] + y[1] == pytest.approx(0.0, abs=DIFFERENCE)


@few
@given(kirsch=numbers, angle=st.floats(0.0, 2 * np.pi))
def test_nothing_presses_on_the_hole_and_far_away_is_the_remote_stress(kirsch, angle):
    c, n = np.cos(angle), np.sin(angle)
    xx, yy, xy = kirsch.stress(kirsch.radius_m * np.array([c, n])) / kirsch.stress_Pa
    assert max(abs(xx * c + xy * n), abs(xy * c + yy * n)) < REALISED
    far = kirsch.stress(1e5 * kirsch.radius_m * np.array([c, n])) / kirsch.stress_Pa
    assert far == pytest.approx([1.0, 0.0, 0.0], abs=REALISED)


def test_the_numerical_gradient_of_each_field_is_the_stated_one():
    for name in SHEETS:
        scene = scene_class(name)()
        around = 0.05 * np.stack([np.cos(np.arange(12)), np.sin(np.arange(12))], axis=-1)
        assert differences(scene, around) == pytest.approx(scene.gradient(around), abs=DIFFERENCE * 0.1)


def test_pixels_see_the_point_that_the_field_says():
    """The way back between its nodes, up to the rim of the smallest hole under the greatest load."""
    kind = scene_class("plate_with_hole")
    scene, camera = kind(radius_m=0.012, stress_Pa=40e6, modulus_Pa=2e9), kind.default_camera
    seen = np.stack(np.meshgrid(np.arange(540.0, 740.0), np.arange(230.0, 430.0)), axis=-1)
    exact = scene.origin_of(camera.to_m(seen), 1.0)
    off = camera.to_square_px(exact) - origins(scene, camera, 1.0, np.zeros(2))[230:430, 540:740]
    sheet = np.hypot(*np.moveaxis(exact, -1, 0)) >= scene.radius_m
    assert np.abs(off[sheet]).max() < BACK_PX


@pytest.mark.parametrize(("name", "block"), [("tensile_strip", 31), ("plate_with_hole", 21)])
def test_marks_are_tracked_to_a_hundredth_of_a_pixel(name, block):
    kind = scene_class(name)
    truth = simulate(kind(**SHORT, turn_deg=0.2, slip_m=0.0005), kind.default_camera, 1)
    track = tracked(truth, block)
    assert not track.is_lost.any()
    off = track.xy_px - truth.xy_px
    assert np.sqrt((off**2).sum(axis=-1).mean(axis=0)).max() < TRACKED_PX


def test_four_tracked_marks_tell_strain_and_poissons_ratio():
    scene = scene_class("tensile_strip")(**SHORT)
    truth = simulate(scene, scene.default_camera, 2)
    xy, load = tracked(truth, 31).xy_px, truth.strain.load

    def extension(one, other):
        length = np.hypot(*(xy[:, truth.point_index(one)] - xy[:, truth.point_index(other)]).T)
        return length / length[0] - 1

    along, across = extension("a", "b"), extension("c", "d")
    assert along == pytest.approx(load * scene.strain, abs=STRAIN)
    assert across == pytest.approx(-load * scene.strain * scene.poisson, abs=STRAIN)
    assert -across[load == 1.0].mean() / along[load == 1.0].mean() == pytest.approx(scene.poisson, rel=0.01)


@pytest.mark.parametrize("effects", [{"distortion": -0.06, "roll_deg": 2.0}, {"shake_px": 0.5}])
def test_a_lens_and_a_hand_are_seen_as_the_truth_says(effects):
    scene = scene_class("tensile_strip")(**SHORT)
    truth = simulate(scene, replace(scene.default_camera, px_per_m=4500.0, **effects), 1)
    off = tracked(truth, 31).xy_px - truth.xy_px
    assert np.sqrt((off**2).sum(axis=-1).mean(axis=0)).max() < 2 * TRACKED_PX


@pytest.mark.parametrize("field", ["shutter", "rolling_shutter"])
@every_sheet
def test_an_open_shutter_is_refused_in_one_line(name, field):
    kind = scene_class(name)
    told = rf"^{field}: expected 0 in {name}, which is filmed by flash, got 0\.5\.$"
    with pytest.raises(InputError, match=told):
        simulate(kind(), replace(kind.default_camera, **{field: 0.5}), 0)


@every_sheet
def test_a_mark_outside_the_picture_is_named(name):
    kind = scene_class(name)
    with pytest.raises(SceneRefusedError, match=r"\w outside the picture, px is \d+.* \(limit 0\)") as caught:
        simulate(kind(), replace(kind.default_camera, width_px=640), 0)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(f"{name}: expected an honest strain, got")


def test_half_of_the_sheet_is_covered_by_dots():
    kind = scene_class("tensile_strip")
    luma = next(draw_frames(simulate(kind(), kind.default_camera, 1))).luma[250:300, 400:850]
    assert (luma < 130).mean() == pytest.approx(0.5, abs=0.04)


def test_contrast_and_size_of_the_speckle_can_be_set():
    kind = scene_class("tensile_strip")
    patch = {}
    for label, values in {"usual": {}, "faint": {"speckle": 0.3}, "coarse": {"speckle_px": 9.0}}.items():
        patch[label] = next(draw_frames(simulate(kind(**values), kind.default_camera, 1))).luma[250:300, 400:850]
    assert patch["faint"].std() == pytest.approx(0.3 * patch["usual"].std(), rel=0.1)
    edges = {label: np.abs(np.diff(luma, axis=1)).mean() for label, luma in patch.items()}
    assert edges["coarse"] < 0.6 * edges["usual"]


def test_no_turn_changes_the_green_strain():
    kind = scene_class("tensile_strip")
    straight, turned = (simulate(kind(turn_deg=turn), kind.default_camera, 0).strain for turn in (0.0, 1.0))
    assert turned.green_strain == pytest.approx(straight.green_strain, abs=REALISED)
    assert straight.green_strain[..., 0].max() == pytest.approx(0.02 + 0.02**2 / 2, rel=REALISED)
    assert straight.small_strain[..., 1].min() == pytest.approx(-0.02 * 0.38, rel=REALISED)


def tracked(truth, block):
    """The points of a clip without noise, followed by correlation."""
    pictures = render(truth, Recording(noise_grey=0.0))
    frames = [Frame(k, k / truth.camera.fps, picture.luma) for k, picture in enumerate(pictures)]
    return run(make_tracker("dic", block=block), frames, [Seed(p, *truth.point_px(p)) for p in truth.points])

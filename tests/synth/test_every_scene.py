"""What holds for every scene over the whole range of its parameters: honest to a millionth, or refused in one line."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from vml_course.errors import InputError, OutOfRangeError, SceneRefusedError
from vml_course.io.truth import read_truth_json, write_truth_json
from vml_course.model.camera import Camera
from vml_course.model.quantity import quantities_of
from vml_course.synth.honesty import angular_momenta, place
from vml_course.synth.path import fine_path
from vml_course.synth.render import draw_frames, scene_of
from vml_course.synth.scene import impact_scene_names, scene_class, scene_names
from vml_course.synth.simulate import simulate

WIDE = Camera(px_per_m=50.0, width_px=1920, height_px=1080, origin_x_px=960.0, origin_y_px=540.0)  # 38 m across
REALISED = 1e-6  # relative: realised against nominal and closed form
CLIP_ENERGY = 1e-5  # of all energy: leap-frog over a whole clip at the highest speeds
FRAME_M = 1e-6
STEP_PX = 0.01  # what halving the time step may move, at the scene's own scale

every_scene = pytest.mark.parametrize("name", scene_names())
every_impact = pytest.mark.parametrize("name", impact_scene_names())
few = settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    phases=(Phase.explicit, Phase.generate),
    suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow],
)


def any_scene(data, name):
    """A scene anywhere in its ranges; combinations that the scene itself refuses are drawn again."""
    kind = scene_class(name)
    values = {field: data.draw(st.floats(item.low, item.high)) for field, item in quantities_of(kind).items()}
    try:
        return kind(**values)
    except InputError as error:
        refusal = str(error)
    assert "\n" not in refusal
    assume(condition=False)
    return None


def simulated(scene, **how):
    """The truth of a scene, or nothing where it is refused, in one line that names the scene."""
    try:
        return simulate(scene, WIDE, 0, **how)
    except (SceneRefusedError, InputError) as error:
        refusal = str(error)
    assert refusal.startswith((f"{scene.name}: expected an honest impact, got ", "contact_ms: expected "))
    assert "\n" not in refusal
    assume(condition=False)
    return None


@every_impact
@few
@given(data=st.data())
def test_what_is_realised_is_nominal_and_the_closed_form(name, data):
    scene = any_scene(data, name)
    truth = simulated(scene)
    law, impact = scene.law(), truth.impact
    for symbol, real in impact.unknowns.items():
        for value in (real.from_states, real.from_impulse):
            assert value == pytest.approx(real.nominal, rel=REALISED, abs=REALISED), symbol
    after, impulse = law.answer()
    assert np.hypot(*(impact.impulse_xy_N_s - impulse)) <= REALISED * np.hypot(*impulse)
    assert law.kinetic(impact.before - law.before) <= REALISED**2 * law.kinetic(law.before)
    assert law.kinetic(impact.after - after) <= REALISED**2 * law.kinetic(law.before)
    ideal = place(scene, law.motion(scene.clock(WIDE.fps).since_impact_s).pose)
    assert np.abs(truth.xy_m - ideal).max() < FRAME_M


@every_impact
@few
@given(data=st.data())
def test_momentum_is_kept_and_energy_never_created(name, data):
    scene = any_scene(data, name)
    truth = simulated(scene)
    law, impact = scene.law(), truth.impact
    met, parted = law.motion(np.array([0.0, law.duration_s])).pose
    before, after = angular_momenta(law, met, impact.before), angular_momenta(law, parted, impact.after)
    assert after.sum() == pytest.approx(before.sum(), abs=REALISED * np.abs(before).sum())
    struck = impact.mass[impact.struck, 0] * (impact.struck_after_m_s - impact.struck_before_m_s)
    assert struck == pytest.approx(impact.impulse_xy_N_s, rel=REALISED, abs=REALISED * abs(impact.impulse_N_s))
    assert law.kinetic(impact.after) <= law.kinetic(impact.before) * (1 + 1e-9)
    figures = {check.name: check.value for check in truth.checks}
    assert figures["energy balance of the clip, of all energy"] < CLIP_ENERGY


@every_impact
@settings(few, max_examples=4)
@given(data=st.data())
def test_half_the_time_step_moves_nothing_that_one_could_see(name, data):
    scene = any_scene(data, name)
    coarse, fine = simulated(scene), simulated(scene, refine=2)
    # The impact is aimed at a whole step; where the phase falls between two, it is half a step late.
    late_s = abs(fine.impact.time_s - coarse.impact.time_s)
    reach = np.abs([marker.local_m for marker in scene.markers()]).max() + 1.0
    speed = (np.abs(coarse.impact.before) + np.abs(coarse.impact.after)).max() * reach
    px_per_m = scene.default_camera.px_per_m
    assert np.abs(fine.xy_m - coarse.xy_m).max() * px_per_m <= STEP_PX + late_s * speed * px_per_m


@every_impact
def test_most_of_the_range_is_honest(name):
    """So that the properties above are not empty: of fixed places in the middle of the range, none is refused."""
    kind = scene_class(name)
    default = kind()
    for share in (0.95, 1.05):
        values = {
            field: float(np.clip(getattr(default, field) * share, item.low, item.high))
            for field, item in quantities_of(kind).items()
        }
        assert simulate(kind(**values), WIDE, 0).impact.unknowns


@every_impact
def test_the_same_scene_gives_the_same_numbers_whatever_the_seed(name):
    kind = scene_class(name)
    first, second = (simulate(kind(), kind.default_camera, seed) for seed in (1, 7))
    assert np.array_equal(first.pose, second.pose)
    assert np.array_equal(first.impact.after, second.impact.after)


@every_impact
def test_everything_stays_in_the_picture_from_the_first_frame_to_the_last(name):
    kind = scene_class(name)
    truth, last = simulate(kind(), kind.default_camera, 0), np.array(kind.default_camera.size_px) - 1
    for marker in kind().markers():
        xy, reach = truth.xy_px[:, truth.point_index(marker.name)], marker.outline_m * truth.camera.px_per_m
        assert (xy >= reach).all(), marker.name
        assert (xy <= last - reach).all(), marker.name
    before, frames = truth.impact.frame_before, len(truth.time_s)
    assert min(before, frames - 2 - before) >= math.floor(0.04 * truth.camera.fps)


@every_impact
def test_a_simulation_takes_few_steps(name):
    """About 20 microseconds each: under half a second a clip."""
    clock = scene_class(name)().clock(scene_class(name).default_camera.fps)
    assert (clock.frame_count - 1) * clock.steps_per_frame <= 20_000


@every_impact
def test_a_body_that_leaves_the_picture_is_named(name):
    kind = scene_class(name)
    near = replace(kind.default_camera, px_per_m=4.0 * kind.default_camera.px_per_m)
    with pytest.raises(SceneRefusedError, match=r"\w+ outside the picture, px is \d+.* \(limit 0\)") as caught:
        simulate(kind(), near, 0)
    assert "\n" not in str(caught.value)


@every_scene
def test_every_number_has_a_range_outside_of_which_it_is_refused(name):
    kind = scene_class(name)
    for field, item in quantities_of(kind).items():
        for wrong in (item.low - 1.0, item.high + 1.0):
            with pytest.raises(OutOfRangeError, match=field) as caught:
                kind(**{field: wrong})
            assert item.range_text in str(caught.value)
            assert "\n" not in str(caught.value)


@every_scene
def test_its_story_names_what_is_given_and_what_is_looked_for(name):
    kind = scene_class(name)
    words = set(
        kind.story.replace(",", " ").replace(".", " ").replace(";", " ").replace(":", " ").replace(")", " ").split()
    )
    assert set(kind().given()) <= words
    assert {symbol for symbol in kind.unknowns if symbol != "e_t"} <= words


@every_scene
def test_its_truth_is_read_back_and_draws_the_same_picture(name, tmp_path):
    kind = scene_class(name)
    camera = replace(kind.default_camera, fps=min(kind.default_camera.fps, 240.0))
    truth = simulate(kind(), camera, 3)
    write_truth_json(tmp_path / "truth.json", truth)
    back = read_truth_json(tmp_path / "truth.json")
    assert scene_of(back) == kind()
    assert back.declared == truth.declared
    real, kept = ((made.impact or made.strain).unknowns for made in (truth, back))
    assert kept == real
    assert np.array_equal(next(draw_frames(back)).luma, next(draw_frames(truth)).luma)


@every_impact
def test_the_fine_path_that_an_open_shutter_sees_passes_through_the_frames(name):
    kind = scene_class(name)
    truth = simulate(kind(impact_phase=0.37), replace(kind.default_camera, fps=240.0), 0)
    path = fine_path(scene_of(truth), 240.0)
    assert np.abs(path.at(truth.time_s) - truth.pose).max() < FRAME_M


@pytest.mark.parametrize(
    ("name", "values", "words"),
    [
        ("two_pucks", {"speed_m_s": 0.3, "normal_deg": 60.0, "drift_m_s": 1.0}, "Nothing would be hit"),
        ("struck_rod", {"offset_m": 0.3}, r"offset_m \(b\): expected at most 0.274 m"),
        ("swinging_door", {"arm_m": 0.7, "door_length_m": 0.6}, r"arm_m \(a\): expected at most door_length_m"),
        ("ballistic_pendulum", {"inertia_kg_m2": 0.01}, r"inertia_kg_m2 \(I\): expected at least M c\^2, 0.06272"),
        ("spin_bounce", {"spin_rad_s": 0.0, "incidence_deg": 0.0}, r"spin_rad_s \(omega1\): expected a slip"),
    ],
)
def test_numbers_that_do_not_go_together_are_told_in_one_line(name, values, words):
    with pytest.raises(InputError, match=words) as caught:
        scene_class(name)(**values)
    assert "\n" not in str(caught.value)


def test_a_ball_that_sticks_shows_its_tangential_restitution():
    kind = scene_class("spin_bounce")
    impact = simulate(kind(friction=1.0), WIDE, 0).impact
    assert set(impact.unknowns) == {"e", "e_t"}
    assert impact.unknown("e_t") == pytest.approx(0.0, abs=REALISED)
    vx, _, spin = impact.after[0]
    assert vx + kind().ball_radius_m * spin == pytest.approx(0.0, abs=1e-9)


def test_a_block_that_stops_stays_where_it_stopped():
    kind = scene_class("hammer_block")
    scene = kind(friction=1.0, omega_before_rad_s=2.0, block_mass_kg=2.0, restitution=0.8, time_after_s=0.3)
    truth = simulate(scene, kind.default_camera, 0)
    x = truth.xy_m[:, truth.point_index("block"), 0]
    assert x[-1] > x[0] + 0.02
    assert np.ptp(x[-20:]) < 1e-9
    assert truth.impact.unknown("mu") == pytest.approx(1.0, rel=REALISED)


def test_both_rise_as_high_as_the_energy_after_the_impact_allows():
    kind = scene_class("ballistic_pendulum")
    scene = kind(time_after_s=0.5)
    truth = simulate(scene, kind.default_camera, 0)
    joined = scene.inertia_kg_m2 + scene.pellet_mass_kg * scene.arm_m**2
    moment = 9.81 * (scene.mass_kg * scene.centre_m + scene.pellet_mass_kg * scene.arm_m)
    highest = math.acos(1 - 0.5 * joined * truth.impact.omega_after_rad_s**2 / moment)
    assert truth.pose[:, 0, 2].max() == pytest.approx(highest, rel=1e-4)
    pellet, depth = truth.pose[truth.impact.frame_before + 1 :, 1, :2], scene.arm_m
    assert np.hypot(*pellet.T) == pytest.approx(depth, rel=1e-9)

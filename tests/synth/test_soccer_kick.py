"""The kick against the textbook."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from vml_course.errors import InputError, OutOfRangeError, SceneRefusedError
from vml_course.model.camera import Camera
from vml_course.synth.closed_form import pair_mass, pinned_impact, pinned_loss
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate
from vml_course.synth.stage import GRAVITY_M_S2

SoccerKick = scene_class("soccer_kick")
CAMERA = SoccerKick.default_camera
# Wide enough for every kick that is drawn below: 8 m across.
WIDE = Camera(px_per_m=150.0, width_px=1280, height_px=720, origin_x_px=300.0, origin_y_px=300.0)

TWIN = 1e-6  # relative: the paper's example, realised
FLOATING = 1e-9  # relative: pymunk's arithmetic against the closed form
STEP_PX = 0.01  # what halving the time step may move

kicks = st.builds(
    SoccerKick,
    restitution=st.floats(0.05, 1.0),
    inertia_kg_m2=st.floats(0.3, 5.0),
    ball_mass_kg=st.floats(0.1, 1.0),
    leg_length_m=st.floats(0.4, 0.7),
    ball_diameter_m=st.floats(0.15, 0.3),
    omega_before_rad_s=st.floats(8.0, 35.0),
    normal_tilt_deg=st.floats(-5.0, 5.0),
    gravity_moment_N_m=st.floats(0.0, 20.0),
    drive_torque_N_m=st.floats(-20.0, 20.0),
    impact_phase=st.floats(0.0, 0.99),
)
few = settings(
    max_examples=15, deadline=None, derandomize=True, phases=(Phase.explicit, Phase.generate)
)  # simulating is slow


@pytest.fixture(scope="module")
def twin():
    return simulate(SoccerKick(), CAMERA, seed=1)


def test_the_paper_twin_realises_its_e_and_its_inertia(twin):
    impact = twin.impact
    assert impact.restitution == pytest.approx(11 / 15, rel=TWIN)
    assert impact.unknowns["e"].from_impulse == pytest.approx(11 / 15, rel=TWIN)
    assert impact.inertia_kg_m2 == pytest.approx(1.8816, rel=TWIN)
    assert impact.unknowns["I"].from_impulse == pytest.approx(1.8816, rel=TWIN)


def test_the_paper_twin_has_the_papers_velocities_and_impulse(twin):
    impact = twin.impact
    assert impact.omega_before_rad_s * 0.56 == pytest.approx(15.0, rel=TWIN)
    assert impact.omega_after_rad_s * 0.56 == pytest.approx(13.0, rel=TWIN)
    assert impact.struck_after_m_s == pytest.approx([24.0, 0.0], abs=24 * TWIN)
    assert impact.impulse_N_s == pytest.approx(12.0, rel=TWIN)


def test_every_check_of_a_truth_has_a_figure_and_keeps_its_limit(twin):
    assert len(twin.checks) >= 15
    assert all(check.passed and math.isfinite(check.value) for check in twin.checks)
    assert len({check.name for check in twin.checks}) == len(twin.checks)


def test_the_clip_shows_the_impact_in_the_middle(twin):
    impact, frames = twin.impact, len(twin.time_s)
    assert twin.time_s[0] == 0.0
    assert twin.time_s[impact.frame_before] <= impact.time_s < twin.time_s[impact.frame_before + 1]
    assert min(impact.frame_before, frames - 1 - impact.frame_before - 1) >= 0.04 * twin.camera.fps


def test_the_ball_rests_on_its_tee_until_the_impact_and_falls_freely_after_it(twin):
    ball, impact = twin.xy_m[:, twin.point_index("ball")], twin.impact
    assert np.ptp(ball[: impact.frame_before + 1], axis=0).max() == 0.0
    flight = twin.time_s[impact.frame_before + 1 :] - impact.time_s
    drop = ball[impact.frame_before + 1 :, 1] - ball[0, 1]
    assert drop == pytest.approx(-0.5 * GRAVITY_M_S2 * flight**2, abs=1e-9)


def test_the_leg_hangs_straight_down_at_the_impact(twin):
    k, impact = twin.impact.frame_before, twin.impact
    at_impact = twin.leg_angle_deg[k] + math.degrees(impact.omega_before_rad_s * (impact.time_s - twin.time_s[k]))
    assert at_impact == pytest.approx(-90.0, abs=0.01)
    foot, knee = (twin.xy_m[:, twin.point_index(name)] for name in ("foot", "knee"))
    assert np.hypot(*(foot - knee).T) == pytest.approx(0.56, rel=FLOATING)


@few
@given(kicks)
def test_what_is_realised_is_what_was_promised(kick):
    impact = simulate(kick, WIDE, seed=0).impact
    arm = kick.leg_length_m * math.cos(math.radians(kick.normal_tilt_deg))
    J, w2, u2 = pinned_impact(  # noqa: N806
        kick.inertia_kg_m2, kick.ball_mass_kg, arm, kick.restitution, kick.omega_before_rad_s, 0.0
    )
    assert impact.arm_m == pytest.approx(arm, rel=1e-6)
    assert impact.restitution == pytest.approx(kick.restitution, rel=1e-6)
    assert impact.inertia_kg_m2 == pytest.approx(kick.inertia_kg_m2, rel=1e-6)
    assert impact.impulse_N_s == pytest.approx(J, rel=1e-6)
    assert impact.omega_after_rad_s == pytest.approx(w2, rel=1e-6, abs=1e-6)
    assert impact.struck_after_m_s @ impact.normal == pytest.approx(u2, rel=1e-6)


@few
@given(kicks)
def test_angular_momentum_about_the_pivot_is_conserved(kick):
    impact = simulate(kick, WIDE, seed=0).impact
    before = kick.inertia_kg_m2 * impact.omega_before_rad_s
    x, y = kick.law().ball_m
    u, v = impact.struck_after_m_s
    after = kick.inertia_kg_m2 * impact.omega_after_rad_s + kick.ball_mass_kg * (x * v - y * u)
    assert after == pytest.approx(before, rel=1e-6)


@few
@given(kicks)
def test_energy_is_lost_as_the_closed_form_says_and_never_gained(kick):
    impact = simulate(kick, WIDE, seed=0).impact
    m, inertia = kick.ball_mass_kg, kick.inertia_kg_m2
    before = 0.5 * inertia * impact.omega_before_rad_s**2
    after = 0.5 * inertia * impact.omega_after_rad_s**2 + 0.5 * m * impact.struck_after_m_s @ impact.struck_after_m_s
    approach = impact.arm_m * impact.omega_before_rad_s
    assert before - after >= -1e-9 * before
    loss = pinned_loss(pair_mass(inertia, m, impact.arm_m), kick.restitution, approach)
    assert before - after == pytest.approx(loss, abs=1e-7 * before)


@few
@given(kicks)
def test_frames_agree_with_runge_kutta_and_parabola(kick):
    truth = simulate(kick, WIDE, seed=0)
    ideal = kick.law().motion(kick.clock(WIDE.fps).since_impact_s).pose
    assert np.abs(truth.pose[:, 1, :2] - ideal[:, 1, :2]).max() < 1e-6
    assert np.abs(truth.pose[:, 0, 2] - ideal[:, 0, 2]).max() < 1e-6


@few
@given(kicks)
def test_a_finer_time_step_moves_nothing_that_one_could_see(kick):
    coarse, fine = simulate(kick, WIDE, seed=0), simulate(kick, WIDE, seed=0, refine=2)
    shift_m = np.abs(fine.xy_m - coarse.xy_m)
    # The impact is aimed at a whole step; half a step is allowed where the phase falls between two.
    late_s = abs(fine.impact.time_s - coarse.impact.time_s)
    speed = np.hypot(*coarse.impact.struck_after_m_s)
    assert shift_m.max() * CAMERA.px_per_m <= STEP_PX + late_s * speed * CAMERA.px_per_m * 1.5


def test_the_same_scene_gives_the_same_numbers():
    first, second = simulate(SoccerKick(), CAMERA, seed=1), simulate(SoccerKick(), CAMERA, seed=1)
    assert np.array_equal(first.pose, second.pose)
    assert first.impact.impulse_N_s == second.impact.impulse_N_s


def test_the_seed_does_not_change_the_motion(twin):
    assert np.array_equal(simulate(SoccerKick(), CAMERA, seed=99).pose, twin.pose)


@pytest.mark.parametrize("fps", [24.0, 60.0, 240.0, 1000.0, 2000.0])
def test_every_frame_rate_is_as_exact(fps):
    truth = simulate(SoccerKick(omega_before_rad_s=12.0), replace(CAMERA, fps=fps), seed=0)
    assert truth.impact.restitution == pytest.approx(11 / 15, rel=TWIN)
    assert np.diff(truth.time_s) == pytest.approx(1 / fps)


@pytest.mark.parametrize("phase", [0.0, 0.25, 0.99])
def test_the_impact_falls_where_the_phase_says(phase):
    truth = simulate(SoccerKick(impact_phase=phase), CAMERA, seed=0)
    assert truth.impact.time_s * 480 - truth.impact.frame_before == pytest.approx(phase, abs=0.005)


def test_a_kick_that_leaves_the_picture_is_refused_and_says_so():
    with pytest.raises(SceneRefusedError, match="ball outside the picture, px is"):
        simulate(SoccerKick(), replace(CAMERA, px_per_m=800.0), seed=0)


def test_a_scale_bar_outside_the_picture_is_refused():
    with pytest.raises(SceneRefusedError, match="scale marks"):
        simulate(SoccerKick(), replace(CAMERA, height_px=580), seed=0)


def test_a_leg_that_cannot_have_come_from_anywhere_is_refused():
    """So strong a drive at so low a speed means that the leg came back through the ball just before."""
    wild = SoccerKick(drive_torque_N_m=100.0, inertia_kg_m2=0.05, omega_before_rad_s=3.0)
    with pytest.raises(SceneRefusedError, match="soccer_kick: expected an honest impact"):
        simulate(wild, CAMERA, seed=0)


@pytest.mark.parametrize(
    ("name", "value"),
    [("restitution", 1.2), ("restitution", -0.1), ("ball_mass_kg", 0.0), ("normal_tilt_deg", 9.0)],
)
def test_parameters_outside_their_range_never_reach_the_simulation(name, value):
    with pytest.raises(OutOfRangeError, match=name):
        SoccerKick(**{name: value})


def test_a_parameter_that_is_no_number_is_refused():
    with pytest.raises(InputError, match=r"leg_length_m \(L\): expected a number"):
        SoccerKick(leg_length_m=float("nan"))

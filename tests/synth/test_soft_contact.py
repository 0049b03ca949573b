"""A contact that lasts gives the restitution that was asked for, and conserves what it should."""

import math
from dataclasses import replace

import numpy as np
import pytest

from vml_course.errors import InputError
from vml_course.synth.laws.touch import straight_damping, straight_duration
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate

SoccerKick = scene_class("soccer_kick")
CAMERA = SoccerKick.default_camera
EXACT = 1e-9
LEAP_FROG = 1e-4  # of the velocities: an integration of its own, 2000 steps a contact


@pytest.mark.parametrize(
    ("e", "damping", "duration"),
    [(0.1, 9.99816, 6.4575), (0.5, 1.43275, 3.6036), (0.73, 0.54938, 3.3512), (0.9, 0.16648, 3.2555)],
)
def test_a_straight_impact_has_the_damping_and_the_duration_that_were_measured(e, damping, duration):
    assert straight_damping(e) == pytest.approx(damping, rel=2e-5)
    assert straight_duration(straight_damping(e)) == pytest.approx(duration, rel=2e-5)


@pytest.mark.parametrize("contact_ms", [0.5, 2.0, 9.0])
@pytest.mark.parametrize("e", [0.2, 11 / 15, 0.95])
def test_e_and_inertia_are_realised_whatever_the_duration(e, contact_ms):
    impact = simulate(SoccerKick(restitution=e, contact_ms=contact_ms), CAMERA, 0).impact
    for symbol, nominal in (("e", e), ("I", 1.8816)):
        assert impact.unknowns[symbol].from_states == pytest.approx(nominal, rel=EXACT)
        assert impact.unknowns[symbol].from_impulse == pytest.approx(nominal, rel=EXACT)
    assert impact.duration_s == pytest.approx(1e-3 * contact_ms, rel=0.05)


def test_angular_momentum_is_kept_and_energy_lost():
    scene = SoccerKick(contact_ms=8.0)
    law, impact = scene.law(), simulate(scene, CAMERA, 0).impact
    (x, y), (u, v) = law.touch.end[1, :2], impact.struck_after_m_s
    after = scene.inertia_kg_m2 * impact.omega_after_rad_s + scene.ball_mass_kg * (x * v - y * u)
    assert after == pytest.approx(scene.inertia_kg_m2 * impact.omega_before_rad_s, rel=EXACT)
    assert law.kinetic(impact.after) < law.kinetic(impact.before)


def test_another_integration_finds_the_same_velocities():
    scene = SoccerKick(contact_ms=9.0)
    strike, touch = scene.law().rigid, scene.law().touch
    turn, omega, ball, speed = touch.start[0, 2], strike.omega_before_rad_s, touch.start[1, :2].copy(), np.zeros(2)
    step, reach = touch.duration_s / 2000, strike.head_radius_m + strike.other.radius_m
    for _ in range(2000):  # positions half a step ahead of the velocities
        turn, ball = turn + 0.5 * step * omega, ball + 0.5 * step * speed
        head = scene.leg_length_m * np.array([math.sin(turn), -math.cos(turn)])
        apart = np.hypot(*(ball - head))
        normal = (ball - head) / apart
        closing = (omega * np.array([-head[1], head[0]]) - speed) @ normal
        force = max(touch.stiffness * max(reach - apart, 0.0) ** 1.5 * (1 + touch.damping * closing), 0.0)
        omega -= step * force * (head[0] * normal[1] - head[1] * normal[0]) / strike.inertia_kg_m2
        speed = speed + step * force / scene.ball_mass_kg * normal
        turn, ball = turn + 0.5 * step * omega, ball + 0.5 * step * speed
    assert omega == pytest.approx(touch.rate_end[0, 2], rel=LEAP_FROG)
    assert speed == pytest.approx(touch.rate_end[1, :2], abs=LEAP_FROG * np.hypot(*speed))


def test_the_frames_of_the_contact_show_both_at_touch():
    scene = SoccerKick(contact_ms=9.0)
    truth = simulate(scene, CAMERA, 0)
    gap = np.hypot(*(truth.xy_m[:, truth.point_index("ball")] - truth.xy_m[:, truth.point_index("foot")]).T)
    since = truth.time_s - truth.impact.time_s
    inside = (since > 0) & (since < truth.impact.duration_s)
    assert inside.sum() == 4
    assert (gap[inside] < 0.185).all()
    assert (gap[~inside] > 0.185 - 1e-9).all()


def test_a_finer_clock_moves_nothing():
    scene = replace(SoccerKick(), contact_ms=6.0)
    coarse, fine = simulate(scene, CAMERA, 0), simulate(scene, CAMERA, 0, refine=2)
    assert np.abs(fine.xy_px - coarse.xy_px).max() < 1e-6


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (
            {"contact_ms": 12.0},
            r"contact_ms: expected at most 9.33 ms, in which the striker turns by 0.25 rad, got 12 ms",
        ),
        ({"contact_ms": 1e-9}, r"contact_ms: expected 0 or at least 0.1 ms, got 1e-09 ms"),
        ({"contact_ms": 5.0, "restitution": 1.0}, r"restitution \(e\): expected at most 0.95 where the contact lasts"),
    ],
)
def test_a_contact_that_cannot_be_is_told_in_one_line(values, words):
    with pytest.raises(InputError, match=words):
        SoccerKick(**values)

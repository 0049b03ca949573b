"""The solver against the simulated kick: two independent roads to the same e and I."""

import numpy as np
import pytest

from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.lines import solve_by_lines
from vml_course.kinetics.models import impact_model, model_names
from vml_course.model.motion import Motion
from vml_course.synth.scene import scene_class, scene_names
from vml_course.synth.simulate import simulate


def _simulated(**values):
    kind = scene_class("soccer_kick")
    truth = simulate(kind(**values), kind.default_camera, 1)
    n = len(truth.time_s)
    return truth, Motion(truth.points, np.arange(n), truth.time_s, truth.xy_m, np.full(truth.xy_m.shape[:2], np.nan))


@pytest.mark.parametrize(
    "values", [{}, {"restitution": 0.5, "inertia_kg_m2": 1.0}, {"normal_tilt_deg": 3.0}, {"gravity_moment_N_m": 9.4}]
)
@pytest.mark.parametrize("drive", ["free", "none"])
def test_a_simulated_kick_is_solved_to_1e_4(values, drive):
    truth, motion = _simulated(**values)
    solution = impact_model(truth.model).solve(motion, truth.given, ImpactOptions(drive=drive))
    assert solution.value("e") == pytest.approx(truth.impact.restitution, rel=1e-4)
    assert solution.value("I") == pytest.approx(truth.impact.inertia_kg_m2, rel=1e-4)
    assert solution.value("J") == pytest.approx(truth.impact.impulse_N_s, rel=1e-4)
    assert solution.value("t_impact") == pytest.approx(truth.impact.time_s, abs=1e-6)
    assert solution.frame_before == truth.impact.frame_before


def _solvable(name):
    """Whether there is a model of the scene's impact that understands all that is given; D is there to be left out."""
    kind = scene_class(name)
    if kind.model not in model_names():
        return False
    model = impact_model(kind.model)
    return set(kind().given()) - {"D"} <= {*model.given, *getattr(model, "optional", ())}


@pytest.mark.parametrize("name", [name for name in scene_names() if _solvable(name)])
@pytest.mark.parametrize("phase", [0.2, 0.8])
def test_every_scene_is_solved_by_its_model(name, phase):
    """With a hundredth of a pixel of noise: the tests that look for a second impact expect some."""
    kind = scene_class(name)
    truth = simulate(kind(impact_phase=phase), kind.default_camera, 1)
    n, noise_m = len(truth.time_s), 0.01 / truth.camera.px_per_m
    xy_m = truth.xy_m + np.random.default_rng(5).normal(0.0, noise_m, truth.xy_m.shape)
    motion = Motion(truth.points, np.arange(n), truth.time_s, xy_m, np.full(xy_m.shape[:2], noise_m))
    solution = impact_model(truth.model).solve(motion, truth.given, ImpactOptions(**truth.declared))
    for symbol in truth.impact.unknowns:
        true, found = truth.impact.unknown(symbol), solution.estimates[symbol]
        assert abs(found.value - true) <= 4 * found.sd + 1e-3 * true, symbol
        assert found.sd < 0.02 * true, symbol


@pytest.mark.parametrize("phase", [0.05, 0.2, 0.95])
def test_the_top_of_a_rise_without_noise_is_no_second_impact(phase):
    """There a swing is so nearly a parabola that two lines, and even a kink, explain it better than a cubic."""
    kind = scene_class("ballistic_pendulum")
    truth = simulate(kind(impact_phase=phase), kind.default_camera, 1)
    n, sigma = len(truth.time_s), np.full(truth.xy_m.shape[:2], np.nan)
    motion = Motion(truth.points, np.arange(n), truth.time_s, truth.xy_m, sigma)
    solution = impact_model(truth.model).solve(motion, truth.given, ImpactOptions(**truth.declared))
    assert solution.value("I") == pytest.approx(truth.impact.inertia_kg_m2, rel=2e-4)


@pytest.mark.parametrize("contact_ms", [2.0, 9.0])
def test_a_contact_that_lasts_is_left_out_and_does_little_harm(contact_ms):
    """What is left is the turning during the contact: physics allows no more than 0.25 rad of it."""
    truth, motion = _simulated(contact_ms=contact_ms)
    solution = impact_model(truth.model).solve(motion, truth.given, ImpactOptions(**truth.declared))
    assert solution.figures["contact_frames"] >= 1
    assert solution.value("e") == pytest.approx(truth.impact.restitution, rel=3e-3)
    assert solution.value("I") == pytest.approx(truth.impact.inertia_kg_m2, rel=1e-3)


def test_the_lines_of_a_student_come_within_half_a_percent():
    truth, motion = _simulated()
    solution = solve_by_lines(motion, truth.given)
    assert solution.value("e") == pytest.approx(truth.impact.restitution, rel=5e-3)
    assert solution.value("I") == pytest.approx(truth.impact.inertia_kg_m2, rel=5e-3)

import numpy as np
import pytest

from vml_course.chart.shapes import GREEN, Dot, Line, Words
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model
from vml_course.kinetics.plot import impact_plot
from vml_course.model.motion import Motion
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate


@pytest.fixture
def plot(kick, with_noise):
    motion = with_noise(kick(), np.random.default_rng(1))
    solution = impact_model("fixed-pivot").solve(motion, {"m": 0.5, "L": 0.56}, ImpactOptions(drive="none"))
    return impact_plot(motion, solution, "foot", "ball")


def test_a_plot_says_what_was_found_and_when(plot):
    words = [shape.text for shape in plot.shapes if isinstance(shape, Words)]
    assert words[0].startswith("e = 0.7")
    assert any("after frame 439" in text for text in words)
    assert "angle of foot about the pivot (°)" in words
    assert words.count("residual (mm)") == 1


def test_lines_are_named_and_drawn_only_where_a_model_has_them(plot):
    words = [shape.text for shape in plot.shapes if isinstance(shape, Words)]
    assert "lines, 20 ms" in words
    kind = scene_class("two_pucks")
    truth = simulate(kind(), kind.default_camera, 1)
    count = len(truth.time_s)
    motion = Motion(truth.points, np.arange(count), truth.time_s, truth.xy_m, np.full(truth.xy_m.shape[:2], 2e-4))
    solution = impact_model("two-pucks").solve(motion, truth.given, ImpactOptions(**truth.declared))
    pucks = impact_plot(motion, solution, "puck_a", "puck_b")
    assert not any("lines" in shape.text for shape in pucks.shapes if isinstance(shape, Words))
    assert not any(shape.colour == GREEN for shape in pucks.shapes if isinstance(shape, Line))


def test_nothing_is_drawn_outside_of_the_picture(plot):
    for shape in plot.shapes:
        places = shape.points if isinstance(shape, Line) else [getattr(shape, "at", (1, 1))]
        for x, y in places:
            assert 0 <= x <= plot.width
            assert 0 <= y <= plot.height


def test_every_measured_frame_near_the_impact_and_its_residual_is_a_dot(plot):
    circles = [shape for shape in plot.shapes if isinstance(shape, Dot)]
    assert len(circles) >= 2 * 38 + 2 * 48

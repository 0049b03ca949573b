import numpy as np
import pytest

from vml_course.chart.shapes import Line, Polygon, Words
from vml_course.kinetics.forces import PinnedRod, forces_of
from vml_course.kinetics.free_body import free_body_diagram, free_body_svg
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model

LEG = PinnedRod(4.0, 0.25, 1.88)


def _diagram(motion):
    solution = impact_model("fixed-pivot").solve(motion, {"m": 0.5, "L": 0.56}, ImpactOptions(drive="none"))
    return free_body_diagram(solution, forces_of(solution, 0.010, LEG))


def test_a_diagram_holds_the_numbers_and_their_uncertainty(kick, with_noise):
    words = [
        shape.text
        for shape in _diagram(with_noise(kick(), np.random.default_rng(1))).shapes
        if isinstance(shape, Words)
    ]
    for name in (
        "impulse J",
        "mean force J / contact time",
        "pin reaction R",
        "energy lost",
        "ω before",
        "v after, along J",
    ):
        assert name in words
    assert sum("±" in text for text in words) >= 8
    assert sum(text.startswith("J = 11.9") for text in words) == 2  # action and reaction


@pytest.mark.parametrize("mirror", [False, True])
def test_action_and_reaction_point_against_each_other(kick, mirror):
    diagram = _diagram(kick(mirror=mirror))
    shafts = [line for line in diagram.shapes if isinstance(line, Line) and line.width == 3]
    ways = [np.subtract(line.points[1], line.points[0]) for line in shafts]
    on_leg, pin, on_ball = ways
    assert on_leg @ on_ball < 0
    assert np.sign(on_ball[0]) == (-1 if mirror else 1)
    assert pin @ on_ball > 0  # struck beyond the centre of percussion the pin would push the other way
    assert len([shape for shape in diagram.shapes if isinstance(shape, Polygon)]) == 4


def test_what_is_not_known_is_not_drawn(kick):
    solution = impact_model("fixed-pivot").solve(kick(), {"m": 0.5, "L": 0.56}, ImpactOptions(drive="none"))
    svg = free_body_svg(solution, forces_of(solution))
    assert "pin reaction" not in svg
    assert "mean force" not in svg
    assert "impulse J" in svg

import numpy as np
import pytest

from vml_course.chart.shapes import RED, Dot, Drawing, Line, Polygon, Words
from vml_course.kinetics.forces import forces_of
from vml_course.kinetics.free_bodies import free_bodies_diagram
from vml_course.kinetics.impact_model import ImpactOptions
from vml_course.kinetics.models import impact_model
from vml_course.model.motion import Motion
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate


def drawn(scene: str) -> tuple[Drawing, float]:
    """Draw a scene's impact without noise; return its impulse, too."""
    kind = scene_class(scene)
    truth = simulate(kind(), kind.default_camera, 1)
    count = len(truth.time_s)
    motion = Motion(truth.points, np.arange(count), truth.time_s, truth.xy_m, np.full(truth.xy_m.shape[:2], 2e-4))
    options = ImpactOptions(**truth.declared)
    solution = impact_model(truth.model).solve(motion, truth.given, options)
    return free_bodies_diagram(solution, forces_of(solution, 0.004), options, truth.given), solution.value("J")


@pytest.mark.parametrize("scene", ["struck_rod", "two_pucks"])
def test_both_bodies_receive_the_same_impulse_in_opposite_directions(scene):
    diagram, impulse = drawn(scene)
    shafts = [shape for shape in diagram.shapes if isinstance(shape, Line) and shape.colour == RED]
    one, other = (np.subtract(line.points[1], line.points[0]) for line in shafts)
    np.testing.assert_allclose(one, -other, atol=1e-9)
    words = [shape.text for shape in diagram.shapes if isinstance(shape, Words)]
    assert words.count(f"J = {impulse:.4g} N s") == 2
    assert {"impulse J", "mean force J / contact time", "energy lost"} <= set(words)
    assert ("moment about G, J b" in words) == (scene == "struck_rod")


@pytest.mark.parametrize("scene", ["struck_rod", "two_pucks"])
def test_the_bodies_lie_apart_above_the_numbers(scene):
    diagram, _ = drawn(scene)
    table = next(
        shape for shape in diagram.shapes if isinstance(shape, Line) and len({y for _, y in shape.points}) == 1
    )
    assert diagram.shapes.index(table) > 5
    places = [place for shape in diagram.shapes[: diagram.shapes.index(table)] for place in places_of(shape)]
    assert all(0 < x < diagram.width and 0 < y < 430 for x, y in places)


def places_of(shape):
    return shape.points if isinstance(shape, Line | Polygon) else [shape.at]


def test_a_rod_is_struck_where_the_ball_met_it():
    diagram, _ = drawn("struck_rod")
    rod = next(shape for shape in diagram.shapes if isinstance(shape, Line) and shape.width > 20)
    kind = scene_class("struck_rod")
    truth = simulate(kind(), kind.default_camera, 1)
    marks = np.hypot(*(truth.xy_m[0, truth.point_index("tip")] - truth.xy_m[0, truth.point_index("tail")]))
    centre = np.mean(rod.points, axis=0)
    length = np.hypot(*np.subtract(*rod.points))
    contacts = [shape.at for shape in diagram.shapes if isinstance(shape, Dot) and shape.radius == 4]
    arms = [np.hypot(*(np.array(place) - centre)) / length for place in contacts]
    assert min(arms) == pytest.approx(truth.given["b"] / marks, rel=0.01)

import xml.etree.ElementTree as ET

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vml_course.chart.axes import Scale, nice_ticks
from vml_course.chart.raster import to_png
from vml_course.chart.shapes import BLUE, RED, Dot, Drawing, Line, Polygon, Words, arrow
from vml_course.chart.svg import to_svg


def _pixels(*shapes):
    data = to_png(Drawing(40, 30, shapes, "test"), 1.0)
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)


@given(st.text(st.characters(min_codepoint=32, max_codepoint=0x2FFF)))
def test_any_words_make_an_svg_that_can_be_read(words):
    drawing = Drawing(40, 30, (Words((1, 2), words), Words((1, 2), words, is_upright=True)), words, words)
    root = ET.fromstring(to_svg(drawing))  # noqa: S314 - our own text
    assert [element.text or "" for element in root.iter("{http://www.w3.org/2000/svg}text")] == [words, words]


def test_both_ways_draw_the_same_shapes_in_their_place():
    shapes = (
        Dot((10, 10), 4, BLUE),
        Polygon(((20, 5), (30, 5), (30, 15), (20, 15)), RED),
        Line(((0, 25), (40, 25)), RED, 2),
    )
    image = _pixels(*shapes)
    assert image[10, 10].tolist() == [178, 114, 0]
    assert image[10, 25].tolist() == [30, 38, 179]
    assert image[25, 35].tolist() == [30, 38, 179]
    assert image[20, 5].tolist() == [255, 255, 255]
    assert to_svg(Drawing(40, 30, shapes, "test")).count("<p") == 2


def test_a_dashed_line_has_gaps():
    row = _pixels(Line(((0, 10), (40, 10)), RED, 2, dash=(6, 10)))[10, :, 0]
    assert 8 <= (row == 255).sum() <= 20  # two gaps of 10, less the round ends of the strokes
    assert (row < 100).sum() >= 18


@pytest.mark.parametrize("upright", [False, True])
def test_words_are_written_near_their_place(upright):
    image = _pixels(Words((20, 15), "ω = 2", 8, anchor="middle", is_upright=upright))
    rows, columns = np.nonzero((image < 128).any(axis=2))
    assert abs(columns.mean() - 20) < 6
    assert abs(rows.mean() - 13) < 6


def test_an_arrow_ends_where_it_points():
    line, tip = arrow((0, 0), (10, 0), BLUE)
    assert tip.points[0] == (10, 0)
    assert line.points[-1][0] < 10


@given(st.floats(-1e6, 1e6), st.floats(1e-6, 1e6), st.integers(2, 8))
def test_ticks_enclose_what_is_shown(low, span, count):
    ticks = nice_ticks(low, low + span, count)
    slack = 1e-6 * (ticks[1] - ticks[0]) + 1e-9 * abs(low)
    assert ticks[0] <= low + slack
    assert ticks[-1] >= low + span - slack


def test_a_scale_maps_its_ends():
    scale = Scale(2.0, 4.0, 100.0, 0.0)
    assert (scale(2.0), scale(3.0), scale(4.0)) == (100.0, 50.0, 0.0)

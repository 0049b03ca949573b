"""The handout: complete, self-contained, and without a word of the answers."""

from __future__ import annotations

import base64
import dataclasses
import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from assignments.errors import AssignmentFileError
from assignments.handout import FirstPicture, render_handout, write_handout
from assignments.load import load_assignment
from assignments.variants import draw_variant, given_values

KICK = load_assignment("soccer-kick")
VARIANT = draw_variant(KICK, bytes(32), "s1")
GIVEN = given_values(KICK, VARIANT)
STICK = (320.25, 585.5, 724.25, 585.5)
POINTS = {"foot": (208.76, 384.0), "knee": (420.0, 200.0), "ball": (1250.1, 480.14)}
PICTURE = FirstPicture(np.random.default_rng(1).integers(0, 255, (720, 1280, 3), dtype=np.uint8), POINTS, STICK)


@pytest.fixture(scope="module")
def html() -> str:
    return render_handout(
        KICK, VARIANT, GIVEN, PICTURE, terms=("Due Friday 12 June, 18:00.", "2 attempts; the best attempt counts.")
    )


def test_it_states_every_given_number_with_its_unit(html: str) -> None:
    for item in KICK.givens:
        cells = rf'>{re.escape(item.label)}</td>.*?<td class="n">{GIVEN[item.id]:g}</td><td class="s">{item.unit}</td>'
        assert re.search(cells, html)


def test_it_states_every_question_with_points_and_tolerance(html: str) -> None:
    for question in KICK.questions:
        row = (
            rf'{re.escape(question.label)}.*?<td class="n">{question.points:g}</td><td>within {question.tolerance:.3%}'
        )
        assert re.search(row.replace(f"{question.tolerance:.3%}", f"{question.tolerance * 100:g} %"), html)


def test_its_command_line_names_the_points_and_leaves_the_scale_to_the_student(html: str) -> None:
    command = re.search(r"<pre>(vml track .*?)</pre>", html)
    assert command
    assert '<span>--scale "X1,Y1,X2,Y2=1 m"</span>' in command[1].replace("&#34;", '"')
    command = re.fullmatch("(.*)", re.sub("</?span>", "", command[1]))
    assert command
    assert "vml track video.mp4 -p foot=209,384 -p knee=420,200 -p ball=1250,480 --fps 480" in command[1]
    assert "X1,Y1,X2,Y2=1 m" in command[1]


def test_it_needs_nothing_beside_it_and_runs_nothing(html: str) -> None:
    assert not re.search(r"<script|<link|@import|https?://(?!www\.w3\.org)", html)
    assert set(re.findall(r'(?:src|href)="([^"#]{1,16})', html)) == {"data:image/jpeg;", "data:image/png;b"}
    assert "default-src 'none'" in html


def test_it_shows_the_first_picture_in_full_size(html: str) -> None:
    data = re.search(r"data:image/jpeg;base64,([^\"]+)", html)
    assert data
    shown = cv2.imdecode(np.frombuffer(base64.b64decode(data[1]), np.uint8), cv2.IMREAD_COLOR)
    assert shown is not None
    assert shown.shape == PICTURE.bgr.shape


def test_enlarged_ends_hold_the_pixels_of_the_picture_at_the_place_they_say() -> None:
    for inset, (x, y) in zip(PICTURE.insets(), (STICK[:2], STICK[2:]), strict=True):
        assert inset.left <= x <= inset.left + inset.width - 1
        assert inset.top <= y <= inset.top + inset.height - 1
        assert inset.left % 10 == inset.top % 10 == 0
        data = np.frombuffer(base64.b64decode(inset.image.split(",")[1]), np.uint8)
        shown = cv2.imdecode(data, cv2.IMREAD_COLOR)
        rows, columns = slice(inset.top, inset.top + inset.height), slice(inset.left, inset.left + inset.width)
        np.testing.assert_array_equal(shown, PICTURE.bgr[rows, columns])


def test_an_end_near_the_border_is_shown_too() -> None:
    near = dataclasses.replace(PICTURE, stick_px=(2.0, 1.0, 1278.0, 718.0))
    left, right = near.insets()
    assert (left.left, left.top) == (0, 0)
    assert (right.left + right.width, right.top + right.height) == (1280, 720)


def test_it_shows_the_due_date_only_when_there_is_one(html: str) -> None:
    assert "Due Friday 12 June, 18:00" in html
    assert "2 attempts; the best attempt counts." in html
    assert "Due " not in render_handout(KICK, VARIANT, GIVEN, PICTURE)


def test_names_of_points_stand_away_from_the_other_points_and_inside_the_picture() -> None:
    for label in PICTURE.labels():
        x, y = POINTS[label.name]
        out = np.subtract(label.end, (x, y))
        for name, other in POINTS.items():
            if name != label.name:
                along = np.subtract(other, (x, y))
                assert out @ along / np.linalg.norm(out) / np.linalg.norm(along) < 0.8
        assert 0 < label.text[0] < 1280
        assert 0 < label.text[1] < 720


def test_no_name_lies_on_the_known_length() -> None:
    over_it = {"foot": (330.0, 560.0), "knee": (520.0, 612.0), "ball": (700.0, 560.0)}
    for label in FirstPicture(PICTURE.bgr, over_it, STICK).labels():
        assert abs(label.end[1] - STICK[1]) >= 50.0


def test_it_tells_of_the_check_and_the_whole_export(html: str) -> None:
    assert "vml check workbook.xlsx" in html
    assert "sheet <code>Data</code>" in html


def test_hostile_texts_are_shown_not_obeyed() -> None:
    hostile = dataclasses.replace(KICK, title="<script>alert(1)</script>")
    assert "<script" not in render_handout(hostile, VARIANT, GIVEN, PICTURE)


def test_a_number_that_the_template_lacks_is_an_error_not_a_gap() -> None:
    with pytest.raises(AssignmentFileError, match=r"soccer-kick/handout\.html\.j2, template: .*no attribute 'm'"):
        render_handout(KICK, VARIANT, {}, PICTURE)


def test_the_file_is_written_whole(tmp_path: Path, html: str) -> None:
    write_handout(tmp_path / "handout.html", html)
    assert (tmp_path / "handout.html").read_text(encoding="utf-8") == html
    assert [path.name for path in tmp_path.iterdir()] == ["handout.html"]

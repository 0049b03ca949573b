"""`vml track`: points placed in any frame, and marks by hand."""

import csv
import json

import numpy as np
import pytest

from vml_course.io.video import write_video
from vml_course.model.frame import Picture

SHIFT_PX = (1.5, -0.5)
FRAMES = 10
FOUND_PX = 0.1


def place(k):
    return 110.0 + SHIFT_PX[0] * k, 115.0 + SHIFT_PX[1] * k


@pytest.fixture(scope="module")
def video(tmp_path_factory, speckle, camera_of):
    half = np.full((speckle.height_px // 2, speckle.width_px // 2), 128, np.uint8)
    path = tmp_path_factory.mktemp("repair") / "moving.mp4"
    planes = (camera_of(speckle.picture(shift=np.multiply(SHIFT_PX, k)), 1.0, k) for k in range(FRAMES))
    write_video(path, (Picture(plane, half, half) for plane in planes), 240, crf=8)
    return path


def rows_of(path):
    with path.open(encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


def test_a_point_in_a_later_frame_and_a_mark_reach_the_table(vml, video, tmp_path):
    x, y = place(6)
    marked = place(2)
    out = tmp_path / "track.csv"
    code, said, _ = vml(
        "track", video, "-p", f"ball={x},{y}@6", "--mark", f"ball={marked[0] + 1},{marked[1]}@2", "--block", 41,
        "-o", out, "--json",
    )  # fmt: skip
    assert code == 0
    rows = rows_of(out)
    assert [row["ball_status"] for row in rows] == ["auto", "auto", "manual"] + ["auto"] * 7
    assert float(rows[2]["ball_x_px"]) == marked[0] + 1
    for k in (0, 1, 3, 4, 9):
        assert float(rows[k]["ball_x_px"]) == pytest.approx(place(k)[0], abs=FOUND_PX)
    ball = json.loads(said)["points"]["ball"]
    assert ball["statuses"] == {"auto": 9, "manual": 1}
    assert (ball["found"], ball["lost"]) == (10, 0)


def test_a_virtual_point_is_written_and_can_end_a_vector(vml, video, tmp_path):
    out = tmp_path / "track.csv"
    code, said, _ = vml(
        "track", video, "-p", "toe=90,100", "-p", "heel=140,125", "--virtual", "knee=toe+heel@120,60", "--block", 31,
        "--vector", "shin=knee:toe", "-o", out, "--overlay", tmp_path / "overlay.mp4",
    )  # fmt: skip
    assert code == 0
    rows = rows_of(out)
    assert {row["knee_status"] for row in rows} == {"virtual"}
    for k in (0, 5, 9):
        assert float(rows[k]["knee_x_px"]) == pytest.approx(120 + k * SHIFT_PX[0], abs=FOUND_PX)
        assert float(rows[k]["knee_y_px"]) == pytest.approx(60 + k * SHIFT_PX[1], abs=FOUND_PX)
    assert float(rows[9]["shin_dlength_pct"]) == pytest.approx(0.0, abs=0.3)
    assert "10 of 10 (10 virtual)" in said


def test_carriers_that_part_are_warned_of(vml, video, tmp_path):
    code, _, said = vml(
        "track", video, "-p", "toe=90,100", "-p", "heel=140,125", "--mark", "heel=165,140@5", "--block", 31,
        "--virtual", "knee=toe+heel@120,60", "-o", tmp_path / "track.csv",
    )  # fmt: skip
    assert code == 0
    assert "warning: knee: toe, heel do not stay the same distance apart" in said


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("-p", "ball=110,115@x"), "-p: expected a point as NAME=X,Y or NAME=X,Y@FRAME, such as ball=640.5,361, got"),
        (("-p", "ball=110,115@"), "-p: expected a point as NAME=X,Y or NAME=X,Y@FRAME"),
        (("-p", "ball=110,115@10"), "ball: expected a frame of the clip, 0 to 9, got 10."),
        (("-p", "ball=110,115", "--mark", "ball=3,4"), "--mark: expected a place by hand as NAME=X,Y@FRAME, such as"),
        (("-p", "ball=110,115", "--mark", "ball=3,4@44"), "mark ball: expected a frame of the clip, 0 to 9, got 44."),
        (("-p", "ball=110,115", "--mark", "foot=3,4@4"), "mark foot: expected one of the points ball, got 'foot'."),
        (("-p", "ball=110,115", "--virtual", "knee=ball"), "--virtual: expected a point as NAME=POINT+POINT@X,Y"),
        (("-p", "ball=110,115", "--virtual", "knee=ball@3"), "--virtual knee: expected two numbers X,Y in px, such"),
        (("-p", "ball=110,115", "--virtual", "ball=ball@3,4"), "point: expected each name once, got ball twice."),
        (("-p", "ball=110,115", "--virtual", "knee=ball+x@3,4"), "virtual knee: expected one of ball, got 'x'."),
        (("-p", "ball=110,115", "--virtual", "knee=ball@3,4@12"), "virtual knee: expected a frame of the clip, 0 to 9"),
        (
            ("-p", "ball=110,115", "--shutter", "soon"),
            "--shutter: expected a share of the frame interval from 0 to 1, or",
        ),
        (("-p", "ball=110,115", "--shutter", "auto", "--method", "block"), "shutter: expected method dic, which alone"),
        (("-p", "ball=110,115", "--fill", "spline"), "fill: expected one of linear, quadratic, got 'spline'."),
        (("-p", "ball=110,115", "--mark", "ball=3,4@0"), "ball: expected one place in a frame, got 2 in frame 0."),
    ],
)
def test_a_place_that_makes_no_sense_is_one_line(vml, video, tmp_path, words, line):
    out = tmp_path / "track.csv"
    code, _, said = vml("track", video, *words, "-o", out)
    assert code == 2
    assert line in said
    assert not out.exists()


def test_a_check_says_how_near_a_point_returns(vml, video):
    x, y = place(9)
    code, said, _ = vml("track", video, "-p", f"ball={x},{y}@9", "--block", 41, "--check", "--json")
    assert code == 0
    assert json.loads(said)["ball"]["returns_px"] < FOUND_PX

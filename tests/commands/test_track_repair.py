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


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("-p", "ball=110,115@x"), "-p: expected a point as NAME=X,Y or NAME=X,Y@FRAME, such as ball=640.5,361, got"),
        (("-p", "ball=110,115@"), "-p: expected a point as NAME=X,Y or NAME=X,Y@FRAME"),
        (("-p", "ball=110,115@10"), "ball: expected a frame of the clip, 0 to 9, got 10."),
        (("-p", "ball=110,115", "--mark", "ball=3,4"), "--mark: expected a place by hand as NAME=X,Y@FRAME, such as"),
        (("-p", "ball=110,115", "--mark", "ball=3,4@44"), "mark ball: expected a frame of the clip, 0 to 9, got 44."),
        (("-p", "ball=110,115", "--mark", "foot=3,4@4"), "mark foot: expected one of the points ball, got 'foot'."),
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

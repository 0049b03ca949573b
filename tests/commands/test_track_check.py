"""`vml track --check`: verdicts before tracking."""

import json

import numpy as np
import pytest

from vml_course.io.video import write_video
from vml_course.model.frame import Picture


@pytest.fixture(scope="module")
def video(tmp_path_factory, speckle, camera_of):
    """Three pictures of a still speckle, its left part covered by plain cloth and its right part by one edge."""
    picture = speckle.picture()
    picture[:, :90] = 120.0
    picture[:, 190:] = np.where(np.arange(50) < 25, 90.0, 170.0)
    half = np.full((speckle.height_px // 2, speckle.width_px // 2), 128, np.uint8)
    path = tmp_path_factory.mktemp("check") / "still.mp4"
    write_video(path, (Picture(camera_of(picture, 2.0, k), half, half) for k in range(3)), 240, crf=0)
    return path


GOOD, BLANK, EDGE = ("-p", "mark=140,110"), ("-p", "cloth=40,110"), ("-p", "seam=214,110")
CHECK = ("--check", "--block", 31)


def test_good_points_pass(vml, video):
    code, out, _ = vml("track", video, *GOOD, *CHECK)
    assert code == 0
    assert out.startswith("mark: good. Good texture. Expect about ±0.0")


def test_a_poor_point_ends_with_code_1_and_says_what_to_do(vml, video):
    code, out, _ = vml("track", video, *GOOD, *BLANK, *EDGE, *CHECK)
    assert code == 1
    assert "cloth: poor. No texture here." in out
    assert "seam: edge. Only an edge: the block can slide up and down." in out


def test_an_edge_alone_is_a_warning(vml, video):
    assert vml("track", video, *EDGE, *CHECK)[0] == 0


def test_the_numbers_come_as_json(vml, video):
    code, out, _ = vml("track", video, *GOOD, *BLANK, *CHECK, "--json")
    facts = json.loads(out)
    assert code == 1
    assert facts["mark"]["verdict"] == "good"
    assert 0 < facts["mark"]["sigma_px"] < 0.05
    assert facts["mark"]["noise_grey"] == pytest.approx(2.0, rel=0.15)
    assert facts["cloth"]["sigma_px"] is None


def test_every_method_can_be_asked(vml, video):
    for method in ("flow", "block"):
        assert vml("track", video, *GOOD, *CHECK, "--method", method)[0] == 0


def test_a_block_that_leaves_the_picture_is_one_line(vml, video):
    code, _, err = vml("track", video, "-p", "rim=4,4", *CHECK)
    assert code == 2
    assert err.startswith("rim: expected a point from (15, 15)")

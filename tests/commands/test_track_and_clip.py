"""`vml clip` and `vml track` at the prompt."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from vml_course.cli import run
from vml_course.io.video import probe, write_video
from vml_course.model.frame import Picture

Vml = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory, speckle: Any, camera_of: Any) -> Path:
    """Eight pictures of a speckle that walks by (1, -0.5) px a picture; its border leaves plain grey."""
    path = tmp_path_factory.mktemp("speckle") / "walk.mp4"
    half = np.full((speckle.height_px // 2, speckle.width_px // 2), 128, np.uint8)
    planes = (camera_of(speckle.picture(shift=(k, -0.5 * k))) for k in range(8))
    write_video(path, (Picture(plane, half, half) for plane in planes), 240, crf=10)
    return path


@pytest.fixture
def vml(capsys: pytest.CaptureFixture[str]) -> Vml:
    def call(*arguments: object) -> tuple[int, str, str]:
        code = run([str(argument) for argument in arguments])
        said = capsys.readouterr()
        return code, said.out, said.err

    return call


POINTS = ("-p", "a=90,110", "-p", "b=150,110")


def test_track_writes_every_file_that_was_asked_for(vml: Vml, video: Path, tmp_path: Path) -> None:
    names = [tmp_path / f"out.{kind}" for kind in ("xlsx", "csv", "mat")]
    outputs = [word for name in names for word in ("-o", name)]
    overlay = tmp_path / "overlay.avi"
    options = ("--scale", "0,0,100,0=50 cm", "--origin", "90,110", "--vector", "bar=a:b", "--block", 41)
    code, out, _ = vml("track", video, *POINTS, *options, *outputs, "--overlay", overlay)
    assert code == 0
    assert "8 of 8" in out
    assert all(str(name) in out.replace("\n", "") for name in [*names, overlay])
    assert probe(overlay).frame_count == 8
    with names[1].open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[:3] == ["frame", "step", "t_s"]
    assert float(rows[7]["t_s"]) == pytest.approx(7 / 240)
    assert float(rows[7]["a_x_px"]) == pytest.approx(97, abs=0.05)
    assert float(rows[7]["a_x_m"]) == pytest.approx(7 / 200, abs=0.001)
    assert float(rows[7]["a_y_m"]) == pytest.approx(3.5 / 200, abs=0.001)
    assert float(rows[7]["bar_length_m"]) == pytest.approx(0.3, abs=0.001)


def test_json_is_all_that_goes_to_standard_output(vml: Vml, video: Path, tmp_path: Path) -> None:
    code, out, err = vml("track", video, *POINTS, "--fps", 120, "--end", 5, "--json", "-o", tmp_path / "t.csv")
    facts = json.loads(out)
    assert code == 0
    assert (facts["frames"], facts["fps"], facts["px_per_m"]) == (6, 120, None)
    assert facts["points"]["a"]["found"] == 6
    assert facts["files"] == [str(tmp_path / "t.csv")]
    assert "Traceback" not in err


def test_the_axis_angle_turns_the_axes(vml: Vml, video: Path, tmp_path: Path) -> None:
    options = ("--scale", "0,0,100,0=1 m", "--origin", "90,110", "--axis-angle", 90)
    vml("track", video, *POINTS, *options, "-o", tmp_path / "t.csv")
    with (tmp_path / "t.csv").open(encoding="utf-8-sig", newline="") as file:
        last = list(csv.DictReader(file))[-1]
    assert float(last["a_x_m"]) == pytest.approx(0.035, abs=0.001), "x points up now, and the point climbed"
    assert float(last["a_y_m"]) == pytest.approx(-0.07, abs=0.001), "y points to the left"


def test_an_estimate_is_a_gate_and_writes_nothing(vml: Vml, video: Path, tmp_path: Path) -> None:
    code, out, _ = vml("track", video, *POINTS, "--estimate", "-o", tmp_path / "t.csv")
    assert code == 0
    assert out.startswith("about ")
    assert "2 points in 8 frames" in out
    code, out, _ = vml("track", video, *POINTS, "--estimate", "--json")
    assert json.loads(out)["seconds"] > 0
    assert list(tmp_path.iterdir()) == []


def test_a_clip_is_cut_and_tracked_under_the_numbers_of_its_video(vml: Vml, video: Path, tmp_path: Path) -> None:
    clip = tmp_path / "clip.avi"
    code, out, _ = vml("clip", video, "--start", 2, "--end", 6, "--step", 2, "-o", clip)
    assert code == 0
    assert "3 pictures" in out
    assert (tmp_path / "clip.avi.vmlclip.json").is_file()
    code, out, _ = vml("track", clip, "-p", "a=92,109", "--json", "-o", tmp_path / "t.csv")
    facts = json.loads(out)
    assert (facts["video"], facts["first_frame"], facts["last_frame"], facts["fps"]) == ("walk.mp4", 2, 6, 240)
    code, out, _ = vml("clip", video, "--start", 0, "--end", 3, "-o", tmp_path / "clip.mp4", "--json")
    assert json.loads(out)["frames"] == 4


def test_a_lost_point_is_said_and_left_empty(vml: Vml, video: Path, tmp_path: Path, camera_of: Any) -> None:
    """The speckle is gone from the fifth picture on."""
    path = tmp_path / "gone.mp4"
    from vml_course.io.video import read_pictures

    pictures = [one.picture for one in read_pictures(video)]
    rng = np.random.default_rng(3)
    noise = rng.normal(128, 25, pictures[0].luma.shape)
    blank = Picture(camera_of(noise), pictures[0].blue, pictures[0].red)
    write_video(path, [*pictures[:4], *[blank] * 4], 240, crf=10)
    code, _, err = vml("track", path, *POINTS, "-o", tmp_path / "t.csv")
    assert code == 0
    assert "warning: a: lost in 4 of 8 frames, first in frame 4." in err
    with (tmp_path / "t.csv").open(encoding="utf-8-sig", newline="") as file:
        last = list(csv.DictReader(file))[-1]
    assert (last["a_x_px"], last["a_status"]) == ("", "lost")


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        ((), "-p"),
        (("-p", "a=90"), "X,Y"),
        (("-p", "a=90,110"), "-o"),
        ((*POINTS, "-o", "t.ods"), ".xlsx"),
        ((*POINTS, "-o", "t.csv", "--overlay", "o.gif"), ".mp4"),
        ((*POINTS, "-o", "nowhere/t.csv"), "folder"),
        ((*POINTS, "-o", "t.csv", "--scale", "1,2,3,4=5 kg"), "--scale"),
        ((*POINTS, "-o", "t.csv", "--scale", "1,2,3,4=5 cm"), "at least 20 px"),
        ((*POINTS, "-o", "t.csv", "--vector", "bar=a:c"), "one of a, b"),
        ((*POINTS, "-o", "t.csv", "--method", "magic"), "dic"),
        ((*POINTS, "-o", "t.csv", "--block", "5"), "block"),
        ((*POINTS, "-o", "t.csv", "--start", "9"), "0 to 7"),
        ((*POINTS, "-o", "t.csv", "--fps", "fast"), "--fps"),
        ((*POINTS, "-o", "t.csv", "--fps", "0"), "fps"),
        (("-p", "a=900,110", "-o", "t.csv"), "a: expected"),
    ],
)
def test_a_mistake_is_one_line_and_leaves_nothing(
    vml: Vml, video: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], names: str
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = vml("track", video, *arguments)
    assert (code, out) == (2, "")
    assert names in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_setting_that_the_method_lacks_is_one_line(vml: Vml, video: Path, tmp_path: Path) -> None:
    from vml_course.track.tracker import tracker_class

    code, _, err = vml("track", video, *POINTS, "--shutter", 0.5, "-o", tmp_path / "t.csv")
    if "shutter" in tracker_class("dic").__dataclass_fields__:
        assert code == 0
    else:
        assert code == 2
        assert "'shutter'" in err
        assert err.count("\n") == 1

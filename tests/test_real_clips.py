"""Videos that this project did not make: phone clips of known physics, tracked at the prompt.

They are not part of the repository; the tests run where the folder lies beside it.
"""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path

import numpy as np
import pytest

from vml_course.cli import run
from vml_course.io.video import probe

FOLDER = Path(__file__).parents[1] / ".." / "shared" / "data" / "real"
G_M_S2 = 9.81
LAUNCH_DEG, LAUNCH_M_S = 45.0, 2.687  # from the file's name
ANGLE_TOLERANCE_DEG = 1.5
DISTANCE_SCATTER = 0.005
LAUNCHER_PX = ((0, 40), (60, 140))  # where the launcher is seen: x, y

pytestmark = pytest.mark.real


@pytest.fixture(scope="module", autouse=True)
def _clips_are_here() -> None:
    """CI has the clips: there their absence is a fault. At a desk without them the tests are left out, and say so."""
    if not FOLDER.is_dir():
        absent = "the real clips (../shared/data/real) are not on this machine"
        pytest.fail(absent) if os.environ.get("CI") else pytest.skip(absent)


def columns(path: Path) -> dict[str, np.ndarray]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    numbers = [name for name in rows[0] if not name.endswith("_status")]
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in numbers}


def track(tmp_path: Path, name: str, *arguments: str) -> dict[str, np.ndarray]:
    table, overlay = tmp_path / "track.csv", tmp_path / "overlay.mp4"
    assert run(["track", str(FOLDER / name), *arguments, "-o", str(table), "--overlay", str(overlay)]) == 0
    found = columns(table)
    assert probe(overlay).frame_count == len(found["frame"])
    return found


def test_the_file_of_a_slow_motion_clip_says_another_rate_than_the_camera_had() -> None:
    info = probe(FOLDER / "pt_projectile_45deg_2.687mps.mp4")
    assert info.fps == pytest.approx(30000 / 1001)
    assert (info.frame_count, info.is_variable_rate, info.damage) == (630, False, "")


def test_the_launch_angle_of_the_projectile_fits_its_name(tmp_path: Path) -> None:
    """Free fall gives the scale, the scale the level velocity, and with the speed in the name the angle."""
    ball = track(
        tmp_path, "pt_projectile_45deg_2.687mps.mp4", "-p", "ball=49.2,68.9", "--start", "180", "--end", "271",
        "--fps", "240", "--block", "13",
    )  # fmt: skip
    t, x, y = ball["t_s"], ball["ball_x_px"], ball["ball_y_px"]
    assert np.isfinite(x).all()
    level, fall = np.polyfit(t, x, 1), np.polyfit(t, y, 2)
    assert np.std(y - np.polyval(fall, t)) < 0.2
    px_per_m = 2 * fall[0] / G_M_S2
    angle_deg = np.degrees(np.arccos(level[0] / px_per_m / LAUNCH_M_S))
    assert angle_deg == pytest.approx(LAUNCH_DEG, abs=ANGLE_TOLERANCE_DEG)
    t_launch = (-level[0] * np.tan(np.radians(LAUNCH_DEG)) - fall[1]) / (
        2 * fall[0]
    )  # where the path climbs so steeply
    for place, (low, high) in zip((np.polyval(level, t_launch), np.polyval(fall, t_launch)), LAUNCHER_PX, strict=True):
        assert low <= place <= high


def test_the_dots_on_the_rolling_cylinder_keep_their_distance(tmp_path: Path) -> None:
    """Over more than a turn.

    The picture's scale falls along the plank, because the camera does not look at it squarely: the disc's own
    radius shrinks by 5 % over the path, and the distance of the dots with it. The scatter is taken about that line.
    """
    dots = track(
        tmp_path, "pt_rolling_cylinder.mp4", "-p", "a=268.9,109.3", "-p", "b=251.2,124.5", "--start", "104",
        "--end", "225", "--fps", "240", "--vector", "dots=a:b", "--block", "11",
    )  # fmt: skip
    length, middle = dots["dots_length_px"], 0.5 * (dots["a_x_px"] + dots["b_x_px"])
    assert np.isfinite(length).all()
    assert np.ptp(dots["dots_angle_deg"]) > 360
    scatter = length / np.polyval(np.polyfit(middle, length, 1), middle) - 1
    assert np.std(scatter) < DISTANCE_SCATTER
    assert np.std(length[:60]) / np.mean(length[:60]) < DISTANCE_SCATTER, "as seen, over half a turn"


def test_a_hand_held_cup_is_followed_or_said_to_be_lost(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["-p", "cup=320,240", "--end", "60", "--json", "-o", str(tmp_path / "cup.csv")]
    assert run(["track", str(FOLDER / "dice_cup.mp4"), *arguments]) == 0
    said = capsys.readouterr()
    facts = json.loads(said.out)
    assert facts["fps"] == pytest.approx(26.777)
    assert facts["points"]["cup"]["found"] + facts["points"]["cup"]["lost"] == 61
    assert ("lost" in said.err) == (facts["points"]["cup"]["lost"] > 0)

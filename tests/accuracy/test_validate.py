"""`vml validate --quick` holds the budget, and breaking anything on purpose turns it red."""

import json
import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from vml_course.cli import run
from vml_course.correlate import template
from vml_course.errors import FileFormatError, FileMissingError
from vml_course.usecases import make_video as making
from vml_course.usecases.budget import limits_of, read_budget
from vml_course.usecases.validate import CONDITIONS, Case, cases, validate

CLEAN = [Case("soccer_kick", CONDITIONS[0], "dic")]


def only():
    """The verdict on one clean clip."""
    (verdict,) = validate(read_budget(), CLEAN)
    return verdict


def test_the_quick_matrix_is_within_the_budget(capsys):
    code = run(["validate", "--quick", "--json"])
    facts = json.loads(capsys.readouterr().out)
    assert {case: one["over"] for case, one in facts.items() if one["over"]} == {}
    assert code == 0
    assert len(facts) >= 4
    best = facts["soccer_kick/clean/dic"]
    assert best["lost_pictures"] == 0
    assert set(best["rms_px"]) == {"foot", "knee", "shin", "ball"}


def test_scenes_in_which_nothing_is_hit_are_left_out():
    assert {case.scene for case in cases()}.isdisjoint({"tensile_strip", "plate_with_hole"})


def test_half_a_pixel_in_the_renderer_turns_it_red(monkeypatch):
    honest, half = making.render, np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 0.0]])

    def shifted(truth, recording):
        for picture in honest(truth, recording):
            yield replace(picture, luma=cv2.warpAffine(picture.luma, half, picture.luma.shape[::-1]))

    monkeypatch.setattr(making, "render", shifted)
    verdict = only()
    assert "worst_rms_px" in verdict.broken
    assert verdict.score.worst_rms_px == pytest.approx(0.5, abs=0.3)  # a point of the turning leg, seen from its seed


def test_a_sign_in_the_kernel_turns_it_red(monkeypatch):
    honest = template.gradients_at_pixels

    def flipped(crop):
        across, down = honest(crop)
        return across, -down

    monkeypatch.setattr(template, "gradients_at_pixels", flipped)
    assert {"worst_rms_px", "lost_pictures"} & set(only().broken)


@pytest.mark.parametrize("factor", [1.001, 0.5])
def test_a_wrong_frame_time_turns_it_red(monkeypatch, factor):
    honest = making.write_video

    def slowed(path, pictures, fps, *how):
        return honest(path, pictures, fps * factor, *how)

    monkeypatch.setattr(making, "write_video", slowed)
    broken = only().broken
    assert "worst_time_error_ms" in broken


def test_a_broken_limit_is_said_and_ends_with_code_1(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("vml_course.usecases.validate.cases", lambda *, quick: CLEAN)
    strict = tmp_path / "strict.toml"
    names = vars(limits_of(read_budget(), "default"))
    strict.write_text("[default]\n" + "\n".join(f"{name} = 0" for name in names), encoding="utf-8")
    assert run(["validate", "--budget", str(strict)]) == 1
    out = capsys.readouterr().out
    assert "soccer_kick/clean/dic: worst_rms_px is 0.00" in out
    assert "0 of 1 cases within the budget" in out


def test_the_matrix_covers_every_scene_condition_and_method():
    whole = {case.name for case in cases()}
    assert {case.name for case in cases(quick=True)} < whole
    assert {"soccer_kick/clean/dic", "soccer_kick/noisy/flow", "soccer_kick/compressed/block"} <= whole


def test_a_longer_row_goes_before_a_shorter_one():
    rows = read_budget()
    rows["clean/dic"] = {"worst_rms_px": 0.01}
    rows["dic"] = {"worst_rms_px": 7.0, "lost_pictures": 3.0}
    rows["soccer_kick/clean/dic"] = {"omega_error_pct": math.inf}
    limits = limits_of(rows, "soccer_kick/clean/dic")
    assert (limits.worst_rms_px, limits.lost_pictures, limits.omega_error_pct) == (0.01, 3.0, math.inf)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[default]\nworst = 1\n", "limits among"),
        ("[default]\nworst_rms_px = 1\n", "a number for every limit"),
        ("[default]\nworst_rms_px = 'x'\n", "a number"),
        ("default = 3\n", "rows of limits"),
        ("[", "a TOML file"),
    ],
)
def test_a_budget_that_makes_no_sense_is_refused(tmp_path, text, words):
    path = tmp_path / "budget.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FileFormatError, match=words):
        read_budget(path)


def test_a_budget_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(FileMissingError):
        read_budget(tmp_path / "none.toml")

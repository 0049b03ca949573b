"""The answer key: the truth of the video, and nothing lost when it is kept."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from assignments.key import answer_key, from_json, stick_px, to_json, true_value
from assignments.load import load_assignment
from assignments.variants import draw_variant, impact_numbers
from vml_course.errors import InputError
from vml_course.model.camera import Camera
from vml_course.model.solution import Estimate, ImpactSolution
from vml_course.model.truth import Truth
from vml_course.synth.scene import scene_class
from vml_course.synth.simulate import simulate

KICK = load_assignment("soccer-kick")
VARIANT = draw_variant(KICK, bytes(32), "s1")
MEASURED = ImpactSolution("fixed-pivot", "joint", {"e": Estimate(0.7, 0.002), "I": Estimate(1.9, math.nan)}, 0.1, 24)
MOVED_PX = 0.01  # what a hand does within one frame, while the shutter rolls down to the bar
PROMISED = 1e-6  # relative: what a simulated impact keeps of its parameters


@pytest.fixture(scope="module")
def truth() -> Truth:
    return simulate(scene_class(KICK.scene)(**VARIANT.parameters), Camera(**VARIANT.camera), VARIANT.seed)


def test_the_key_holds_what_was_simulated_and_it_is_what_was_drawn(truth: Truth) -> None:
    key = answer_key(KICK, VARIANT, truth, None, "0" * 64)
    drawn = impact_numbers(KICK, VARIANT.parameters)
    expected = {"v_f1": drawn.v1, "v_f2": drawn.v2, "v_b2": drawn.u2, "omega1": drawn.omega1, "omega2": drawn.omega2}
    expected |= {"e": drawn.e, "I": drawn.I, "px_per_m": VARIANT.camera["px_per_m"], "fps": 480.0}
    assert {name: key.values[name] for name in expected} == pytest.approx(expected, rel=PROMISED)
    assert key.values["v_b1"] == pytest.approx(0.0, abs=1e-12)
    assert set(key.values) == {question.id for question in KICK.questions}
    assert (key.truth["theta_impact_rad"], key.truth["tilt_rad"]) == pytest.approx((-math.pi / 2, 0.0), abs=1e-3)
    assert key.measured == key.expected_sd == {}


def test_speeds_of_the_foot_are_those_of_its_true_path(truth: Truth) -> None:
    """Distance along the arc between two frames before the impact, over their time."""
    foot = truth.xy_m[:, truth.point_index("foot")]
    step = np.hypot(*(foot[1] - foot[0])) / (truth.time_s[1] - truth.time_s[0])
    assert true_value("v_f1", truth) == pytest.approx(step, rel=0.02)  # gravity acts on the leg in between


def test_a_question_without_a_known_truth_is_refused(truth: Truth) -> None:
    with pytest.raises(InputError, match=r"question\.spin: expected one of px_per_m, .*, got 'spin'"):
        true_value("spin", truth)


def test_the_stick_is_where_a_bent_and_rolling_picture_from_a_hand_shows_it() -> None:
    bent = {"distortion": 0.08, "rolling_shutter": 0.7, "shake_px": 3.0}
    scene, square = scene_class(KICK.scene)(**VARIANT.parameters), Camera(**VARIANT.camera)
    shaken = simulate(scene, replace(square, **bent), VARIANT.seed)
    ends = [shaken.mark_px(name) for name in (KICK.stick.tail, KICK.stick.head)]
    assert stick_px(shaken, KICK) == pytest.approx(np.ravel(ends))
    kept = answer_key(KICK, VARIANT, shaken, None, "0" * 64).truth
    assert [kept[f"stick_{axis}{end}_px"] for end in "12" for axis in "xy"] == pytest.approx(np.ravel(ends))
    lens_only = shaken.camera.to_px(np.array([shaken.marks_m[name] for name in (KICK.stick.tail, KICK.stick.head)]))
    assert np.abs(lens_only - ends).max() > MOVED_PX


def test_a_key_survives_being_kept(truth: Truth) -> None:
    key = answer_key(KICK, VARIANT, truth, MEASURED, "0" * 64)
    again = from_json(json.loads(json.dumps(to_json(key), allow_nan=False)))
    assert to_json(again) == to_json(key)
    np.testing.assert_array_equal(again.xy_px, truth.xy_px)
    assert again.points == truth.points
    assert again.scene == "soccer_kick"
    assert again.expected_sd["e"] == 0.002
    assert math.isnan(again.expected_sd["I"])


def test_a_key_of_the_first_version_is_that_of_a_kick(truth: Truth) -> None:
    content = to_json(answer_key(KICK, VARIANT, truth, None, "0" * 64))
    del content["scene"]
    assert from_json(content).scene == "soccer_kick"

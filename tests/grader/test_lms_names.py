"""Names of files in the downloads of learning platforms."""

from __future__ import annotations

import datetime as dt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.lms import platforms, recognise
from vml_course.errors import UnknownNameError


@pytest.mark.parametrize(
    ("path", "platform", "kind", "value", "original", "late"),
    [
        ("doejane_90210_555_my lab.xlsx", "canvas", "canvas_id", "90210", "my lab.xlsx", False),
        ("doejane_LATE_90210_555_my lab.xlsx", "canvas", "canvas_id", "90210", "my lab.xlsx", True),
        ("doe_jane_90210_555_a_1_2_b.xlsx", "canvas", "canvas_id", "90210", "a_1_2_b.xlsx", False),
        ("sub/æøå_90210_555_lab-1.xlsx", "canvas", "canvas_id", "90210", "lab-1.xlsx", False),
        ("anon_x7Ab2_555_lab.xlsx", "canvas", "canvas_anonymous", "x7Ab2", "lab.xlsx", False),
        ("anon_LATE_x7Ab2_555_lab.xlsx", "canvas", "canvas_anonymous", "x7Ab2", "lab.xlsx", True),
        ("Jane Doe_48213_assignsubmission_file/lab.xlsx", "moodle", "moodle_participant", "48213", "lab.xlsx", None),
        ("Jane Doe_48213_assignsubmission_file_/lab.xlsx", "moodle", "moodle_participant", "48213", "lab.xlsx", None),
        ("J_1 D_48213_assignsubmission_file_lab_2.xlsx", "moodle", "moodle_participant", "48213", "lab_2.xlsx", None),
        ("x/Ann_7_assignsubmission_file/deep/lab.xlsx", "moodle", "moodle_participant", "7", "lab.xlsx", None),
        ("assignment_1_export/submission_77/lab.xlsx", "gradescope", "gradescope", "77", "lab.xlsx", None),
        ("A b_c_jdoe_attempt_2026-05-01-23-58-10_l_1.xlsx", "blackboard", "login", "jdoe", "l_1.xlsx", None),
    ],
)
def test_each_platforms_names_are_understood(path, platform, kind, value, original, late) -> None:
    found = recognise(path)
    assert found is not None
    assert (found.platform, found.kind, found.value, found.original) == (platform, kind, value, original)
    assert found.is_late is late
    assert recognise(path, platform) == found


def test_blackboard_says_when_it_came() -> None:
    found = recognise("Lab_jdoe_attempt_2026-05-01-23-58-10_lab.xlsx")
    assert found is not None
    assert found.received == dt.datetime(2026, 5, 1, 23, 58, 10)  # noqa: DTZ001 - the platform's local time


@pytest.mark.parametrize(
    "path",
    [
        "lab.xlsx",
        "my_lab_2.xlsx",
        "a/b/c.xlsx",
        "Lab_jdoe_attempt_2026-15-01-23-58-10_lab.xlsx",
        "submission_7/.hidden",
    ],
)
def test_other_names_say_nothing(path: str) -> None:
    assert recognise(path) is None


def test_an_unknown_platform_is_told_with_those_known() -> None:
    assert list(platforms()) == ["blackboard", "canvas", "gradescope", "moodle"]
    with pytest.raises(UnknownNameError, match="lms: expected one of auto, blackboard, canvas, gradescope, moodle"):
        recognise("x", "webct")


@given(st.text(st.characters(exclude_characters="/"), min_size=1, max_size=60), st.integers(1, 10**9))
def test_any_full_name_in_front_leaves_moodles_number_found(name: str, number: int) -> None:
    found = recognise(f"{name}_{number}_assignsubmission_file/lab.xlsx", "moodle")
    if "\n" not in name:
        assert found is not None
        assert found.value == str(number)

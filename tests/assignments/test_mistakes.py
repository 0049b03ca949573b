"""The formulas of common mistakes against the figures of the paper's kick."""

from __future__ import annotations

import dataclasses
import math

import pytest

from assignments.mistakes import MISTAKES, ImpactNumbers
from tests.impacts import numbers_of_impact

PAPER = ImpactNumbers(
    v1=15,
    v2=13,
    u1=0,
    u2=24,
    omega1=15 / 0.56,
    omega2=13 / 0.56,
    m=0.5,
    L=0.56,
    D=0.22,
    S=500,
    tilt_rad=math.radians(5),
)

# The published catalogue prints three digits; the last may be rounded either way.
THREE_DIGITS = 6e-3

PAPER_VALUES = {
    "E1": 1.364, "E2": 1.600, "E3": 2.467, "E4": 0.692, "E5": -0.733, "E6": 0.0833, "E6b": 12, "E7": 0.538, "E8": 0.856,
    "E9": 0.964, "E10": 0.0293, "E11": 799, "E12": -0.379, "E12b": 4.383, "E13": -0.839, "E13b": -0.70, "E14": -2.467,
    "E15": 0.727, "E16": 0.387, "E16b": 0.560, "E17": 0.802, "E17b": 1.041, "E18": 0.677, "E18b": 0.529, "E18c": -1.0,
    "E19": 0.867, "E20": 0.458, "E21": 0.846, "E22": 0.133, "E24": 1.124, "E24b": 0.471,
    "I1": 3.36, "I2": 1.054, "I4": 6.00, "I5": 6.17, "I5b": 20.3, "I5c": 188, "I5d": 18816, "I6": 1882, "I6b": 4.15,
    "I6c": 18.5, "I6d": 1.69, "I7": 941, "I7b": 4.7e5, "I8": 0.0328, "I8b": 0.197, "I9": 2.25, "I9b": 1.51, "I9c": 2.62,
    "I10": 2.03, "I11": -1.88, "I12": 0.148, "I12b": 0.370, "I12c": 0.296, "I13": 1.019, "I14": 1.613, "I15": 0.862,
    "I15b": 0.706, "I16": 0.134, "I17": 0.251, "I17b": 0.289, "I18": 0.470, "I19": 3.39, "I20": 1.889, "I23": 0.94,
    "I23b": 3.76, "I24": 1.38, "I24b": 2.57, "I25": 3.26, "I27": 0.157, "I28": 2.04, "I28b": 1.72,
}  # fmt: skip


@pytest.mark.parametrize(("code", "expected"), PAPER_VALUES.items())
def test_a_mistake_gives_the_value_of_the_published_catalogue(code: str, expected: float) -> None:
    assert MISTAKES[code].value(PAPER) == pytest.approx(expected, rel=THREE_DIGITS)


def test_every_mistake_is_checked_against_a_number() -> None:
    assert set(MISTAKES) == set(PAPER_VALUES) | {"E25"}


def test_an_incoming_ball_whose_sign_is_lost_seems_to_be_chased() -> None:
    incoming = dataclasses.replace(PAPER, u1=-5.0)
    assert MISTAKES["E25"].value(incoming) == pytest.approx((24 - 13) / (15 - 5))


def test_a_mistake_that_cannot_be_made_has_no_value() -> None:
    upright, standing = dataclasses.replace(PAPER, tilt_rad=0.0), dataclasses.replace(PAPER, v1=0.0, u1=0.0)
    assert math.isnan(MISTAKES["E25"].value(PAPER))
    assert math.isnan(MISTAKES["E15"].value(upright))
    assert math.isnan(MISTAKES["I20"].value(upright))
    assert math.isnan(MISTAKES["E2"].value(standing))
    assert math.isnan(MISTAKES["E8"].value(dataclasses.replace(PAPER, u2=1.0)))


def test_the_closed_form_gives_the_velocities_of_the_paper() -> None:
    found = numbers_of_impact({"e": 11 / 15, "I": 1.8816, "m": 0.5, "L": 0.56, "D": 0.22, "omega1": 15 / 0.56})
    assert (found.v1, found.v2, found.u1, found.u2) == pytest.approx((15, 13, 0, 24), abs=1e-12)
    assert (found.e, found.I) == pytest.approx((11 / 15, 1.8816), rel=1e-12)
    assert (found.D, found.tilt_rad, math.isnan(found.S)) == (0.22, 0.0, True)


def test_the_closed_form_keeps_e_and_inertia_when_the_ball_comes_in() -> None:
    found = numbers_of_impact({"e": 0.6, "I": 0.9, "m": 0.3, "L": 0.5, "omega1": 20.0, "u1": -4.0})
    assert (found.e, found.I, found.u1) == pytest.approx((0.6, 0.9, -4.0), rel=1e-12)
    assert math.isnan(found.D)


def test_the_closed_form_keeps_scale_and_tilt() -> None:
    found = numbers_of_impact({"e": 0.6, "I": 0.9, "m": 0.3, "L": 0.5, "omega1": 20.0}, px_per_m=500.0, tilt_rad=0.1)
    assert (found.S, found.tilt_rad) == (500.0, 0.1)


def test_what_comes_from_a_body_at_rest_is_another_mistakes() -> None:
    at_rest = dataclasses.replace(PAPER, omega1=0.0, v1=0.0, u1=-5.0)
    assert math.isnan(MISTAKES["I16"].value(at_rest))
    assert math.isnan(MISTAKES["E25"].value(at_rest))
    assert math.isfinite(MISTAKES["I17b"].value(PAPER))

"""A body on a pivot that meets another one: its numbers, and what wrong answers look like.

What the textbooks of a fixed pivot and of a hammer share. Mistakes are formulas of the numbers that a student
works with, and two use this one list. The variant generator draws again until common mistakes give different numbers,
and the grader's diagnosis compares a wrong answer with them, evaluated on the student's own velocities.
The sentences that a student reads are in `pinned_hints.py`.

Codes and formulas follow the catalogue of eccentric-impact mistakes of this project (E: coefficient of
restitution, I: moment of inertia); a letter after the number marks a variety of the same mistake.
Mistakes that leave the number unchanged (frames inside the contact, for I) cannot be named by value and
are not here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from assignments.pinned_hints import PINNED_HINTS
from assignments.theory import Mistake

FEET = 3.28084  # in a metre
DEGREES = 180.0 / math.pi
RPM = 30.0 / math.pi
POUNDS = 2.20462  # in a kilogram
STANDARD_GRAVITY = 9.81
MATCH_BALL_KG = 0.45  # what a search for "mass of a soccer ball" answers
THIGH_M = 0.45


@dataclass(frozen=True)
class ImpactNumbers:
    """The numbers of an impact on a body about a fixed axis, true or as a student wrote them; SI units.

    Attributes
    ----------
    v1, v2 : float
        Speed of the striking point along its path before and after, positive towards the struck body.
    u1, u2 : float
        Velocity of the struck body before and after, positive in the same direction.
    omega1, omega2 : float
        Angular velocity before and after.
    m, L, D : float
        Mass and diameter of the struck body, arm of the striking point about the axis.
    S : float
        Scale of the picture in px/m.
    tilt_rad : float
        Angle between the contact normal and the path of the striking point.
    mark : float
        Distance from the axis to the tracked mark, where that is another one than L (a door's edge).
    """

    v1: float
    v2: float
    u1: float
    u2: float
    omega1: float
    omega2: float
    m: float
    L: float
    D: float = math.nan
    S: float = math.nan
    tilt_rad: float = 0.0
    mark: float = math.nan

    @property
    def e(self) -> float:
        """Coefficient of restitution that follows from the velocities."""
        return (self.u2 - self.v2) / (self.v1 - self.u1)

    @property
    def gain(self) -> float:
        """Angular momentum that the struck body gained about the axis, m L (u2 - u1)."""
        return self.m * self.L * (self.u2 - self.u1)

    @property
    def I(self) -> float:  # noqa: E743, N802 - the textbook's letter
        """Moment of inertia that follows from the conservation of angular momentum about the axis."""
        return self.gain / (self.omega1 - self.omega2)


Formula = Callable[[ImpactNumbers], float]


def _turning(n: ImpactNumbers, value: float) -> float:
    """Return a value that is another mistake's where the body stood still before."""
    return value if n.omega1 else math.nan


def _mean_cosine(omega: float, window_s: float) -> float:
    swept = omega * window_s
    return math.sin(swept) / swept


def _horizontal(n: ImpactNumbers, window_s: float) -> float:
    s1, s2 = _mean_cosine(n.omega1, window_s), _mean_cosine(n.omega2, window_s)
    return (n.u2 - s2 * n.v2) / (s1 * n.v1 - n.u1)


def _smoothed(n: ImpactNumbers, q: float) -> float:
    return ((1 - q) * n.e - q) / ((1 - q) - q * n.e)


def _foot_scaled(n: ImpactNumbers, factor: float) -> float:
    return (n.u2 - factor * n.v2) / (factor * n.v1 - n.u1)


def _ball_scaled(n: ImpactNumbers, factor: float) -> float:
    return (factor * n.u2 - n.v2) / (n.v1 - factor * n.u1)


def _energy_ratio(n: ImpactNumbers) -> float:
    before = n.I * n.omega1**2 + n.m * n.u1**2
    return (n.I * n.omega2**2 + n.m * n.u2**2) / before


def _tilted(n: ImpactNumbers) -> float:
    if n.tilt_rad == 0:
        return math.nan
    return n.e * math.cos(n.tilt_rad) - n.omega2 / n.omega1 * (1 - math.cos(n.tilt_rad))


def _spin(n: ImpactNumbers) -> float:
    """Angular momentum gained by a solid ball that would roll off the foot, over the loss of rate."""
    return 0.4 * n.m * n.D / 2 * (n.u2 - n.u1) / (n.omega1 - n.omega2)


_E: tuple[tuple[str, str, Formula], ...] = (
    ("E1", "inverted: approach over separation", lambda n: 1 / n.e),
    ("E2", "speed of the {striker} after the impact left out", lambda n: n.u2 / (n.v1 - n.u1)),
    ("E3", "sign of the {striker}'s speed after the impact", lambda n: (n.u2 + n.v2) / (n.v1 - n.u1)),
    ("E4", "speeds of the {striker} before and after swapped", lambda n: (n.u2 - n.v1) / (n.v2 - n.u1)),
    ("E5", "{striker} and {struck} swapped in one of the differences", lambda n: -n.e),
    ("E6", "ratio of the changes, {striker} over {struck}", lambda n: (n.v1 - n.v2) / (n.u2 - n.u1)),
    ("E6b", "ratio of the changes, {struck} over {striker}", lambda n: (n.u2 - n.u1) / (n.v1 - n.v2)),
    ("E7", "squared", lambda n: n.e**2),
    ("E8", "square root", lambda n: math.sqrt(n.e)),
    ("E9", "ratio of kinetic energies", _energy_ratio),
    ("E10", "angular velocity used as the {striker}'s speed", lambda n: (n.u2 - n.omega2) / (n.omega1 - n.u1)),
    ("E11", "{struck} in px/s, {striker} in m/s", lambda n: _ball_scaled(n, n.S)),
    ("E12", "{striker} in ft/s, {struck} in m/s", lambda n: _foot_scaled(n, FEET)),
    ("E12b", "{struck} in ft/s, {striker} in m/s", lambda n: _ball_scaled(n, FEET)),
    ("E13", "angular velocity in deg/s", lambda n: _foot_scaled(n, DEGREES)),
    ("E13b", "angular velocity in revolutions per minute", lambda n: _foot_scaled(n, RPM)),
    ("E14", "sign of the angular velocity (y axis down)", lambda n: _turning(n, (n.u2 + n.v2) / (-n.v1 - n.u1))),
    ("E15", "total speeds instead of components along the normal", _tilted),
    ("E16", "a frame inside the contact, 80 % of the impulse done", lambda n: 0.8 * (1 + n.e) - 1),
    ("E16b", "a frame inside the contact, 90 % of the impulse done", lambda n: 0.9 * (1 + n.e) - 1),
    ("E17", "horizontal component of the {striker} over 20 ms", lambda n: _horizontal(n, 0.020)),
    ("E17b", "horizontal component of the {striker} over 40 ms", lambda n: _horizontal(n, 0.040)),
    ("E18", "lightly smoothed across the impact", lambda n: _smoothed(n, 0.10)),
    ("E18b", "smoothed across the impact", lambda n: _smoothed(n, 0.25)),
    ("E18c", "difference taken across the impact", lambda n: _smoothed(n, 0.50)),
    ("E19", "{striker} after over {striker} before", lambda n: n.v2 / n.v1),
    ("E20", "separation over the {struck}'s speed after", lambda n: (n.u2 - n.v2) / n.u2),
    ("E21", "separation over the {striker}'s speed after", lambda n: (n.u2 - n.v2) / n.v2),
    ("E22", "change of the {striker}'s speed over its speed before", lambda n: (n.v1 - n.v2) / n.v1),
    ("E24", "{striker}'s speed taken R too near the {pivot}", lambda n: _foot_scaled(n, 1 - n.D / 2 / n.L)),
    ("E24b", "{striker}'s speed taken R too far from the {pivot}", lambda n: _foot_scaled(n, 1 + n.D / 2 / n.L)),
    (
        "E25",
        "sign of the incoming {struck} lost",
        lambda n: _turning(n, (n.u2 - n.v2) / (n.v1 - abs(n.u1))) if n.u1 < 0 else math.nan,
    ),
)

_I: tuple[tuple[str, str, Formula], ...] = (
    ("I1", "arm left out, or change of {striker} speed used as change of angular velocity", lambda n: n.I / n.L),
    ("I2", "one arm too many", lambda n: n.I * n.L),
    ("I4", "effective mass at the {striker} instead of moment of inertia", lambda n: n.I / n.L**2),
    ("I5", "arm in feet", lambda n: n.I * FEET),
    ("I5b", "arm in feet, squared", lambda n: n.I * FEET**2),
    ("I5c", "arm in centimetres", lambda n: n.I * 100),
    ("I5d", "arm in centimetres, squared", lambda n: n.I * 1e4),
    ("I6", "mass in grams", lambda n: n.I * 1000),
    ("I6b", "mass in pounds", lambda n: n.I * POUNDS),
    ("I6c", "weight instead of mass", lambda n: n.I * STANDARD_GRAVITY),
    ("I6d", "mass of a match ball (0.45 kg) instead of the given one", lambda n: n.I * MATCH_BALL_KG / n.m),
    ("I7", "{struck} in px/s", lambda n: n.I * n.S),
    ("I7b", "{struck} in px/s and arm in px", lambda n: n.I * n.S**2),
    ("I8", "angular velocity in deg/s", lambda n: n.I / DEGREES),
    ("I8b", "angular velocity in revolutions per minute", lambda n: n.I / RPM),
    ("I9", "arm to the far side of the {struck}'s centre, L + R", lambda n: n.I * (1 + n.D / 2 / n.L)),
    ("I9b", "arm L - R", lambda n: n.I * (1 - n.D / 2 / n.L)),
    ("I9c", "arm L + D, diameter taken for radius", lambda n: n.I * (1 + n.D / n.L)),
    ("I10", "spin of the {struck} added", lambda n: n.I + _spin(n)),
    ("I11", "before and after swapped", lambda n: -n.I),
    ("I12", "{struck}'s own moment of inertia instead of m L^2", _spin),
    ("I12b", "{struck}'s moment of inertia as m R^2", lambda n: 2.5 * _spin(n)),
    ("I12c", "{struck}'s own moment of inertia with the diameter", lambda n: 2 * _spin(n)),
    ("I13", "{striker} and {struck} stuck together", lambda n: n.m * n.L**2 * n.omega2 / (n.omega1 - n.omega2)),
    ("I14", "kinetic energy conserved", lambda n: n.m * (n.u2**2 - n.u1**2) / (n.omega1**2 - n.omega2**2)),
    ("I15", "speed of separation for the {struck}'s change", lambda n: n.I * (n.u2 - n.v2) / (n.u2 - n.u1)),
    (
        "I15b",
        "{struck} after minus {striker} before for the {struck}'s change",
        lambda n: n.I * (n.u2 - n.v1) / (n.u2 - n.u1),
    ),
    ("I16", "sum of the angular velocities", lambda n: _turning(n, n.gain / (n.omega1 + n.omega2))),
    ("I17", "angular velocity before only", lambda n: n.gain / n.omega1),
    ("I17b", "angular velocity after only", lambda n: _turning(n, n.gain / n.omega2)),
    ("I18", "about the middle of the {body}, taken as a rod", lambda n: n.I / 4),
    ("I19", "about the hip", lambda n: n.I * (1 + THIGH_M / n.L)),
    (
        "I20",
        "total {struck} speed instead of its component",
        lambda n: n.I / math.cos(n.tilt_rad) if n.tilt_rad else math.nan,
    ),
    ("I23", "half", lambda n: n.I / 2),
    ("I23b", "double", lambda n: n.I * 2),
    ("I24", "multiplied by e", lambda n: n.I * n.e),
    ("I24b", "divided by e", lambda n: n.I / n.e),
    ("I25", "multiplied by 1 + e", lambda n: n.I * (1 + n.e)),
    ("I27", "m L^2 of the {struck}", lambda n: n.m * n.L**2),
    ("I28", "m L^2 of the {struck} added", lambda n: n.I + n.m * n.L**2),
    ("I28b", "m L^2 of the {struck} subtracted", lambda n: n.I - n.m * n.L**2),
)

_ONLY = {"I6d": "soccer_kick", "I18": "soccer_kick", "I19": "soccer_kick"}  # a match ball, a shin, a hip

MISTAKES: Mapping[str, Mistake] = {
    code: Mistake(code, quantity, about, formula, PINNED_HINTS.get(code, ""), _ONLY.get(code, ""))
    for quantity, rows in (("e", _E), ("I", _I))
    for code, about, formula in rows
}

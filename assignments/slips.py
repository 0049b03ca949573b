"""Slips of units that spoil any conclusion in the same way: which factor each brings."""

from __future__ import annotations

from assignments.mistakes import DEGREES, POUNDS, RPM, STANDARD_GRAVITY
from assignments.theory import Formula, Mistake


def slips_of_mass(prefix: str, quantity: str, formula: Formula) -> tuple[Mistake, ...]:
    """Return the slips by which a conclusion that is proportional to the given mass goes wrong."""
    rows = (
        ("g", "mass in grams", 1000.0, "The mass looks as if it were in grams. Use kg."),
        ("lb", "mass in pounds", POUNDS, "The mass looks as if it were in pounds. Use kg."),
        ("w", "weight instead of mass", STANDARD_GRAVITY, "It looks as if a weight was used for the mass."),
    )
    return tuple(
        Mistake(f"{prefix}{letter}", quantity, about, _times(formula, factor), hint)
        for letter, about, factor, hint in rows
    )


def slips_of_rate(prefix: str, quantity: str, formula: Formula) -> tuple[Mistake, ...]:
    """Return the slips by which a conclusion that is inversely proportional to an angular velocity goes wrong."""
    rows = (
        ("d", "angular velocity in deg/s", DEGREES, "ω looks as if it were in degrees per second. Use rad/s."),
        ("r", "angular velocity in revolutions per minute", RPM, "ω looks as if it were in rev/min. Use rad/s."),
    )
    return tuple(
        Mistake(f"{prefix}{letter}", quantity, about, _times(formula, 1 / factor), hint)
        for letter, about, factor, hint in rows
    )


def _times(formula: Formula, factor: float) -> Formula:
    return lambda numbers: factor * formula(numbers)
